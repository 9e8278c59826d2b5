//! Endless loops, and loops that exceed the iteration limit of older drivers.
//!
//! Mesa's lavapipe before version 23 silently stops the loops of a pixel after 65,535 iterations in total.
//! The iterations of nested loops and of called functions are counted from constant bounds.

use std::collections::HashSet;

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{
    BinaryOp, Block, BuiltIn, Condition, ExprId, ExprKind, Input, Place, Statement, StatementKind, StepOp,
    Type, Value, VariableId, VariableKind, walk,
};

use super::program::{Definition, Program, callee};
use super::{Findings, format_number};

/// The limit of lavapipe before Mesa 23, in iterations of all loops of a pixel.
const MAX_PIXEL_ITERATIONS: f64 = 65_535.0;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let mut counter = Counter {
        program,
        findings,
        call_iterations: vec![0.0; tree.functions.len()],
        is_reported: false,
    };
    for &function in &program.functions {
        if let Some(body) = &tree[function].body {
            counter.call_iterations[function.index()] = counter.block(body);
        }
    }
    let total = counter.call_iterations[program.main.index()];
    if total > MAX_PIXEL_ITERATIONS && !counter.is_reported {
        let at = tree[program.main].at;
        report(
            counter.findings,
            at,
            format!(
                "the loops of one pixel may run {} iterations in total",
                format_number(total)
            ),
        );
    }
}

fn report(findings: &mut Findings, at: Place, message: String) {
    findings.add(Code::LongLoop, at, message, |diagnostic| {
        diagnostic.note(
            "lavapipe before Mesa 23 silently stops the loops of a pixel after 65,535 iterations in total",
        )
    });
}

struct Counter<'a, 'f> {
    program: &'a Program<'a>,
    findings: &'f mut Findings,
    /// By function index: the maximum number of iterations in a call, as far as bounds are constant.
    call_iterations: Vec<f64>,
    /// Whether a loop has been reported; enclosing code, which runs at least as long, is then not reported.
    is_reported: bool,
}

impl Counter<'_, '_> {
    fn block(&mut self, block: &Block) -> f64 {
        block.iter().map(|statement| self.statement(statement)).sum()
    }

    /// The maximum number of iterations that a statement runs.
    fn statement(&mut self, statement: &Statement) -> f64 {
        let tree = self.program.tree;
        let own: f64 = walk::own_expressions(tree, statement)
            .into_iter()
            .map(|expr| self.expression(expr))
            .sum();
        match &statement.kind {
            StatementKind::Block(body) => self.block(body),
            StatementKind::If { arms, otherwise } => {
                let bodies = arms.iter().map(|arm| &arm.body).chain(otherwise);
                own + bodies.map(|body| self.block(body)).fold(0.0, f64::max)
            }
            StatementKind::Switch { cases, .. } => {
                own + cases
                    .iter()
                    .map(|case| self.block(&case.body))
                    .fold(0.0, f64::max)
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let first = self.block(init);
                let inside = self.block(body);
                let max_iterations = match condition {
                    Some(Condition::Expression(condition)) => max_iterations(self.program, *condition, *step),
                    _ => None,
                };
                self.check_endless(statement, *condition, *step, body);
                first + self.loop_iterations(statement.at, max_iterations, own + inside)
            }
            StatementKind::While { condition, body } => {
                let inside = self.block(body);
                self.check_endless(statement, Some(*condition), None, body);
                self.loop_iterations(statement.at, None, own + inside)
            }
            StatementKind::DoWhile { condition, body } => {
                let inside = self.block(body);
                self.check_endless(statement, Some(Condition::Expression(*condition)), None, body);
                self.loop_iterations(statement.at, None, own + inside)
            }
            _ => own,
        }
    }

    fn expression(&self, root: ExprId) -> f64 {
        let tree = self.program.tree;
        let calls = tree
            .postorder(root)
            .into_iter()
            .filter_map(|expr| callee(tree, expr));
        calls.map(|function| self.call_iterations[function.index()]).sum()
    }

    fn loop_iterations(&mut self, at: Place, max_iterations: Option<f64>, inside: f64) -> f64 {
        let total = max_iterations.unwrap_or(1.0) * (1.0 + inside);
        if total > MAX_PIXEL_ITERATIONS && inside <= MAX_PIXEL_ITERATIONS && max_iterations.is_some() {
            self.is_reported = true;
            let message = match inside {
                0.0 => format!("this loop may run {} iterations", format_number(total)),
                _ => format!(
                    "this loop and the loops inside it may run {} iterations",
                    format_number(total)
                ),
            };
            report(self.findings, at, message);
        }
        total
    }

    fn check_endless(
        &mut self,
        statement: &Statement,
        condition: Option<Condition>,
        step: Option<ExprId>,
        body: &Block,
    ) {
        let tree = self.program.tree;
        if !self.condition_never_changes(condition, step, body) || has_exit(body, true) {
            return;
        }
        let message = match condition {
            Some(Condition::Expression(expr)) if !tree[expr].constant => {
                "infinite loop: its body does not change its condition"
            }
            _ => "infinite loop: its condition is always true, and no `break` or `return` leaves it",
        };
        self.findings
            .add(Code::EndlessLoop, statement.at, message, |diagnostic| {
                diagnostic
                    .note("browsers reset the GPU after a few seconds")
                    .help("bound the number of iterations, or leave the loop with `break`")
            });
    }

    /// Whether a condition that is true once remains true forever.
    fn condition_never_changes(
        &self,
        condition: Option<Condition>,
        step: Option<ExprId>,
        body: &Block,
    ) -> bool {
        let program = self.program;
        let tree = program.tree;
        let condition = match condition {
            None => return true,
            Some(Condition::Declare(_)) => return false,
            Some(Condition::Expression(condition)) => condition,
        };
        if let Some(constant) = tree.value(condition) {
            return constant.components() == [Value::Bool(true)];
        }
        // Only innermost loops are analyzed, so that nested bodies are not visited once per enclosing loop.
        let is_innermost =
            |statement: &Statement| walk::child_blocks(statement).is_empty() || !is_loop(statement);
        let mut innermost = true;
        walk::each(body, &mut |statement| innermost &= is_innermost(statement));
        if !innermost {
            return false;
        }
        let mut tested = HashSet::new();
        let only_locals = !walk::any(tree, condition, |kind| match kind {
            ExprKind::Variable(variable) => {
                tested.insert(*variable);
                matches!(tree[*variable].kind, VariableKind::Global)
            }
            ExprKind::Call { .. } | ExprKind::Assign { .. } | ExprKind::Step { .. } => true,
            _ => false,
        });
        let mut changed = false;
        for root in walk::roots(tree, body).into_iter().chain(step) {
            for expr in tree.postorder(root) {
                tree.each_write(expr, |target, _| {
                    changed |= tree
                        .root_variable(target)
                        .is_some_and(|variable| tested.contains(&variable));
                });
            }
        }
        only_locals && !changed
    }
}

fn is_loop(statement: &Statement) -> bool {
    matches!(
        statement.kind,
        StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. }
    )
}

/// Whether a statement in a loop's body leaves the loop; `break_exits`: whether a `break` here does.
fn has_exit(block: &Block, break_exits: bool) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Break => break_exits,
        StatementKind::Return(_) | StatementKind::Discard => true,
        StatementKind::Switch { .. } => walk::child_blocks(statement)
            .into_iter()
            .any(|body| has_exit(body, false)),
        _ => {
            let break_exits = break_exits && !is_loop(statement);
            walk::child_blocks(statement)
                .into_iter()
                .any(|body| has_exit(body, break_exits))
        }
    })
}

// Iteration counts of counting loops.

/// The maximum number of iterations of a counting loop with constant bounds.
fn max_iterations(program: &Program, condition: ExprId, step: Option<ExprId>) -> Option<f64> {
    let tree = program.tree;
    let &ExprKind::Binary { op, left, right } = &tree[condition].kind else {
        return None;
    };
    let (op, counter, bound) = match (&tree[left].kind, &tree[right].kind) {
        (ExprKind::Variable(counter), _) if program.constant(left).is_none() => (op, *counter, right),
        (_, ExprKind::Variable(counter)) => (op.mirrored(), *counter, left),
        _ => return None,
    };
    let by = step_size(program, counter, step?)?;
    // The counter must have one initial value, and be changed only by the step.
    let ([Definition::Value(first), Definition::Change(change)]
    | [Definition::Change(change), Definition::Value(first)]) = *program.definitions(counter)
    else {
        return None;
    };
    if Some(change) != step {
        return None;
    }
    let (first, bound) = (constant_number(program, first)?, constant_number(program, bound)?);
    let distance = match op {
        BinaryOp::Less | BinaryOp::LessEqual if by > 0.0 => bound - first,
        BinaryOp::Greater | BinaryOp::GreaterEqual if by < 0.0 => first - bound,
        // The counter moves away from its bound: an `int` wraps around through all its values.
        BinaryOp::Less | BinaryOp::LessEqual if first < bound && tree[counter].ty == Type::INT => {
            // About 2³² values.
            return Some(4e9 / by.abs());
        }
        _ => return None,
    };
    let size = by.abs();
    let max_iterations = match op {
        BinaryOp::LessEqual | BinaryOp::GreaterEqual => (distance / size).floor() + 1.0,
        _ => (distance / size).ceil(),
    };
    (max_iterations.is_finite()).then_some(max_iterations.max(0.0))
}

/// The amount that a step adds to the loop's counter.
fn step_size(program: &Program, counter: VariableId, step: ExprId) -> Option<f64> {
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
        } => (*target, constant_number(program, *value)?),
        ExprKind::Assign {
            op: Some(BinaryOp::Subtract),
            target,
            value,
        } => (*target, -constant_number(program, *value)?),
        _ => return None,
    };
    let is_counter = matches!(tree[target].kind, ExprKind::Variable(variable) if variable == counter);
    (is_counter && by != 0.0).then_some(by)
}

/// The value of a constant number. `min(iFrame, 0)`, an idiom that prevents unrolling, is 0.
fn constant_number(program: &Program, expr: ExprId) -> Option<f64> {
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
