//! The values of built-in functions of constants: floats in double precision, integers in 32 wrapping bits.

use std::cmp::Ordering;

use crate::constant::ordering;
use crate::tree::{Constant, Type, Value};

/// How the value of a function follows from constant arguments.
#[derive(Debug, Clone, Copy)]
pub(super) enum ConstantFunction {
    /// No function for constants is known.
    Unknown,
    /// Componentwise, of one float.
    Float(fn(f64) -> f64),
    /// Componentwise, of two floats; a scalar is combined with every component.
    Float2(fn(f64, f64) -> f64),
    /// Componentwise, of scalars of any types, as [`Self::Float2`].
    Scalars(fn(&[Value]) -> Option<Value>),
    /// Of the components of a vector of booleans.
    Booleans(fn(&[bool]) -> bool),
    /// Of the components of each argument.
    OfVectors(fn(&[Vec<f64>]) -> Option<Vec<f64>>),
    /// Of the components of a matrix, in column order, and the number of its rows.
    OfMatrix(fn(&[f64], usize) -> Vec<f64>),
}

impl ConstantFunction {
    /// The components of the value, of type `ty`; `None` if it is undefined or not known.
    pub(super) fn call(self, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
        let floats = || arguments.iter().map(|argument| floats(argument.components()));
        let all_floats = |values: Vec<f64>| values.into_iter().map(Value::Float).collect();
        match self {
            Self::Unknown => None,
            Self::Float(function) => {
                componentwise(ty, arguments, |x| Some(Value::Float(function(float(x)?))))
            }
            Self::Float2(function) => componentwise(ty, arguments, |x| match *x {
                [Value::Float(x), Value::Float(y)] => Some(Value::Float(function(x, y))),
                _ => None,
            }),
            Self::Scalars(function) => componentwise(ty, arguments, function),
            Self::Booleans(function) => {
                let components = arguments.first()?.components().iter();
                let all: Vec<_> = components.map(|&value| value == Value::Bool(true)).collect();
                Some(vec![Value::Bool(function(&all))])
            }
            Self::OfVectors(function) => {
                let vectors: Vec<_> = floats().collect::<Option<_>>()?;
                function(&vectors).map(all_floats)
            }
            Self::OfMatrix(function) => {
                let Type::Matrix { rows, .. } = arguments.first()?.ty else {
                    return None;
                };
                let components = floats().next()??;
                Some(all_floats(function(&components, rows.into())))
            }
        }
    }
}

/// Evaluates a function of each component; a scalar is combined with every component.
fn componentwise(
    ty: Type,
    arguments: &[Constant],
    function: impl Fn(&[Value]) -> Option<Value>,
) -> Option<Vec<Value>> {
    let count = usize::from(ty.component_count()?);
    let component = |at: usize| {
        let pick = |argument: &Constant| {
            let at = if argument.components().len() == 1 { 0 } else { at };
            argument.components().get(at).copied()
        };
        function(&arguments.iter().map(pick).collect::<Option<Vec<_>>>()?)
    };
    (0..count).map(component).collect()
}

/// The values, if all are floats.
fn floats(values: &[Value]) -> Option<Vec<f64>> {
    values.iter().map(|&value| float(&[value])).collect()
}

/// The only value, if it is a float.
pub(super) fn float(values: &[Value]) -> Option<f64> {
    match *values {
        [Value::Float(value)] => Some(value),
        _ => None,
    }
}

// Functions of floats with a restricted domain.

pub(super) fn atan(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(x)] => Some(Value::Float(libm::atan(x))),
        [Value::Float(y), Value::Float(x)] => Some(Value::Float(libm::atan2(y, x))),
        _ => None,
    }
}

pub(super) fn pow(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(x), Value::Float(y)] if x >= 0.0 => Some(Value::Float(libm::pow(x, y))),
        _ => None,
    }
}

pub(super) fn smoothstep(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(low), Value::Float(high), Value::Float(x)] if low < high => {
            let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
            Some(Value::Float(t * t * (3.0 - 2.0 * t)))
        }
        _ => None,
    }
}

// Functions of several scalar types.

pub(super) fn abs(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(x)] => Some(Value::Float(x.abs())),
        [Value::Int(x)] => Some(Value::Int(x.wrapping_abs())),
        _ => None,
    }
}

pub(super) fn sign(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(0.0)] => Some(Value::Float(0.0)),
        [Value::Float(x)] => Some(Value::Float(x.signum())),
        [Value::Int(x)] => Some(Value::Int(x.signum())),
        _ => None,
    }
}

/// GLSL's `min` (§8.3): y if it is less than x, otherwise x, also if one is NaN.
pub(super) fn min(x: &[Value]) -> Option<Value> {
    match *x {
        [x, y] => Some(if ordering(y, x)? == Some(Ordering::Less) {
            y
        } else {
            x
        }),
        _ => None,
    }
}

/// GLSL's `max` (§8.3): y if x is less than it, otherwise x, also if one is NaN.
pub(super) fn max(x: &[Value]) -> Option<Value> {
    match *x {
        [x, y] => Some(if ordering(x, y)? == Some(Ordering::Less) {
            y
        } else {
            x
        }),
        _ => None,
    }
}

pub(super) fn clamp(x: &[Value]) -> Option<Value> {
    match *x {
        [x, low, high] => min(&[max(&[x, low])?, high]),
        _ => None,
    }
}

pub(super) fn mix(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Float(x), Value::Float(y), Value::Float(t)] => Some(Value::Float(x * (1.0 - t) + y * t)),
        [no, yes, Value::Bool(which)] => Some(if which { yes } else { no }),
        _ => None,
    }
}

pub(super) fn bits_to_float(x: &[Value]) -> Option<Value> {
    let bits = match *x {
        [Value::Int(x)] => x.cast_unsigned(),
        [Value::Uint(x)] => x,
        _ => return None,
    };
    Some(Value::Float(f64::from(f32::from_bits(bits))))
}

pub(super) fn not(x: &[Value]) -> Option<Value> {
    match *x {
        [Value::Bool(x)] => Some(Value::Bool(!x)),
        _ => None,
    }
}

/// Compares two numbers by their order; false if one is NaN.
pub(super) fn compare(x: &[Value], holds: fn(Ordering) -> bool) -> Option<Value> {
    match *x {
        [a, b] => Some(Value::Bool(ordering(a, b)?.is_some_and(holds))),
        _ => None,
    }
}

/// Whether two values are equal, or whether they are not.
pub(super) fn equal(x: &[Value], expected: bool) -> Option<Value> {
    match *x {
        [a, b] => Some(Value::Bool((a == b) == expected)),
        _ => None,
    }
}

// Geometric and matrix functions (§8.5, §8.6).

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `a + s·b`
fn along(a: &[f64], s: f64, b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + s * b).collect()
}

pub(super) fn length(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [a] => Some(vec![dot(a, a).sqrt()]),
        _ => None,
    }
}

pub(super) fn distance(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [a, b] => length(&[along(a, -1.0, b)]),
        _ => None,
    }
}

pub(super) fn dot_product(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [a, b] => Some(vec![dot(a, b)]),
        _ => None,
    }
}

pub(super) fn cross(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    let [a, b] = arguments else {
        return None;
    };
    match (&a[..], &b[..]) {
        ([a, b, c], [x, y, z]) => Some(vec![b * z - y * c, c * x - z * a, a * y - x * b]),
        _ => None,
    }
}

pub(super) fn normalize(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    let [a] = arguments else {
        return None;
    };
    let length = dot(a, a).sqrt();
    Some(a.iter().map(|a| a / length).collect())
}

pub(super) fn faceforward(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [n, i, reference] if dot(reference, i) < 0.0 => Some(n.clone()),
        [n, ..] => Some(n.iter().map(|n| -n).collect()),
        _ => None,
    }
}

pub(super) fn reflect(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [i, n] => Some(along(i, -2.0 * dot(n, i), n)),
        _ => None,
    }
}

pub(super) fn refract(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    let [i, n, eta] = arguments else {
        return None;
    };
    let (eta, cosine) = (*eta.first()?, dot(n, i));
    let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if k < 0.0 {
        return Some(vec![0.0; i.len()]);
    }
    let scaled: Vec<_> = i.iter().map(|i| eta * i).collect();
    Some(along(&scaled, -(eta * cosine + k.sqrt()), n))
}

pub(super) fn outer_product(arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
    match arguments {
        [column, row] => Some(toyproof_math::outer_product(column, row).components()),
        _ => None,
    }
}

pub(super) fn transpose(components: &[f64], rows: usize) -> Vec<f64> {
    let columns = components.len() / rows;
    let row = |row: usize| (0..columns).map(move |column| components[column * rows + row]);
    (0..rows).flat_map(row).collect()
}
