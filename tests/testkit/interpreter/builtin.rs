//! Built-in functions (§8).

use toyproof::eval::{Fault, Substitute, UndefinedPolicy};
use toyproof::glsl::tree::{BuiltIn, ExprId, Type};
use toyproof::math::{self, Matrix};

use super::operator::{less, less_equal, to_int};
use super::real::{Real, Transcendental};
use super::value::{Component, Value, floats, reals, size};
use super::{Result, Run, Stop};

impl<N: Real> Run<'_, N> {
    /// A call of a built-in function.
    pub(super) fn built_in(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        expr: ExprId,
    ) -> Result<Value<N>, N> {
        use BuiltIn as B;
        if function.is_texture() {
            return self.texture(function, arguments, expr);
        }
        if function == B::Modf {
            let value = self.value(arguments[0])?;
            let whole: Value<N> = value.iter().map(|x| Component::Float(x.real().trunc())).collect();
            self.assign(arguments[1], &whole)?;
            let parts = value.iter().zip(&whole);
            return Ok(parts
                .map(|(x, whole)| Component::Float(x.real() - whole.real()))
                .collect());
        }
        let mut values = Vec::new();
        for &argument in arguments {
            values.push(self.value(argument)?);
        }
        if let Some(value) = self.of_vectors(function, arguments, &values) {
            return Ok(value);
        }
        let mut result = Value::new();
        for at in 0..size(self.tree, self.tree[expr].ty) {
            // A scalar argument applies to every component.
            let own = values
                .iter()
                .map(|value| if value.len() == 1 { value[0] } else { value[at] });
            let own: Vec<Component<N>> = own.collect();
            let component = match own[..] {
                [x] => self.of_one(function, x, expr)?,
                [x, y] => self.of_two(function, x, y, expr),
                [x, y, z] => self.of_three(function, [x, y, z], expr),
                _ => panic!("{function:?} of {} arguments", own.len()),
            };
            result.push(self.settle(component));
        }
        Ok(result)
    }

    /// Functions that do not work component by component.
    fn of_vectors(&self, function: BuiltIn, arguments: &[ExprId], values: &[Value<N>]) -> Option<Value<N>> {
        use BuiltIn as B;
        let rows = || match self.tree[arguments[0]].ty {
            Type::Matrix { rows, .. } => usize::from(rows),
            other => panic!("{other:?} is not a matrix"),
        };
        let first = &values[0];
        let all = |at: usize| reals(&values[at]);
        Some(match function {
            B::Any => vec![Component::Bool(first.iter().any(|component| component.truth()))],
            B::All => vec![Component::Bool(first.iter().all(|component| component.truth()))],
            B::PackHalf2x16 | B::PackSnorm2x16 | B::PackUnorm2x16 => {
                let [low, high] = [first[0], first[1]].map(|x| match function {
                    B::PackHalf2x16 => u32::from(to_half(x.real().to_f32())),
                    B::PackSnorm2x16 => pack(x.real(), -1.0, 32767.0),
                    _ => pack(x.real(), 0.0, 65535.0),
                });
                vec![Component::Uint(low | high << 16)]
            }
            B::UnpackHalf2x16 | B::UnpackSnorm2x16 | B::UnpackUnorm2x16 => {
                let bits = first[0].bits();
                let parts = [bits as u16, (bits >> 16) as u16];
                parts
                    .map(|part| match function {
                        B::UnpackHalf2x16 => Component::float(from_half(part)),
                        B::UnpackSnorm2x16 => {
                            let scaled = N::from_f64(part.cast_signed().into()) / N::from_f64(32767.0);
                            Component::Float(math::clamp(scaled, N::from_f64(-1.0), N::from_f64(1.0)))
                        }
                        _ => Component::Float(N::from_f64(part.into()) / N::from_f64(65535.0)),
                    })
                    .to_vec()
            }
            B::Length => floats([math::length(&all(0))]),
            B::Distance => floats([math::distance(&all(0), &all(1))]),
            B::Dot => floats([math::dot(&all(0), &all(1))]),
            B::Cross => {
                let [a, b] = [all(0), all(1)].map(|v| [v[0], v[1], v[2]]);
                floats(math::cross(a, b))
            }
            B::Normalize => floats(math::normalize(&all(0))),
            B::Faceforward => floats(math::faceforward(&all(0), &all(1), &all(2))),
            B::Reflect => floats(math::reflect(&all(0), &all(1))),
            B::Refract => floats(math::refract(&all(0), &all(1), all(2)[0])),
            B::MatrixCompMult => floats(all(0).into_iter().zip(all(1)).map(|(a, b)| a * b)),
            B::OuterProduct => floats(math::outer_product(&all(0), &all(1)).components()),
            B::Transpose => {
                let rows = rows();
                let columns = first.len() / rows;
                (0..first.len())
                    .map(|at| first[at % columns * rows + at / columns])
                    .collect()
            }
            B::Determinant => floats([math::determinant(&Matrix::new(&all(0), rows()))]),
            B::Inverse => floats(math::inverse(&Matrix::new(&all(0), rows())).components()),
            _ => return None,
        })
    }

    fn of_one(&mut self, function: BuiltIn, x: Component<N>, expr: ExprId) -> Result<Component<N>, N> {
        use BuiltIn as B;
        Ok(match (function, x) {
            (B::Not, Component::Bool(x)) => Component::Bool(!x),
            (B::Abs, Component::Int(x)) => Component::Int(x.wrapping_abs()),
            (B::Sign, Component::Int(x)) => Component::Int(x.signum()),
            (B::IntBitsToFloat | B::UintBitsToFloat, x) => Component::float(f32::from_bits(x.bits()).into()),
            (B::IsNan, Component::Float(x)) => Component::Bool(x.is_nan()),
            (B::IsInf, Component::Float(x)) => Component::Bool(x.to_f64().is_infinite()),
            (B::FloatBitsToInt | B::FloatBitsToUint, Component::Float(x)) => {
                if x.is_nan() {
                    return Err(Stop::Skipped("the bits of NaN"));
                }
                let bits = x.to_f32().to_bits();
                if function == B::FloatBitsToInt {
                    Component::Int(bits.cast_signed())
                } else {
                    Component::Uint(bits)
                }
            }
            (_, Component::Float(x)) => Component::Float(self.of_float(function, x, expr)?),
            _ => panic!("{function:?} of {x:?}"),
        })
    }

    fn of_float(&mut self, function: BuiltIn, x: N, expr: ExprId) -> Result<N, N> {
        use BuiltIn as B;
        let transcendental = match function {
            B::Abs => return Ok(x.abs()),
            B::Sign => return Ok(math::sign(x)),
            B::Radians => return Ok(math::radians(x)),
            B::Degrees => return Ok(math::degrees(x)),
            B::Fract => return Ok(math::fract(x)),
            B::InverseSqrt => return Ok(math::inverse_sqrt(x)),
            B::Sqrt => return Ok(x.sqrt()),
            B::Floor => return Ok(x.floor()),
            B::Ceil => return Ok(x.ceil()),
            B::Trunc => return Ok(x.trunc()),
            B::Round | B::RoundEven => return Ok(x.round_even()),
            B::DFdx => return self.derivative(x, 1, expr),
            B::DFdy => return self.derivative(x, 2, expr),
            B::Fwidth => {
                let along = self.derivative(x, 1, expr)?;
                return Ok(along.abs() + self.derivative(x, 2, expr)?.abs());
            }
            B::Sin => Transcendental::Sin,
            B::Cos => Transcendental::Cos,
            B::Tan => Transcendental::Tan,
            B::Asin => Transcendental::Asin,
            B::Acos => Transcendental::Acos,
            B::Atan => Transcendental::Atan,
            B::Sinh => Transcendental::Sinh,
            B::Cosh => Transcendental::Cosh,
            B::Tanh => Transcendental::Tanh,
            B::Asinh => Transcendental::Asinh,
            B::Acosh => Transcendental::Acosh,
            B::Atanh => Transcendental::Atanh,
            B::Exp => Transcendental::Exp,
            B::Exp2 => Transcendental::Exp2,
            B::Log => Transcendental::Log,
            B::Log2 => Transcendental::Log2,
            _ => panic!("{function:?} of a float"),
        };
        Ok(x.transcendental(transcendental))
    }

    fn of_two(&mut self, function: BuiltIn, x: Component<N>, y: Component<N>, expr: ExprId) -> Component<N> {
        use BuiltIn as B;
        match (function, x, y) {
            (B::LessThan, ..) => Component::Bool(less(x, y)),
            (B::GreaterThan, ..) => Component::Bool(less(y, x)),
            (B::LessThanEqual, ..) => Component::Bool(less_equal(x, y)),
            (B::GreaterThanEqual, ..) => Component::Bool(less_equal(y, x)),
            (B::Equal, ..) => Component::Bool(x.equals(y)),
            (B::NotEqual, ..) => Component::Bool(!x.equals(y)),
            (B::Min | B::Max, Component::Float(a), Component::Float(b)) => {
                self.fault(Fault::NotANumber, expr, a.is_nan() || b.is_nan());
                Component::Float(if function == B::Min { min(a, b) } else { max(a, b) })
            }
            (B::Min, ..) => {
                if less(x, y) {
                    x
                } else {
                    y
                }
            }
            (B::Max, ..) => {
                if less(x, y) {
                    y
                } else {
                    x
                }
            }
            (B::Atan, Component::Float(y), Component::Float(x)) => Component::Float(y.atan2(x)),
            (B::Pow, Component::Float(base), Component::Float(exponent))
                if self.interpreter.undefined
                    == UndefinedPolicy::Substitute(Substitute::OtherImplementation) =>
            {
                Component::Float(base.abs().pow(exponent))
            }
            (B::Pow, Component::Float(base), Component::Float(exponent)) => {
                let zero = N::from_f64(0.0);
                let is_outside = base < zero || base == zero && exponent <= zero;
                self.fault(Fault::PowDomain, expr, is_outside);
                Component::Float(base.pow(exponent))
            }
            (B::Mod, Component::Float(x), Component::Float(y)) => Component::Float(math::modulo(x, y)),
            (B::Step, Component::Float(edge), Component::Float(x)) => Component::Float(math::step(edge, x)),
            _ => panic!("{function:?} of {x:?} and {y:?}"),
        }
    }

    fn of_three(&mut self, function: BuiltIn, [x, y, z]: [Component<N>; 3], expr: ExprId) -> Component<N> {
        match (function, x, y, z) {
            (BuiltIn::Clamp, Component::Float(x), Component::Float(low), Component::Float(high)) => {
                self.fault(
                    Fault::NotANumber,
                    expr,
                    x.is_nan() || low.is_nan() || high.is_nan(),
                );
                self.fault(Fault::ReversedClamp, expr, low > high);
                Component::Float(min(max(x, low), high))
            }
            (BuiltIn::Clamp, ..) => {
                let least = if less(x, y) { y } else { x };
                if less(least, z) { least } else { z }
            }
            (BuiltIn::Mix, x, y, Component::Bool(chooses_second)) => {
                if chooses_second {
                    y
                } else {
                    x
                }
            }
            (BuiltIn::Mix, Component::Float(x), Component::Float(y), Component::Float(t)) => {
                Component::Float(math::mix(x, y, t))
            }
            (BuiltIn::Smoothstep, Component::Float(low), Component::Float(high), Component::Float(x)) => {
                self.fault(Fault::EqualEdges, expr, low == high);
                Component::Float(math::smoothstep(low, high, x))
            }
            _ => panic!("{function:?} of {x:?}, {y:?} and {z:?}"),
        }
    }
}

/// Of zeros with different signs the second, of NaN and a number the number, as in lavapipe.
pub(super) fn min<N: Real>(a: N, b: N) -> N {
    if a < b || b.is_nan() {
        a.operand()
    } else {
        b.operand()
    }
}

/// As [`min`].
pub(super) fn max<N: Real>(a: N, b: N) -> N {
    if a > b || b.is_nan() {
        a.operand()
    } else {
        b.operand()
    }
}

/// A number from `least` to 1 in 16 bits; 1 becomes `scale`.
fn pack<N: Real>(x: N, least: f64, scale: f64) -> u32 {
    let bounded = min(max(x, N::from_f64(least)), N::from_f64(1.0));
    let rounded = (bounded * N::from_f64(scale)).round_even();
    to_int(rounded.to_f64()).cast_unsigned() & 0xffff
}

/// The largest finite half-precision float.
const MAX_HALF: f64 = 65_504.0;

/// The nearest half-precision float (IEEE 754 binary16), ties to even, found among all of them.
fn to_half(x: f32) -> u16 {
    let sign = if x.is_sign_negative() { 0x8000 } else { 0 };
    let size = f64::from(x.abs());
    if size.is_nan() {
        return sign | 0x7e00;
    }
    // Half a unit above the largest.
    if size >= MAX_HALF + 16.0 {
        return sign | 0x7c00;
    }
    // The finite ones are in order.
    let above = (0..0x7c00)
        .collect::<Vec<u16>>()
        .partition_point(|&half| from_half(half) < size) as u16;
    let distance = |half: u16| (from_half(half) - size).abs();
    let nearest = if above == 0 {
        0
    } else if above == 0x7c00 || distance(above - 1) < distance(above) {
        above - 1
    } else if distance(above - 1) == distance(above) {
        above - above % 2
    } else {
        above
    };
    sign | nearest
}

/// The value of a half-precision float.
fn from_half(half: u16) -> f64 {
    let sign = if half & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (i32::from(half >> 10 & 31), f64::from(half & 0x3ff) / 1024.0);
    sign * match exponent {
        0 => fraction * 2.0_f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction) * 2.0_f64.powi(exponent - 15),
    }
}
