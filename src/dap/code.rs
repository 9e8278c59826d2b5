//! The places of a shader at which its execution can stop, in the order of the text, with the variables that
//! are in scope there and the expressions that are evaluated. They are those of the events
//! [`EventKind::Step`](toyproof_eval::EventKind::Step).

use std::collections::HashMap;
use std::ops::ControlFlow;

use toyproof_glsl::tree::{
    Condition, ExprId, ExprKind, FunctionId, Place, Statement, StatementKind, Tree, VariableId,
};

/// A place at which the execution can stop.
pub(crate) struct StepPlace<'a> {
    /// The place of the statement or of the condition.
    pub(crate) at: Place,
    /// The local variables and parameters in scope, outermost first; an inner one may have the same name.
    pub(crate) scope: &'a [VariableId],
    /// What is evaluated.
    pub(crate) exprs: &'a [ExprId],
}

/// Visits the places of a function until `visit` breaks.
pub(crate) fn visit_function(
    tree: &Tree,
    function: FunctionId,
    visit: &mut dyn FnMut(StepPlace<'_>) -> ControlFlow<()>,
) {
    let mut walker = Walker {
        tree,
        scope: tree[function].parameters.clone(),
        visit,
    };
    // A break has no value.
    let _ = walker.block(tree[function].body.as_deref().unwrap_or_default());
}

/// The local variables and parameters that are in scope at a place of a function, outermost first, each name
/// once; at its end without a place.
pub(crate) fn visible(tree: &Tree, function: FunctionId, at: Option<Place>) -> Vec<VariableId> {
    let mut found: Vec<VariableId> = tree[function].parameters.clone();
    let body = tree[function].body.as_deref().unwrap_or_default();
    match at {
        None => found.extend(body.iter().filter_map(declared)),
        Some(at) => visit_function(tree, function, &mut |place| {
            if place.at != at {
                return ControlFlow::Continue(());
            }
            found = place.scope.to_vec();
            ControlFlow::Break(())
        }),
    }
    let mut last: HashMap<&str, VariableId> = HashMap::new();
    for &variable in &found {
        last.insert(&tree[variable].name, variable);
    }
    found.retain(|variable| {
        let name = &*tree[*variable].name;
        !name.is_empty() && last.get(name) == Some(variable)
    });
    found
}

/// The variables that each place of the shader reads or writes.
pub(crate) fn named_variables(tree: &Tree) -> HashMap<Place, Vec<VariableId>> {
    let mut named: HashMap<Place, Vec<VariableId>> = HashMap::new();
    for function in tree.functions.ids() {
        visit_function(tree, function, &mut |place| {
            let exprs = place.exprs.iter().flat_map(|&expr| tree.postorder(expr));
            let variables = exprs.filter_map(|expr| match tree[expr].kind {
                ExprKind::Variable(variable) => Some(variable),
                _ => None,
            });
            named.entry(place.at).or_default().extend(variables);
            ControlFlow::Continue(())
        });
    }
    named
}

fn declared(statement: &Statement) -> Option<VariableId> {
    match statement.kind {
        StatementKind::Declare(variable) => Some(variable),
        _ => None,
    }
}

struct Walker<'a, 'v> {
    tree: &'a Tree,
    scope: Vec<VariableId>,
    visit: &'v mut dyn FnMut(StepPlace<'_>) -> ControlFlow<()>,
}

impl Walker<'_, '_> {
    fn step(&mut self, at: Place, exprs: &[ExprId]) -> ControlFlow<()> {
        (self.visit)(StepPlace {
            at,
            scope: &self.scope,
            exprs,
        })
    }

    /// Visits statements that are a scope of their own.
    fn block(&mut self, block: &[Statement]) -> ControlFlow<()> {
        let outer = self.scope.len();
        self.statements(block)?;
        self.scope.truncate(outer);
        ControlFlow::Continue(())
    }

    fn statements(&mut self, statements: &[Statement]) -> ControlFlow<()> {
        statements
            .iter()
            .try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Statement) -> ControlFlow<()> {
        let at = statement.at;
        match &statement.kind {
            StatementKind::Expression(expr) => self.step(at, &[*expr])?,
            StatementKind::Declare(variable) => self.declare(*variable, at)?,
            StatementKind::Struct(_) => {}
            StatementKind::Block(block) => self.block(block)?,
            StatementKind::If { arms, otherwise } => {
                for (index, arm) in arms.iter().enumerate() {
                    let at = if index == 0 {
                        at
                    } else {
                        self.tree[arm.condition].at
                    };
                    self.step(at, &[arm.condition])?;
                    self.block(&arm.body)?;
                }
                self.block(otherwise.as_deref().unwrap_or_default())?;
            }
            StatementKind::Switch { selector, cases } => {
                self.step(at, &[*selector])?;
                let outer = self.scope.len();
                for case in cases {
                    self.statements(&case.body)?;
                }
                self.scope.truncate(outer);
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                let outer = self.scope.len();
                self.statements(init)?;
                match condition {
                    Some(condition) => self.condition(*condition, at)?,
                    None => step.map_or(ControlFlow::Continue(()), |step| {
                        self.step(self.tree[step].at, &[step])
                    })?,
                }
                self.block(body)?;
                self.scope.truncate(outer);
            }
            StatementKind::While { condition, body } => {
                let outer = self.scope.len();
                self.condition(*condition, at)?;
                self.block(body)?;
                self.scope.truncate(outer);
            }
            StatementKind::DoWhile { body, condition } => {
                self.block(body)?;
                self.step(self.tree[*condition].at, &[*condition])?;
            }
            StatementKind::Return(value) => self.step(at, value.as_slice())?,
            StatementKind::Break | StatementKind::Continue | StatementKind::Discard => self.step(at, &[])?,
        }
        ControlFlow::Continue(())
    }

    fn declare(&mut self, variable: VariableId, at: Place) -> ControlFlow<()> {
        if let Some(initializer) = self.tree[variable].initializer {
            self.step(at, &[initializer])?;
        }
        self.scope.push(variable);
        ControlFlow::Continue(())
    }

    fn condition(&mut self, condition: Condition, at: Place) -> ControlFlow<()> {
        match condition {
            Condition::Expression(expr) => self.step(self.tree[expr].at, &[expr]),
            Condition::Declare(variable) => self.declare(variable, at),
        }
    }
}
