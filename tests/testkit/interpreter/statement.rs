//! Statements (§6): each returns how control leaves it.

use toyproof::glsl::tree::{
    Block, Case, Condition, ExprId, FunctionId, Label, Statement, StatementKind, Type, VariableId,
};

use super::real::Real;
use super::value::{Value, zero};
use super::{Result, Run, Stop};

/// How control leaves a statement.
#[derive(Debug)]
enum Flow<N> {
    /// To the next one.
    Next,
    Break,
    Continue,
    Return(Value<N>),
}

impl<N: Real> Run<'_, N> {
    /// Runs the body of a function whose parameters have values.
    pub(super) fn body(&mut self, function: FunctionId) -> Result<Value<N>, N> {
        let tree = self.tree;
        let body = tree[function]
            .body
            .as_ref()
            .expect("a function that is called has a body");
        Ok(match self.block(body)? {
            Flow::Return(value) => value,
            // A function that ends without `return` gives zero.
            _ => zero(tree, tree[function].return_type),
        })
    }

    fn block(&mut self, block: &Block) -> Result<Flow<N>, N> {
        for statement in block {
            match self.statement(statement)? {
                Flow::Next => {}
                left => return Ok(left),
            }
        }
        Ok(Flow::Next)
    }

    /// Declares a variable: evaluates its initializer, or sets it to zero as in WebGL.
    pub(super) fn declare(&mut self, variable: VariableId) -> Result<(), N> {
        let (ty, initializer) = (self.tree[variable].ty, self.tree[variable].initializer);
        if matches!(ty, Type::Sampler(_)) {
            return Ok(());
        }
        let value = match initializer {
            Some(initializer) => self.value(initializer)?,
            None => zero(self.tree, ty),
        };
        self.variables.insert(variable, value);
        Ok(())
    }

    pub(super) fn condition(&mut self, expr: ExprId) -> Result<bool, N> {
        Ok(self.value(expr)?[0].truth())
    }

    fn statement(&mut self, statement: &Statement) -> Result<Flow<N>, N> {
        self.step()?;
        match &statement.kind {
            StatementKind::Expression(expr) => {
                self.value(*expr)?;
            }
            StatementKind::Declare(variable) => self.declare(*variable)?,
            StatementKind::Struct(_) => {}
            StatementKind::Block(body) => return self.block(body),
            StatementKind::If { arms, otherwise } => {
                for arm in arms {
                    if self.condition(arm.condition)? {
                        return self.block(&arm.body);
                    }
                }
                if let Some(otherwise) = otherwise {
                    return self.block(otherwise);
                }
            }
            StatementKind::Switch { selector, cases } => return self.switch(*selector, cases),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(init)?;
                return self.iterate(*condition, body, *step, None);
            }
            StatementKind::While { condition, body } => {
                return self.iterate(Some(*condition), body, None, None);
            }
            StatementKind::DoWhile { body, condition } => {
                return self.iterate(None, body, None, Some(*condition));
            }
            StatementKind::Break => return Ok(Flow::Break),
            StatementKind::Continue => return Ok(Flow::Continue),
            StatementKind::Return(None) => return Ok(Flow::Return(Value::new())),
            StatementKind::Return(Some(value)) => return Ok(Flow::Return(self.value(*value)?)),
            StatementKind::Discard => return Err(Stop::Discarded),
        }
        Ok(Flow::Next)
    }

    /// Runs a loop: `condition` before each iteration, `step` after it, then `until`, which must hold to go on.
    fn iterate(
        &mut self,
        condition: Option<Condition>,
        body: &Block,
        step: Option<ExprId>,
        until: Option<ExprId>,
    ) -> Result<Flow<N>, N> {
        self.path.push(0);
        let left = loop {
            self.step()?;
            let goes_on = match condition {
                None => true,
                Some(Condition::Expression(expr)) => self.condition(expr)?,
                Some(Condition::Declare(variable)) => {
                    self.declare(variable)?;
                    self.variables[&variable][0].truth()
                }
            };
            if !goes_on {
                break Flow::Next;
            }
            match self.block(body)? {
                Flow::Next | Flow::Continue => {}
                Flow::Break => break Flow::Next,
                returned @ Flow::Return(_) => break returned,
            }
            if let Some(step) = step {
                self.value(step)?;
            }
            if let Some(until) = until
                && !self.condition(until)?
            {
                break Flow::Next;
            }
            if let Some(iteration) = self.path.last_mut() {
                *iteration += 1;
            }
        };
        self.path.pop();
        Ok(left)
    }

    /// Runs the cases of a `switch` from the one that matches, or from `default`, up to a `break`.
    fn switch(&mut self, selector: ExprId, cases: &[Case]) -> Result<Flow<N>, N> {
        let selector = self.value(selector)?[0].bits();
        // All cases are one scope: a variable whose declaration is jumped over is zero.
        for statement in cases.iter().flat_map(|case| &case.body) {
            if let StatementKind::Declare(variable) = statement.kind {
                let zero: Value<N> = zero(self.tree, self.tree[variable].ty);
                self.variables.insert(variable, zero);
            }
        }
        let matches = |label: &Label| matches!(label, Label::Case { value, .. } if *value == selector);
        let matching = cases.iter().position(|case| case.labels.iter().any(matches));
        let default = || {
            cases
                .iter()
                .position(|case| case.labels.contains(&Label::Default))
        };
        let Some(first) = matching.or_else(default) else {
            return Ok(Flow::Next);
        };
        for case in &cases[first..] {
            match self.block(&case.body)? {
                Flow::Next => {}
                Flow::Break => break,
                left => return Ok(left),
            }
        }
        Ok(Flow::Next)
    }
}
