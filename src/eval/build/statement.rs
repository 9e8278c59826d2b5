//! Statements (§6): control flow as scopes, loops and branches.

use toyproof_glsl::tree::{
    Arm, Block, Case, Condition, ExprId, Label, Place, Statement, StatementKind, Type, VariableId,
    VariableKind,
};

use super::lvalue::Location;
use super::{Builder, Result};
use crate::ir::{Block as Nodes, Cell, EventKind, Node, Operation, PartKind, Scope, Value, ValueDef};

impl Builder<'_> {
    pub(super) fn block(&mut self, block: &Block) -> Result<()> {
        for statement in block {
            self.statement(statement)?;
            let over = matches!(self.writer.borrow().block.last(), Some(Node::Break(_)));
            if over {
                break;
            }
        }
        Ok(())
    }

    fn statement(&mut self, statement: &Statement) -> Result<()> {
        self.begin_origin(statement.at, None);
        if self.begins_step(&statement.kind) {
            self.trace_step(statement.at);
        }
        match &statement.kind {
            StatementKind::Expression(expr) => {
                self.expression(*expr)?;
            }
            StatementKind::Declare(variable) => self.declare(*variable)?,
            StatementKind::Struct(_) => {}
            StatementKind::Block(body) => self.block(body)?,
            StatementKind::If { arms, otherwise } => self.arms(arms, otherwise.as_ref())?,
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases)?,
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(init)?;
                self.loop_statement(statement.at, *condition, body, *step, None)?;
            }
            StatementKind::While { condition, body } => {
                self.loop_statement(statement.at, Some(*condition), body, None, None)?;
            }
            StatementKind::DoWhile { body, condition } => {
                self.loop_statement(statement.at, None, body, None, Some(*condition))?;
            }
            StatementKind::Break => {
                self.trace_statement(statement.at);
                self.push_break(self.breaks.last().copied());
            }
            StatementKind::Continue => {
                self.trace_statement(statement.at);
                self.push_break(self.continues.last().copied());
            }
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    let values = self.expression(*value)?;
                    self.trace_event(EventKind::Return, statement.at, self.ty(*value), &values);
                    if let Some(frame) = self.call_stack.last() {
                        self.store_all(frame.result, &values);
                    }
                } else {
                    self.trace_statement(statement.at);
                }
                self.push_break(self.call_stack.last().map(|frame| frame.scope));
            }
            StatementKind::Discard => {
                self.trace_statement(statement.at);
                let yes = self.bool_value(true);
                self.store(self.discarded, yes);
                self.push_break(self.call_stack.first().map(|frame| frame.scope));
            }
        }
        Ok(())
    }

    /// Whether a statement itself computes or decides something, before statements in it do.
    fn begins_step(&self, kind: &StatementKind) -> bool {
        match *kind {
            StatementKind::Declare(variable) => self.tree[variable].initializer.is_some(),
            StatementKind::Struct(_)
            | StatementKind::Block(_)
            | StatementKind::For { .. }
            | StatementKind::While { .. }
            | StatementKind::DoWhile { .. } => false,
            _ => true,
        }
    }

    fn trace_statement(&mut self, at: Place) {
        self.trace_event(EventKind::Statement, at, Type::Void, &[]);
    }

    fn push_break(&self, scope: Option<Scope>) {
        if let Some(scope) = scope {
            self.push(Node::Break(scope));
        }
    }

    /// Declares a variable: evaluates its initializer, or sets it to zero.
    pub(super) fn declare(&mut self, variable: VariableId) -> Result<()> {
        let (ty, initializer) = (self.tree[variable].ty, self.tree[variable].initializer);
        if matches!(ty, Type::Sampler(_)) {
            return Ok(());
        }
        let values = match initializer {
            Some(initializer) => self.expression(initializer)?,
            None => self.zeros(ty),
        };
        let cells = match self.locations.get(&variable) {
            Some(&Location::Cells(cells)) if self.shared.contains(&variable) => cells,
            _ => self.allocate_type(ty)?,
        };
        self.locations.insert(variable, Location::Cells(cells));
        self.bind_here(variable, cells);
        if let (Some(initializer), Some(at)) = (initializer, self.tree[variable].at)
            && self.tree[variable].value.is_none()
        {
            let whole = at.to(self.at(initializer));
            self.trace_event(EventKind::Assignment(at), whole, ty, &values);
        }
        self.store_all(cells, &values);
        if let Some(at) = self.tree[variable].at {
            self.trace_variable(cells, at, initializer.map(|_| &values[..]));
        }
        let local = self.tree[variable].kind == VariableKind::Local;
        if local && !self.shared.contains(&variable) {
            self.begin_variable(variable, cells, initializer.is_some());
        }
        Ok(())
    }

    fn arms(&mut self, arms: &[Arm], otherwise: Option<&Block>) -> Result<()> {
        let Some((arm, others)) = arms.split_first() else {
            let Some((block, first)) = otherwise.and_then(|block| Some((block, block.first()?))) else {
                return Ok(());
            };
            return self.part(PartKind::Else, first.at, |builder| builder.block(block));
        };
        let condition = self.condition(arm.condition)?;
        let at = self.at(arm.condition);
        let yes = self.inner(|builder| builder.part(PartKind::If, at, |builder| builder.block(&arm.body)))?;
        let no = self.inner(|builder| {
            if let Some(next) = others.first() {
                builder.trace_step(builder.at(next.condition));
            }
            builder.arms(others, otherwise)
        })?;
        self.push_if(condition, yes, no);
        Ok(())
    }

    /// Emits an `if`; one that only breaks needs no blocks.
    fn push_if(&self, condition: Value, yes: Nodes, no: Nodes) {
        let node = match (&yes[..], &no[..]) {
            ([], []) => return,
            (&[Node::Break(scope)], []) => Node::BreakIf {
                scope,
                condition,
                when: true,
            },
            (_, &[Node::Break(scope)]) => {
                self.push(Node::BreakIf {
                    scope,
                    condition,
                    when: false,
                });
                self.writer.borrow_mut().block.extend(yes);
                return;
            }
            _ => Node::If { condition, yes, no },
        };
        self.push(node);
    }

    fn loop_statement(
        &mut self,
        at: Place,
        condition: Option<Condition>,
        body: &Block,
        step: Option<ExprId>,
        until: Option<ExprId>,
    ) -> Result<()> {
        let (out, on) = (self.scope(), self.scope());
        let id = self.new_loop(at);
        let nodes = self.inner(|builder| {
            builder.push(Node::LoopHeader(id));
            builder.begin_iteration(at);
            if let Some(condition) = condition {
                let condition = match condition {
                    Condition::Expression(expr) => {
                        builder.trace_step(builder.at(expr));
                        builder.condition(expr)?
                    }
                    Condition::Declare(variable) => {
                        builder.trace_step(at);
                        builder.declare(variable)?;
                        match builder.location(variable) {
                            Location::Cells(cells) => builder.load(Cell(cells.first)),
                            _ => builder.bool_value(false),
                        }
                    }
                };
                builder.break_unless(out, condition);
            }
            let nodes = builder.inner(|builder| {
                builder.breaks.push(out);
                builder.continues.push(on);
                builder.part(PartKind::Loop, at, |builder| builder.block(body))?;
                builder.breaks.pop();
                builder.continues.pop();
                Ok(())
            })?;
            let ends = has_break(&nodes, on) || !never_falls_through(&nodes);
            builder.push_scope(on, nodes);
            if ends {
                if let Some(step) = step {
                    if condition.is_none() {
                        builder.trace_step(builder.at(step));
                    }
                    builder.expression(step)?;
                }
                if let Some(until) = until {
                    builder.trace_step(builder.at(until));
                    let condition = builder.condition(until)?;
                    builder.break_unless(out, condition);
                }
            }
            builder.end_loop();
            Ok(())
        })?;
        let body = vec![Node::Loop { id, body: nodes }];
        self.push(Node::Scope { scope: out, body });
        Ok(())
    }

    fn break_unless(&self, scope: Scope, condition: Value) {
        let def = self.writer.borrow().defs[condition.0 as usize];
        if def != ValueDef::Word(u32::MAX) {
            self.push(Node::BreakIf {
                scope,
                condition,
                when: false,
            });
        }
    }

    /// Emits a `switch`: each case runs for the pixels whose selector matches it, or that fall through from
    /// the case before.
    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> Result<()> {
        let selector_at = self.at(selector);
        let selector = self.scalar(selector)?;
        self.declare_switch_variables(cases)?;
        let out = self.scope();
        let all = cases.iter().flat_map(|case| &case.labels);
        let named = self.any_label(selector, all);
        let body = self.inner(|builder| {
            let mut falls_through = None;
            for case in cases {
                let mut matches = builder.any_label(selector, &case.labels);
                if case.labels.contains(&Label::Default) {
                    let others = match named {
                        Some(named) => builder.unary(Operation::Not, named),
                        None => builder.bool_value(true),
                    };
                    matches = Some(builder.either(matches, others));
                }
                if let Some(before) = falls_through {
                    matches = Some(builder.either(matches, before));
                }
                let condition = matches.unwrap_or_else(|| builder.bool_value(false));
                let mut body = builder.inner(|builder| {
                    builder.breaks.push(out);
                    let at = case.body.first().map_or(selector_at, |first| first.at);
                    builder.part(PartKind::Case, at, |builder| builder.block(&case.body))?;
                    builder.breaks.pop();
                    Ok(())
                })?;
                falls_through = (!never_falls_through(&body)).then_some(condition);
                if falls_through.is_none() {
                    // Pixels that break at the end of this case run no later one.
                    simplify_exits(&mut body, out);
                }
                builder.push(Node::If {
                    condition,
                    yes: body,
                    no: Nodes::new(),
                });
            }
            Ok(())
        })?;
        self.push_scope(out, body);
        Ok(())
    }

    fn either(&self, a: Option<Value>, b: Value) -> Value {
        a.map_or(b, |a| self.binary(Operation::Or, a, b))
    }

    /// Returns whether the selector matches one of the labels, or `None` if there are no labels.
    fn any_label<'b>(&self, selector: Value, labels: impl IntoIterator<Item = &'b Label>) -> Option<Value> {
        let mut any = None;
        for label in labels {
            if let Label::Case { value, .. } = *label {
                let value = self.word(value);
                let equal = self.binary(Operation::EqualWord, selector, value);
                any = Some(self.either(any, equal));
            }
        }
        any
    }

    /// Allocates the variables that the cases declare. All cases are one scope: a later one may read a
    /// variable whose declaration was jumped over.
    fn declare_switch_variables(&mut self, cases: &[Case]) -> Result<()> {
        for statement in cases.iter().flat_map(|case| &case.body) {
            if let StatementKind::Declare(variable) = statement.kind
                && !matches!(self.tree[variable].ty, Type::Sampler(_))
            {
                let ty = self.tree[variable].ty;
                let cells = self.allocate_type(ty)?;
                let zeros = self.zeros(ty);
                self.store_all(cells, &zeros);
                self.locations.insert(variable, Location::Cells(cells));
                self.shared.insert(variable);
            }
        }
        Ok(())
    }
}

// Simplification of breaks: a `return` at the end needs no jump, and nodes after `if (c) return x;` are moved
// into its `else`.

/// The maximum nesting depth of moved nodes.
const MAX_NESTING: usize = 100;

/// Removes breaks at the end of a scope, after moving nodes so that there are more of them.
pub(super) fn simplify_exits(body: &mut Nodes, scope: Scope) {
    simplify_exits_at(body, scope, 0);
}

fn simplify_exits_at(body: &mut Nodes, scope: Scope, depth: usize) {
    if depth > MAX_NESTING {
        return;
    }
    let splits = body.iter().position(|node| match node {
        Node::If { yes, no, .. } => ends_in_break(yes, scope) || ends_in_break(no, scope),
        _ => false,
    });
    if let Some(at) = splits {
        let rest = body.split_off(at + 1);
        if let Some(Node::If { yes, no, .. }) = body.last_mut() {
            match (ends_in_break(yes, scope), ends_in_break(no, scope)) {
                (true, false) => no.extend(rest),
                (false, true) => yes.extend(rest),
                // The rest is unreachable.
                _ => {}
            }
        }
    }
    match body.last_mut() {
        Some(Node::Break(left)) if *left == scope => {
            body.pop();
        }
        Some(Node::If { yes, no, .. }) => {
            simplify_exits_at(yes, scope, depth + 1);
            simplify_exits_at(no, scope, depth + 1);
        }
        _ => {}
    }
}

fn ends_in_break(block: &Nodes, scope: Scope) -> bool {
    matches!(block.last(), Some(Node::Break(left)) if *left == scope)
}

/// Whether control never reaches the end of a block.
pub(super) fn never_falls_through(block: &Nodes) -> bool {
    match block.last() {
        Some(Node::Break(_)) => true,
        Some(Node::If { yes, no, .. }) => never_falls_through(yes) && never_falls_through(no),
        _ => false,
    }
}

/// Whether a block contains a break of a scope.
pub(super) fn has_break(block: &Nodes, scope: Scope) -> bool {
    block.iter().any(|node| match node {
        Node::Break(left) | Node::BreakIf { scope: left, .. } => *left == scope,
        Node::If { yes, no, .. } => has_break(yes, scope) || has_break(no, scope),
        Node::Scope { body, .. } | Node::Loop { body, .. } => has_break(body, scope),
        _ => false,
    })
}
