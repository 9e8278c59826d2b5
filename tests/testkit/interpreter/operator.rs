//! Operators (§5.9), constructors and conversions (§5.4).

use toyproof::eval::Fault;
use toyproof::glsl::tree::{BinaryOp, Constructor, ExprId, Scalar, Type, UnaryOp};
use toyproof::math::Matrix;

use super::real::Real;
use super::value::{Component, Value, floats, reals, size};
use super::{Result, Run};

/// A unary operator on a component.
pub(super) fn unary<N: Real>(op: UnaryOp, component: Component<N>) -> Component<N> {
    match (op, component) {
        (UnaryOp::Plus, component) => component,
        (UnaryOp::Minus, Component::Float(value)) => Component::Float(-value),
        (UnaryOp::Minus, integer) => integer.with_bits(integer.bits().wrapping_neg()),
        (UnaryOp::Not, component) => Component::Bool(!component.truth()),
        (UnaryOp::BitNot, integer) => integer.with_bits(!integer.bits()),
    }
}

/// Whether a component is less than another of the same type.
pub(super) fn less<N: Real>(a: Component<N>, b: Component<N>) -> bool {
    match (a, b) {
        (Component::Float(a), Component::Float(b)) => a < b,
        (Component::Int(a), Component::Int(b)) => a < b,
        _ => a.bits() < b.bits(),
    }
}

/// Whether a component is less than or equal to another of the same type.
pub(super) fn less_equal<N: Real>(a: Component<N>, b: Component<N>) -> bool {
    match (a, b) {
        (Component::Float(a), Component::Float(b)) => a <= b,
        _ => !less(b, a),
    }
}

impl<N: Real> Run<'_, N> {
    /// A binary operator that evaluates both operands.
    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        (a_type, a): (Type, &[Component<N>]),
        (b_type, b): (Type, &[Component<N>]),
        expr: ExprId,
    ) -> Value<N> {
        let are_equal = || a.iter().zip(b).all(|(&a, &b)| a.equals(b));
        match op {
            BinaryOp::Equal => return vec![Component::Bool(are_equal())],
            BinaryOp::NotEqual => return vec![Component::Bool(!are_equal())],
            BinaryOp::Multiply => {
                if let Some(product) = matrix_product((a_type, a), (b_type, b)) {
                    return product;
                }
            }
            _ => {}
        }
        // A scalar operand applies to every component of the other.
        let pick = |side: &[Component<N>], at: usize| if side.len() == 1 { side[0] } else { side[at] };
        let mut value = Value::new();
        for at in 0..a.len().max(b.len()) {
            let result = self.scalars(op, pick(a, at), pick(b, at), expr);
            value.push(self.settle(result));
        }
        value
    }

    fn scalars(&mut self, op: BinaryOp, a: Component<N>, b: Component<N>, expr: ExprId) -> Component<N> {
        use BinaryOp as B;
        use Component as C;
        match (op, a, b) {
            (B::Add, C::Float(a), C::Float(b)) => C::Float(a + b),
            (B::Subtract, C::Float(a), C::Float(b)) => C::Float(a - b),
            (B::Multiply, C::Float(a), C::Float(b)) => C::Float(a * b),
            (B::Divide, C::Float(a), C::Float(b)) => {
                // Which quotients of zeros are undefined depends on what a compiler sees.
                let zero = N::from_f64(0.0);
                self.is_undefined = a == zero && b == zero;
                C::Float(a / b)
            }
            (B::Less, ..) => C::Bool(less(a, b)),
            (B::Greater, ..) => C::Bool(less(b, a)),
            (B::LessEqual, ..) => C::Bool(less_equal(a, b)),
            (B::GreaterEqual, ..) => C::Bool(less_equal(b, a)),
            (B::Xor, C::Bool(a), C::Bool(b)) => C::Bool(a != b),
            _ => {
                let bits = self.integers(op, (a, b), expr);
                a.with_bits(bits)
            }
        }
    }

    /// An operator on integers: both are signed or both are unsigned, except for shifts.
    fn integers(&mut self, op: BinaryOp, (left, right): (Component<N>, Component<N>), expr: ExprId) -> u32 {
        use BinaryOp as B;
        let (a, b) = (left.bits(), right.bits());
        let is_signed = matches!(left, Component::Int(_));
        match op {
            B::Add => a.wrapping_add(b),
            B::Subtract => a.wrapping_sub(b),
            B::Multiply => a.wrapping_mul(b),
            B::Divide => {
                self.fault(Fault::DivisionByZero, expr, b == 0);
                match (b, is_signed) {
                    (0, _) => a,
                    (_, true) => a.cast_signed().wrapping_div(b.cast_signed()).cast_unsigned(),
                    (_, false) => a / b,
                }
            }
            B::Remainder => {
                self.fault(Fault::RemainderByZero, expr, b == 0);
                match (b, is_signed) {
                    (0, _) => 0,
                    // The remainder has the sign of the divisor.
                    (_, true) => {
                        let (a, b) = (i64::from(a.cast_signed()), i64::from(b.cast_signed()));
                        let remainder = a.rem_euclid(b.abs());
                        let floored = if b < 0 && remainder != 0 {
                            remainder + b
                        } else {
                            remainder
                        };
                        (floored as i32).cast_unsigned()
                    }
                    (_, false) => a % b,
                }
            }
            B::ShiftLeft | B::ShiftRight => {
                self.fault(Fault::ShiftTooFar, expr, b >= 32);
                match (op, is_signed) {
                    (B::ShiftLeft, _) => a << (b & 31),
                    (_, true) => (a.cast_signed() >> (b & 31)).cast_unsigned(),
                    (_, false) => a >> (b & 31),
                }
            }
            B::BitAnd => a & b,
            B::BitXor => a ^ b,
            B::BitOr => a | b,
            _ => panic!("{op:?} of {left:?} and {right:?}"),
        }
    }

    /// A constructor.
    pub(super) fn construct(
        &mut self,
        constructor: Constructor,
        ty: Type,
        arguments: &[ExprId],
    ) -> Result<Value<N>, N> {
        let tree = self.tree;
        let count = size(tree, ty);
        let mut value = Value::new();
        for &argument in arguments {
            let components = self.value(argument)?;
            if matches!(constructor, Constructor::Struct | Constructor::Array) {
                value.extend(components);
                continue;
            }
            // Components that are dropped are not converted: they may be out of range.
            let wanted = match constructor {
                Constructor::Scalar | Constructor::Splat | Constructor::Diagonal => 1,
                Constructor::Resize => components.len(),
                _ => count - value.len(),
            };
            let scalar = ty.scalar().expect("a scalar, vector or matrix");
            for component in components.into_iter().take(wanted) {
                let converted = self.convert(component, scalar, argument);
                value.push(self.settle(converted));
            }
        }
        let matrix = |component: &dyn Fn(usize, usize) -> Component<N>| {
            let Type::Matrix { columns, rows } = ty else {
                panic!("{ty:?} is not a matrix");
            };
            let (columns, rows) = (usize::from(columns), usize::from(rows));
            (0..columns * rows)
                .map(|at| component(at / rows, at % rows))
                .collect()
        };
        let unit = |column: usize, row: usize| Component::float(f64::from(u8::from(column == row)));
        Ok(match constructor {
            Constructor::Splat => vec![value[0]; count],
            Constructor::Diagonal => matrix(&|column, row| {
                if column == row {
                    value[0]
                } else {
                    Component::float(0.0)
                }
            }),
            Constructor::Resize => {
                let Type::Matrix { columns, rows } = tree[arguments[0]].ty else {
                    panic!("a matrix is made of a matrix");
                };
                let (columns, rows) = (usize::from(columns), usize::from(rows));
                matrix(&|column, row| {
                    let is_given = column < columns && row < rows;
                    if is_given {
                        value[column * rows + row]
                    } else {
                        unit(column, row)
                    }
                })
            }
            _ => value,
        })
    }

    /// Converts a component (§5.4.1).
    fn convert(&mut self, component: Component<N>, to: Scalar, expr: ExprId) -> Component<N> {
        match (to, component) {
            (Scalar::Bool, component) => Component::Bool(component.is_not_zero()),
            (Scalar::Float, Component::Float(value)) => Component::Float(value),
            (Scalar::Float, Component::Bool(value)) => Component::float(f64::from(u8::from(value))),
            (Scalar::Float, Component::Int(value)) => Component::float(value.into()),
            (Scalar::Float, Component::Uint(value)) => Component::float(value.into()),
            (Scalar::Int, Component::Float(value)) => {
                self.fault(Fault::IntegerOverflow, expr, !is_int(value));
                Component::Int(to_int(value.to_f64()))
            }
            (Scalar::Uint, Component::Float(value)) => {
                let is_inside = N::from_f64(-1.0) < value && value < N::from_f64(4_294_967_296.0);
                self.fault(Fault::IntegerOverflow, expr, !is_inside);
                Component::Uint(to_uint(value.to_f64()))
            }
            (Scalar::Int, Component::Bool(value)) => Component::Int(value.into()),
            (Scalar::Uint, Component::Bool(value)) => Component::Uint(value.into()),
            (Scalar::Int, integer) => Component::Int(integer.bits().cast_signed()),
            (Scalar::Uint, integer) => Component::Uint(integer.bits()),
        }
    }
}

/// Whether a float is in range of `int`.
pub(super) fn is_int<N: Real>(value: N) -> bool {
    value.trunc() >= N::from_f64(-2_147_483_648.0) && value < N::from_f64(2_147_483_648.0)
}

/// Rounds toward zero. Values that are too large become the largest f32 that fits: naga clamps to it before it converts.
pub(super) fn to_int(value: f64) -> i32 {
    match value {
        value if value >= 2_147_483_648.0 => 2_147_483_520,
        value if value <= -2_147_483_648.0 => i32::MIN,
        value if value.is_nan() => NAN_AS_INTEGER,
        value => value.trunc() as i32,
    }
}

fn to_uint(value: f64) -> u32 {
    match value {
        value if value >= 4_294_967_296.0 => 4_294_967_040,
        value if value.is_nan() => NAN_AS_UNSIGNED,
        value => value.trunc().max(0.0) as u32,
    }
}

/// What NaN is converted to: naga clamps it, and `min` of a number and NaN is the number.
const NAN_AS_INTEGER: i32 = 2_147_483_520;
const NAN_AS_UNSIGNED: u32 = 4_294_967_040;

/// The product of a matrix with a matrix or a vector; none for other operands.
fn matrix_product<N: Real>(
    (a_type, a): (Type, &[Component<N>]),
    (b_type, b): (Type, &[Component<N>]),
) -> Option<Value<N>> {
    let rows = |ty| match ty {
        Type::Matrix { rows, .. } => usize::from(rows),
        _ => 1,
    };
    let product = match (a_type, b_type) {
        (Type::Matrix { .. }, Type::Vector(..)) => {
            Matrix::new(&reals(a), rows(a_type)).times_vector(&reals(b))
        }
        (Type::Vector(..), Type::Matrix { .. }) => {
            Matrix::new(&reals(b), rows(b_type)).vector_times(&reals(a))
        }
        (Type::Matrix { .. }, Type::Matrix { .. }) => {
            let (a, b) = (
                Matrix::new(&reals(a), rows(a_type)),
                Matrix::new(&reals(b), rows(b_type)),
            );
            a.times(&b).components()
        }
        _ => return None,
    };
    Some(floats(product))
}
