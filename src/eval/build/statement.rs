//! Statements (§6): control as scopes, loops and choices.

use toyproof_glsl::tree::{
    Arm, Block, Case, Condition, ExprId, Label, Place, Statement, StatementKind, Type, VariableId,
    VariableKind,
};

use super::place::Home;
use super::{Builder, Result, tail};
use crate::ir::function::{Block as Nodes, Cell, Node, Origin, Scope, Value};
use crate::ir::operation::Operation;
use crate::trace::story::What;

impl Builder<'_> {
    pub(super) fn block(&mut self, block: &Block) -> Result<()> {
        for statement in block {
            self.statement(statement)?;
            let over = matches!(self.draft.borrow().block.last(), Some(Node::Leave(_)));
            if over {
                break;
            }
        }
        Ok(())
    }

    fn statement(&mut self, statement: &Statement) -> Result<()> {
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
                self.repeat(statement.at, *condition, body, *step, None)?;
            }
            StatementKind::While { condition, body } => {
                self.repeat(statement.at, Some(*condition), body, None, None)?;
            }
            StatementKind::DoWhile { body, condition } => {
                self.repeat(statement.at, None, body, None, Some(*condition))?;
            }
            StatementKind::Break => {
                self.ran(statement.at);
                self.leave(self.breaks.last().copied());
            }
            StatementKind::Continue => {
                self.ran(statement.at);
                self.leave(self.continues.last().copied());
            }
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    let values = self.expression(*value)?;
                    self.tell(What::Returned, statement.at, self.ty(*value), &values);
                    if let Some(frame) = self.frames.last() {
                        self.store_all(frame.result, &values);
                    }
                } else {
                    self.ran(statement.at);
                }
                self.leave(self.frames.last().map(|frame| frame.scope));
            }
            StatementKind::Discard => {
                self.ran(statement.at);
                let yes = self.truth(true);
                self.store(self.discarded, yes);
                self.leave(self.frames.first().map(|frame| frame.scope));
            }
        }
        Ok(())
    }

    fn ran(&mut self, at: Place) {
        self.tell(What::Ran, at, Type::Void, &[]);
    }

    fn leave(&self, scope: Option<Scope>) {
        if let Some(scope) = scope {
            self.push(Node::Leave(scope));
        }
    }

    /// A variable begins: its initialiser runs, or it is zero.
    pub(super) fn declare(&mut self, variable: VariableId) -> Result<()> {
        let (ty, initialiser) = (self.tree[variable].ty, self.tree[variable].initialiser);
        if matches!(ty, Type::Sampler(_)) {
            return Ok(());
        }
        let values = match initialiser {
            Some(initialiser) => self.expression(initialiser)?,
            None => self.zeros(ty),
        };
        let cells = match self.homes.get(&variable) {
            Some(&Home::Cells(cells)) if self.shared.contains(&variable) => cells,
            _ => self.allocate_type(ty)?,
        };
        self.homes.insert(variable, Home::Cells(cells));
        if let (Some(initialiser), Some(at)) = (initialiser, self.tree[variable].at)
            && self.tree[variable].value.is_none()
        {
            let whole = at.to(self.at(initialiser));
            self.tell(What::Stored(at), whole, ty, &values);
        }
        self.store_all(cells, &values);
        let local = self.tree[variable].kind == VariableKind::Local;
        if local && !self.shared.contains(&variable) {
            self.begin(variable, cells, initialiser.is_some());
        }
        Ok(())
    }

    fn arms(&mut self, arms: &[Arm], otherwise: Option<&Block>) -> Result<()> {
        let Some((arm, others)) = arms.split_first() else {
            return otherwise.map_or(Ok(()), |block| self.block(block));
        };
        let condition = self.condition(arm.condition)?;
        let yes = self.inner(|builder| builder.block(&arm.body))?;
        let no = self.inner(|builder| builder.arms(others, otherwise))?;
        self.choice(condition, yes, no);
        Ok(())
    }

    /// An `if`; one that only leaves needs no branches.
    fn choice(&self, condition: Value, yes: Nodes, no: Nodes) {
        let node = match (&yes[..], &no[..]) {
            ([], []) => return,
            (&[Node::Leave(scope)], []) => Node::LeaveIf {
                scope,
                condition,
                when: true,
            },
            (_, &[Node::Leave(scope)]) => {
                self.push(Node::LeaveIf {
                    scope,
                    condition,
                    when: false,
                });
                self.draft.borrow_mut().block.extend(yes);
                return;
            }
            _ => Node::If { condition, yes, no },
        };
        self.push(node);
    }

    fn repeat(
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
            builder.push(Node::Round(id));
            builder.begin_round(at);
            if let Some(condition) = condition {
                let condition = match condition {
                    Condition::Expression(expr) => builder.condition(expr)?,
                    Condition::Declare(variable) => {
                        builder.declare(variable)?;
                        match builder.home(variable) {
                            Home::Cells(cells) => builder.load(Cell(cells.first)),
                            _ => builder.truth(false),
                        }
                    }
                };
                builder.leave_unless(out, condition);
            }
            let nodes = builder.inner(|builder| {
                builder.breaks.push(out);
                builder.continues.push(on);
                builder.block(body)?;
                builder.breaks.pop();
                builder.continues.pop();
                Ok(())
            })?;
            let ends = tail::leaves(&nodes, on) || !tail::never_ends(&nodes);
            builder.push_scope(on, nodes);
            if ends {
                if let Some(step) = step {
                    builder.expression(step)?;
                }
                if let Some(until) = until {
                    let condition = builder.condition(until)?;
                    builder.leave_unless(out, condition);
                }
            }
            builder.end_rounds();
            Ok(())
        })?;
        let body = vec![Node::Loop { id, body: nodes }];
        self.push(Node::Scope { scope: out, body });
        Ok(())
    }

    fn leave_unless(&self, scope: Scope, condition: Value) {
        let origin = self.draft.borrow().origins[condition.0 as usize];
        if origin != Origin::Word(u32::MAX) {
            self.push(Node::LeaveIf {
                scope,
                condition,
                when: false,
            });
        }
    }

    /// Each case runs for the pixels whose selector leads to it, or that come from the case before.
    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> Result<()> {
        let selector = self.scalar(selector)?;
        self.share(cases)?;
        let out = self.scope();
        let all = cases.iter().flat_map(|case| &case.labels);
        let named = self.any_label(selector, all);
        let body = self.inner(|builder| {
            let mut reached = None;
            for case in cases {
                let mut here = builder.any_label(selector, &case.labels);
                if case.labels.contains(&Label::Default) {
                    let others = match named {
                        Some(named) => builder.unary(Operation::Not, named),
                        None => builder.truth(true),
                    };
                    here = Some(builder.either(here, others));
                }
                if let Some(before) = reached {
                    here = Some(builder.either(here, before));
                }
                let condition = here.unwrap_or_else(|| builder.truth(false));
                let mut body = builder.inner(|builder| {
                    builder.breaks.push(out);
                    builder.block(&case.body)?;
                    builder.breaks.pop();
                    Ok(())
                })?;
                reached = (!tail::never_ends(&body)).then_some(condition);
                if reached.is_none() {
                    // No later case is for those who leave at the end of this one.
                    tail::shorten(&mut body, out);
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

    /// Whether the selector is one of the labels; none of no labels.
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

    /// All cases are one scope: what one declares, a later one may read, though control jumped over it.
    fn share(&mut self, cases: &[Case]) -> Result<()> {
        for statement in cases.iter().flat_map(|case| &case.body) {
            if let StatementKind::Declare(variable) = statement.kind
                && !matches!(self.tree[variable].ty, Type::Sampler(_))
            {
                let ty = self.tree[variable].ty;
                let cells = self.allocate_type(ty)?;
                let zeros = self.zeros(ty);
                self.store_all(cells, &zeros);
                self.homes.insert(variable, Home::Cells(cells));
                self.shared.insert(variable);
            }
        }
        Ok(())
    }
}
