//! Operators without side effects (§5.9), `?:` and `,`.

use super::{Checker, liberal_conversion};
use crate::codes::Code;
use crate::tree::{BinaryOp, ExprId, ExprKind, Place, Scalar, Type, UnaryOp};

impl Checker<'_> {
    pub(crate) fn unary(&mut self, op: UnaryOp, operand: ExprId, at: Place) -> ExprId {
        let ty = self.ty(operand);
        let at = at.to(self.tree[operand].at);
        let fits = match op {
            UnaryOp::Plus | UnaryOp::Minus => ty.scalar().is_some_and(|scalar| scalar != Scalar::Bool),
            UnaryOp::Not => ty == Type::BOOL,
            UnaryOp::BitNot => is_integral(ty),
        };
        if !fits && ty != Type::Error {
            let message = format!("`{}` does not take {}", op.symbol(), self.said(ty));
            let mut diagnostic = Code::BadOperands.at(at, message);
            if op == UnaryOp::Not && matches!(ty, Type::Scalar(_)) {
                diagnostic = diagnostic
                    .note("`!` turns a `bool` round; to ask whether a number is 0, compare it with `==`");
            }
            return self.refuse_with(diagnostic, at);
        }
        let constant = self.tree[operand].constant;
        self.push(ExprKind::Unary { op, operand }, ty, constant, at)
    }

    pub(crate) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> ExprId {
        let at = self.tree[left].at.to(self.tree[right].at);
        let (a, b) = (self.ty(left), self.ty(right));
        if a == Type::Error || b == Type::Error {
            return self.broken(at);
        }
        let (left, right) = self.balance(op, left, right);
        let Some(ty) = self.binary_type(op, self.ty(left), self.ty(right)) else {
            let message = format!(
                "`{}` does not take {} and {}",
                op.symbol(),
                self.said(a),
                self.said(b)
            );
            let diagnostic = Code::BadOperands.at(at, message);
            let diagnostic = self.mended_operands(diagnostic, op, left, right);
            return self.refuse_with(diagnostic, at);
        };
        let constant = self.tree[left].constant && self.tree[right].constant;
        self.push(ExprKind::Binary { op, left, right }, ty, constant, at)
    }

    /// Under `lenient`, converts the operand of the weaker scalar type.
    fn balance(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> (ExprId, ExprId) {
        let shift = matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight);
        let (a, b) = (self.ty(left), self.ty(right));
        let (Some(x), Some(y)) = (a.scalar(), b.scalar()) else {
            return (left, right);
        };
        if !self.lenient || shift || x == y {
            return (left, right);
        }
        let to_left = b.with_scalar(x).and_then(|to| self.convert(right, to));
        let to_right = a.with_scalar(y).and_then(|to| self.convert(left, to));
        (to_right.unwrap_or(left), to_left.unwrap_or(right))
    }

    /// The type of `a op b`; none if there is no such operation.
    pub(super) fn binary_type(&self, op: BinaryOp, a: Type, b: Type) -> Option<Type> {
        match op {
            BinaryOp::Multiply => product(a, b),
            BinaryOp::Divide | BinaryOp::Add | BinaryOp::Subtract => {
                componentwise(a, b).filter(|ty| ty.scalar() != Some(Scalar::Bool))
            }
            BinaryOp::Remainder | BinaryOp::BitAnd | BinaryOp::BitXor | BinaryOp::BitOr => {
                componentwise(a, b).filter(|&ty| is_integral(ty))
            }
            // The signs may differ; a scalar takes no vector to shift by.
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight => {
                let sizes = (a.component_count()?, b.component_count()?);
                (is_integral(a) && is_integral(b) && (sizes.1 == 1 || sizes.0 == sizes.1)).then_some(a)
            }
            BinaryOp::Less | BinaryOp::Greater | BinaryOp::LessEqual | BinaryOp::GreaterEqual => {
                let numbers = matches!(a, Type::Scalar(scalar) if scalar != Scalar::Bool);
                (a == b && numbers).then_some(Type::BOOL)
            }
            BinaryOp::Equal | BinaryOp::NotEqual => {
                (a == b && a != Type::Void && !self.holds_sampler(a)).then_some(Type::BOOL)
            }
            BinaryOp::And | BinaryOp::Xor | BinaryOp::Or => {
                (a == Type::BOOL && b == Type::BOOL).then_some(Type::BOOL)
            }
        }
    }

    pub(crate) fn conditional(&mut self, condition: ExprId, yes: ExprId, no: ExprId) -> ExprId {
        let at = self.tree[condition].at.to(self.tree[no].at);
        let condition = self.condition(condition);
        let (mut yes, mut no) = (yes, no);
        // Under `lenient`, one side may be converted to the other's type.
        if let Some(fits) = self.convert(no, self.ty(yes)) {
            no = fits;
        } else if let Some(fits) = self.convert(yes, self.ty(no)) {
            yes = fits;
        }
        let (a, b) = (self.ty(yes), self.ty(no));
        if a != b && a != Type::Error && b != Type::Error {
            let message = format!(
                "`?:` chooses between values of one type, and these are {} and {}",
                self.said(a),
                self.said(b)
            );
            let diagnostic = Code::Mismatch.at(at, message);
            let diagnostic = if liberal_conversion(a, b) {
                self.related_mend(diagnostic, yes, b)
            } else {
                self.related_mend(diagnostic, no, a)
            };
            return self.refuse_with(diagnostic, at);
        }
        // Samplers are no values (§4.1.7). WebGL has no `?:` between calls without value, arrays or structures.
        let webgl_has_none = matches!(a, Type::Array(_) | Type::Struct(_)) && !self.lenient;
        if a == Type::Void || self.holds_sampler(a) || webgl_has_none {
            let message = format!("`?:` cannot choose between values of type {}", self.said(a));
            return self.refuse(Code::BadType, at, message);
        }
        let constant = [condition, yes, no].iter().all(|&part| self.tree[part].constant);
        self.push(ExprKind::Conditional { condition, yes, no }, a, constant, at)
    }

    /// `first, second`: never a constant expression (§4.3.3).
    pub(crate) fn sequence(&mut self, first: ExprId, second: ExprId) -> ExprId {
        let at = self.tree[first].at.to(self.tree[second].at);
        let ty = self.ty(second);
        self.push(ExprKind::Sequence { first, second }, ty, false, at)
    }
}

fn is_integral(ty: Type) -> bool {
    matches!(ty.scalar(), Some(Scalar::Int | Scalar::Uint))
}

/// The type of an operation on components: of equal types, or of a scalar with anything of its scalars.
fn componentwise(a: Type, b: Type) -> Option<Type> {
    if a.scalar()? != b.scalar()? {
        return None;
    }
    match (a, b) {
        _ if a == b => Some(a),
        (Type::Scalar(_), other) | (other, Type::Scalar(_)) => Some(other),
        _ => None,
    }
}

/// The type of a product: linear-algebraic where a matrix meets a matrix or a vector.
fn product(a: Type, b: Type) -> Option<Type> {
    match (a, b) {
        (Type::Matrix { columns, rows }, Type::Vector(Scalar::Float, size)) => {
            (columns == size).then_some(Type::Vector(Scalar::Float, rows))
        }
        (Type::Vector(Scalar::Float, size), Type::Matrix { columns, rows }) => {
            (rows == size).then_some(Type::Vector(Scalar::Float, columns))
        }
        (Type::Matrix { columns: inner, rows }, Type::Matrix { columns, rows: other }) => {
            (inner == other).then_some(Type::Matrix { columns, rows })
        }
        _ => componentwise(a, b).filter(|ty| ty.scalar() != Some(Scalar::Bool)),
    }
}
