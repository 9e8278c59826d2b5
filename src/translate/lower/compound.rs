//! `t += f(t *= 2.0)`: what the right side makes of the target is what is added to, and `t[i] += i++` adds to
//! the element that `i` named before.
//!
//! GLSL leaves open when the target is read; naga reads it first, WebGL2's translators and glslang read it
//! last. Its indices all of them evaluate first, but here the right side moves before them, too.

use toyproof_glsl::tree::{ExprKind, walk};

use super::draft::Draft;
use super::lvalue::{self, Fix};

pub(super) fn run(draft: &mut Draft) {
    draft.operands_first(|draft, id| {
        if let ExprKind::Assign {
            op: Some(_),
            target,
            value,
        } = draft.tree[id].kind
            && walk::may_change(&draft.tree, value, target)
        {
            let mut steps = Vec::new();
            lvalue::fix_indices(draft, target, Fix::Changing, &mut steps);
            steps.push(lvalue::set_aside(draft, value, "value"));
            let operation = draft.build_at(id).detach(id);
            lvalue::replace(draft, id, steps, Some(operation));
        }
    });
}
