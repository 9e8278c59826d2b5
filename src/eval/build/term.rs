//! Values as numbers: what is written over any number type writes instructions here.

use std::cell::RefCell;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use toyproof_math::Number;

use super::Draft;
use crate::ir::function::{NONE, Origin, Value};
use crate::ir::operation::Operation;

/// A float of a program that is being written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term<'a> {
    draft: &'a RefCell<Draft>,
    pub(super) value: Value,
}

/// A `bool` of such a program.
#[derive(Debug, Clone, Copy)]
pub(super) struct Truth<'a>(Term<'a>);

impl<'a> Term<'a> {
    pub(super) fn new(draft: &'a RefCell<Draft>, value: Value) -> Self {
        Self { draft, value }
    }

    fn push(self, operation: Operation, operands: [Value; 3]) -> Self {
        let value = self
            .draft
            .borrow_mut()
            .push(Origin::Operation(operation, operands));
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

impl BitAnd for Truth<'_> {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(self.0.binary(Operation::And, other.0))
    }
}

impl BitOr for Truth<'_> {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0.binary(Operation::Or, other.0))
    }
}

impl Not for Truth<'_> {
    type Output = Self;

    fn not(self) -> Self {
        Self(self.0.unary(Operation::Not))
    }
}

impl<'a> Number for Term<'a> {
    type Truth = Truth<'a>;

    fn literal(self, value: f64) -> Self {
        let value = self.draft.borrow_mut().push(Origin::Float(value.to_bits()));
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

    fn less(self, other: Self) -> Truth<'a> {
        Truth(self.binary(Operation::Less, other))
    }

    fn select(truth: Truth<'a>, yes: Self, no: Self) -> Self {
        yes.push(Operation::Select, [truth.0.value, yes.value, no.value])
    }
}
