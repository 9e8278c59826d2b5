//! The events that a traced run may record.

use std::collections::HashMap;
use std::ops::Range;

use toyproof_glsl::tree::{FunctionId, Place, Type, VariableId};

/// Identifies an event of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EventId(pub(crate) u32);

/// Identifies an inlined call.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CallId(pub(crate) u32);

/// Identifies what an event of the kind [`EventKind::Store`] writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StoreId(pub(crate) u32);

/// A static event of a program. A function that is inlined twice has its events twice.
#[derive(Debug, Clone, Copy)]
pub struct Event {
    /// The kind of the event.
    pub kind: EventKind,
    /// The source location.
    pub at: Place,
    /// The type of the value; `void` if there is none.
    pub ty: Type,
    /// The call that contains it; none in `mainImage` and at global scope.
    pub call: Option<CallId>,
    /// The [`EventKind::LoopHeader`] event of the innermost enclosing loop.
    pub round: Option<EventId>,
}

/// The kind of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The variable, or part of one, at this location is assigned the value.
    Assignment(Place),
    /// A subexpression has the value.
    Subexpression,
    /// The condition of `if`, a loop, `?:`, `&&` or `||` has the value.
    Branch,
    /// An iteration of a loop begins.
    LoopHeader,
    /// A function returns the value.
    Return,
    /// A statement without a value is executed: `break`, `discard`.
    Statement,
    /// A statement begins, or the condition of an `else if` or of a loop. Like the following kinds, only
    /// recorded by [`Program::step_debugger`](crate::Program::step_debugger).
    Step,
    /// The body of a function begins.
    Entry,
    /// Cells of variables are written.
    Store(StoreId),
}

/// What an event writes. Its values are those of the cells, in their order.
#[derive(Debug, Clone)]
pub struct Store {
    /// The cells.
    pub cells: Vec<u32>,
    /// Whether the first value of the event is a number that is added to each cell.
    pub is_indexed: bool,
    /// Whether all values are zero, which the event does not repeat.
    pub is_zero: bool,
}

/// An inlined function call.
#[derive(Debug, Clone, Copy)]
pub struct Call {
    /// The function.
    pub function: FunctionId,
    /// The location of the call.
    pub at: Place,
    /// The enclosing call.
    pub parent: Option<CallId>,
}

/// All events of a program, in execution order; those of a loop in the order of one iteration.
#[derive(Debug, Clone, Default)]
pub struct TraceSchema {
    pub(crate) events: Vec<Event>,
    pub(crate) calls: Vec<Call>,
    pub(crate) stores: Vec<Store>,
    /// The cells of each variable in each call, and of those at global scope and in `mainImage`.
    pub(crate) variables: HashMap<(Option<CallId>, VariableId), Range<u32>>,
}

impl TraceSchema {
    /// Returns an event.
    #[must_use]
    pub fn event(&self, id: EventId) -> &Event {
        &self.events[id.0 as usize]
    }

    /// Returns a call.
    #[must_use]
    pub fn call(&self, id: CallId) -> &Call {
        &self.calls[id.0 as usize]
    }

    /// Returns what an event of the kind [`EventKind::Store`] writes.
    #[must_use]
    pub fn store(&self, id: StoreId) -> &Store {
        &self.stores[id.0 as usize]
    }

    /// Returns the cells of a variable in a call, or of one at global scope or in `mainImage`: one for each
    /// component. `None` for variables that are not in cells, such as uniforms.
    #[must_use]
    pub fn cells(&self, call: Option<CallId>, variable: VariableId) -> Option<Range<u32>> {
        self.variables.get(&(call, variable)).cloned()
    }

    /// Returns the headers of the enclosing loops, outermost first; a loop header is last in its own list.
    #[must_use]
    pub fn loop_headers(&self, id: EventId) -> Vec<EventId> {
        let own = (self.event(id).kind == EventKind::LoopHeader).then_some(id);
        let mut rounds: Vec<EventId> = own.into_iter().collect();
        let mut next = self.event(id).round;
        while let Some(round) = next {
            rounds.push(round);
            next = self.event(round).round;
        }
        rounds.reverse();
        rounds
    }
}
