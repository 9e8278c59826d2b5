//! Operators (§5.9), `?:`, `,`, and assignments (§5.8).

use toyproof_diagnostic::Code;

use super::{Checker, is_desktop_conversion};
use crate::tree::{
    BinaryOp, BuiltInVariable, Direction, ExprId, ExprKind, Place, Scalar, StepOp, Type, UnaryOp,
    VariableKind,
};

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
            let message = format!("invalid operand of `{}`: {}", op.symbol(), self.quoted_type(ty));
            let mut diagnostic = Code::BadOperands.at(at, message);
            if op == UnaryOp::Not && matches!(ty, Type::Scalar(_)) {
                diagnostic = diagnostic.help("`!` negates a `bool`; to test whether a number is 0, use `==`");
            }
            return self.refuse_with(diagnostic, at);
        }
        self.check_complement(op, at);
        let constant = self.tree[operand].constant;
        self.push(ExprKind::Unary { op, operand }, ty, constant, at)
    }

    pub(crate) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> ExprId {
        let at = self.tree[left].at.to(self.tree[right].at);
        let (a, b) = (self.ty(left), self.ty(right));
        if a == Type::Error || b == Type::Error {
            return self.error_expr(at);
        }
        self.check_operator(op, at);
        if matches!(op, BinaryOp::Equal | BinaryOp::NotEqual) {
            self.check_whole_array(a, "a comparison", at);
        }
        let (left, right) = self.promote_operands(op, left, right);
        let Some(ty) = self.binary_type(op, self.ty(left), self.ty(right)) else {
            return self.refuse_operands(op.symbol(), op, [left, right], [a, b]);
        };
        let constant = self.tree[left].constant && self.tree[right].constant;
        self.push(ExprKind::Binary { op, left, right }, ty, constant, at)
    }

    /// Reports operands whose types an operator does not take.
    fn refuse_operands(
        &mut self,
        symbol: &str,
        op: BinaryOp,
        [left, right]: [ExprId; 2],
        types: [Type; 2],
    ) -> ExprId {
        let at = self.tree[left].at.to(self.tree[right].at);
        let [a, b] = types.map(|ty| self.quoted_type(ty));
        let diagnostic = Code::BadOperands.at(at, format!("invalid operands of `{symbol}`: {a} and {b}"));
        let diagnostic = self.with_operand_fixit(diagnostic, op, left, right);
        self.refuse_with(diagnostic, at)
    }

    /// Where the language converts implicitly, converts the operand whose scalar type has the lower rank.
    fn promote_operands(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> (ExprId, ExprId) {
        let shift = matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight);
        let (a, b) = (self.ty(left), self.ty(right));
        let (Some(x), Some(y)) = (a.scalar(), b.scalar()) else {
            return (left, right);
        };
        if !self.language.converts_implicitly() || shift || x == y {
            return (left, right);
        }
        let to_left = b.with_scalar(x).and_then(|to| self.convert(right, to));
        let to_right = a.with_scalar(y).and_then(|to| self.convert(left, to));
        (to_right.unwrap_or(left), to_left.unwrap_or(right))
    }

    /// The type of `a op b`; `None` if the operator does not accept the operands.
    pub(super) fn binary_type(&self, op: BinaryOp, a: Type, b: Type) -> Option<Type> {
        match op {
            BinaryOp::Multiply => product(a, b),
            BinaryOp::Divide | BinaryOp::Add | BinaryOp::Subtract => {
                componentwise(a, b).filter(|ty| ty.scalar() != Some(Scalar::Bool))
            }
            BinaryOp::Remainder | BinaryOp::BitAnd | BinaryOp::BitXor | BinaryOp::BitOr => {
                componentwise(a, b).filter(|&ty| is_integral(ty))
            }
            // The operands may differ in signedness; a scalar cannot be shifted by a vector.
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
        // One side may be converted to the other's type.
        if let Some(fits) = self.convert(no, self.ty(yes)) {
            no = fits;
        } else if let Some(fits) = self.convert(yes, self.ty(no)) {
            yes = fits;
        }
        let (a, b) = (self.ty(yes), self.ty(no));
        if a != b && a != Type::Error && b != Type::Error {
            let message = format!(
                "both results of `?:` must have the same type, not {} and {}",
                self.quoted_type(a),
                self.quoted_type(b)
            );
            let diagnostic = Code::Mismatch.at(at, message);
            let diagnostic = if is_desktop_conversion(a, b) {
                self.with_related_fixit(diagnostic, yes, b)
            } else {
                self.with_related_fixit(diagnostic, no, a)
            };
            return self.refuse_with(diagnostic, at);
        }
        // Samplers are not values (§4.1.7). WebGL does not allow `?:` of `void`, arrays or structures.
        let webgl_has_none = matches!(a, Type::Array(_) | Type::Struct(_)) && !self.language.is_desktop();
        if a == Type::Void || self.holds_sampler(a) || webgl_has_none {
            let message = format!("the results of `?:` cannot be of type {}", self.quoted_type(a));
            return self.refuse(Code::BadType, at, message);
        }
        let constant = [condition, yes, no].iter().all(|&part| self.tree[part].constant);
        self.push(ExprKind::Conditional { condition, yes, no }, a, constant, at)
    }

    /// Checks `first, second`, which is never a constant expression (§4.3.3).
    pub(crate) fn sequence(&mut self, first: ExprId, second: ExprId) -> ExprId {
        let at = self.tree[first].at.to(self.tree[second].at);
        let ty = self.ty(second);
        self.push(ExprKind::Sequence { first, second }, ty, false, at)
    }
}

fn is_integral(ty: Type) -> bool {
    matches!(ty.scalar(), Some(Scalar::Int | Scalar::Uint))
}

/// The type of a componentwise operation: on equal types, or on a scalar and a type of the same scalar type.
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

/// The type of a product: linear-algebraic for a matrix with a matrix or vector, otherwise componentwise.
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

// Assignments and lvalues (§5.8).

impl Checker<'_> {
    pub(crate) fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> ExprId {
        let at = self.tree[target].at.to(self.tree[value].at);
        if !self.check_lvalue(target, "assigned to") {
            return self.error_expr(at);
        }
        let ty = self.ty(target);
        let value = match op {
            None => self.expect(value, ty, "the assigned value"),
            Some(op) => self.compound_operand(op, target, value),
        };
        if ty == Type::Error || self.ty(value) == Type::Error {
            return self.error_expr(at);
        }
        if let Some(op) = op {
            self.check_operator(op, at);
        }
        self.check_whole_array(ty, "an assignment", at);
        self.push(ExprKind::Assign { op, target, value }, ty, false, at)
    }

    /// Checks the right side of `+=` and similar: the operation must result in the target's type.
    fn compound_operand(&mut self, op: BinaryOp, target: ExprId, value: ExprId) -> ExprId {
        let (a, mut value) = (self.ty(target), value);
        let scalar = a.scalar();
        if let Some(to) = scalar.and_then(|scalar| self.ty(value).with_scalar(scalar)) {
            value = self.convert(value, to).unwrap_or(value);
        }
        let b = self.ty(value);
        if a == Type::Error || b == Type::Error || self.binary_type(op, a, b) == Some(a) {
            return value;
        }
        self.refuse_operands(&format!("{}=", op.symbol()), op, [target, value], [a, b])
    }

    pub(crate) fn step(&mut self, op: StepOp, postfix: bool, target: ExprId, at: Place) -> ExprId {
        let at = at.to(self.tree[target].at);
        let ty = self.ty(target);
        if ty == Type::Error || !self.check_lvalue(target, "changed") {
            return self.error_expr(at);
        }
        if ty.scalar().is_none_or(|scalar| scalar == Scalar::Bool) {
            let message = format!("invalid operand of `{}`: {}", op.symbol(), self.quoted_type(ty));
            return self.refuse(Code::BadOperands, at, message);
        }
        self.push(ExprKind::Step { op, postfix, target }, ty, false, at)
    }

    /// Whether the expression is an lvalue; if not, reports an error. `verb` names the operation in the
    /// message.
    pub(super) fn check_lvalue(&mut self, expr: ExprId, verb: &str) -> bool {
        let at = self.tree[expr].at;
        if self.ty(expr) == Type::Error {
            return true;
        }
        let mut part = expr;
        let variable = loop {
            part = match self.tree[part].kind {
                ExprKind::Variable(variable) => break variable,
                ExprKind::Swizzle { components, .. } if components.repeats() => {
                    let message = format!(
                        "`.{}` repeats a component and cannot be {verb}",
                        components.name()
                    );
                    self.error(Code::NotWritable, at, message);
                    return false;
                }
                ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. }
                | ExprKind::Index { base, .. } => base,
                _ => {
                    self.error(
                        Code::NotWritable,
                        at,
                        format!("this expression cannot be {verb}: it is not a variable"),
                    );
                    return false;
                }
            };
        };
        let variable = &self.tree[variable];
        let ty = self.tree.type_name(variable.ty);
        let copy = format!(
            "copy it to a local variable and change the copy: `{ty} copy = {};`",
            variable.name
        );
        let constant = "remove `const` from its declaration";
        let (what, help) = match variable.kind {
            VariableKind::BuiltInConstant => ("a constant", None),
            VariableKind::Const => ("a constant", Some(constant.to_owned())),
            VariableKind::Parameter(Direction::ConstIn) => ("a `const` parameter", Some(constant.to_owned())),
            VariableKind::Channel(_) => ("a sampler", None),
            VariableKind::Input(_) | VariableKind::Uniform => ("a uniform", Some(copy)),
            VariableKind::Varying => ("an input", Some(copy)),
            VariableKind::BuiltIn(built_in) if built_in != BuiltInVariable::FragDepth => {
                ("an input", Some(copy))
            }
            _ if self.holds_sampler(self.ty(expr)) => ("a sampler", None),
            _ => return true,
        };
        let message = format!("`{}` is {what} and cannot be {verb}", variable.name);
        let mut diagnostic = Code::NotWritable.at(at, message);
        if let (Some(declared), VariableKind::Const | VariableKind::Parameter(_)) =
            (variable.at, variable.kind)
        {
            diagnostic = diagnostic.related(declared.span, "declared here");
        }
        diagnostic.helps.extend(help);
        self.report(diagnostic);
        false
    }
}
