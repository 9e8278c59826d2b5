//! Values of any type: their parts, their components, literals of a test file, and how they are compared.

use toyproof_glsl::tree::{Direction, Function, Scalar, Tree, Type, VariableKind};
use toyproof_toml::Literal;

/// The largest array that is an argument or a result.
const MAX_ARRAY: u32 = 256;

/// The parts of a type that is composed of others, each with the end of its path; `None` for scalars, and for
/// types without values.
pub(crate) fn parts(tree: &Tree, ty: Type) -> Option<Vec<(String, Type)>> {
    let indexed = |count: u32, part: Type| (0..count).map(|index| (format!("[{index}]"), part)).collect();
    match ty {
        Type::Vector(scalar, size) => Some(indexed(u32::from(size), Type::Scalar(scalar))),
        Type::Matrix { columns, rows } => {
            Some(indexed(u32::from(columns), Type::Vector(Scalar::Float, rows)))
        }
        Type::Array(id) => {
            let array = tree.array(id);
            (array.size <= MAX_ARRAY).then(|| indexed(array.size, array.element))
        }
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            Some(
                members
                    .map(|member| (format!(".{}", member.name), member.ty))
                    .collect(),
            )
        }
        _ => None,
    }
}

/// A component of a variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Component {
    /// The expression for it.
    pub(super) path: String,
    pub(super) scalar: Scalar,
}

/// The components of a variable; `None` for types without values.
pub(super) fn components(tree: &Tree, ty: Type, path: &str) -> Option<Vec<Component>> {
    match (parts(tree, ty), ty) {
        (Some(parts), _) => {
            let parts = parts.iter();
            let all = parts.map(|(end, ty)| components(tree, *ty, &format!("{path}{end}")));
            Some(all.collect::<Option<Vec<_>>>()?.concat())
        }
        (None, Type::Scalar(scalar)) => Some(vec![Component {
            path: path.to_owned(),
            scalar,
        }]),
        _ => None,
    }
}

// Literals of a test file.

/// Adds the components of a literal.
pub(super) fn flatten(literal: &Literal, into: &mut Vec<f64>) {
    match literal {
        Literal::Number { value, .. } => into.push(*value),
        Literal::Boolean(value) => into.push(f64::from(u8::from(*value))),
        Literal::List(list) => list.iter().for_each(|literal| flatten(literal, into)),
    }
}

/// The type that a value most likely has.
pub(super) fn likely_type(literal: &Literal) -> String {
    let is_number = |literal: &Literal| matches!(literal, Literal::Number { .. });
    match literal {
        Literal::Number { .. } => "float".to_owned(),
        Literal::Boolean(_) => "bool".to_owned(),
        Literal::List(list) => {
            let is_vector = (2..=4).contains(&list.len());
            match list.first() {
                Some(Literal::Number { .. }) if is_vector && list.iter().all(is_number) => {
                    format!("vec{}", list.len())
                }
                _ => format!(
                    "{{{}}}",
                    list.iter().map(likely_type).collect::<Vec<_>>().join(", ")
                ),
            }
        }
    }
}

/// A value as the test file has it.
pub(crate) fn literal_text(literal: &Literal) -> String {
    match literal {
        Literal::Number {
            value,
            is_integer: true,
        } => format!("{value}"),
        Literal::Number { value, .. } => format!("{value:?}"),
        Literal::Boolean(value) => value.to_string(),
        Literal::List(list) => format!(
            "[{}]",
            list.iter().map(literal_text).collect::<Vec<_>>().join(", ")
        ),
    }
}

/// Whether a value can be an expected one of a type, where numbers that are not finite may also be expected.
pub(super) fn fits(tree: &Tree, ty: Type, literal: &Literal) -> bool {
    match (parts(tree, ty), literal) {
        (Some(parts), Literal::List(list)) => {
            parts.len() == list.len()
                && parts
                    .iter()
                    .zip(list)
                    .all(|((_, ty), literal)| fits(tree, *ty, literal))
        }
        (None, literal) => matches!(
            (ty, literal),
            (Type::Scalar(Scalar::Bool), Literal::Boolean(_))
                | (
                    Type::Scalar(Scalar::Float | Scalar::Int | Scalar::Uint),
                    Literal::Number { .. }
                )
        ),
        _ => false,
    }
}

/// A value as an expression of a type; `None` if it cannot have the type.
pub(super) fn expression(tree: &Tree, ty: Type, literal: &Literal) -> Option<String> {
    if let Some(parts) = parts(tree, ty) {
        let Literal::List(list) = literal else {
            return None;
        };
        let values = parts
            .iter()
            .zip(list)
            .map(|((_, ty), literal)| expression(tree, *ty, literal));
        let values: Vec<_> = values.collect::<Option<_>>()?;
        return (list.len() == parts.len()).then(|| format!("{}({})", tree.type_name(ty), values.join(", ")));
    }
    match (ty, literal) {
        (Type::Scalar(Scalar::Bool), Literal::Boolean(value)) => Some(value.to_string()),
        (Type::Scalar(Scalar::Float), Literal::Number { value, .. }) => Some(format!("({value:?})")),
        (
            Type::Scalar(Scalar::Int),
            Literal::Number {
                value,
                is_integer: true,
            },
        ) => (value.abs() <= f64::from(i32::MAX)).then(|| format!("({value})")),
        (
            Type::Scalar(Scalar::Uint),
            Literal::Number {
                value,
                is_integer: true,
            },
        ) => (0.0..=f64::from(u32::MAX))
            .contains(value)
            .then(|| format!("{value}u")),
        _ => None,
    }
}

/// A function's return type, name and parameters.
pub(super) fn prototype(tree: &Tree, function: &Function) -> String {
    let parameters = function.parameters.iter().map(|&id| {
        let direction = match tree[id].kind {
            VariableKind::Parameter(Direction::Out) => "out ",
            VariableKind::Parameter(Direction::InOut) => "inout ",
            _ => "",
        };
        format!("{direction}{}", tree.type_name(tree[id].ty))
    });
    let parameters: Vec<_> = parameters.collect();
    let returns = tree.type_name(function.return_type);
    format!("{returns} {}({})", function.name, parameters.join(", "))
}

// Comparison.

/// Whether a component agrees with the expected one; NaN agrees with NaN. The tolerance is relative to
/// values above 1.
pub(super) fn agrees(actual: f64, expected: f64, tolerance: f64) -> bool {
    if expected.is_finite() {
        (actual - expected).abs() <= margin(expected, tolerance)
    } else {
        actual == expected || (actual.is_nan() && expected.is_nan())
    }
}

/// The largest difference from an expected value; 0 without a tolerance, also from an infinite one.
pub(super) fn margin(expected: f64, tolerance: f64) -> f64 {
    if tolerance == 0.0 {
        0.0
    } else {
        tolerance * expected.abs().max(1.0)
    }
}

/// Components for a message.
pub(super) fn numbers(components: &[f64]) -> String {
    // Enough digits to show a difference, and no more than f32 has.
    let number = |component: &f64| {
        let digits = format!("{component:.6e}").parse::<f64>().unwrap_or(*component);
        format!("{digits:?}")
    };
    match components {
        [one] => number(one),
        several => format!("({})", several.iter().map(number).collect::<Vec<_>>().join(", ")),
    }
}
