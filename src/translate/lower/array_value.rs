//! Arrays that are values get names, for languages that list the elements of an array in declarations only.

use std::collections::HashSet;

use toyproof_glsl::tree::{Constructor, ExprId, ExprKind, Tree};

use crate::lower::context::LoweringContext;

/// Rewrites `float[2](a, b)` outside the values of declarations as `(t = float[2](a, b), t)`;
/// [`Pass::Sequences`](super::Pass::Sequences) turns the assignment into a declaration.
pub(crate) fn name_array_values(cx: &mut LoweringContext) {
    let declared = values_of_declarations(&cx.tree);
    cx.each_expression_postorder(|cx, id| {
        let is_array = matches!(
            cx.tree[id].kind,
            ExprKind::Construct {
                constructor: Constructor::Array,
                ..
            }
        );
        if !is_array || declared.contains(&id) {
            return;
        }
        let (kind, ty, at) = (cx.tree[id].kind.clone(), cx.tree[id].ty, cx.tree[id].at);
        let array = cx.temporary("array", ty, at);
        let mut build = cx.build(at);
        let value = build.push(kind, ty);
        let first = build.set(array, value);
        let second = build.variable(array);
        cx.tree[id].kind = ExprKind::Sequence { first, second };
    });
}

/// The initial values of variables, and the elements and members that they list.
fn values_of_declarations(tree: &Tree) -> HashSet<ExprId> {
    let initializers = tree
        .variables
        .iter()
        .filter_map(|(_, variable)| variable.initializer);
    let mut pending: Vec<ExprId> = initializers.collect();
    let mut values = HashSet::new();
    while let Some(id) = pending.pop() {
        values.insert(id);
        if let ExprKind::Construct {
            constructor: Constructor::Array | Constructor::Struct,
            arguments,
        } = &tree[id].kind
        {
            pending.extend(arguments);
        }
    }
    values
}
