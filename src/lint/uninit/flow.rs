//! Definite assignment: a forward data-flow analysis of the structured tree of a function.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, Condition, Constructor, Direction, ExprId, ExprKind, FunctionId, Label,
    Statement, StatementKind, Type, Value, VariableId, VariableKind, walk,
};

use super::part::{Access, Layout, Parts};
use super::state::{Slot, Slots, State};
use crate::program::{Program, direction};

/// A `switch` with more labels than this, and no `default`, is taken to have a label for each value.
const MAX_PARTIAL_LABELS: usize = 2;

/// The effect of a function on a parameter, for its callers.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ParameterSummary {
    /// The parts of the argument that are read before the function assigns them on any path.
    reads: Parts,
    /// The parts that the function assigns on some path.
    assigned: Parts,
    /// The parts that it leaves unassigned on some path.
    unassigned: Parts,
}

/// The result of the analysis of a function.
#[derive(Debug, Default)]
pub(super) struct Flow {
    pub(super) parameters: Vec<ParameterSummary>,
    /// By variable: the first read that no assignment precedes on any path, and the parts unassigned there.
    pub(super) definite: BTreeMap<VariableId, (ExprId, Parts)>,
    /// By variable: reads that assignments precede on some paths only.
    pub(super) maybe: BTreeMap<VariableId, BTreeSet<ExprId>>,
    /// Whether the end can be reached without a `return`.
    pub(super) falls_off: bool,
    /// Whether the output color is unassigned on all paths to the end.
    pub(super) never_colors: bool,
    /// The accesses that read global variables, with their expressions.
    pub(super) global_reads: Vec<(Access, ExprId)>,
    /// The parts of global variables that are assigned.
    pub(super) global_writes: BTreeMap<VariableId, Parts>,
}

/// Analyzes a function whose callees' summaries are known. `color` is the output of `mainImage`.
pub(super) fn analyze(
    program: &Program,
    layout: &Layout,
    summaries: &[Vec<ParameterSummary>],
    color: Option<VariableId>,
    function: FunctionId,
) -> Flow {
    let tree = program.tree;
    let mut analysis = Analysis {
        program,
        layout,
        summaries,
        color,
        slots: HashMap::new(),
        state: State::default(),
        targets: Vec::new(),
        saved: Vec::new(),
        exit: State::default(),
        is_rehearsal: false,
        parameters: tree[function].parameters.iter().copied().zip(0..).collect(),
        flow: Flow {
            parameters: vec![ParameterSummary::default(); tree[function].parameters.len()],
            ..Flow::default()
        },
    };
    let Some(body) = &tree[function].body else {
        return analysis.flow;
    };
    analysis.begin(function, body);
    analysis.block(body);
    analysis.flow.falls_off = analysis.state.is_reachable;
    analysis.leave();
    analysis.summarize(function);
    analysis.flow
}

/// The states at the jumps to the end of a loop or `switch`.
struct Target {
    breaks: State,
    /// `None` for a `switch`.
    continues: Option<State>,
}

struct Analysis<'a> {
    program: &'a Program<'a>,
    layout: &'a Layout<'a>,
    summaries: &'a [Vec<ParameterSummary>],
    color: Option<VariableId>,
    /// The variables that may be unassigned: those declared without a value, and the parameters.
    slots: HashMap<VariableId, Slot>,
    state: State,
    /// The loops and `switch`es around the current statement, innermost last.
    targets: Vec<Target>,
    /// The states on the other paths of the conditional operators being evaluated.
    saved: Vec<State>,
    /// The state at all `return`s and at the end.
    exit: State,
    /// Whether this only finds out how a loop's body changes the state: nothing is recorded.
    is_rehearsal: bool,
    parameters: HashMap<VariableId, usize>,
    flow: Flow,
}

// Statements.

impl Analysis<'_> {
    /// Collects the variables, and declares the parameters. An argument that is passed in counts as
    /// unassigned, too, so that the summary contains the parts that are read.
    fn begin(&mut self, function: FunctionId, body: &Block) {
        let tree = self.program.tree;
        let mut variables = tree[function].parameters.clone();
        walk::each(body, &mut |statement| {
            if let StatementKind::Declare(variable) = statement.kind
                && tree[variable].initializer.is_none()
            {
                variables.push(variable);
            }
        });
        variables.retain(|&variable| !matches!(tree[variable].ty, Type::Sampler(_)));
        let mut slots = Slots::default();
        for variable in variables {
            let count = self.layout.whole(tree[variable].ty).count_ones();
            self.slots.insert(variable, slots.add(count));
        }
        self.state = State::entry(&slots);
        for &parameter in &tree[function].parameters {
            self.declare(parameter);
        }
    }

    fn declare(&mut self, variable: VariableId) {
        if let Some(&slot) = self.slots.get(&variable) {
            let whole = self.layout.whole(self.program.tree[variable].ty);
            self.state.declare(slot, whole);
        }
    }

    /// Ends the function on this path.
    fn leave(&mut self) {
        let state = std::mem::take(&mut self.state);
        if !self.is_rehearsal {
            self.exit.join(&state);
        }
    }

    /// Concludes from the state at the exit.
    fn summarize(&mut self, function: FunctionId) {
        let tree = self.program.tree;
        let parameters = &tree[function].parameters;
        for (parameter, summary) in parameters.iter().zip(&mut self.flow.parameters) {
            if let Some(&slot) = self.slots.get(parameter) {
                let whole = self.layout.whole(tree[*parameter].ty);
                summary.unassigned = self.exit.unassigned(slot) & whole;
            }
        }
        if let Some(color) = self.color
            && direction(tree, color) == Direction::Out
            && let Some(&slot) = self.slots.get(&color)
        {
            let whole = self.layout.whole(tree[color].ty);
            self.flow.never_colors =
                self.exit.unassigned(slot) & whole == whole && self.exit.assigned(slot) & whole == 0;
        }
    }

    fn block(&mut self, block: &Block) {
        for statement in block {
            if !self.state.is_reachable {
                return;
            }
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        if self.program.deadline.is_over() {
            self.state = State::default();
            return;
        }
        match &statement.kind {
            StatementKind::Expression(expr) => self.evaluate(*expr),
            StatementKind::Declare(variable) => match self.program.tree[*variable].initializer {
                Some(value) => self.evaluate(value),
                None => self.declare(*variable),
            },
            StatementKind::Struct(_) => {}
            StatementKind::Block(body) => self.block(body),
            StatementKind::If { arms, otherwise } => self.branch(arms, otherwise.as_ref()),
            StatementKind::Switch { selector, cases } => self.switch(*selector, cases),
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(init);
                self.repeat(*condition, true, body, *step);
            }
            StatementKind::While { condition, body } => self.repeat(Some(*condition), true, body, None),
            StatementKind::DoWhile { body, condition } => {
                self.repeat(Some(Condition::Expression(*condition)), false, body, None);
            }
            StatementKind::Break => {
                let state = std::mem::take(&mut self.state);
                if let Some(target) = self.targets.last_mut() {
                    target.breaks.join(&state);
                }
            }
            StatementKind::Continue => {
                let state = std::mem::take(&mut self.state);
                let mut targets = self.targets.iter_mut().rev();
                if let Some(continues) = targets.find_map(|target| target.continues.as_mut()) {
                    continues.join(&state);
                }
            }
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.evaluate(*value);
                }
                self.leave();
            }
            StatementKind::Discard => self.state = State::default(),
        }
    }

    fn branch(&mut self, arms: &[Arm], otherwise: Option<&Block>) {
        let mut after = State::default();
        for arm in arms {
            self.evaluate(arm.condition);
            let mut other = self.state.clone();
            match self.constant(arm.condition) {
                Some(true) => other = State::default(),
                Some(false) => self.state = State::default(),
                None => {}
            }
            self.block(&arm.body);
            after.join(&self.state);
            self.state = other;
            if !self.state.is_reachable {
                break;
            }
        }
        if let Some(body) = otherwise {
            self.block(body);
        }
        self.state.join(&after);
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) {
        self.evaluate(selector);
        let selected = std::mem::take(&mut self.state);
        self.targets.push(Target {
            breaks: State::default(),
            continues: None,
        });
        for case in cases {
            // A label is reached from the selector, and from the case before it.
            self.state.join(&selected);
            self.block(&case.body);
        }
        let labels = || cases.iter().flat_map(|case| &case.labels);
        let has_default = labels().any(|label| *label == Label::Default);
        if !has_default && labels().count() <= MAX_PARTIAL_LABELS {
            self.state.join(&selected);
        }
        if let Some(target) = self.targets.pop() {
            self.state.join(&target.breaks);
        }
    }

    /// A loop. One whose condition is not constantly false is taken to run at least once.
    fn repeat(
        &mut self,
        condition: Option<Condition>,
        is_tested_first: bool,
        body: &Block,
        step: Option<ExprId>,
    ) {
        let condition = match condition {
            Some(Condition::Expression(condition)) => Some(condition),
            Some(Condition::Declare(variable)) => self.program.tree[variable].initializer,
            None => None,
        };
        let holds = condition.map_or(Some(true), |condition| self.constant(condition));
        if is_tested_first && let Some(condition) = condition {
            self.evaluate(condition);
            if holds == Some(false) {
                return;
            }
        }
        // Assigned parts stay assigned, so the state after one iteration, merged with that before it, is the
        // state before any iteration. That state is found by a first pass that records nothing; a loop
        // inside of a first pass needs no second one, so a statement is visited once for each loop around it.
        let before = (!self.is_rehearsal).then(|| self.state.clone());
        let was_rehearsal = std::mem::replace(&mut self.is_rehearsal, true);
        let mut after = self.iteration(condition, holds, body, step);
        let repeated = std::mem::take(&mut self.state);
        self.is_rehearsal = was_rehearsal;
        if let Some(before) = before {
            self.state = before;
            self.state.join(&repeated);
            after = self.iteration(condition, holds, body, step);
        } else {
            after.join_assigned(&repeated);
        }
        self.state = after;
    }

    /// Runs a loop's body, its step and its condition. Returns the state after the loop; `self.state` becomes
    /// that before the next iteration.
    fn iteration(
        &mut self,
        condition: Option<ExprId>,
        holds: Option<bool>,
        body: &Block,
        step: Option<ExprId>,
    ) -> State {
        self.targets.push(Target {
            breaks: State::default(),
            continues: Some(State::default()),
        });
        self.block(body);
        let mut after = State::default();
        if let Some(target) = self.targets.pop() {
            self.state.join(&target.continues.unwrap_or_default());
            after = target.breaks;
        }
        for expr in step.into_iter().chain(condition) {
            self.evaluate(expr);
        }
        if holds != Some(true) {
            after.join(&self.state);
        }
        if holds == Some(false) {
            self.state = State::default();
        }
        after
    }

    /// The value of a constant condition.
    fn constant(&self, condition: ExprId) -> Option<bool> {
        match *self.program.tree.value(condition)?.components() {
            [Value::Bool(value)] => Some(value),
            _ => None,
        }
    }
}

// Expressions.

/// Pending work for an expression.
enum Work {
    Evaluate(ExprId),
    Read(Access, ExprId),
    Assign(Access),
    /// Parts that a called function assigns on some of its paths.
    AssignMaybe(Access),
    /// Keeps the state for the path that skips the next operand.
    Fork,
    /// Continues on the other path.
    Switch,
    /// Merges both paths.
    Join,
}

impl Analysis<'_> {
    /// Evaluates an expression, its operands in the order of evaluation.
    fn evaluate(&mut self, root: ExprId) {
        if !self.state.is_reachable {
            return;
        }
        let mut pending = vec![Work::Evaluate(root)];
        while let Some(next) = pending.pop() {
            let begin = pending.len();
            match next {
                // Literals and constants read no variable that could be unassigned.
                Work::Evaluate(expr) if self.program.tree[expr].constant => {}
                Work::Evaluate(expr) => self.steps(expr, &mut pending),
                Work::Read(access, expr) => self.read(access, expr),
                Work::Assign(access) => self.assign(&access, State::assign),
                Work::AssignMaybe(access) => self.assign(&access, State::assign_maybe),
                Work::Fork => self.saved.push(self.state.clone()),
                Work::Switch => {
                    if let Some(other) = self.saved.last_mut() {
                        std::mem::swap(&mut self.state, other);
                    }
                }
                Work::Join => {
                    if let Some(other) = self.saved.pop() {
                        self.state.join(&other);
                    }
                }
            }
            // The work was pushed in the order of execution, and is popped from the end.
            pending[begin..].reverse();
        }
    }

    /// Pushes the steps of an expression in the order of evaluation.
    fn steps(&self, expr: ExprId, pending: &mut Vec<Work>) {
        let tree = self.program.tree;
        match &tree[expr].kind {
            ExprKind::Variable(_)
            | ExprKind::Swizzle { .. }
            | ExprKind::Member { .. }
            | ExprKind::Index { .. } => match self.layout.access(expr) {
                Some(access) => {
                    self.indices(expr, pending);
                    pending.push(Work::Read(self.as_read(access, expr), expr));
                }
                None => tree[expr]
                    .kind
                    .for_each_operand(|operand| pending.push(Work::Evaluate(operand))),
            },
            ExprKind::Binary {
                op: BinaryOp::And | BinaryOp::Or,
                left,
                right,
            } => pending.extend([
                Work::Evaluate(*left),
                Work::Fork,
                Work::Evaluate(*right),
                Work::Join,
            ]),
            ExprKind::Conditional { condition, yes, no } => match self.constant(*condition) {
                Some(true) => pending.push(Work::Evaluate(*yes)),
                Some(false) => pending.push(Work::Evaluate(*no)),
                None => pending.extend([
                    Work::Evaluate(*condition),
                    Work::Fork,
                    Work::Evaluate(*yes),
                    Work::Switch,
                    Work::Evaluate(*no),
                    Work::Join,
                ]),
            },
            ExprKind::Assign { op, target, value } => {
                self.indices(*target, pending);
                pending.extend(self.assigned_values(*target, *value).map(Work::Evaluate));
                if let Some(access) = self.layout.access(*target) {
                    if op.is_some() {
                        pending.push(Work::Read(access.clone(), *target));
                    }
                    pending.push(Work::Assign(access));
                }
            }
            ExprKind::Step { target, .. } => {
                self.indices(*target, pending);
                if let Some(access) = self.layout.access(*target) {
                    pending.extend([Work::Read(access.clone(), *target), Work::Assign(access)]);
                }
            }
            ExprKind::Call { function, arguments } => self.call(*function, arguments, pending),
            ExprKind::BuiltIn { function, arguments } => {
                for (index, &argument) in arguments.iter().enumerate() {
                    match self.layout.access(argument) {
                        Some(access) if function.out_parameter() == Some(index) => {
                            self.indices(argument, pending);
                            pending.push(Work::Assign(access));
                        }
                        _ => pending.push(Work::Evaluate(argument)),
                    }
                }
            }
            ExprKind::Length { .. } => {}
            kind => kind.for_each_operand(|operand| pending.push(Work::Evaluate(operand))),
        }
    }

    /// The operands of an assigned value that matter. The image's alpha is always 1, whatever is assigned.
    fn assigned_values(&self, target: ExprId, value: ExprId) -> impl Iterator<Item = ExprId> + use<> {
        let tree = self.program.tree;
        let colors = match &tree[value].kind {
            ExprKind::Construct {
                constructor: Constructor::Vector,
                arguments,
            } if matches!(tree[target].kind, ExprKind::Variable(variable) if Some(variable) == self.color) => {
                match &arguments[..] {
                    [colors @ .., alpha]
                        if !colors.is_empty()
                            && matches!(tree[*alpha].ty, Type::Scalar(_))
                            && self.layout.access(*alpha).is_some() =>
                    {
                        colors.to_vec()
                    }
                    _ => vec![value],
                }
            }
            _ => vec![value],
        };
        colors.into_iter()
    }

    fn call(&self, function: FunctionId, arguments: &[ExprId], pending: &mut Vec<Work>) {
        let tree = self.program.tree;
        let mut after = Vec::new();
        let parameters = tree[function].parameters.iter().zip(arguments);
        for ((&parameter, &argument), summary) in parameters.zip(&self.summaries[function.index()]) {
            let Some(access) = self.layout.access(argument) else {
                pending.push(Work::Evaluate(argument));
                continue;
            };
            self.indices(argument, pending);
            // A whole variable has the parts of the parameter; a part of a variable counts as one.
            let of_argument = |parts: Parts| match tree[argument].kind {
                ExprKind::Variable(_) => access.parts & parts,
                _ if parts == 0 => 0,
                _ => access.parts,
            };
            let narrowed = |parts: Parts| Access {
                parts: of_argument(parts),
                ..access.clone()
            };
            let passed = direction(tree, parameter);
            if passed != Direction::Out {
                pending.push(Work::Read(
                    self.as_read(narrowed(summary.reads), argument),
                    argument,
                ));
            }
            if matches!(passed, Direction::Out | Direction::InOut) {
                after.push(Work::Assign(narrowed(summary.assigned & !summary.unassigned)));
                after.push(Work::AssignMaybe(narrowed(summary.assigned & summary.unassigned)));
            }
        }
        pending.append(&mut after);
    }

    /// Reading a whole structure or array counts as reading one unknown part of it: it may be passed on with
    /// members that are never used.
    fn as_read(&self, mut access: Access, expr: ExprId) -> Access {
        access.is_one_of_parts |= matches!(self.program.tree[expr].ty, Type::Struct(_) | Type::Array(_));
        access
    }

    /// Evaluates the indices of an lvalue.
    fn indices(&self, expr: ExprId, pending: &mut Vec<Work>) {
        let tree = self.program.tree;
        pending.extend(tree.path(expr).filter_map(|node| match tree[node].kind {
            ExprKind::Index { index, .. } => Some(Work::Evaluate(index)),
            _ => None,
        }));
    }

    fn read(&mut self, access: Access, expr: ExprId) {
        let Some(&slot) = self.slots.get(&access.variable) else {
            if self.is_unset_global(access.variable) && !self.is_rehearsal {
                self.flow.global_reads.push((access, expr));
            }
            return;
        };
        let unassigned = self.state.unassigned(slot) & access.parts;
        let never_assigned = unassigned & !self.state.assigned(slot);
        if unassigned == 0 || access.is_one_of_parts && unassigned != access.parts {
            return;
        }
        let is_definite = never_assigned != 0 && (!access.is_one_of_parts || never_assigned == access.parts);
        self.state.drop_unassigned(slot, access.parts);
        if !self.is_rehearsal {
            self.record(&access, expr, is_definite.then_some(never_assigned));
        }
    }

    /// Records a read of unassigned parts: for the callers if they pass them in, otherwise for the author.
    fn record(&mut self, access: &Access, expr: ExprId, never_assigned: Option<Parts>) {
        let variable = access.variable;
        match (self.parameters.get(&variable), never_assigned) {
            (Some(&index), never_assigned) if direction(self.program.tree, variable) != Direction::Out => {
                self.flow.parameters[index].reads |= never_assigned.unwrap_or(0);
            }
            (_, Some(parts)) => {
                self.flow.definite.entry(variable).or_insert((expr, parts));
            }
            (_, None) => {
                self.flow.maybe.entry(variable).or_default().insert(expr);
            }
        }
    }

    fn assign(&mut self, access: &Access, assign: fn(&mut State, Slot, Parts)) {
        if access.parts == 0 {
            return;
        }
        if let Some(&slot) = self.slots.get(&access.variable) {
            assign(&mut self.state, slot, access.parts);
        }
        if let Some(&index) = self.parameters.get(&access.variable) {
            self.flow.parameters[index].assigned |= access.parts;
        } else if self.is_unset_global(access.variable) {
            *self.flow.global_writes.entry(access.variable).or_default() |= access.parts;
        }
    }

    /// Whether a variable is a global one without an initial value.
    fn is_unset_global(&self, variable: VariableId) -> bool {
        let variable = &self.program.tree[variable];
        variable.kind == VariableKind::Global && variable.initializer.is_none()
    }
}
