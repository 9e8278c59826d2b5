//! `out` and `inout` arguments that are components, swizzles, elements or members: `m(p.x)`, `m(a[i])`, `m(s.a)`.
//!
//! naga passes a pointer to a component, which its SPIR-V writer panics on. GLSL copies in and out (§6.1.1):
//! so do we, with indices evaluated once, where the argument stands, and values copied in when all arguments
//! are evaluated, as glslang does. Arguments that are parts of one variable are copied too: WGSL forbids
//! pointers that alias. Of `in` arguments, too, variables and their parts are read last, those of `const in`
//! in their turn: `f(i, i++)`.

use std::collections::HashSet;

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, Type, VariableId, VariableKind, walk};

use super::draft::Draft;
use super::lvalue::{self, Fix};

pub(super) fn run(draft: &mut Draft) {
    let discarded = draft.discarded();
    draft.operands_first(|draft, id| {
        if let ExprKind::Call { function, arguments } = &draft.tree[id].kind {
            let directions = draft.tree[*function]
                .parameters
                .iter()
                .map(|&parameter| direction(draft, parameter));
            let arguments: Vec<_> = arguments.iter().copied().zip(directions).collect();
            copy(draft, id, &arguments, discarded.contains(&id));
        }
    });
}

fn direction(draft: &Draft, parameter: VariableId) -> Direction {
    match draft.tree[parameter].kind {
        VariableKind::Parameter(direction) => direction,
        _ => Direction::In,
    }
}

fn is_out(direction: Direction) -> bool {
    matches!(direction, Direction::Out | Direction::InOut)
}

/// Lets a call work on copies where naga cannot point at the arguments themselves.
fn copy(draft: &mut Draft, call: ExprId, arguments: &[(ExprId, Direction)], discarded: bool) {
    let mut written = HashSet::new();
    let awkward: Vec<bool> = arguments
        .iter()
        .map(|&(argument, direction)| {
            let is_whole = matches!(draft.tree[argument].kind, ExprKind::Variable(_));
            is_out(direction)
                && (!draft
                    .tree
                    .root_variable(argument)
                    .is_none_or(|root| written.insert(root))
                    || !is_whole)
        })
        .collect();
    let late: Vec<bool> = arguments
        .iter()
        .map(|&(argument, direction)| {
            direction == Direction::In && draft.tree.root_variable(argument).is_some()
        })
        .collect();
    let changed = (0..arguments.len()).any(|at| {
        let mut later = arguments[at + 1..].iter();
        late[at] && later.any(|&(later, _)| walk::may_change(&draft.tree, later, arguments[at].0))
    });
    if !changed && !awkward.contains(&true) {
        return;
    }
    // Once one value is set aside, all are: what stays in the call is evaluated last.
    let acting = arguments
        .iter()
        .any(|&(argument, _)| walk::acts(&draft.tree, argument));
    let (mut before, mut copied, mut after) = (Vec::new(), Vec::new(), Vec::new());
    for ((&(argument, direction), awkward), late) in arguments.iter().zip(awkward).zip(late) {
        if acting && late {
            lvalue::fix_indices(draft, argument, Fix::Changing, &mut before);
        } else if awkward {
            lvalue::fix_indices(draft, argument, Fix::Changing, &mut before);
            let at = draft.tree[argument].at;
            let ty = draft.tree[argument].ty;
            let copy = draft.temporary("argument", ty, at);
            let mut build = draft.build(at);
            if direction == Direction::InOut {
                let read = build.copy(argument);
                copied.push(build.set(copy, read));
            }
            let home = build.detach(argument);
            let value = build.variable(copy);
            let back = build.assign(home, value);
            super::swizzle::mend(draft, back);
            after.push(back);
            draft.tree[argument].kind = ExprKind::Variable(copy);
        } else if acting && !is_out(direction) && !draft.tree[argument].constant {
            before.push(lvalue::set_aside(draft, argument, "argument"));
        }
    }
    before.extend(copied);
    let at = draft.tree[call].at;
    let ty = draft.tree[call].ty;
    let mut steps = before;
    let operation = draft.build(at).detach(call);
    if discarded || ty == Type::Void {
        steps.push(operation);
        steps.extend(after);
        lvalue::replace(draft, call, steps, None);
    } else {
        let result = draft.temporary("result", ty, at);
        let mut build = draft.build(at);
        steps.push(build.set(result, operation));
        let result = build.variable(result);
        steps.extend(after);
        lvalue::replace(draft, call, steps, Some(result));
    }
}
