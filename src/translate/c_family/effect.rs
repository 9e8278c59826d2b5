//! Which functions have side effects, and so which expressions.

use std::collections::HashSet;

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, StatementKind, Tree, VariableKind, walk};

/// The functions that write a global variable or a parameter of their caller, or discard the pixel,
/// themselves
/// or by a function that they call.
pub(super) fn impure_functions(tree: &Tree) -> HashSet<FunctionId> {
    let mut impure = HashSet::new();
    let mut callers: Vec<(FunctionId, FunctionId)> = Vec::new();
    for (id, function) in tree.functions.iter() {
        let Some(body) = &function.body else { continue };
        walk::each(body, &mut |statement| {
            if matches!(statement.kind, StatementKind::Discard) {
                impure.insert(id);
            }
        });
        for root in walk::roots(tree, body) {
            for expr in tree.postorder(root) {
                if let ExprKind::Call { function, .. } = tree[expr].kind {
                    callers.push((id, function));
                }
                tree.each_write(expr, |target, _| {
                    let is_own = tree.root_variable(target).is_some_and(|variable| {
                        matches!(
                            tree[variable].kind,
                            VariableKind::Local | VariableKind::Parameter(Direction::In | Direction::ConstIn)
                        )
                    });
                    if !is_own {
                        impure.insert(id);
                    }
                });
            }
        }
    }
    loop {
        let count = impure.len();
        for &(caller, called) in &callers {
            if impure.contains(&called) {
                impure.insert(caller);
            }
        }
        if impure.len() == count {
            return impure;
        }
    }
}

/// Whether the value of an expression is all that its evaluation results in.
pub(super) fn is_pure(tree: &Tree, impure: &HashSet<FunctionId>, root: ExprId) -> bool {
    tree.postorder(root).into_iter().all(|id| match tree[id].kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } => false,
        ExprKind::Call { function, .. } => !impure.contains(&function),
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_none(),
        _ => true,
    })
}
