//! Constants of any type, as they are written.

use toyproof_glsl::tree::{Scalar, Tree, Type};

/// The largest number of members of a structure for which a constant is written.
const MAX_MEMBERS: usize = 8;

/// The constant 0 of a type; `None` for arrays, samplers and large structures.
pub(super) fn zero(tree: &Tree, ty: Type) -> Option<String> {
    of(tree, ty, ["false", "0", "0u", "0."])
}

/// The constant 1 of a type.
pub(super) fn one(tree: &Tree, ty: Type) -> Option<String> {
    of(tree, ty, ["true", "1", "1u", "1."])
}

/// A constant whose components are these numbers, of which the fitting one is taken.
fn of(tree: &Tree, ty: Type, [bool, int, uint, float]: [&str; 4]) -> Option<String> {
    let scalar = |scalar| match scalar {
        Scalar::Bool => bool,
        Scalar::Int => int,
        Scalar::Uint => uint,
        Scalar::Float => float,
    };
    match ty {
        Type::Scalar(of) => Some(scalar(of).to_owned()),
        Type::Vector(of, _) => {
            let component = if of == Scalar::Bool { bool } else { int };
            Some(format!("{}({component})", tree.type_name(ty)))
        }
        Type::Matrix { .. } => Some(format!("{}({int})", tree.type_name(ty))),
        Type::Struct(id) if !tree[id].name.is_empty() && tree[id].members.len() <= MAX_MEMBERS => {
            let members = tree[id].members.iter();
            let members = members.map(|member| of(tree, member.ty, [bool, int, uint, float]));
            let members = members.collect::<Option<Vec<_>>>()?;
            Some(format!("{}({})", tree[id].name, members.join(", ")))
        }
        _ => None,
    }
}
