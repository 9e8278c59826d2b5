//! Operators (§5.9), component by component.

use toyproof_glsl::tree::{BinaryOp, Place, Scalar, Type, UnaryOp};

use super::{Builder, layout};
use crate::ir::function::{NONE, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Fault, Predicate};

impl Builder<'_> {
    pub(super) fn unary_operator(&self, op: UnaryOp, ty: Type, values: &[Value]) -> Vec<Value> {
        let operation = match op {
            UnaryOp::Plus => return values.to_vec(),
            UnaryOp::Minus if ty.scalar() == Some(Scalar::Float) => Operation::Neg,
            UnaryOp::Minus => Operation::NegWord,
            UnaryOp::Not | UnaryOp::BitNot => Operation::Not,
        };
        values.iter().map(|&value| self.unary(operation, value)).collect()
    }

    pub(super) fn binary_operator(
        &mut self,
        op: BinaryOp,
        (a_type, b_type): (Type, Type),
        a: &[Value],
        b: &[Value],
        at: Place,
    ) -> Vec<Value> {
        match op {
            BinaryOp::Equal => return vec![self.equal(a_type, a, b)],
            BinaryOp::NotEqual => {
                let equal = self.equal(a_type, a, b);
                return vec![self.unary(Operation::Not, equal)];
            }
            BinaryOp::Multiply => {
                if let Some(product) = self.matrix_product((a_type, b_type), a, b) {
                    return product;
                }
            }
            _ => {}
        }
        let scalar = a_type.scalar().unwrap_or(Scalar::Int);
        // A scalar meets every component of the other side.
        let count = a.len().max(b.len());
        let pick = |side: &[Value], at: usize| side[if side.len() == 1 { 0 } else { at }];
        (0..count)
            .map(|index| {
                let value = self.scalars(op, scalar, pick(a, index), pick(b, index), at);
                self.settle(value)
            })
            .collect()
    }

    fn scalars(&mut self, op: BinaryOp, scalar: Scalar, a: Value, b: Value, at: Place) -> Value {
        use BinaryOp as B;
        use Operation as O;
        let float = scalar == Scalar::Float;
        let signed = scalar == Scalar::Int;
        let operation = match op {
            B::Add if float => O::Add,
            B::Subtract if float => O::Sub,
            B::Multiply if float => O::Mul,
            B::Divide if float => {
                self.check(Fault::ZeroByZero, at, Predicate::ConstantZeros, [a, b]);
                O::Div
            }
            B::Add => O::AddWord,
            B::Subtract => O::SubWord,
            B::Multiply => O::MulWord,
            B::Divide => {
                self.check(Fault::DivisionByZero, at, Predicate::Zero, [b, NONE]);
                if signed { O::DivInt } else { O::DivUint }
            }
            B::Remainder => {
                self.check(Fault::RemainderByZero, at, Predicate::Zero, [b, NONE]);
                if signed { O::RemInt } else { O::RemUint }
            }
            B::ShiftLeft | B::ShiftRight => {
                self.check(Fault::ShiftTooFar, at, Predicate::From(32), [b, NONE]);
                match (op, signed) {
                    (B::ShiftLeft, _) => O::ShiftLeft,
                    (_, true) => O::ShiftRightInt,
                    (_, false) => O::ShiftRightUint,
                }
            }
            B::BitAnd | B::And => O::And,
            B::BitXor | B::Xor => O::Xor,
            B::BitOr | B::Or => O::Or,
            B::Less => return self.less(scalar, a, b),
            B::Greater => return self.less(scalar, b, a),
            B::LessEqual => return self.less_equal(scalar, a, b),
            B::GreaterEqual => return self.less_equal(scalar, b, a),
            B::Equal => return self.equal(Type::Scalar(scalar), &[a], &[b]),
            B::NotEqual => {
                let equal = self.equal(Type::Scalar(scalar), &[a], &[b]);
                return self.unary(O::Not, equal);
            }
        };
        self.binary(operation, a, b)
    }

    pub(super) fn less(&self, scalar: Scalar, a: Value, b: Value) -> Value {
        match scalar {
            Scalar::Float => self.binary(Operation::Less, a, b),
            Scalar::Int => self.binary(Operation::LessInt, a, b),
            Scalar::Uint | Scalar::Bool => self.binary(Operation::LessUint, a, b),
        }
    }

    pub(super) fn less_equal(&self, scalar: Scalar, a: Value, b: Value) -> Value {
        if scalar == Scalar::Float {
            return self.binary(Operation::LessEqual, a, b);
        }
        let greater = self.less(scalar, b, a);
        self.unary(Operation::Not, greater)
    }

    /// Whether all components are equal.
    pub(super) fn equal(&self, ty: Type, a: &[Value], b: &[Value]) -> Value {
        let scalars = self.tree.scalars(ty);

        let pairs = a.iter().zip(b).zip(scalars);
        let each = pairs.map(|((&a, &b), scalar)| match layout::kind(scalar) {
            Kind::Float => self.binary(Operation::Equal, a, b),
            Kind::Word => self.binary(Operation::EqualWord, a, b),
        });
        let whole = each.reduce(|a, b| self.binary(Operation::And, a, b));
        whole.unwrap_or_else(|| self.truth(true))
    }

    /// The product of a matrix with a matrix or a vector; none of other operands.
    fn matrix_product(&self, types: (Type, Type), a: &[Value], b: &[Value]) -> Option<Vec<Value>> {
        let rows = |ty| match ty {
            Type::Matrix { rows, .. } => usize::from(rows),
            _ => 1,
        };
        let [a, b] = [self.terms(a), self.terms(b)];
        let matrix = |terms: &[_], ty| toyproof_math::Matrix::new(terms, rows(ty));
        let product = match types {
            (Type::Matrix { .. }, Type::Vector(..)) => matrix(&a, types.0).times_vector(&b),
            (Type::Vector(..), Type::Matrix { .. }) => matrix(&b, types.1).vector_times(&a),
            (Type::Matrix { .. }, Type::Matrix { .. }) => {
                matrix(&a, types.0).times(&matrix(&b, types.1)).components()
            }
            _ => return None,
        };
        Some(product.into_iter().map(|term| term.value).collect())
    }
}
