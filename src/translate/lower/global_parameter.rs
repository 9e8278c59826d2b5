//! Global variables as parameters, for languages whose functions see none that changes.

use std::collections::{BTreeMap, HashMap};

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, BuiltInVariable, Direction, ExprId, ExprKind, FunctionId, Input, Item, Statement,
    StatementKind, Tree, Type, Variable, VariableId, VariableKind, walk,
};

use super::call_order::callees_first;
use crate::lower::context::LoweringContext;

/// The variable that [`orient_derivatives`] adds. Like the position of the pixel, only the entry point of the
/// host has it.
pub(crate) const UPWARD: &str = "upward";

/// Why the global variables of a shader cannot become parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) enum GlobalConflict {
    /// A function reads or writes a global variable that is also its `out` argument.
    Aliased,
    /// A function other than the host calls `mainImage`.
    CalledEntry,
}

/// The global variables that a function uses, itself or by the functions that it calls, and whether it writes
/// them.
type Uses = BTreeMap<VariableId, bool>;

/// Rewrites the shader so that functions have the global variables that they use as parameters: `mainImage`
/// declares the author's, and has those that only the host's entry point knows as additional parameters.
/// Returns the latter, in order.
///
/// # Errors
/// If the result would have another meaning.
pub(crate) fn pass_globals(cx: &mut LoweringContext) -> Result<Vec<VariableId>, GlobalConflict> {
    let own = own_globals(&cx.tree);
    let mut uses = uses(cx);
    // What `mainImage` declares is initialized by what it has.
    let initial = own.iter().filter_map(|&id| cx.tree[id].initializer);
    let initial: Vec<ExprId> = initial.collect();
    let main = cx.main_image;
    let declared: Vec<VariableId> = {
        let of_initializers = initial.iter().map(|&root| of_expression(&cx.tree, root, &uses));
        let mut all = uses.get(&main).cloned().unwrap_or_default();
        for used in of_initializers.collect::<Vec<_>>() {
            merge(&mut all, &used);
        }
        uses.insert(main, all.clone());
        own.iter().copied().filter(|id| all.contains_key(id)).collect()
    };
    check(&cx.tree, &uses, main)?;
    let mut known_by_host = Vec::new();
    for (function, used) in &uses {
        let mut renamed = HashMap::new();
        for (&global, &written) in used {
            let (name, ty) = (cx.tree[global].name.clone(), cx.tree[global].ty);
            let at = cx.tree[*function].at;
            let is_declared = *function == main && is_own(&cx.tree, global);
            let kind = match (is_declared, written) {
                (true, _) => VariableKind::Local,
                (false, true) => VariableKind::Parameter(Direction::InOut),
                (false, false) => VariableKind::Parameter(Direction::In),
            };
            let mut variable = Variable::new(name, ty, kind, Some(at));
            if is_declared {
                variable.initializer = cx.tree[global].initializer;
            }
            let local = cx.tree.variables.push(variable);
            cx.moved.insert(local);
            renamed.insert(global, local);
            if !is_declared {
                cx.tree[*function].parameters.push(local);
                if *function == main {
                    known_by_host.push(global);
                }
            }
        }
        let mut roots = match &cx.tree[*function].body {
            Some(body) => walk::roots(&cx.tree, body),
            None => Vec::new(),
        };
        if *function == main {
            roots.extend(&initial);
            declare(cx, &declared, &renamed);
        }
        for root in roots {
            rewrite(cx, root, &renamed, &uses);
        }
    }
    Ok(known_by_host)
}

/// The author's global variables that are not constant, in their order.
fn own_globals(tree: &Tree) -> Vec<VariableId> {
    let items = tree.items.iter().filter_map(|item| match *item {
        Item::Variable(id) if is_own(tree, id) => Some(id),
        _ => None,
    });
    items.collect()
}

fn is_own(tree: &Tree, id: VariableId) -> bool {
    tree[id].kind == VariableKind::Global
}

/// Whether only the host's entry point has the value.
fn is_passed(tree: &Tree, id: VariableId) -> bool {
    is_own(tree, id)
        || matches!(
            tree[id].kind,
            VariableKind::BuiltIn(BuiltInVariable::FragCoord)
                | VariableKind::Input(Input::Resolution | Input::ChannelResolution)
        )
}

/// The variables that each function uses.
fn uses(cx: &LoweringContext) -> BTreeMap<FunctionId, Uses> {
    let tree = &cx.tree;
    let mut uses: BTreeMap<FunctionId, Uses> = BTreeMap::new();
    for (function, callees) in callees_first(tree) {
        let mut used = Uses::new();
        let body = tree[function].body.as_ref().map(|body| walk::roots(tree, body));
        for expr in body.into_iter().flatten().flat_map(|root| tree.postorder(root)) {
            add(tree, expr, &mut used);
        }
        for of_call in callees.iter().filter_map(|callee| uses.get(callee)) {
            merge(&mut used, of_call);
        }
        if !used.is_empty() {
            uses.insert(function, used);
        }
    }
    uses
}

/// Adds what an expression itself, not its operands, uses.
fn add(tree: &Tree, expr: ExprId, used: &mut Uses) {
    if let ExprKind::Variable(variable) = tree[expr].kind
        && is_passed(tree, variable)
    {
        used.entry(variable).or_default();
    }
    tree.each_write(expr, |target, _| {
        if let Some(variable) = tree.root_variable(target).filter(|&id| is_passed(tree, id)) {
            used.insert(variable, true);
        }
    });
}

fn of_expression(tree: &Tree, root: ExprId, uses: &BTreeMap<FunctionId, Uses>) -> Uses {
    let mut used = Uses::new();
    for expr in tree.postorder(root) {
        add(tree, expr, &mut used);
        if let ExprKind::Call { function, .. } = tree[expr].kind
            && let Some(of_call) = uses.get(&function)
        {
            merge(&mut used, of_call);
        }
    }
    used
}

/// Adds the uses of a called function.
fn merge(used: &mut Uses, of_call: &Uses) {
    for (&variable, &written) in of_call {
        *used.entry(variable).or_default() |= written;
    }
}

/// Checks that no global variable is an `out` argument of a function that also uses it, and that only the
/// host calls `mainImage`.
fn check(tree: &Tree, uses: &BTreeMap<FunctionId, Uses>, main: FunctionId) -> Result<(), GlobalConflict> {
    for id in tree.exprs.ids() {
        let ExprKind::Call { function, .. } = tree[id].kind else {
            continue;
        };
        if function == main {
            return Err(GlobalConflict::CalledEntry);
        }
        let Some(used) = uses.get(&function) else { continue };
        let mut is_aliased = false;
        tree.each_write(id, |target, _| {
            is_aliased |= tree
                .root_variable(target)
                .is_some_and(|root| used.contains_key(&root));
        });
        if is_aliased {
            return Err(GlobalConflict::Aliased);
        }
    }
    Ok(())
}

/// Declares variables at the beginning of `mainImage`.
fn declare(cx: &mut LoweringContext, globals: &[VariableId], renamed: &HashMap<VariableId, VariableId>) {
    let main = cx.main_image;
    let at = cx.tree[main].at;
    let declarations = globals.iter().filter_map(|global| {
        Some(Statement {
            at: cx.tree[*global].at.unwrap_or(at),
            kind: StatementKind::Declare(*renamed.get(global)?),
        })
    });
    let declarations: Vec<Statement> = declarations.collect();
    if let Some(body) = &mut cx.tree[main].body {
        body.splice(0..0, declarations);
    }
}

/// Replaces the variables in an expression, and passes them to the functions that it calls.
fn rewrite(
    cx: &mut LoweringContext,
    root: ExprId,
    renamed: &HashMap<VariableId, VariableId>,
    uses: &BTreeMap<FunctionId, Uses>,
) {
    for id in cx.tree.postorder(root) {
        match &mut cx.tree[id].kind {
            ExprKind::Variable(variable) => {
                if let Some(local) = renamed.get(variable) {
                    *variable = *local;
                }
            }
            ExprKind::Call { function, .. } => {
                let Some(used) = uses.get(function) else { continue };
                let passed = used.keys().filter_map(|global| renamed.get(global).copied());
                let passed: Vec<VariableId> = passed.collect();
                let mut build = cx.build_at(id);
                let passed: Vec<ExprId> = passed.into_iter().map(|local| build.variable(local)).collect();
                if let ExprKind::Call { arguments, .. } = &mut cx.tree[id].kind {
                    arguments.extend(passed);
                }
            }
            _ => {}
        }
    }
}

/// Multiplies derivatives along y by a variable of the host's entry point, 1 or -1.
pub(crate) fn orient_derivatives(cx: &mut LoweringContext) {
    let is_derivative = |kind: &ExprKind| {
        matches!(
            kind,
            ExprKind::BuiltIn {
                function: BuiltIn::DFdy,
                ..
            }
        )
    };
    if !cx.tree.exprs.iter().any(|(_, expr)| is_derivative(&expr.kind)) {
        return;
    }
    let kind = VariableKind::BuiltIn(BuiltInVariable::FragCoord);
    let upward = cx
        .tree
        .variables
        .push(Variable::new(UPWARD, Type::FLOAT, kind, None));
    cx.each_expression(|cx, id| {
        if is_derivative(&cx.tree[id].kind) {
            let mut build = cx.build_at(id);
            let right = build.detach(id);
            let left = build.variable(upward);
            cx.tree[id].kind = ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            };
        }
    });
}
