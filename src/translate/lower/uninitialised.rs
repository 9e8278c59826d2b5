//! Variables that begin without a value: locals are zero at each declaration, `out` parameters at each call.
//!
//! That is what WebGL does. naga zeroes locals once for each call of their function, so those inside of loops keep
//! what the last round left in them, and `out` parameters keep what the caller left.

use toyproof_glsl::tree::{
    Block, Direction, ExprKind, FunctionId, Statement, StatementKind, Type, VariableId, VariableKind, walk,
};

use super::draft::Draft;
use super::zero;

pub(super) fn run(draft: &mut Draft) {
    draft.each_body(|draft, function, mut body| {
        declarations(draft, &body, false);
        let zeroes = out_parameters(draft, function, &body);
        body.splice(0..0, zeroes);
        body
    });
}

fn declarations(draft: &mut Draft, block: &Block, in_loop: bool) {
    for statement in block {
        match statement.kind {
            StatementKind::Declare(variable) if in_loop && draft.tree[variable].initialiser.is_none() => {
                let ty = draft.tree[variable].ty;
                let zero = zero::value(draft, ty, statement.at);
                draft.tree[variable].initialiser = Some(zero);
            }
            _ => {}
        }
        let loops = matches!(
            statement.kind,
            StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. }
        );
        for body in walk::inner(statement) {
            declarations(draft, body, in_loop || loops);
        }
    }
}

/// `p = vec3(0.0);` for each `out` parameter that the function may read or leave before it has written the whole of it.
fn out_parameters(draft: &mut Draft, function: FunctionId, body: &Block) -> Vec<Statement> {
    let at = draft.tree[function].at;
    let parameters = draft.tree[function].parameters.clone();
    let open: Vec<VariableId> = parameters
        .into_iter()
        .filter(|&id| draft.tree[id].kind == VariableKind::Parameter(Direction::Out))
        .filter(|&id| !matches!(draft.tree[id].ty, Type::Sampler(_)) && !is_written_first(draft, id, body))
        .collect();
    open.into_iter()
        .map(|parameter| {
            let ty = draft.tree[parameter].ty;
            let zero = zero::value(draft, ty, at);
            Statement {
                kind: StatementKind::Expression(draft.build(at).set(parameter, zero)),
                at,
            }
        })
        .collect()
}

/// Whether the statements that run first write the variable, and nothing reads it before.
fn is_written_first(draft: &Draft, variable: VariableId, body: &Block) -> bool {
    for statement in body {
        let written = match statement.kind {
            StatementKind::Expression(expr) => match draft.tree[expr].kind {
                ExprKind::Assign {
                    op: None,
                    target,
                    value,
                } if matches!(draft.tree[target].kind, ExprKind::Variable(v) if v == variable) => Some(value),
                _ => None,
            },
            StatementKind::Declare(_) => None,
            _ => return false,
        };
        let read = written.map_or_else(
            || walk::own_expressions(&draft.tree, statement),
            |value| vec![value],
        );
        if read
            .into_iter()
            .any(|root| walk::mentions(&draft.tree, root, variable))
        {
            return false;
        }
        if written.is_some() {
            return true;
        }
    }
    false
}
