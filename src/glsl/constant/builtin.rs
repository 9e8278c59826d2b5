//! Built-in functions of constants (§8).

use toyproof_math::{Matrix, determinant, inverse, outer_product};

use super::arithmetic::order;
use crate::tree::{BuiltIn, Constant, Type, Value};

/// The scalars of the result; none where they are undefined or not worth computing.
pub(super) fn call(function: BuiltIn, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
    if let Some(value) = geometric(function, arguments).or_else(|| of_matrices(function, arguments)) {
        return Some(value);
    }
    if let Some(value) = truths(function, arguments) {
        return Some(vec![Value::Bool(value)]);
    }
    // All others work on components; a scalar meets every component.
    let count = usize::from(ty.component_count()?);
    (0..count)
        .map(|at| {
            let pick = |argument: &Constant| {
                let at = if argument.components().len() == 1 { 0 } else { at };
                argument.components().get(at).copied()
            };
            component(function, &arguments.iter().map(pick).collect::<Option<Vec<_>>>()?)
        })
        .collect()
}

fn component(function: BuiltIn, arguments: &[Value]) -> Option<Value> {
    match *arguments {
        [Value::Float(x)] => of_float(function, x),
        [Value::Float(x), Value::Float(y)] => of_floats(function, x, y),
        [Value::Float(x), Value::Float(y), Value::Float(z)] => Some(Value::Float(match function {
            BuiltIn::Clamp => least(greatest(x, y), z),
            BuiltIn::Mix => x * (1.0 - z) + y * z,
            BuiltIn::Smoothstep if x < y => {
                let t = ((z - x) / (y - x)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
            _ => return None,
        })),
        [no, yes, Value::Bool(which)] if function == BuiltIn::Mix => Some(if which { yes } else { no }),
        _ => of_others(function, arguments),
    }
}

fn of_float(function: BuiltIn, x: f64) -> Option<Value> {
    Some(Value::Float(match function {
        BuiltIn::Radians => x.to_radians(),
        BuiltIn::Degrees => x.to_degrees(),
        BuiltIn::Sin => libm::sin(x),
        BuiltIn::Cos => libm::cos(x),
        BuiltIn::Tan => libm::tan(x),
        BuiltIn::Asin => libm::asin(x),
        BuiltIn::Acos => libm::acos(x),
        BuiltIn::Atan => libm::atan(x),
        BuiltIn::Sinh => libm::sinh(x),
        BuiltIn::Cosh => libm::cosh(x),
        BuiltIn::Tanh => libm::tanh(x),
        BuiltIn::Asinh => libm::asinh(x),
        BuiltIn::Acosh => libm::acosh(x),
        BuiltIn::Atanh => libm::atanh(x),
        BuiltIn::Exp => libm::exp(x),
        BuiltIn::Log => libm::log(x),
        BuiltIn::Exp2 => libm::exp2(x),
        BuiltIn::Log2 => libm::log2(x),
        BuiltIn::Sqrt => x.sqrt(),
        BuiltIn::InverseSqrt => 1.0 / x.sqrt(),
        BuiltIn::Abs => x.abs(),
        BuiltIn::Sign if x == 0.0 => 0.0,
        BuiltIn::Sign => x.signum(),
        BuiltIn::Floor => x.floor(),
        BuiltIn::Trunc => x.trunc(),
        BuiltIn::Round => x.round(),
        BuiltIn::RoundEven => x.round_ties_even(),
        BuiltIn::Ceil => x.ceil(),
        BuiltIn::Fract => x - x.floor(),
        // Constants do not change from pixel to pixel (§8.9).
        BuiltIn::DFdx | BuiltIn::DFdy | BuiltIn::Fwidth => 0.0,
        BuiltIn::IsNan => return Some(Value::Bool(x.is_nan())),
        BuiltIn::IsInf => return Some(Value::Bool(x.is_infinite())),
        BuiltIn::FloatBitsToInt => return Some(Value::Int((x as f32).to_bits().cast_signed())),
        BuiltIn::FloatBitsToUint => return Some(Value::Uint((x as f32).to_bits())),
        _ => return None,
    }))
}

fn of_floats(function: BuiltIn, x: f64, y: f64) -> Option<Value> {
    Some(Value::Float(match function {
        BuiltIn::Atan => libm::atan2(x, y),
        BuiltIn::Pow if x >= 0.0 => libm::pow(x, y),
        BuiltIn::Mod => x - y * (x / y).floor(),
        BuiltIn::Min => least(x, y),
        BuiltIn::Max => greatest(x, y),
        BuiltIn::Step => f64::from(u8::from(y >= x)),
        _ => return relation(function, Value::Float(x), Value::Float(y)),
    }))
}

fn of_others(function: BuiltIn, arguments: &[Value]) -> Option<Value> {
    Some(match (function, arguments) {
        (BuiltIn::Abs, [Value::Int(x)]) => Value::Int(x.wrapping_abs()),
        (BuiltIn::Sign, [Value::Int(x)]) => Value::Int(x.signum()),
        (BuiltIn::IntBitsToFloat, [Value::Int(x)]) => {
            Value::Float(f64::from(f32::from_bits(x.cast_unsigned())))
        }
        (BuiltIn::UintBitsToFloat, [Value::Uint(x)]) => Value::Float(f64::from(f32::from_bits(*x))),
        (BuiltIn::Not, [Value::Bool(x)]) => Value::Bool(!x),
        (BuiltIn::Min, [Value::Int(x), Value::Int(y)]) => Value::Int(*x.min(y)),
        (BuiltIn::Min, [Value::Uint(x), Value::Uint(y)]) => Value::Uint(*x.min(y)),
        (BuiltIn::Max, [Value::Int(x), Value::Int(y)]) => Value::Int(*x.max(y)),
        (BuiltIn::Max, [Value::Uint(x), Value::Uint(y)]) => Value::Uint(*x.max(y)),
        (BuiltIn::Clamp, [Value::Int(x), Value::Int(y), Value::Int(z)]) => Value::Int(*x.max(y).min(z)),
        (BuiltIn::Clamp, [Value::Uint(x), Value::Uint(y), Value::Uint(z)]) => Value::Uint(*x.max(y).min(z)),
        (_, &[a, b]) => return relation(function, a, b),
        _ => return None,
    })
}

/// §8.7.
fn relation(function: BuiltIn, a: Value, b: Value) -> Option<Value> {
    use std::cmp::Ordering;
    Some(Value::Bool(match function {
        BuiltIn::Equal => a == b,
        BuiltIn::NotEqual => a != b,
        BuiltIn::LessThan => order(a, b)? == Some(Ordering::Less),
        BuiltIn::GreaterThan => order(a, b)? == Some(Ordering::Greater),
        BuiltIn::LessThanEqual => order(a, b)?.is_some_and(Ordering::is_le),
        BuiltIn::GreaterThanEqual => order(a, b)?.is_some_and(Ordering::is_ge),
        _ => return None,
    }))
}

fn truths(function: BuiltIn, arguments: &[Constant]) -> Option<bool> {
    let mut all = arguments.first()?.components().iter();
    match function {
        BuiltIn::Any => Some(all.any(|&value| value == Value::Bool(true))),
        BuiltIn::All => Some(all.all(|&value| value == Value::Bool(true))),
        _ => None,
    }
}

/// The components of each argument, if all are floats.
fn floats(arguments: &[Constant]) -> Option<Vec<Vec<f64>>> {
    let float = |value: &Value| match value {
        Value::Float(value) => Some(*value),
        _ => None,
    };
    arguments
        .iter()
        .map(|argument| argument.components().iter().map(float).collect())
        .collect()
}

/// §8.6.
fn of_matrices(function: BuiltIn, arguments: &[Constant]) -> Option<Vec<Value>> {
    let (columns, rows) = match arguments.first()?.ty {
        Type::Matrix { columns, rows } => (usize::from(columns), usize::from(rows)),
        // Of `outerProduct`.
        _ => (1, 1),
    };
    let result = match (function, &floats(arguments)?[..]) {
        (BuiltIn::MatrixCompMult, [a, b]) => a.iter().zip(b).map(|(a, b)| a * b).collect(),
        (BuiltIn::OuterProduct, [column, row]) => outer_product(column, row).components(),
        (BuiltIn::Transpose, [m]) => (0..rows)
            .flat_map(|row| (0..columns).map(move |column| m[column * rows + row]))
            .collect(),
        (BuiltIn::Determinant, [m]) => vec![determinant(&Matrix::new(m, rows))],
        (BuiltIn::Inverse, [m]) => inverse(&Matrix::new(m, rows)).components(),
        _ => return None,
    };
    Some(result.into_iter().map(Value::Float).collect())
}

/// §8.5.
fn geometric(function: BuiltIn, arguments: &[Constant]) -> Option<Vec<Value>> {
    let vectors = floats(arguments)?;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let along = |a: &[f64], s: f64, b: &[f64]| a.iter().zip(b).map(|(a, b)| a + s * b).collect::<Vec<_>>();
    let result = match (function, &vectors[..]) {
        (BuiltIn::Length, [a]) => vec![dot(a, a).sqrt()],
        (BuiltIn::Distance, [a, b]) => {
            let between = along(a, -1.0, b);
            vec![dot(&between, &between).sqrt()]
        }
        (BuiltIn::Dot, [a, b]) => vec![dot(a, b)],
        (BuiltIn::Cross, [a, b]) => match (&a[..], &b[..]) {
            ([a, b, c], [x, y, z]) => vec![b * z - y * c, c * x - z * a, a * y - x * b],
            _ => return None,
        },
        (BuiltIn::Normalize, [a]) => {
            let length = dot(a, a).sqrt();
            a.iter().map(|a| a / length).collect()
        }
        (BuiltIn::Faceforward, [n, i, reference]) if dot(reference, i) < 0.0 => n.clone(),
        (BuiltIn::Faceforward, [n, ..]) => n.iter().map(|n| -n).collect(),
        (BuiltIn::Reflect, [i, n]) => along(i, -2.0 * dot(n, i), n),
        (BuiltIn::Refract, [i, n, eta]) => {
            let (eta, cosine) = (*eta.first()?, dot(n, i));
            let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
            if k < 0.0 {
                vec![0.0; i.len()]
            } else {
                let scaled: Vec<_> = i.iter().map(|i| eta * i).collect();
                along(&scaled, -(eta * cosine + k.sqrt()), n)
            }
        }
        _ => return None,
    };
    Some(result.into_iter().map(Value::Float).collect())
}

/// §8.3: y if it is less, x else; so also where one is NaN.
fn least(x: f64, y: f64) -> f64 {
    if y < x { y } else { x }
}

fn greatest(x: f64, y: f64) -> f64 {
    if x < y { y } else { x }
}
