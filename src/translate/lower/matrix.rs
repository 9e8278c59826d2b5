//! Matrix constructors: `mat2(v4)`, and a last argument that gives more components than are left, `mat2(v3, v3)`.
//!
//! naga repeats the one vector as each column, and makes a column too many of what is left over (gfx-rs/wgpu #4897).

use toyproof_glsl::tree::{Constructor, ExprKind, Swizzle, Type};

use super::draft::Draft;
use super::helper::Helper;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let ty = draft.tree[id].ty;
        let ExprKind::Construct {
            constructor: Constructor::Matrix,
            arguments,
        } = &draft.tree[id].kind
        else {
            return;
        };
        let arguments = arguments.clone();
        if let &[only] = arguments.as_slice() {
            let (vector, at) = (draft.tree[only].ty, draft.tree[id].at);
            let function = draft.helper(Helper::Matrix, (ty, vector), at);
            draft.tree[id].kind = ExprKind::Call { function, arguments };
        } else if let Some((&last, others)) = arguments.split_last() {
            let count = |ty: Type| ty.component_count().unwrap_or(0);
            let given: u8 = others
                .iter()
                .map(|&argument| count(draft.tree[argument].ty))
                .sum();
            let left = count(ty).saturating_sub(given);
            if left < count(draft.tree[last].ty)
                && let Some(components) = Swizzle::new(&[0, 1, 2, 3][..usize::from(left.min(4))])
            {
                let trimmed = draft.build_at(last).swizzle(last, components);
                let mut arguments = arguments;
                arguments.pop();
                arguments.push(trimmed);
                draft.tree[id].kind = ExprKind::Construct {
                    constructor: Constructor::Matrix,
                    arguments,
                };
            }
        }
    });
}
