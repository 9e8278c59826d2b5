//! One number of a value, as its type says.

use serde::{Serialize, Serializer};
use toyproof_eval::Told;
use toyproof_glsl::tree::{Scalar, Tree, Type};
use toyproof_verify::explain::digits;

/// A component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Component {
    Float(f64),
    Int(i32),
    Uint(u32),
    Bool(bool),
}

impl Serialize for Component {
    /// A number or a boolean; what JSON has no number for, by its name.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Float(value) if value.is_finite() => serializer.serialize_f64(value),
            Self::Float(value) => serializer.serialize_str(&digits(value, false)),
            Self::Int(value) => serializer.serialize_i32(value),
            Self::Uint(value) => serializer.serialize_u32(value),
            Self::Bool(value) => serializer.serialize_bool(value),
        }
    }
}

impl Component {
    /// In as many digits as tell an f32 from its neighbours, or of an f64 in ten.
    pub(super) fn digits(self, single: bool) -> String {
        match self {
            Self::Float(value) => digits(value, single),
            Self::Int(value) => value.to_string(),
            Self::Uint(value) => format!("{value}u"),
            Self::Bool(value) => value.to_string(),
        }
    }
}

/// The components of a value with their meaning.
pub(super) fn typed(tree: &Tree, ty: Type, told: &[Told]) -> Vec<Component> {
    let mut scalars = tree.scalars(ty).into_iter();
    let each = told.iter().map(|&told| match (told, scalars.next()) {
        (Told::Float(value), _) => Component::Float(value),
        (Told::Word(word), Some(Scalar::Bool)) => Component::Bool(word != 0),
        (Told::Word(word), Some(Scalar::Uint)) => Component::Uint(word),
        (Told::Word(word), _) => Component::Int(word.cast_signed()),
    });
    each.collect()
}

/// What the components of a type are called behind the name of a variable: `.x`, `[2].center.y`, or nothing.
pub(super) fn components(tree: &Tree, ty: Type) -> Vec<String> {
    let within = |name: String, ty: Type| {
        let inner = components(tree, ty).into_iter();
        inner.map(move |component| format!("{name}{component}"))
    };
    match ty {
        Type::Scalar(_) => vec![String::new()],
        Type::Vector(_, size) => ["x", "y", "z", "w"][..usize::from(size)]
            .iter()
            .map(|name| format!(".{name}"))
            .collect(),
        Type::Matrix { columns, rows } => (0..columns)
            .flat_map(|column| within(format!("[{column}]"), Type::vector(Scalar::Float, rows)))
            .collect(),
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            members
                .flat_map(|member| within(format!(".{}", member.name), member.ty))
                .collect()
        }
        Type::Array(id) => {
            let array = tree.array(id);
            (0..array.size)
                .flat_map(|at| within(format!("[{at}]"), array.element))
                .collect()
        }
        Type::Void | Type::Sampler(_) | Type::Error => Vec::new(),
    }
}
