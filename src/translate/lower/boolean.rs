//! Numbers made of `bool`s where the sizes differ: `vec3(b)`, `vec2(b3)`, `float(b2)`.
//!
//! naga converts one `bool` argument by a selection of the argument's own size, so that `vec3(b)` is a float.

use toyproof_glsl::tree::{Constructor, ExprKind, Scalar, Swizzle, Type};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let ExprKind::Construct {
            constructor,
            ref arguments,
        } = draft.tree[id].kind
        else {
            return;
        };
        let &[only] = arguments.as_slice() else {
            return;
        };
        let (to, from) = (draft.tree[id].ty, draft.tree[only].ty);
        let (Some(scalar), Some(Scalar::Bool)) = (to.scalar(), from.scalar()) else {
            return;
        };
        if scalar == Scalar::Bool {
            return;
        }
        let mut build = draft.build_at(id);
        let only = if let (Type::Vector(..) | Type::Matrix { .. }, Type::Scalar(_)) = (to, from) {
            build.construct(Constructor::Scalar, vec![only], Type::Scalar(scalar))
        } else {
            let left = to.component_count().unwrap_or(1);
            let components = Swizzle::new(&[0, 1, 2, 3][..usize::from(left.min(4))]);
            match components {
                Some(components) if from.component_count() != Some(left) => build.swizzle(only, components),
                _ => return,
            }
        };
        draft.tree[id].kind = ExprKind::Construct {
            constructor,
            arguments: vec![only],
        };
    });
}
