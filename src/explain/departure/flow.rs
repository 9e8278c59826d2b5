//! The data flow between the events of a program: from which events the value of another is computed.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use toyproof_diagnostic::{Place, Span};
use toyproof_eval::{CallId, EventId, EventKind, TraceEvent, TraceSchema};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::walk::{child_blocks, direction, each, jumps, own_expressions};
use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, Statement, StatementKind, Tree, VariableId, VariableKind,
};

/// What an event evaluates or stores.
#[derive(Debug, Clone, Copy)]
enum Origin {
    /// A subexpression, a condition or a returned value.
    Expression(ExprId),
    /// `target = value` or `target += value`.
    Assignment {
        value: ExprId,
        variable: VariableId,
        /// Whether the old value of the variable counts.
        keeps_old: bool,
    },
    /// `++x`.
    Step(VariableId),
    /// A parameter, which gets the argument of the call.
    Parameter(VariableId),
}

/// A variable in one inlined call; global variables are in none.
type Instance = (VariableId, Option<CallId>);

/// The data flow of a program, as far as some executions of it use it.
pub(super) struct Flow<'a> {
    tree: &'a Tree,
    schema: &'a TraceSchema,
    origins: HashMap<EventId, Origin>,
    /// The events of the subexpressions in a call.
    parts: HashMap<(ExprId, Option<CallId>), EventId>,
    /// The events that assign a variable.
    definitions: HashMap<Instance, Vec<EventId>>,
    /// The parameters whose values a call copies back to a variable.
    outputs: HashMap<Instance, Vec<Instance>>,
    /// The events that return from a call.
    returns: HashMap<CallId, Vec<EventId>>,
    /// The calls by the place of their expression.
    calls: HashMap<(ExprId, Option<CallId>), CallId>,
    /// The events of conditions.
    branches: HashMap<(ExprId, Option<CallId>), EventId>,
    /// The conditions that decide whether an expression is evaluated, in its own function.
    controls: HashMap<ExprId, Rc<[ExprId]>>,
    /// The conditions that decide whether a variable is assigned.
    guards: HashMap<VariableId, Vec<ExprId>>,
    /// The variable that `mainImage` returns the color in.
    color: Option<VariableId>,
    /// The place of the function that the host calls; where that is `main`, also of the call of it.
    entry: Span,
}

impl<'a> Flow<'a> {
    /// The data flow between the events of some traces.
    pub(super) fn new<'e>(
        checked: &'a Checked,
        schema: &'a TraceSchema,
        events: impl IntoIterator<Item = &'e TraceEvent>,
    ) -> Self {
        let tree = &checked.tree;
        let ids: BTreeSet<EventId> = events.into_iter().map(|event| event.event).collect();
        let controls = controls(tree);
        let mut flow = Self {
            tree,
            schema,
            entry: tree[checked.main_image].at.span,
            origins: HashMap::new(),
            parts: HashMap::new(),
            definitions: HashMap::new(),
            outputs: HashMap::new(),
            returns: HashMap::new(),
            calls: HashMap::new(),
            branches: HashMap::new(),
            guards: guards(tree, &controls),
            controls,
            color: tree[checked.main_image].parameters.first().copied(),
        };
        let places = Places::new(tree);
        let mut calls: BTreeSet<CallId> = BTreeSet::new();
        let ranks = ranks(schema, &ids);
        for id in ids {
            flow.add(id, ranks.get(&id).copied().unwrap_or(0), &places);
            let mut call = schema.event(id).call;
            while let Some(id) = call.filter(|&id| calls.insert(id)) {
                call = schema.call(id).parent;
            }
        }
        for id in calls {
            flow.add_call(id, &places);
        }
        flow
    }

    fn add(&mut self, id: EventId, rank: usize, places: &Places) {
        let event = self.schema.event(id);
        let origin = match event.kind {
            EventKind::Subexpression => {
                let expr = places.computed(event.at, rank);
                if let Some(expr) = expr {
                    self.parts.insert((expr, event.call), id);
                }
                expr.map(Origin::Expression)
            }
            EventKind::Branch => {
                let expr = places.at(event.at).first().copied();
                if let Some(expr) = expr {
                    self.branches.insert((expr, event.call), id);
                }
                expr.map(Origin::Expression)
            }
            EventKind::Return => {
                if let Some(call) = event.call {
                    self.returns.entry(call).or_default().push(id);
                }
                places.returned.get(&event.at).copied().map(Origin::Expression)
            }
            EventKind::Assignment(target) => {
                let stored = self.stored(event.at, target, places);
                if let Some((variable, _)) = stored {
                    let instance = self.instance(variable, event.call);
                    self.definitions.entry(instance).or_default().push(id);
                }
                stored.map(|(_, origin)| origin)
            }
            EventKind::LoopHeader
            | EventKind::Statement
            | EventKind::Step
            | EventKind::Entry
            | EventKind::Store(_) => None,
        };
        self.origins.extend(origin.map(|origin| (id, origin)));
    }

    /// The variable that an assignment stores to, and what it stores.
    fn stored(&self, whole: Place, target: Place, places: &Places) -> Option<(VariableId, Origin)> {
        let tree = self.tree;
        if let Some(&variable) = places.declared.get(&target) {
            return Some(match (tree[variable].kind, tree[variable].initializer) {
                (VariableKind::Parameter(_), _) => (variable, Origin::Parameter(variable)),
                (_, Some(value)) => (
                    variable,
                    Origin::Assignment {
                        value,
                        variable,
                        keeps_old: false,
                    },
                ),
                (_, None) => return None,
            });
        }
        for &expr in places.at(whole) {
            if let ExprKind::Assign { op, target, value } = tree[expr].kind {
                let variable = root(tree, target)?;
                let is_part = !matches!(tree[target].kind, ExprKind::Variable(_));
                let keeps_old = op.is_some() || is_part;
                return Some((
                    variable,
                    Origin::Assignment {
                        value,
                        variable,
                        keeps_old,
                    },
                ));
            }
        }
        let variable = places.at(target).iter().find_map(|&expr| root(tree, expr))?;
        Some((variable, Origin::Step(variable)))
    }

    fn add_call(&mut self, id: CallId, places: &Places) {
        let (tree, call) = (self.tree, *self.schema.call(id));
        for &expr in places.at(call.at) {
            let ExprKind::Call { function, arguments } = &tree[expr].kind else {
                continue;
            };
            if *function != call.function {
                continue;
            }
            self.calls.insert((expr, call.parent), id);
            for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                if direction(tree, parameter) != Direction::In
                    && let Some(variable) = root(tree, argument)
                {
                    let instance = self.instance(variable, call.parent);
                    self.outputs
                        .entry(instance)
                        .or_default()
                        .push((parameter, Some(id)));
                }
            }
        }
    }

    fn instance(&self, variable: VariableId, call: Option<CallId>) -> Instance {
        let is_global = matches!(
            self.tree[variable].kind,
            VariableKind::Global | VariableKind::Const
        );
        (variable, call.filter(|_| !is_global))
    }

    /// The place of an event.
    pub(super) fn span(&self, event: EventId) -> Span {
        self.schema.event(event).at.span
    }

    /// The call that an event is in; `None` in the function that the host calls.
    pub(super) fn call(&self, event: EventId) -> Option<Span> {
        let call = self.schema.event(event).call?;
        let at = self.schema.call(call).at.span;
        (at != self.entry).then_some(at)
    }
}

/// The expressions and declarations of a tree by their places.
struct Places {
    exprs: HashMap<Place, Vec<ExprId>>,
    /// The operations that are not constant, operands before their users.
    operations: HashMap<Place, Vec<ExprId>>,
    declared: HashMap<Place, VariableId>,
    returned: HashMap<Place, ExprId>,
}

impl Places {
    fn new(tree: &Tree) -> Self {
        let mut exprs: HashMap<Place, Vec<ExprId>> = HashMap::new();
        let mut operations: HashMap<Place, Vec<ExprId>> = HashMap::new();
        for (id, expr) in tree.exprs.iter() {
            exprs.entry(expr.at).or_default().push(id);
            let is_operation = matches!(
                expr.kind,
                ExprKind::Binary { .. }
                    | ExprKind::Unary { .. }
                    | ExprKind::Conditional { .. }
                    | ExprKind::BuiltIn { .. }
            );
            if is_operation && tree.value(id).is_none() {
                operations.entry(expr.at).or_default().push(id);
            }
        }
        for all in operations.values_mut().filter(|all| all.len() > 1) {
            all.sort_by_cached_key(|&id| tree.postorder(id).len());
        }
        let declared = tree.variables.iter();
        let declared = declared
            .filter_map(|(id, variable)| Some((variable.at?, id)))
            .collect();
        let mut returned = HashMap::new();
        for body in tree
            .functions
            .iter()
            .filter_map(|(_, function)| function.body.as_ref())
        {
            each(body, &mut |statement| {
                if let StatementKind::Return(Some(value)) = statement.kind {
                    returned.insert(statement.at, value);
                }
            });
        }
        Self {
            exprs,
            operations,
            declared,
            returned,
        }
    }

    fn at(&self, place: Place) -> &[ExprId] {
        self.exprs.get(&place).map_or(&[], Vec::as_slice)
    }

    /// The operation at a place with this rank in the order of evaluation: in a macro's body that mentions its
    /// arguments, several have the place of the whole.
    fn computed(&self, place: Place, rank: usize) -> Option<ExprId> {
        self.operations.get(&place)?.get(rank).copied()
    }
}

/// The ranks of subexpressions among those at the same place in the same call.
fn ranks(schema: &TraceSchema, ids: &BTreeSet<EventId>) -> HashMap<EventId, usize> {
    let mut counts: HashMap<(Place, Option<CallId>), usize> = HashMap::new();
    let mut ranks = HashMap::new();
    for &id in ids {
        let event = schema.event(id);
        if event.kind == EventKind::Subexpression {
            let count = counts.entry((event.at, event.call)).or_default();
            ranks.insert(id, *count);
            *count += 1;
        }
    }
    ranks
}

/// The variable that an lvalue is, or is a part of.
fn root(tree: &Tree, lvalue: ExprId) -> Option<VariableId> {
    match tree[lvalue].kind {
        ExprKind::Variable(variable) => Some(variable),
        ExprKind::Swizzle { vector: whole, .. }
        | ExprKind::Member { structure: whole, .. }
        | ExprKind::Index { base: whole, .. } => root(tree, whole),
        _ => None,
    }
}

/// The conditions that decide whether each expression is evaluated: those of the enclosing `if`s and loops,
/// and those in front of a jump that could have left the block.
fn controls(tree: &Tree) -> HashMap<ExprId, Rc<[ExprId]>> {
    let mut all = HashMap::new();
    for body in tree
        .functions
        .iter()
        .filter_map(|(_, function)| function.body.as_ref())
    {
        block_controls(tree, body, &[], &mut all);
    }
    all
}

/// The controls of the assignments of each variable.
fn guards(tree: &Tree, controls: &HashMap<ExprId, Rc<[ExprId]>>) -> HashMap<VariableId, Vec<ExprId>> {
    let mut all: HashMap<VariableId, Vec<ExprId>> = HashMap::new();
    for (id, expr) in tree.exprs.iter() {
        if let ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } = expr.kind
            && let (Some(variable), Some(controls)) = (root(tree, target), controls.get(&id))
        {
            let conditions = all.entry(variable).or_default();
            conditions.extend_from_slice(controls);
            conditions.sort_unstable();
            conditions.dedup();
        }
    }
    all
}

/// Adds the controls of the expressions in a block; returns the conditions of jumps.
fn block_controls(
    tree: &Tree,
    block: &[Statement],
    outer: &[ExprId],
    all: &mut HashMap<ExprId, Rc<[ExprId]>>,
) -> Vec<ExprId> {
    let mut controls: Vec<ExprId> = outer.to_vec();
    let mut of_jumps = Vec::new();
    for statement in block {
        let shared: Rc<[ExprId]> = controls.as_slice().into();
        let own = own_expressions(tree, statement);
        for &root in &own {
            for expr in tree.postorder(root) {
                all.insert(expr, Rc::clone(&shared));
            }
        }
        if jumps(statement) {
            of_jumps.extend_from_slice(&controls[..]);
        }
        let is_conditional = !matches!(statement.kind, StatementKind::Block(_));
        let mut inner = controls.clone();
        if is_conditional {
            inner.extend(own);
        }
        for body in child_blocks(statement) {
            let jumps = block_controls(tree, body, &inner, all);
            of_jumps.extend(jumps.iter().filter(|condition| !outer.contains(condition)));
            controls.extend(jumps);
        }
        controls.sort_unstable();
        controls.dedup();
    }
    of_jumps
}

/// The execution of a pixel.
pub(super) struct Execution<'a> {
    pub(super) flow: &'a Flow<'a>,
    pub(super) events: &'a [TraceEvent],
    /// The positions of each event, in order.
    positions: HashMap<EventId, Vec<usize>>,
}

impl<'a> Execution<'a> {
    pub(super) fn new(flow: &'a Flow<'a>, events: &'a [TraceEvent]) -> Self {
        let mut positions: HashMap<EventId, Vec<usize>> = HashMap::new();
        for (at, event) in events.iter().enumerate() {
            positions.entry(event.event).or_default().push(at);
        }
        Self {
            flow,
            events,
            positions,
        }
    }

    /// The last assignment of the color, and what decided that it is the last.
    pub(super) fn color(&self) -> Vec<usize> {
        let instance = self.flow.color.map(|color| (color, None));
        instance.map_or_else(Vec::new, |instance| self.sources(instance, self.events.len()))
    }

    /// The positions of the conditions because of which the value at a position is computed.
    pub(super) fn conditions(&self, at: usize) -> Vec<usize> {
        let flow = self.flow;
        let id = self.events[at].event;
        let call = flow.schema.event(id).call;
        let Some(&(Origin::Expression(expr) | Origin::Assignment { value: expr, .. })) =
            flow.origins.get(&id)
        else {
            return Vec::new();
        };
        let conditions = flow
            .controls
            .get(&expr)
            .into_iter()
            .flat_map(|controls| controls.iter());
        let branches = conditions.filter_map(|&condition| flow.branches.get(&(condition, call)));
        branches
            .filter_map(|&branch| self.latest(&[branch], at))
            .collect()
    }

    /// The positions of the values from which the one at a position is computed.
    pub(super) fn inputs(&self, at: usize) -> Vec<usize> {
        let mut all = Vec::new();
        let id = self.events[at].event;
        let call = self.flow.schema.event(id).call;
        let tree = self.flow.tree;
        match self.flow.origins.get(&id) {
            Some(&Origin::Expression(expr)) => self.operands(expr, at, call, &mut all),
            Some(&Origin::Assignment {
                value,
                variable,
                keeps_old,
            }) => {
                self.values(value, at, call, &mut all);
                if keeps_old {
                    all.extend(self.sources(self.flow.instance(variable, call), at));
                }
            }
            Some(&Origin::Step(variable)) => {
                all.extend(self.sources(self.flow.instance(variable, call), at));
            }
            Some(&Origin::Parameter(parameter)) => {
                let call = call.map(|call| (call, *self.flow.schema.call(call)));
                if let Some((id, own)) = call
                    && let Some((&(expr, _), _)) = self.flow.calls.iter().find(|&(_, &other)| other == id)
                    && let ExprKind::Call { function, arguments } = &tree[expr].kind
                    && let Some(index) = tree[*function]
                        .parameters
                        .iter()
                        .position(|&own| own == parameter)
                {
                    self.values(arguments[index], at, own.parent, &mut all);
                }
            }
            None => {}
        }
        all
    }

    /// The values of the operands of an expression.
    fn operands(&self, expr: ExprId, before: usize, call: Option<CallId>, all: &mut Vec<usize>) {
        let kind = &self.flow.tree[expr].kind;
        let is_operation = self.flow.parts.contains_key(&(expr, call));
        if !is_operation {
            return self.values(expr, before, call, all);
        }
        kind.for_each_operand(|operand| self.values(operand, before, call, all));
    }

    /// The value of an expression, or those of its parts where it has no event of its own. Chains may be
    /// thousands of operators long, so there is no recursion.
    fn values(&self, expr: ExprId, before: usize, call: Option<CallId>, all: &mut Vec<usize>) {
        let flow = self.flow;
        let mut pending = vec![expr];
        while let Some(expr) = pending.pop() {
            match &flow.tree[expr].kind {
                ExprKind::Variable(variable) => {
                    all.extend(self.sources(flow.instance(*variable, call), before));
                }
                ExprKind::Call { .. } => {
                    let id = flow.calls.get(&(expr, call));
                    let returns = id.and_then(|id| flow.returns.get(id));
                    all.extend(returns.and_then(|returns| self.latest(returns, before)));
                }
                kind => match flow.parts.get(&(expr, call)) {
                    Some(&part) => all.extend(self.latest(&[part], before)),
                    None => kind.for_each_operand(|operand| pending.push(operand)),
                },
            }
        }
    }

    /// The last definition of a variable before a position, and the later conditions that could have led to
    /// another one.
    fn sources(&self, instance: Instance, before: usize) -> Vec<usize> {
        let (variable, call) = instance;
        let definition = self.definition(instance, before);
        let conditions = self.flow.guards.get(&variable).into_iter().flatten();
        let branches = conditions.filter_map(|&condition| self.flow.branches.get(&(condition, call)));
        let untaken = branches.filter_map(|&branch| self.latest(&[branch], before));
        let untaken = untaken.filter(|&at| definition.is_none_or(|definition| at > definition));
        definition.into_iter().chain(untaken).collect()
    }

    /// The last definition of a variable before a position.
    fn definition(&self, instance: Instance, before: usize) -> Option<usize> {
        let flow = self.flow;
        let own = flow
            .definitions
            .get(&instance)
            .and_then(|ids| self.latest(ids, before));
        let outputs = flow.outputs.get(&instance).into_iter().flatten();
        // Functions do not recurse, so a parameter is another variable.
        outputs
            .filter_map(|&parameter| self.definition(parameter, before))
            .chain(own)
            .max()
    }

    fn latest(&self, ids: &[EventId], before: usize) -> Option<usize> {
        let latest = |id| {
            let positions = self.positions.get(id)?;
            positions[..positions.partition_point(|&at| at < before)]
                .last()
                .copied()
        };
        ids.iter().filter_map(latest).max()
    }
}
