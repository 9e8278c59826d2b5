//! How values of a type lie in components: columns, members and elements in order.

use toyproof_glsl::tree::{Scalar, StructId, Tree, Type};

use crate::ir::operation::Kind;

/// How many components a type has; none for `void` and samplers.
pub(super) fn size(tree: &Tree, ty: Type) -> usize {
    match ty {
        Type::Array(id) => {
            let array = tree.array(id);
            size(tree, array.element) * array.size as usize
        }
        Type::Struct(id) => tree[id].members.iter().map(|member| size(tree, member.ty)).sum(),
        _ => ty.component_count().map_or(0, usize::from),
    }
}

/// How many components stand before a member.
pub(super) fn offset(tree: &Tree, id: StructId, member: usize) -> usize {
    tree[id].members[..member]
        .iter()
        .map(|member| size(tree, member.ty))
        .sum()
}

/// What an index selects of a type, and how many of them there are.
pub(super) fn element(tree: &Tree, ty: Type) -> (Type, u32) {
    match ty {
        Type::Array(id) => (tree.array(id).element, tree.array(id).size),
        Type::Matrix { columns, rows } => (Type::vector(Scalar::Float, rows), u32::from(columns)),
        Type::Vector(scalar, size) => (Type::Scalar(scalar), u32::from(size)),
        _ => (ty, 1),
    }
}

pub(super) fn kind(scalar: Scalar) -> Kind {
    match scalar {
        Scalar::Float => Kind::Float,
        Scalar::Bool | Scalar::Int | Scalar::Uint => Kind::Word,
    }
}
