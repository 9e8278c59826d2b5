//! Expressions of the size of an image: a list of steps on a stack, which needs no recursion.

use serde::{Deserialize, Serialize};

/// An expression of the width and the height of the image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeExpr(Vec<Step>);

/// A step of the evaluation of an expression, in postfix notation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Step {
    /// Pushes a number.
    Constant(f64),
    /// Pushes the width of the image in pixels.
    Width,
    /// Pushes the height of the image in pixels.
    Height,
    /// Replaces the last number.
    Unary(UnaryFunction),
    /// Replaces the last two numbers by one.
    Binary(BinaryFunction),
}

/// A function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum UnaryFunction {
    /// The number with the opposite sign.
    Negate,
    /// The absolute value.
    Abs,
    /// The next lower integer.
    Floor,
    /// The next higher integer.
    Ceil,
    /// The nearest integer; halves are rounded away from 0.
    Round,
    /// The next integer toward 0.
    Trunc,
    /// The square root.
    Sqrt,
}

/// A function of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BinaryFunction {
    /// The sum.
    Add,
    /// The difference.
    Subtract,
    /// The product.
    Multiply,
    /// The quotient.
    Divide,
    /// The remainder, which has the sign of the dividend.
    Remainder,
    /// The smaller number.
    Min,
    /// The larger number.
    Max,
    /// The power.
    Pow,
}

impl SizeExpr {
    /// An expression of these steps; `None` if a step lacks a number, or not one number is left.
    pub fn new(steps: Vec<Step>) -> Option<Self> {
        let depth = steps.iter().try_fold(0_usize, |depth, step| match step {
            Step::Constant(_) | Step::Width | Step::Height => Some(depth + 1),
            Step::Unary(_) => (depth >= 1).then_some(depth),
            Step::Binary(_) => (depth >= 2).then(|| depth - 1),
        });
        (depth == Some(1)).then_some(Self(steps))
    }

    /// The value for an image of this size, in pixels.
    pub fn value(&self, [width, height]: [u32; 2]) -> f64 {
        let mut stack = Vec::new();
        for step in &self.0 {
            let value = match step {
                Step::Constant(value) => *value,
                Step::Width => f64::from(width),
                Step::Height => f64::from(height),
                Step::Unary(function) => function.value(stack.pop().unwrap_or(f64::NAN)),
                Step::Binary(function) => {
                    let [right, left] = [(); 2].map(|()| stack.pop().unwrap_or(f64::NAN));
                    function.value(left, right)
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }
}

impl UnaryFunction {
    fn value(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Abs => x.abs(),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Round => x.round(),
            Self::Trunc => x.trunc(),
            Self::Sqrt => x.sqrt(),
        }
    }
}

impl BinaryFunction {
    fn value(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Add => x + y,
            Self::Subtract => x - y,
            Self::Multiply => x * y,
            Self::Divide => x / y,
            Self::Remainder => x % y,
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Pow => x.powf(y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_work_on_a_stack() {
        use BinaryFunction::{Divide, Max, Pow, Remainder, Subtract};
        use Step::{Binary, Constant, Height, Unary, Width};
        let value = |steps: &[Step]| SizeExpr::new(steps.to_vec()).map(|expr| expr.value([64, 36]));
        assert_eq!(value(&[Width, Constant(3.0), Binary(Divide)]), Some(64.0 / 3.0));
        assert_eq!(value(&[Width, Height, Binary(Subtract)]), Some(28.0));
        assert_eq!(value(&[Width, Height, Binary(Remainder)]), Some(28.0));
        assert_eq!(value(&[Constant(2.0), Constant(5.0), Binary(Pow)]), Some(32.0));
        let half = [
            Constant(-2.5),
            Unary(UnaryFunction::Round),
            Constant(-7.0),
            Binary(Max),
        ];
        assert_eq!(value(&half), Some(-3.0));
        for malformed in [
            &[][..],
            &[Width, Height],
            &[Width, Binary(Max)],
            &[Unary(UnaryFunction::Abs)],
        ] {
            assert_eq!(value(malformed), None);
        }
    }
}
