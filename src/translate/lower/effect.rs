//! Which functions have side effects, and so which expressions.

use std::collections::HashSet;

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, StatementKind, Tree, VariableKind, walk};

use super::call_order::callees_first;

/// The functions that write a global variable or a parameter of their caller, or discard the pixel,
/// themselves or by a function that they call.
pub(crate) fn impure_functions(tree: &Tree) -> HashSet<FunctionId> {
    let mut impure = HashSet::new();
    for (function, callees) in callees_first(tree) {
        if callees.iter().any(|callee| impure.contains(callee)) || has_effect(tree, function) {
            impure.insert(function);
        }
    }
    impure
}

/// Whether a function itself writes what is not its own, or discards the pixel.
fn has_effect(tree: &Tree, function: FunctionId) -> bool {
    let Some(body) = &tree[function].body else {
        return false;
    };
    let mut found = false;
    walk::each(body, &mut |statement| {
        found |= matches!(statement.kind, StatementKind::Discard);
    });
    for expr in walk::roots(tree, body)
        .into_iter()
        .flat_map(|root| tree.postorder(root))
    {
        tree.each_write(expr, |target, _| {
            found |= !tree.root_variable(target).is_some_and(|variable| {
                matches!(
                    tree[variable].kind,
                    VariableKind::Local | VariableKind::Parameter(Direction::In | Direction::ConstIn)
                )
            });
        });
    }
    found
}

/// Whether the value of an expression is all that its evaluation results in.
pub(crate) fn is_pure(tree: &Tree, impure: &HashSet<FunctionId>, root: ExprId) -> bool {
    tree.postorder(root).into_iter().all(|id| match tree[id].kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } => false,
        ExprKind::Call { function, .. } => !impure.contains(&function),
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_none(),
        _ => true,
    })
}
