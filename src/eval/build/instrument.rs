//! Instrumentation: checks for undefined behavior, flags of written components, and trace events.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, FunctionId, Place, Tree, Type, VariableId};

use super::call::direction;
use super::lvalue::{LValue, Location, component_count};
use super::{Builder, InlinedCall, Substitute, TraceDetail, UndefinedPolicy};
use crate::ir::{
    Call, CallId, Cell, Cells, Event, EventId, EventKind, Fault, Kind, NONE, Node, Operation, Predicate,
    Site, SiteId, Store, StoreId, Value, ValueDef,
};

/// The number substituted for undefined results: in range of every index, and rarely a genuine result.
const SUBSTITUTE_NUMBER: f64 = 0.5;

impl Builder<'_> {
    /// Records pixels for which a predicate holds. The undefined results must then be passed to
    /// [`Builder::substitute_undefined`].
    pub(super) fn check(&mut self, fault: Fault, at: Place, predicate: Predicate, values: [Value; 2]) {
        match self.options.undefined {
            UndefinedPolicy::Observed => {
                let site = Site { fault, at };
                let next = SiteId(self.sites.len() as u32);
                let id = *self.site_ids.entry(site).or_insert(next);
                if id == next {
                    self.sites.push(site);
                }
                self.push(Node::Check {
                    predicate,
                    values,
                    site: id,
                });
            }
            UndefinedPolicy::Substitute(_) if fault.is_undefined() => {
                self.unresolved.push((predicate, values));
            }
            UndefinedPolicy::Substitute(_) | UndefinedPolicy::Plain => {}
        }
    }

    /// Returns the value of a checked operation, with undefined results substituted if so configured.
    pub(super) fn substitute_undefined(&mut self, value: Value) -> Value {
        let [settled] = self.substitute_undefined_all([value]);
        settled
    }

    /// Substitutes undefined results of an operation that has several values.
    pub(super) fn substitute_undefined_all<const N: usize>(&mut self, values: [Value; N]) -> [Value; N] {
        let other = match self.options.undefined {
            UndefinedPolicy::Substitute(Substitute::NotANumber) => f64::NAN,
            UndefinedPolicy::Substitute(Substitute::OtherImplementation) => 0.0,
            _ => SUBSTITUTE_NUMBER,
        };
        let unresolved = std::mem::take(&mut self.unresolved);
        let conditions = unresolved
            .into_iter()
            .filter_map(|(predicate, values)| self.predicate_value(predicate, values));
        let Some(any) = conditions.reduce(|a, b| self.binary(Operation::Or, a, b)) else {
            return values;
        };
        values.map(|value| {
            let (kind, other) = match self.kind(value) {
                Kind::Float => (Kind::Float, self.float(other)),
                Kind::Word => (Kind::Word, self.word(0)),
            };
            self.select(any, other, value, kind)
        })
    }

    /// Returns the word of a predicate, or `None` if it depends on more than values or the result is defined.
    fn predicate_value(&self, predicate: Predicate, [a, b]: [Value; 2]) -> Option<Value> {
        use Operation as O;
        let outside = |is_above: Value, limit: f64| {
            let is_below = self.binary(O::Less, a, self.float(limit));
            let is_inside = self.binary(O::And, is_above, is_below);
            self.unary(O::Not, is_inside)
        };
        Some(match predicate {
            Predicate::AtLeast(limit) => {
                let below = self.binary(O::LessUint, a, self.word(limit));
                self.unary(O::Not, below)
            }
            Predicate::Zero => self.binary(O::EqualWord, a, self.word(0)),
            Predicate::NotInt => {
                let whole = self.unary(O::Trunc, a);
                let is_above = self.binary(O::LessEqual, self.float(-2_147_483_648.0), whole);
                outside(is_above, 2_147_483_648.0)
            }
            Predicate::NotUint => {
                let is_above = self.binary(O::Less, self.float(-1.0), a);
                outside(is_above, 4_294_967_296.0)
            }
            Predicate::Unordered => {
                let [a, b] = [a, b].map(|value| self.unary(O::IsNan, value));
                self.binary(O::Or, a, b)
            }
            Predicate::Equal => self.binary(O::Equal, a, b),
            Predicate::Greater => self.binary(O::Less, b, a),
            Predicate::PowUndefined => {
                let zero = self.float(0.0);
                let negative = self.binary(O::Less, a, zero);
                let is_zero = self.binary(O::Equal, a, zero);
                let not_positive = self.binary(O::LessEqual, b, zero);
                let both = self.binary(O::And, is_zero, not_positive);
                self.binary(O::Or, negative, both)
            }
            Predicate::ConstantZeros => {
                let zero = self.float(0.0);
                let [a, b] = [a, b].map(|value| self.binary(O::Equal, value, zero));
                self.binary(O::And, a, b)
            }
            Predicate::PartialQuad
            | Predicate::Negative
            | Predicate::NotPositive
            | Predicate::BeyondOne
            | Predicate::AtLeastOne
            | Predicate::BelowOne
            | Predicate::BothZero => return None,
        })
    }

    fn kind(&self, value: Value) -> Kind {
        match self.writer.borrow().defs[value.0 as usize] {
            ValueDef::Operation(operation, _) => operation.kind(),
            ValueDef::Load(cell) => self.cells[cell.0 as usize],
            ValueDef::LoadAt { kind, .. } => kind,
            ValueDef::Word(_) => Kind::Word,
            _ => Kind::Float,
        }
    }
}

// Flags of written components, for variables that may be uninitialized.

/// The tracking state of a variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct WrittenFlags {
    /// A flag word for each component: whether it has been written.
    flags: Cells,
    /// The place of the variable's declaration.
    at: Place,
}

/// The maximum number of components of a tracked variable.
const MAX_FLAGGED_COMPONENTS: u32 = 64;

/// Returns the variables that are passed to `out` parameters, directly or through `inout` parameters, and so
/// may become uninitialized.
pub(super) fn out_arguments(tree: &Tree) -> HashSet<VariableId> {
    let mut variables = HashSet::new();
    let mut pending = Vec::new();
    let mut inout_arguments = HashMap::<VariableId, Vec<VariableId>>::new();
    for (_, expr) in tree.exprs.iter() {
        let ExprKind::Call {
            function,
            ref arguments,
        } = expr.kind
        else {
            continue;
        };
        for (&argument, &parameter) in arguments.iter().zip(&tree[function].parameters) {
            let Some(root) = tree.root_variable(argument) else {
                continue;
            };
            match direction(tree[parameter].kind) {
                Direction::Out => pending.push(root),
                Direction::InOut => inout_arguments.entry(parameter).or_default().push(root),
                Direction::In | Direction::ConstIn => {}
            }
        }
    }
    while let Some(variable) = pending.pop() {
        if variables.insert(variable) {
            pending.extend(inout_arguments.get(&variable).into_iter().flatten());
        }
    }
    variables
}

impl Builder<'_> {
    /// Begins to track a variable in cells of its own. Variables with a value are tracked only if they are
    /// passed to `out` parameters.
    pub(super) fn begin_variable(&mut self, variable: VariableId, cells: Cells, with_value: bool) {
        let Some(at) = self.tree[variable].at else { return };
        if self.options.undefined != UndefinedPolicy::Observed
            || cells.count > MAX_FLAGGED_COMPONENTS
            || with_value && !self.out_arguments.contains(&variable)
        {
            return;
        }
        let flags = Cells {
            first: self.cells.len() as u32,
            count: cells.count,
        };
        self.cells.extend((0..cells.count).map(|_| Kind::Word));
        self.written.insert(cells.first, WrittenFlags { flags, at });
        self.set_flags(flags, with_value);
    }

    /// Marks the argument of an `out` parameter as uninitialized, and binds the parameter to its cells until
    /// [`Self::end_out_parameters`].
    pub(super) fn begin_out_parameter(&mut self, parameter: VariableId, cells: Cells) {
        let (Some((first, _)), Some(at)) = (self.flag(cells.first), self.tree[parameter].at) else {
            return;
        };
        self.out_parameters.push((cells, at));
        let count = cells.count;
        self.set_flags(Cells { first, count }, false);
    }

    /// Ends all `out` parameters but the first `count`.
    pub(super) fn end_out_parameters(&mut self, count: usize) {
        self.out_parameters.truncate(count);
    }

    fn set_flags(&self, flags: Cells, is_written: bool) {
        let value = self.bool_value(is_written);
        for flag in flags.first..flags.first + flags.count {
            self.store(Cell(flag), value);
        }
    }

    /// Sets the flag of a cell that is written, or of the one that an index selects from there.
    pub(super) fn mark_written(&self, cell: u32, index: Option<(Value, Cells)>) {
        let Some((flag, _)) = self.flag(cell) else { return };
        let value = self.bool_value(true);
        self.push(match index {
            None => Node::Store {
                cell: Cell(flag),
                value,
            },
            Some((index, cells)) => Node::StoreAt {
                cells: Cells {
                    first: cells.first + flag - cell,
                    ..cells
                },
                offset: cell - cells.first,
                index,
                value,
            },
        });
    }

    /// Checks the flags of cells that are read. Copying a whole structure is not a read.
    pub(super) fn check_written(&mut self, ty: Type, cells_read: &[u32], index: Option<(Value, Cells)>) {
        if matches!(ty, Type::Struct(_) | Type::Array(_)) {
            return;
        }
        let Some((_, at)) = cells_read.first().and_then(|&cell| self.flag(cell)) else {
            return;
        };
        let flags = cells_read.iter().filter_map(|&cell| {
            let (flag, _) = self.flag(cell)?;
            Some(match index {
                None => self.load(Cell(flag)),
                Some((index, cells)) => self.value(ValueDef::LoadAt {
                    cells: Cells {
                        first: cells.first + flag - cell,
                        ..cells
                    },
                    offset: cell - cells.first,
                    index,
                    kind: Kind::Word,
                }),
            })
        });
        let all = flags.reduce(|a, b| {
            if a == b {
                a
            } else {
                self.binary(Operation::And, a, b)
            }
        });
        if let Some(all) = all {
            self.check(Fault::NeverWritten, at, Predicate::Zero, [all, NONE]);
        }
    }

    /// Returns the flag of a cell, and the declaration of the variable or parameter that it currently belongs
    /// to.
    fn flag(&self, cell: u32) -> Option<(u32, Place)> {
        let (&first, &WrittenFlags { flags, at }) = self.written.range(..=cell).next_back()?;
        let contains_cell = |(cells, _): &&(Cells, Place)| cell.wrapping_sub(cells.first) < cells.count;
        let part = self
            .out_parameters
            .iter()
            .rev()
            .find(contains_cell)
            .map(|&(_, at)| at);
        (cell - first < flags.count).then(|| (flags.first + cell - first, part.unwrap_or(at)))
    }
}

// Trace events: one for each value that a statement stores, branches on, or computes in between.

/// The maximum number of components traced; for larger values, such as arrays of structures, only the event
/// is.
const MAX_TRACED_COMPONENTS: usize = 16;

impl Builder<'_> {
    /// Emits an event with a value.
    pub(super) fn trace_event(&mut self, kind: EventKind, at: Place, ty: Type, values: &[Value]) {
        let is_large = values.len() > MAX_TRACED_COMPONENTS;
        self.trace_values(kind, at, ty, if is_large { &[] } else { values });
    }

    /// Emits an event with all of its values.
    fn trace_values(&mut self, kind: EventKind, at: Place, ty: Type, traced: &[Value]) {
        if !self.options.trace.is_traced() {
            return;
        }
        let id = self.schema.events.len() as u32;
        self.schema.events.push(Event {
            kind,
            at,
            ty,
            call: self.current_call(),
            round: self.loop_headers.last().copied(),
        });
        if traced.is_empty() {
            self.push(Node::Trace {
                event: id,
                component: 0,
                value: NONE,
            });
        }
        for (component, &value) in (0..).zip(traced) {
            self.push(Node::Trace {
                event: id,
                component,
                value,
            });
        }
    }

    /// Emits an event for a computed subexpression; none for names, constants, constructors, and calls.
    pub(super) fn trace_part(&mut self, expr: ExprId, values: &[Value]) {
        let tree = self.tree;
        let is_made = match &tree[expr].kind {
            ExprKind::Binary { .. }
            | ExprKind::Unary { .. }
            | ExprKind::Conditional { .. }
            | ExprKind::BuiltIn { .. } => tree.value(expr).is_none(),
            _ => false,
        };
        if is_made && component_count(tree, tree[expr].ty) > 0 {
            self.trace_event(EventKind::Subexpression, tree[expr].at, tree[expr].ty, values);
        }
    }

    /// Begins a loop iteration; the events up to [`Builder::end_loop`] belong to it.
    pub(super) fn begin_iteration(&mut self, at: Place) {
        if self.options.trace.is_traced() {
            let id = EventId(self.schema.events.len() as u32);
            self.trace_event(EventKind::LoopHeader, at, Type::Void, &[]);
            self.loop_headers.push(id);
        }
    }

    pub(super) fn end_loop(&mut self) {
        self.loop_headers.pop();
    }

    /// Emits events for the parameters of a function.
    pub(super) fn trace_parameters(&mut self, function: FunctionId) {
        if !self.options.trace.is_traced() {
            return;
        }
        for &parameter in &self.tree[function].parameters {
            let variable = &self.tree[parameter];
            if direction(variable.kind) != Direction::Out
                && let Some(at) = variable.at
                && let Location::Cells(cells) = self.location(parameter)
            {
                let values = self.load_all(cells);
                self.trace_event(EventKind::Assignment(at), at, variable.ty, &values);
            }
        }
    }

    /// Registers a call inside of the function that is being written.
    pub(super) fn name_call(&mut self, function: FunctionId, at: Place) -> Option<CallId> {
        let parent = self.current_call();
        (self.options.trace != TraceDetail::Nothing).then(|| {
            self.schema.calls.push(Call { function, at, parent });
            CallId(self.schema.calls.len() as u32 - 1)
        })
    }

    /// The call that is being written; none at global scope and in `mainImage`.
    pub(super) fn current_call(&self) -> Option<CallId> {
        self.call_stack.last().and_then(|frame: &InlinedCall| frame.call)
    }

    /// Whether the steps of the program are recorded.
    fn records_steps(&self) -> bool {
        self.options.trace == TraceDetail::Steps
    }

    /// Emits the event of a statement that begins, or of a condition on a line of its own, or counts it.
    pub(super) fn trace_step(&mut self, at: Place) {
        if self.records_steps() {
            self.trace_values(EventKind::Step, at, Type::Void, &[]);
        }
        self.count_statement(at);
    }

    /// Emits the event of a function whose body begins.
    pub(super) fn trace_entry(&mut self, function: FunctionId) {
        if self.records_steps() {
            self.trace_values(EventKind::Entry, self.tree[function].at, Type::Void, &[]);
        }
    }

    /// Notes the cells of a variable of a call, or of one at global scope or in `mainImage`.
    pub(super) fn bind(&mut self, call: Option<CallId>, variable: VariableId, cells: Cells) {
        if self.records_steps() {
            let range = cells.first..cells.first + cells.count;
            self.schema.variables.insert((call, variable), range);
        }
    }

    /// Notes the cells of a variable of the function that is being written.
    pub(super) fn bind_here(&mut self, variable: VariableId, cells: Cells) {
        self.bind(self.current_call(), variable, cells);
    }

    /// Emits the event of a part of a variable that is written.
    pub(super) fn trace_write(&mut self, target: &LValue, at: Place, values: &[Value]) {
        if !self.records_steps() {
            return;
        }
        let store = Store {
            cells: self.cells_of(target),
            is_indexed: target.index.is_some(),
            is_zero: false,
        };
        let index = target.index.map(|(index, _)| index);
        let all: Vec<Value> = index.into_iter().chain(values.iter().copied()).collect();
        self.trace_store(store, at, &all);
    }

    /// Emits the event of a variable that is written as a whole; without values, it becomes zero.
    pub(super) fn trace_variable(&mut self, cells: Cells, at: Place, values: Option<&[Value]>) {
        if self.records_steps() && cells.count > 0 {
            let store = Store {
                cells: (cells.first..cells.first + cells.count).collect(),
                is_indexed: false,
                is_zero: values.is_none(),
            };
            self.trace_store(store, at, values.unwrap_or_default());
        }
    }

    fn trace_store(&mut self, store: Store, at: Place, values: &[Value]) {
        let id = StoreId(self.schema.stores.len() as u32);
        self.schema.stores.push(store);
        self.trace_values(EventKind::Store(id), at, Type::Void, values);
    }
}
