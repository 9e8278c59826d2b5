//! How often loops run that count.

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, ExprId, ExprKind, Input, StepOp, Type, Value, VariableId, VariableKind,
};

use super::super::program::{Definition, Program};

/// How often a counting loop runs at most, if its bounds are constant.
pub(super) fn rounds(program: &Program, condition: ExprId, step: Option<ExprId>) -> Option<f64> {
    let tree = program.tree;
    let &ExprKind::Binary { op, left, right } = &tree[condition].kind else {
        return None;
    };
    let (op, counter, bound) = match (&tree[left].kind, &tree[right].kind) {
        (ExprKind::Variable(counter), _) if program.constant(left).is_none() => (op, *counter, right),
        (_, ExprKind::Variable(counter)) => (op.mirrored(), *counter, left),
        _ => return None,
    };
    let by = change_by(program, counter, step?)?;
    // It is given its first value, and changed by the step: by nothing else.
    let ([Definition::Value(first), Definition::Change(change)]
    | [Definition::Change(change), Definition::Value(first)]) = *program.definitions(counter)
    else {
        return None;
    };
    if Some(change) != step {
        return None;
    }
    let (first, bound) = (scalar(program, first)?, scalar(program, bound)?);
    let way = match op {
        BinaryOp::Less | BinaryOp::LessEqual if by > 0.0 => bound - first,
        BinaryOp::Greater | BinaryOp::GreaterEqual if by < 0.0 => first - bound,
        // Away from its bound: an `int` runs round through all of its values.
        BinaryOp::Less | BinaryOp::LessEqual if first < bound && tree[counter].ty == Type::INT => {
            return Some(4e9 / by.abs());
        }
        _ => return None,
    };
    let size = by.abs();
    let rounds = match op {
        BinaryOp::LessEqual | BinaryOp::GreaterEqual => (way / size).floor() + 1.0,
        _ => (way / size).ceil(),
    };
    (rounds.is_finite()).then_some(rounds.max(0.0))
}

/// What a step adds to its counter.
fn change_by(program: &Program, counter: VariableId, step: ExprId) -> Option<f64> {
    let tree = program.tree;
    let (target, by) = match &tree[step].kind {
        ExprKind::Step {
            op: StepOp::Increment,
            target,
            ..
        } => (*target, 1.0),
        ExprKind::Step {
            op: StepOp::Decrement,
            target,
            ..
        } => (*target, -1.0),
        ExprKind::Assign {
            op: Some(BinaryOp::Add),
            target,
            value,
        } => (*target, scalar(program, *value)?),
        ExprKind::Assign {
            op: Some(BinaryOp::Subtract),
            target,
            value,
        } => (*target, -scalar(program, *value)?),
        _ => return None,
    };
    let is_counter = matches!(tree[target].kind, ExprKind::Variable(variable) if variable == counter);
    (is_counter && by != 0.0).then_some(by)
}

/// The value of a number that is always the same. `min(iFrame, 0)`, which keeps compilers from unrolling, is 0.
fn scalar(program: &Program, expr: ExprId) -> Option<f64> {
    let tree = program.tree;
    if let Some(constant) = program.constant(expr) {
        return match *constant.components() {
            [Value::Int(value)] => Some(f64::from(value)),
            [Value::Uint(value)] => Some(f64::from(value)),
            [Value::Float(value)] => Some(value),
            _ => None,
        };
    }
    match &tree[expr].kind {
        ExprKind::BuiltIn {
            function: BuiltIn::Min,
            arguments,
        } => {
            let is_frame = |expr: ExprId| match tree[expr].kind {
                ExprKind::Variable(variable) => tree[variable].kind == VariableKind::Input(Input::Frame),
                _ => false,
            };
            let zero =
                |expr: ExprId| program.constant(expr).and_then(|constant| constant.integer()) == Some(0);
            let (a, b) = (arguments[0], arguments[1]);
            (is_frame(a) && zero(b) || zero(a) && is_frame(b)).then_some(0.0)
        }
        _ => None,
    }
}
