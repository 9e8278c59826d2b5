//! What may differ between the pixels of a quad: values, and which way control goes.

use std::collections::HashMap;

use toyproof_glsl::tree::{
    Block, BuiltInVariable, Condition, Direction, ExprId, FunctionId, Statement, StatementKind, VariableId,
    VariableKind,
};

use super::super::program::{Program, direction};
use super::control::{Control, Parted};

/// How often all functions are looked at, until nothing more is found to differ. What is left then is taken to differ nowhere.
const MAX_ROUNDS: usize = 12;

/// What may differ between the pixels of a quad, as far as it is known.
pub(super) struct Differing<'a> {
    pub(super) program: &'a Program<'a>,
    /// By index.
    pub(super) variables: Vec<Traits>,
    /// By the index of the function: its result.
    pub(super) results: Vec<Traits>,
    /// By the index of the function: why pixels may differ in whether they call it.
    pub(super) calls: Vec<Option<ExprId>>,
    /// By the index of the expression: its value, of those looked at last.
    pub(super) values: Vec<Traits>,
    /// Loops that pixels may leave in different rounds, by where their statements lie in memory, and why.
    loops: HashMap<*const Statement, ExprId>,
    pub(super) grew: bool,
}

/// What is known of a value in the pixels of a quad.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Traits {
    /// It may be another in each.
    pub(super) differs: bool,
    /// It was made where control had parted: pixels that went another way hold what is left of an earlier step, or nothing.
    pub(super) parted: bool,
}

impl Traits {
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            differs: self.differs || other.differs,
            parted: self.parted || other.parted,
        }
    }
}

/// Told of each expression that is evaluated where control may have parted, why that is, and of the values so far.
pub(super) type Visit<'v> = dyn FnMut(ExprId, ExprId, &[Traits]) + 'v;

impl<'a> Differing<'a> {
    /// All that differs between the pixels of a quad, in all functions that run.
    pub(super) fn new(program: &'a Program<'a>) -> Self {
        let tree = program.tree;
        let mut differing = Self {
            program,
            variables: vec![Traits::default(); tree.variables.len()],
            results: vec![Traits::default(); tree.functions.len()],
            calls: vec![None; tree.functions.len()],
            values: vec![Traits::default(); tree.exprs.len()],
            loops: HashMap::new(),
            grew: true,
        };
        for (id, variable) in tree.variables.iter() {
            differing.variables[id.index()].differs = matches!(
                variable.kind,
                VariableKind::BuiltIn(BuiltInVariable::FragCoord | BuiltInVariable::PointCoord)
                    | VariableKind::Varying
            );
        }
        for &parameter in &tree[program.main].parameters {
            differing.variables[parameter.index()].differs = direction(tree, parameter) != Direction::Out;
        }
        for _ in 0..MAX_ROUNDS {
            if !std::mem::take(&mut differing.grew) {
                break;
            }
            // Callers first: what they pass is then known.
            for &function in program.functions.iter().rev() {
                differing.function(function, &mut |_, _, _| {});
            }
        }
        differing
    }

    /// Goes through a function's statements.
    pub(super) fn function(&mut self, function: FunctionId, visit: &mut Visit) {
        let tree = self.program.tree;
        if let Some(body) = &tree[function].body {
            let control = Control {
                own: None,
                callers: self.calls[function.index()],
            };
            self.block(function, body, control, &mut Parted::default(), visit);
        }
    }

    fn block(
        &mut self,
        function: FunctionId,
        block: &Block,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        for statement in block {
            let control = Control {
                own: control.own.or(parted.cause()),
                ..control
            };
            self.statement(function, statement, control, parted, visit);
        }
    }

    fn statement(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let within = |own: Option<ExprId>| Control {
            own: control.own.or(own),
            ..control
        };
        match &statement.kind {
            StatementKind::Block(body) => self.block(function, body, control, parted, visit),
            StatementKind::If { arms, otherwise } => {
                // Each condition is asked only where those before it did not hold.
                let mut cause = None;
                for arm in arms {
                    self.expression(arm.condition, within(cause), visit);
                    cause = cause.or(self.values[arm.condition.index()]
                        .differs
                        .then_some(arm.condition));
                    self.block(function, &arm.body, within(cause), parted, visit);
                }
                if let Some(body) = otherwise {
                    self.block(function, body, within(cause), parted, visit);
                }
            }
            StatementKind::Switch { selector, cases } => {
                self.expression(*selector, control, visit);
                let cause = self.values[selector.index()].differs.then_some(*selector);
                let outer = parted.exit;
                for case in cases {
                    self.block(function, &case.body, within(cause), parted, visit);
                }
                parted.exit = outer;
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(function, init, control, parted, visit);
                self.repeat(
                    function,
                    statement,
                    (*condition, *step),
                    body,
                    control,
                    parted,
                    visit,
                );
            }
            StatementKind::While { condition, body } => {
                self.repeat(
                    function,
                    statement,
                    (Some(*condition), None),
                    body,
                    control,
                    parted,
                    visit,
                );
            }
            StatementKind::DoWhile { body, condition } => {
                let after = Some(Condition::Expression(*condition));
                self.repeat(function, statement, (after, None), body, control, parted, visit);
            }
            StatementKind::Break => parted.exit = parted.exit.or(control.own),
            StatementKind::Continue => parted.round = parted.round.or(control.own),
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.expression(*value, control, visit);
                    let value = self.values[value.index()];
                    let one_of_many = control.own.is_some() && self.program.returned(function).len() > 1;
                    let result = &mut self.results[function.index()];
                    let more = result.or(Traits {
                        differs: value.differs || control.own.is_some(),
                        parted: value.parted || one_of_many,
                    });
                    self.grew |= *result != more;
                    *result = more;
                }
                parted.function = parted.function.or(control.own);
            }
            StatementKind::Expression(expr) => self.expression(*expr, control, visit),
            StatementKind::Declare(variable) => {
                if let Some(value) = tree[*variable].initialiser {
                    self.expression(value, control, visit);
                    self.write(*variable, self.values[value.index()], control);
                }
            }
            StatementKind::Struct(_) | StatementKind::Discard => {}
        }
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "a loop's parts, and what is handed down to all statements"
    )]
    fn repeat(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        (condition, step): (Option<Condition>, Option<ExprId>),
        body: &Block,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let key = std::ptr::from_ref(statement);
        let control = Control {
            own: control.own.or(self.loops.get(&key).copied()),
            ..control
        };
        let condition = condition.and_then(|condition| match condition {
            Condition::Expression(expr) => Some(expr),
            Condition::Declare(variable) => tree[variable].initialiser,
        });
        let mut inner = Parted {
            function: parted.function,
            ..Parted::default()
        };
        let mut cause = None;
        if let Some(condition) = condition {
            self.expression(condition, control, visit);
            cause = self.values[condition.index()].differs.then_some(condition);
        }
        let within = Control {
            own: control.own.or(cause),
            ..control
        };
        self.block(function, body, within, &mut inner, visit);
        // A round that was cut short is over; who left the loop is not back for the step.
        let left = inner.function.or(inner.exit);
        if let Some(step) = step {
            self.expression(
                step,
                Control {
                    own: within.own.or(left),
                    ..within
                },
                visit,
            );
        }
        if let Some(cause) = left.or(cause)
            && !self.loops.contains_key(&key)
        {
            self.loops.insert(key, cause);
            self.grew = true;
        }
        parted.function = inner.function;
    }

    pub(super) fn mark(&mut self, variable: VariableId, traits: Traits) {
        let of = &mut self.variables[variable.index()];
        let more = of.or(traits);
        self.grew |= *of != more;
        *of = more;
    }

    /// A variable is given a value here.
    pub(super) fn write(&mut self, variable: VariableId, value: Traits, control: Control) {
        // What a caller's control makes differ, differs for all that this call sees, but for globals.
        let is_global = self.program.tree[variable].kind == VariableKind::Global;
        let differs = control.own.is_some() || is_global && control.callers.is_some();
        // Another name for a value is as good as the value.
        let is_name = self.program.only_value(variable).is_some();
        let traits = Traits {
            differs: value.differs || differs,
            parted: value.parted || differs && !is_name,
        };
        self.mark(variable, traits);
    }
}
