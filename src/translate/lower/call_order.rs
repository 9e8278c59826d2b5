//! The order in which what holds of functions is found from what holds of those that they call.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_glsl::tree::{ExprKind, FunctionId, Tree, walk};

/// The functions with bodies, each after those that it calls, and with these: there is no recursion.
pub(crate) fn callees_first(tree: &Tree) -> Vec<(FunctionId, BTreeSet<FunctionId>)> {
    let mut called: BTreeMap<FunctionId, BTreeSet<FunctionId>> = BTreeMap::new();
    for (id, function) in tree.functions.iter() {
        let Some(body) = &function.body else { continue };
        let roots = walk::roots(tree, body).into_iter();
        let calls = roots
            .flat_map(|root| tree.postorder(root))
            .filter_map(|expr| match tree[expr].kind {
                ExprKind::Call { function, .. } => Some(function),
                _ => None,
            });
        called.insert(id, calls.collect());
    }
    let mut order = Vec::with_capacity(called.len());
    let roots: Vec<FunctionId> = called.keys().copied().collect();
    let mut started = BTreeSet::new();
    for root in roots {
        let mut pending = vec![(root, false)];
        while let Some((function, callees_done)) = pending.pop() {
            if callees_done {
                order.extend(called.remove(&function).map(|callees| (function, callees)));
            } else if let Some(callees) = called.get(&function)
                && started.insert(function)
            {
                pending.push((function, true));
                pending.extend(callees.iter().map(|&callee| (callee, false)));
            }
        }
    }
    order
}
