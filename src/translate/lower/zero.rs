//! Values of zero: what WebGL puts into variables before the shader writes them.

use toyproof_glsl::tree::{Constructor, ExprId, Place, Scalar, Statement, StatementKind, Type};

use super::draft::Draft;
use super::helper::Helper;
use super::member;

/// Longer values come out of a function, so that they read well.
const LONGEST: u64 = 16;

/// An expression of that type whose every component is zero.
pub(super) fn value(draft: &mut Draft, ty: Type, at: Place) -> ExprId {
    match ty {
        Type::Struct(_) | Type::Array(_) if size(draft, ty) > LONGEST => from_function(draft, ty, at),
        Type::Struct(id) if member::has_narrow(&draft.tree, id) => from_function(draft, ty, at),
        Type::Struct(id) => {
            let members: Vec<_> = draft.tree[id].members.iter().map(|member| member.ty).collect();
            let arguments = members.into_iter().map(|ty| value(draft, ty, at)).collect();
            draft.build(at).construct(Constructor::Struct, arguments, ty)
        }
        Type::Array(id) => {
            let array = draft.tree.array(id);
            let arguments = (0..array.size).map(|_| value(draft, array.element, at)).collect();
            draft.build(at).construct(Constructor::Array, arguments, ty)
        }
        _ => {
            let mut build = draft.build(at);
            let zero = build.small(ty.scalar().unwrap_or(Scalar::Float), false);
            match ty {
                Type::Vector(..) => build.construct(Constructor::Splat, vec![zero], ty),
                Type::Matrix { .. } => build.construct(Constructor::Diagonal, vec![zero], ty),
                _ => zero,
            }
        }
    }
}

/// A call of a function that gives zero.
fn from_function(draft: &mut Draft, ty: Type, at: Place) -> ExprId {
    let function = draft.helper(Helper::Zero, (ty, Type::Void), at);
    draft.build(at).call(function, Vec::new())
}

/// How many scalars and vectors a value is made of.
fn size(draft: &Draft, ty: Type) -> u64 {
    match ty {
        Type::Struct(id) => draft.tree[id]
            .members
            .iter()
            .map(|member| size(draft, member.ty))
            .sum(),
        Type::Array(id) => {
            let array = draft.tree.array(id);
            u64::from(array.size) * size(draft, array.element)
        }
        _ => 1,
    }
}

/// The body of a function that gives zero: a variable that nobody writes.
pub(super) fn body(draft: &mut Draft, ty: Type, at: Place) -> Vec<Statement> {
    let zero = draft.local("zero", ty, at);
    let value = draft.build(at).variable(zero);
    vec![
        Statement {
            kind: StatementKind::Declare(zero),
            at,
        },
        Statement {
            kind: StatementKind::Return(Some(value)),
            at,
        },
    ]
}
