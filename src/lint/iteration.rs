//! Loops that never end, and loops that may run longer than older drivers let them.
//!
//! Mesa's lavapipe before version 23 stops all loops of a pixel after 65,535 iterations in total, and says nothing.
//! Iterations are counted from constant bounds: loops inside of loops, and in what they call.

mod rounds;

use std::collections::HashSet;

use rounds::rounds;
use toyproof_glsl::Code;
use toyproof_glsl::tree::{
    Block, Condition, ExprId, ExprKind, Place, Statement, StatementKind, Value, VariableKind, walk,
};

use super::program::Program;
use super::{Found, number};

/// What older versions of lavapipe let all loops of a pixel do.
const CAP: f64 = 65_535.0;

pub(super) fn run(program: &Program, found: &mut Found) {
    let tree = program.tree;
    let mut counter = Counter {
        program,
        found,
        calls: vec![0.0; tree.functions.len()],
        told: false,
    };
    for &function in &program.functions {
        if let Some(body) = &tree[function].body {
            counter.calls[function.index()] = counter.block(body);
        }
    }
    let total = counter.calls[program.main.index()];
    if total > CAP && !counter.told {
        let at = tree[program.main].at;
        tell(
            counter.found,
            at,
            format!("the loops of a pixel may run {} iterations in all", number(total)),
        );
    }
}

fn tell(found: &mut Found, at: Place, message: String) {
    found.tell(Code::LongLoop, at, message, |diagnostic| {
        diagnostic.note("lavapipe before Mesa 23 stops the loops of a pixel after 65,535 iterations in total, without a word; newer drivers take long")
    });
}

struct Counter<'a, 'f> {
    program: &'a Program<'a>,
    found: &'f mut Found,
    /// By the index of the function: the most iterations that a call runs, as far as bounds are constant.
    calls: Vec<f64>,
    /// Whether a loop was told of: what encloses it runs no shorter.
    told: bool,
}

impl Counter<'_, '_> {
    fn block(&mut self, block: &Block) -> f64 {
        block.iter().map(|statement| self.statement(statement)).sum()
    }

    /// The most iterations that a statement runs.
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
                let rounds = match condition {
                    Some(Condition::Expression(condition)) => rounds(self.program, *condition, *step),
                    _ => None,
                };
                self.endless(statement, *condition, *step, body);
                first + self.repeat(statement.at, rounds, own + inside)
            }
            StatementKind::While { condition, body } => {
                let inside = self.block(body);
                self.endless(statement, Some(*condition), None, body);
                self.repeat(statement.at, None, own + inside)
            }
            StatementKind::DoWhile { condition, body } => {
                let inside = self.block(body);
                self.endless(statement, Some(Condition::Expression(*condition)), None, body);
                self.repeat(statement.at, None, own + inside)
            }
            _ => own,
        }
    }

    fn expression(&self, root: ExprId) -> f64 {
        let tree = self.program.tree;
        let calls = tree
            .postorder(root)
            .into_iter()
            .filter_map(|expr| super::program::callee(tree, expr));
        calls.map(|function| self.calls[function.index()]).sum()
    }

    fn repeat(&mut self, at: Place, rounds: Option<f64>, inside: f64) -> f64 {
        let total = rounds.unwrap_or(1.0) * (1.0 + inside);
        if total > CAP && inside <= CAP && rounds.is_some() {
            self.told = true;
            let message = match inside {
                0.0 => format!("this loop may run {} iterations", number(total)),
                _ => format!(
                    "this loop and those inside of it may run {} iterations",
                    number(total)
                ),
            };
            tell(self.found, at, message);
        }
        total
    }

    fn endless(
        &mut self,
        statement: &Statement,
        condition: Option<Condition>,
        step: Option<ExprId>,
        body: &Block,
    ) {
        let tree = self.program.tree;
        if !self.never_stops(condition, step, body) || is_left(body, true) {
            return;
        }
        let message = match condition {
            Some(Condition::Expression(expr)) if !tree[expr].constant => {
                "this loop never ends once it is entered: nothing in it changes its condition"
            }
            _ => "this loop never ends: its condition is always true, and nothing leaves it",
        };
        self.found
            .tell(Code::EndlessLoop, statement.at, message, |diagnostic| {
                diagnostic
                    .note("browsers stop the GPU after some seconds; leave the loop by `break`, or bound it")
            });
    }

    /// Whether a condition, once it holds, holds for ever.
    fn never_stops(&self, condition: Option<Condition>, step: Option<ExprId>, body: &Block) -> bool {
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
        // Loops inside of loops are looked at once each, not once for each that encloses them.
        let is_innermost = |statement: &Statement| walk::inner(statement).is_empty() || !is_loop(statement);
        let mut innermost = true;
        walk::each(body, &mut |statement| innermost &= is_innermost(statement));
        if !innermost {
            return false;
        }
        let mut asked = HashSet::new();
        let only_locals = !walk::any(tree, condition, |kind| match kind {
            ExprKind::Variable(variable) => {
                asked.insert(*variable);
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
                        .is_some_and(|variable| asked.contains(&variable));
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

/// Whether something in a loop's body leaves it; `breaks` where a `break` would be the loop's own.
fn is_left(block: &Block, breaks: bool) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Break => breaks,
        StatementKind::Return(_) | StatementKind::Discard => true,
        StatementKind::Switch { .. } => walk::inner(statement)
            .into_iter()
            .any(|body| is_left(body, false)),
        _ => {
            let own = breaks && !is_loop(statement);
            walk::inner(statement).into_iter().any(|body| is_left(body, own))
        }
    })
}
