//! Operators (§5.9), constructors and conversions (§5.4), component by component.

use std::cell::RefCell;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use toyproof_glsl::tree::{BinaryOp, Constructor, ExprId, Place, Scalar, Type, UnaryOp};
use toyproof_math::Number;

use super::lvalue::{component_count, scalar_kind};
use super::{Builder, IrWriter, Result};
use crate::ir::{Fault, Kind, NONE, Operation, Predicate, Value, ValueDef};

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
        // A scalar operand applies to every component of the other.
        let count = a.len().max(b.len());
        let pick = |side: &[Value], at: usize| side[if side.len() == 1 { 0 } else { at }];
        (0..count)
            .map(|index| {
                let value = self.scalars(op, scalar, pick(a, index), pick(b, index), at);
                self.substitute_undefined(value)
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
                self.check(Fault::ShiftTooFar, at, Predicate::AtLeast(32), [b, NONE]);
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

    /// Returns whether all components are equal.
    pub(super) fn equal(&self, ty: Type, a: &[Value], b: &[Value]) -> Value {
        let scalars = self.tree.scalars(ty);

        let pairs = a.iter().zip(b).zip(scalars);
        let each = pairs.map(|((&a, &b), scalar)| match scalar_kind(scalar) {
            Kind::Float => self.binary(Operation::Equal, a, b),
            Kind::Word => self.binary(Operation::EqualWord, a, b),
        });
        let whole = each.reduce(|a, b| self.binary(Operation::And, a, b));
        whole.unwrap_or_else(|| self.bool_value(true))
    }

    /// Returns the product of a matrix with a matrix or a vector; none for other operands.
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

// Constructors and conversions (§5.4).

impl Builder<'_> {
    pub(super) fn construct(
        &mut self,
        constructor: Constructor,
        ty: Type,
        arguments: &[ExprId],
    ) -> Result<Vec<Value>> {
        let composite = matches!(constructor, Constructor::Struct | Constructor::Array);
        let mut values = Vec::new();
        for &argument in arguments {
            let components = self.expression(argument)?;
            if composite {
                values.extend(components);
                continue;
            }
            let (Some(from), Some(to)) = (self.ty(argument).scalar(), ty.scalar()) else {
                continue;
            };
            // Surplus components of the last argument are not converted: they may be out of range.
            let wanted = match constructor {
                Constructor::Scalar | Constructor::Splat | Constructor::Diagonal => 1,
                Constructor::Resize => components.len(),
                _ => component_count(self.tree, ty) - values.len(),
            };
            let at = self.at(argument);
            for value in components.into_iter().take(wanted) {
                let converted = self.convert(value, from, to, at);
                values.push(self.substitute_undefined(converted));
            }
        }
        Ok(match (constructor, ty) {
            (Constructor::Splat, _) => vec![values[0]; component_count(self.tree, ty)],
            (Constructor::Diagonal, Type::Matrix { columns, rows }) => {
                let zero = self.float(0.0);
                each(
                    columns,
                    rows,
                    |column, row| if column == row { values[0] } else { zero },
                )
            }
            (Constructor::Resize, Type::Matrix { columns, rows }) => {
                let Some(Type::Matrix {
                    columns: old_columns,
                    rows: old_rows,
                }) = arguments.first().map(|&argument| self.ty(argument))
                else {
                    return Ok(values);
                };
                let (zero, one) = (self.float(0.0), self.float(1.0));
                each(columns, rows, |column, row| {
                    if column < old_columns && row < old_rows {
                        values[usize::from(column * old_rows + row)]
                    } else if column == row {
                        one
                    } else {
                        zero
                    }
                })
            }
            _ => values,
        })
    }

    /// Converts a scalar to a different scalar type (§5.4.1).
    fn convert(&mut self, value: Value, from: Scalar, to: Scalar, at: Place) -> Value {
        match (from, to) {
            (Scalar::Float, Scalar::Float)
            | (Scalar::Bool, Scalar::Bool)
            | (Scalar::Int | Scalar::Uint, Scalar::Int | Scalar::Uint) => value,
            (Scalar::Bool, Scalar::Float) => {
                let (one, zero) = (self.float(1.0), self.float(0.0));
                self.select(value, one, zero, Kind::Float)
            }
            (Scalar::Bool, Scalar::Int | Scalar::Uint) => {
                let one = self.word(1);
                self.binary(Operation::And, value, one)
            }
            (Scalar::Int, Scalar::Float) => self.unary(Operation::FromInt, value),
            (Scalar::Uint, Scalar::Float) => self.unary(Operation::FromUint, value),
            (Scalar::Float, Scalar::Int) => {
                self.check(Fault::IntegerOverflow, at, Predicate::NotInt, [value, NONE]);
                self.unary(Operation::ToInt, value)
            }
            (Scalar::Float, Scalar::Uint) => {
                self.check(Fault::IntegerOverflow, at, Predicate::NotUint, [value, NONE]);
                self.unary(Operation::ToUint, value)
            }
            (Scalar::Float, Scalar::Bool) => {
                let zero = self.float(0.0);
                self.binary(Operation::NotEqual, value, zero)
            }
            (Scalar::Int | Scalar::Uint, Scalar::Bool) => {
                let zero = self.word(0);
                let equal = self.binary(Operation::EqualWord, value, zero);
                self.unary(Operation::Not, equal)
            }
        }
    }
}

/// Returns the components of a matrix, column by column.
fn each(columns: u8, rows: u8, component: impl Fn(u8, u8) -> Value) -> Vec<Value> {
    let component = &component;
    (0..columns)
        .flat_map(|column| (0..rows).map(move |row| component(column, row)))
        .collect()
}

// Terms: generic numeric code that is called with them emits instructions.

/// A float value of the program that is being written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term<'a> {
    writer: &'a RefCell<IrWriter>,
    pub(super) value: Value,
}

/// A `bool` value of the program that is being written.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoolTerm<'a>(Term<'a>);

impl<'a> Term<'a> {
    pub(super) fn new(writer: &'a RefCell<IrWriter>, value: Value) -> Self {
        Self { writer, value }
    }

    fn push(self, operation: Operation, operands: [Value; 3]) -> Self {
        let value = self
            .writer
            .borrow_mut()
            .push(ValueDef::Operation(operation, operands));
        Self { value, ..self }
    }

    fn unary(self, operation: Operation) -> Self {
        self.push(operation, [self.value, NONE, NONE])
    }

    fn binary(self, operation: Operation, other: Self) -> Self {
        self.push(operation, [self.value, other.value, NONE])
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident,)*) => {$(
        impl $trait for Term<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.binary(Operation::$trait, other)
            }
        }
    )*};
}

operators! {
    Add add,
    Sub sub,
    Mul mul,
    Div div,
}

impl Neg for Term<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.unary(Operation::Neg)
    }
}

impl BitAnd for BoolTerm<'_> {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(self.0.binary(Operation::And, other.0))
    }
}

impl BitOr for BoolTerm<'_> {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0.binary(Operation::Or, other.0))
    }
}

impl Not for BoolTerm<'_> {
    type Output = Self;

    fn not(self) -> Self {
        Self(self.0.unary(Operation::Not))
    }
}

impl<'a> Number for Term<'a> {
    type Bool = BoolTerm<'a>;

    fn literal(self, value: f64) -> Self {
        let value = self.writer.borrow_mut().push(ValueDef::Float(value.to_bits()));
        Self { value, ..self }
    }

    fn sqrt(self) -> Self {
        self.unary(Operation::Sqrt)
    }

    fn abs(self) -> Self {
        self.unary(Operation::Abs)
    }

    fn floor(self) -> Self {
        self.unary(Operation::Floor)
    }

    fn less(self, other: Self) -> BoolTerm<'a> {
        BoolTerm(self.binary(Operation::Less, other))
    }

    fn select(condition: BoolTerm<'a>, yes: Self, no: Self) -> Self {
        yes.push(Operation::Select, [condition.0.value, yes.value, no.value])
    }
}
