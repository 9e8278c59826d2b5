//! Global variables and constants whose initialiser naga cannot evaluate: they begin in a function that runs before
//! `mainImage`, in the author's order. Constant arrays become variables outside of functions.
//!
//! naga evaluates an initialiser or refuses it if it is a constant's, and drops it silently if it is a variable's. A constant
//! array that is indexed by a variable it copies to a local variable at each use, which makes lavapipe ten times slower.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Direction, ExprId, ExprKind, Item, Scalar, Statement, StatementKind,
    Tree, Type, VariableId, VariableKind,
};

use super::draft::Draft;
use super::lvalue;

pub(super) fn run(draft: &mut Draft) {
    let variables: Vec<VariableId> = draft
        .tree
        .items
        .iter()
        .filter_map(|item| match *item {
            Item::Variable(variable) => Some(variable),
            _ => None,
        })
        .collect();
    let globals = variables.iter().copied().collect();
    for variable in variables {
        let Some(value) = draft.tree[variable].initialiser else {
            continue;
        };
        let evaluated = evaluates(&draft.tree, &globals, value);
        if !evaluated || matches!(draft.tree[variable].ty, Type::Array(_)) {
            draft.tree[variable].kind = VariableKind::Global;
        }
        if !evaluated {
            draft.tree[variable].initialiser = None;
            let set = draft.build_at(value).set(variable, value);
            draft.start.push(set);
        }
    }
    // Now that it is clear which constants still are: a variable has no value yet where arrays begin.
    lift_arrays(draft, &globals);
    start(draft);
}

/// Moves arrays out of functions that begin with constants and are never written.
fn lift_arrays(draft: &mut Draft, globals: &HashSet<VariableId>) {
    let written = written(&draft.tree);
    let mut lifted = Vec::new();
    draft.each_statement(|draft, statement, out| {
        if let StatementKind::Declare(variable) = statement.kind
            && let Some(value) = draft.tree[variable].initialiser
            && matches!(draft.tree[variable].ty, Type::Array(_))
            && !written.contains(&variable)
            && evaluates(&draft.tree, globals, value)
        {
            lifted.push(variable);
        } else {
            out.push(statement);
        }
    });
    for variable in lifted {
        draft.tree[variable].kind = VariableKind::Global;
        draft.moved.insert(variable);
        draft.tree.items.push(Item::Variable(variable));
    }
}

/// The variables that some expression writes, wholly or in part.
fn written(tree: &Tree) -> HashSet<VariableId> {
    let mut targets = Vec::new();
    for (_, expr) in tree.exprs.iter() {
        match &expr.kind {
            ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => targets.push(*target),
            ExprKind::Call { function, arguments } => {
                let outs = arguments
                    .iter()
                    .zip(&tree[*function].parameters)
                    .filter(|(_, parameter)| {
                        matches!(
                            tree[**parameter].kind,
                            VariableKind::Parameter(Direction::Out | Direction::InOut)
                        )
                    });
                targets.extend(outs.map(|(argument, _)| *argument));
            }
            _ => {}
        }
    }
    let root = |target| lvalue::path(tree, target).last().copied();
    targets
        .into_iter()
        .filter_map(root)
        .filter_map(|root| match tree[root].kind {
            ExprKind::Variable(variable) => Some(variable),
            _ => None,
        })
        .collect()
}

/// Whether naga's evaluator takes an expression at global scope.
fn evaluates(tree: &Tree, globals: &HashSet<VariableId>, root: ExprId) -> bool {
    let is_small = |id: ExprId| matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..));
    tree.postorder(root).into_iter().all(|id| match &tree[id].kind {
        ExprKind::Literal(_) => true,
        ExprKind::Variable(variable) => {
            globals.contains(variable) && tree[*variable].kind == VariableKind::Const
        }
        ExprKind::Unary { .. } => is_small(id),
        &ExprKind::Binary { op, left, right } => {
            let scalars =
                matches!(tree[left].ty, Type::Scalar(_)) && matches!(tree[right].ty, Type::Scalar(_));
            let arithmetic = matches!(
                op,
                BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Multiply | BinaryOp::Divide
            );
            is_small(left)
                && is_small(right)
                && (scalars || arithmetic)
                && !matches!(op, BinaryOp::ShiftLeft | BinaryOp::Xor)
        }
        ExprKind::Construct {
            constructor,
            arguments,
        } => match constructor {
            Constructor::Struct | Constructor::Array => true,
            Constructor::Resize => false,
            _ => arguments.iter().all(|&argument| is_small(argument)),
        },
        &ExprKind::Swizzle { vector, .. } => is_small(vector),
        ExprKind::BuiltIn { function, arguments } => {
            is_evaluated(*function)
                && arguments
                    .iter()
                    .all(|&argument| is_small(argument) && tree[argument].ty.scalar() == Some(Scalar::Float))
        }
        _ => false,
    })
}

/// The built-in functions that naga's evaluator knows.
fn is_evaluated(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::Radians
            | B::Degrees
            | B::Sin
            | B::Cos
            | B::Tan
            | B::Asin
            | B::Acos
            | B::Atan
            | B::Sinh
            | B::Cosh
            | B::Tanh
            | B::Asinh
            | B::Acosh
            | B::Atanh
            | B::Pow
            | B::Exp
            | B::Log
            | B::Exp2
            | B::Log2
            | B::Sqrt
            | B::InverseSqrt
            | B::Abs
            | B::Sign
            | B::Floor
            | B::Trunc
            | B::Ceil
            | B::Fract
            | B::Min
            | B::Max
            | B::Clamp
            | B::Dot
            | B::Cross
            | B::Length
            | B::Distance
            | B::Normalize
            | B::Step
    )
}

/// Makes a function of what runs before `mainImage`.
fn start(draft: &mut Draft) {
    let start = std::mem::take(&mut draft.start);
    let Some(&first) = start.first() else {
        return;
    };
    let at = draft.tree[first].at;
    let function = draft.function("toyproof_start".to_owned(), &[], Type::Void, at);
    let body = start.into_iter().map(|set| Statement {
        kind: StatementKind::Expression(set),
        at: draft.tree[set].at,
    });
    let body = body.collect();
    draft.tree[function].body = Some(body);
    draft.begin = Some(function);
}
