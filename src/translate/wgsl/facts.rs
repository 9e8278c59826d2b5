//! What is known of variables: who is written, who is indexed by what only the running shader knows, which functions act.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, Type, VariableId, VariableKind, walk};

use crate::lower::Draft;

/// What is known of a draft.
#[derive(Default)]
pub(super) struct Facts {
    /// Written after it began, wholly or in part: it must be a `var`.
    pub(super) written: HashSet<VariableId>,
    /// Indexed by a variable: an array or matrix must then lie in memory.
    pub(super) indexed: HashSet<VariableId>,
    /// Functions that others call.
    pub(super) called: HashSet<FunctionId>,
    /// The globals that each function names.
    pub(super) globals: HashMap<FunctionId, HashSet<VariableId>>,
}

impl Facts {
    pub(super) fn of(draft: &Draft) -> Self {
        let tree = &draft.tree;
        let mut facts = Self::default();
        let write = |written: &mut HashSet<VariableId>, target: ExprId| {
            written.extend(tree.root_variable(target));
        };
        for id in reached(draft) {
            match &tree[id].kind {
                ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => {
                    write(&mut facts.written, *target);
                }
                ExprKind::Call { function, arguments } => {
                    facts.called.insert(*function);
                    for (argument, parameter) in arguments.iter().zip(&tree[*function].parameters) {
                        if is_out(draft, *parameter) {
                            write(&mut facts.written, *argument);
                        }
                    }
                }
                ExprKind::BuiltIn { function, arguments } => {
                    if let Some(&argument) = function.out_parameter().and_then(|at| arguments.get(at)) {
                        write(&mut facts.written, argument);
                    }
                }
                &ExprKind::Index { base, index }
                    if !tree[index].constant
                        && matches!(tree[base].ty, Type::Array(_) | Type::Matrix { .. }) =>
                {
                    facts.indexed.extend(tree.root_variable(base));
                }
                _ => {}
            }
        }
        for (id, function) in tree.functions.iter() {
            let named = facts.globals.entry(id).or_default();
            for root in function.body.iter().flat_map(|body| walk::roots(tree, body)) {
                for expr in tree.postorder(root) {
                    if let ExprKind::Variable(variable) = tree[expr].kind
                        && matches!(tree[variable].kind, VariableKind::Global | VariableKind::Const)
                    {
                        named.insert(variable);
                    }
                }
            }
        }
        facts
    }

    /// Whether a local or parameter must lie in memory.
    pub(super) fn is_memory(&self, variable: VariableId) -> bool {
        self.written.contains(&variable) || self.indexed.contains(&variable)
    }
}

/// The expressions that are printed: lowering leaves others behind in the tree.
fn reached(draft: &Draft) -> Vec<ExprId> {
    let tree = &draft.tree;
    let bodies = tree
        .functions
        .iter()
        .filter_map(|(_, function)| function.body.as_ref());
    let roots = bodies.flat_map(|body| walk::roots(tree, body));
    let globals = tree
        .variables
        .iter()
        .filter_map(|(_, variable)| variable.initialiser);
    roots
        .chain(globals)
        .flat_map(|root| tree.postorder(root))
        .collect()
}

/// Whether a parameter is a pointer.
pub(super) fn is_out(draft: &Draft, parameter: VariableId) -> bool {
    matches!(
        draft.tree[parameter].kind,
        VariableKind::Parameter(Direction::Out | Direction::InOut)
    )
}
