//! Numbers that record the operations on them.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Shl, Shr, Sub};

use crate::float::{Bits, Float, Number};
use crate::native::flush;

/// The index of a step in an [`ExprGraph`].
pub type StepId = usize;

/// One operation on the results of earlier steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Step {
    /// An argument, a float, by index.
    Argument(usize),
    /// A float constant, by its bits.
    Float(u32),
    /// An unsigned integer.
    Bits(u32),
    /// An operation on one value.
    Unary(Unary, StepId),
    /// An operation on two values of one type.
    Binary(Binary, StepId, StepId),
    /// Selects the second step if the first is true, otherwise the third.
    Select(StepId, StepId, StepId),
}

/// An operation on one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unary {
    /// The negated float.
    Negate,
    /// The square root of a float.
    Sqrt,
    /// The absolute value of a float.
    Abs,
    /// The largest integer not greater than a float.
    Floor,
    /// The encoding of a float.
    ToBits,
    /// The float with an encoding.
    FromBits,
    /// The nearest float to an integer in two's complement.
    FromSigned,
    /// The negated boolean.
    Not,
}

/// An operation on two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Binary {
    /// Sum of floats, or of integers, which wrap.
    Add,
    /// Difference of floats, or of integers, which wrap.
    Subtract,
    /// Product of floats, or of integers, which wrap.
    Multiply,
    /// Quotient of floats.
    Divide,
    /// Comparison of floats, or of integers, which are unsigned.
    Less,
    /// Conjunction of integers, bitwise, or of booleans.
    And,
    /// Disjunction of integers, bitwise, or of booleans.
    Or,
    /// Left shift of an integer, by less than 32.
    Left,
    /// Logical right shift of an integer, by less than 32.
    Right,
}

/// The type of a step's result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A float.
    Float,
    /// An unsigned integer.
    Bits,
    /// A boolean.
    Bool,
}

/// A straight-line sequence of steps without duplicates.
#[derive(Debug, Default)]
pub struct ExprGraph {
    steps: RefCell<Steps>,
}

#[derive(Debug, Default)]
struct Steps {
    all: Vec<(Step, Kind)>,
    known: HashMap<Step, StepId>,
}

impl ExprGraph {
    /// The term for an argument.
    pub fn argument(&self, index: usize) -> FloatTerm<'_> {
        Term::new(self, Step::Argument(index), Kind::Float).into()
    }

    /// A step and the type of its result.
    pub fn step(&self, id: StepId) -> (Step, Kind) {
        self.steps.borrow().all[id]
    }

    /// The number of steps that are operations, not arguments or constants.
    pub fn operations(&self) -> usize {
        let steps = self.steps.borrow();
        let is_operation = |(step, _): &&(Step, Kind)| step.operands().next().is_some();
        steps.all.iter().filter(is_operation).count()
    }

    /// Computes steps in 32-bit floats. Denormal arguments and results become zeros.
    ///
    /// # Panics
    /// If the graph names more arguments than there are.
    pub fn evaluate(&self, results: &[StepId], arguments: &[f32]) -> Vec<f32> {
        let steps = self.steps.borrow();
        // The encodings of the results of all steps: operands precede their users.
        let mut values: Vec<u32> = Vec::with_capacity(steps.all.len());
        for &(step, _) in &steps.all {
            let word = |id: StepId| values[id];
            let float = |id: StepId| f32::from_bits(values[id]);
            values.push(match step {
                Step::Argument(index) => flush(arguments[index]).to_bits(),
                Step::Float(bits) | Step::Bits(bits) => bits,
                Step::Unary(operation, a) => match operation {
                    Unary::Negate => (-float(a)).to_bits(),
                    Unary::Sqrt => float(a).sqrt().to_bits(),
                    Unary::Abs => float(a).abs().to_bits(),
                    Unary::Floor => float(a).floor().to_bits(),
                    Unary::ToBits | Unary::FromBits => word(a),
                    Unary::FromSigned => (word(a).cast_signed() as f32).to_bits(),
                    Unary::Not => u32::from(word(a) == 0),
                },
                Step::Binary(operation, a, b) if steps.all[a].1 == Kind::Float => {
                    let (a, b) = (float(a), float(b));
                    match operation {
                        Binary::Add => flush(a + b).to_bits(),
                        Binary::Subtract => flush(a - b).to_bits(),
                        Binary::Multiply => flush(a * b).to_bits(),
                        Binary::Divide => flush(a / b).to_bits(),
                        Binary::Less => u32::from(a < b),
                        Binary::And | Binary::Or | Binary::Left | Binary::Right => {
                            unreachable!("floats have no bits until they are converted")
                        }
                    }
                }
                Step::Binary(operation, a, b) => {
                    let (a, b) = (word(a), word(b));
                    match operation {
                        Binary::Add => a.wrapping_add(b),
                        Binary::Subtract => a.wrapping_sub(b),
                        Binary::Multiply => a.wrapping_mul(b),
                        Binary::Divide => unreachable!("only floats are divided"),
                        Binary::Less => u32::from(a < b),
                        Binary::And => a & b,
                        Binary::Or => a | b,
                        Binary::Left => a.wrapping_shl(b),
                        Binary::Right => a.wrapping_shr(b),
                    }
                }
                Step::Select(condition, yes, no) => word(if word(condition) == 0 { no } else { yes }),
            });
        }
        results.iter().map(|&id| f32::from_bits(values[id])).collect()
    }

    fn push(&self, step: Step, kind: Kind) -> StepId {
        let mut steps = self.steps.borrow_mut();
        if let Some(&id) = steps.known.get(&step) {
            return id;
        }
        let id = steps.all.len();
        steps.all.push((step, kind));
        steps.known.insert(step, id);
        id
    }
}

impl Step {
    /// The steps that are its operands.
    pub fn operands(self) -> impl Iterator<Item = StepId> {
        let operands = match self {
            Self::Argument(_) | Self::Float(_) | Self::Bits(_) => [None; 3],
            Self::Unary(_, a) => [Some(a), None, None],
            Self::Binary(_, a, b) => [Some(a), Some(b), None],
            Self::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten()
    }
}

/// A term: a step's result in its graph.
#[derive(Debug, Clone, Copy)]
struct Term<'a> {
    graph: &'a ExprGraph,
    id: StepId,
}

impl<'a> Term<'a> {
    fn new(graph: &'a ExprGraph, step: Step, kind: Kind) -> Self {
        let id = graph.push(step, kind);
        Self { graph, id }
    }

    fn unary(self, operation: Unary, kind: Kind) -> Self {
        Self::new(self.graph, Step::Unary(operation, self.id), kind)
    }

    fn binary(self, operation: Binary, other: Self, kind: Kind) -> Self {
        Self::new(self.graph, Step::Binary(operation, self.id, other.id), kind)
    }

    fn select(self, yes: Self, no: Self, kind: Kind) -> Self {
        if yes.id == no.id {
            return yes;
        }
        Self::new(self.graph, Step::Select(self.id, yes.id, no.id), kind)
    }

    /// The bits of a constant; `None` for other steps.
    fn known(self) -> Option<u32> {
        match self.graph.step(self.id).0 {
            Step::Float(bits) | Step::Bits(bits) => Some(bits),
            _ => None,
        }
    }
}

macro_rules! terms {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $name<'a>(Term<'a>);

        impl $name<'_> {
            /// The step that computes it.
            pub fn id(self) -> StepId {
                self.0.id
            }
        }

        impl<'a> From<Term<'a>> for $name<'a> {
            fn from(term: Term<'a>) -> Self {
                Self(term)
            }
        }
    )*};
}

terms! {
    /// A term of type float.
    FloatTerm;
    /// A term of type integer.
    BitsTerm;
    /// A term of type boolean.
    BoolTerm;
}

macro_rules! operators {
    ($term:ident, $literal:ty, $kind:expr; $($operator:ident $name:ident;)*) => {$(
        impl $operator for $term<'_> {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                self.0.binary(operators!(@ $operator), other.0, $kind).into()
            }
        }

        impl $operator<$literal> for $term<'_> {
            type Output = Self;

            fn $name(self, other: $literal) -> Self {
                self.$name(self.literal(other.into()))
            }
        }
    )*};
    (@ Add) => { Binary::Add };
    (@ Sub) => { Binary::Subtract };
    (@ Mul) => { Binary::Multiply };
    (@ Div) => { Binary::Divide };
    (@ BitAnd) => { Binary::And };
    (@ BitOr) => { Binary::Or };
    (@ Shl) => { Binary::Left };
    (@ Shr) => { Binary::Right };
}

operators! {
    FloatTerm, f32, Kind::Float;
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

operators! {
    BitsTerm, u32, Kind::Bits;
    Add add;
    Sub sub;
    Mul mul;
    BitAnd bitand;
    BitOr bitor;
    Shl shl;
    Shr shr;
}

impl Neg for FloatTerm<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.0.unary(Unary::Negate, Kind::Float).into()
    }
}

impl<'a> Number for FloatTerm<'a> {
    type Bool = BoolTerm<'a>;

    fn literal(self, value: f64) -> Self {
        Term::new(self.0.graph, Step::Float((value as f32).to_bits()), Kind::Float).into()
    }

    fn sqrt(self) -> Self {
        self.0.unary(Unary::Sqrt, Kind::Float).into()
    }

    fn abs(self) -> Self {
        self.0.unary(Unary::Abs, Kind::Float).into()
    }

    fn floor(self) -> Self {
        self.0.unary(Unary::Floor, Kind::Float).into()
    }

    fn less(self, other: Self) -> BoolTerm<'a> {
        self.0.binary(Binary::Less, other.0, Kind::Bool).into()
    }

    fn select(condition: BoolTerm<'a>, yes: Self, no: Self) -> Self {
        condition.0.select(yes.0, no.0, Kind::Float).into()
    }
}

impl<'a> Float for FloatTerm<'a> {
    type Bits = BitsTerm<'a>;

    fn to_bits(self) -> BitsTerm<'a> {
        match self.0.known() {
            Some(bits) => Term::new(self.0.graph, Step::Bits(bits), Kind::Bits).into(),
            None => self.0.unary(Unary::ToBits, Kind::Bits).into(),
        }
    }

    fn from_bits(bits: BitsTerm<'a>) -> Self {
        match bits.0.known() {
            Some(known) => Term::new(bits.0.graph, Step::Float(known), Kind::Float).into(),
            None => bits.0.unary(Unary::FromBits, Kind::Float).into(),
        }
    }

    fn from_signed(bits: BitsTerm<'a>) -> Self {
        bits.0.unary(Unary::FromSigned, Kind::Float).into()
    }
}

impl<'a> Bits for BitsTerm<'a> {
    type Bool = BoolTerm<'a>;

    fn literal(self, value: u32) -> Self {
        Term::new(self.0.graph, Step::Bits(value), Kind::Bits).into()
    }

    fn left(self, by: Self) -> Self {
        self << by
    }

    fn right(self, by: Self) -> Self {
        self >> by
    }

    fn less(self, other: Self) -> BoolTerm<'a> {
        self.0.binary(Binary::Less, other.0, Kind::Bool).into()
    }

    fn select(condition: BoolTerm<'a>, yes: Self, no: Self) -> Self {
        condition.0.select(yes.0, no.0, Kind::Bits).into()
    }
}

impl BitAnd for BoolTerm<'_> {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        self.0.binary(Binary::And, other.0, Kind::Bool).into()
    }
}

impl BitOr for BoolTerm<'_> {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.0.binary(Binary::Or, other.0, Kind::Bool).into()
    }
}

impl Not for BoolTerm<'_> {
    type Output = Self;

    fn not(self) -> Self {
        self.0.unary(Unary::Not, Kind::Bool).into()
    }
}
