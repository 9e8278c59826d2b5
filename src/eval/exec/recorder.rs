//! Recording of execution traces: the stored and computed values and the branches of one pixel, in execution
//! order.

use std::cell::{Cell, RefCell};

use crate::exec::lanes::{LANES, Lanes};
use crate::exec::number::Arithmetic;
use crate::ir::{EventId, Site, SiteId};

/// A dynamic event: one execution of a static one.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceEvent {
    /// The static event.
    pub event: EventId,
    /// The components of the event's value.
    pub values: Vec<TraceValue>,
}

/// The value of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TraceValue {
    /// A float; an f32 is represented exactly.
    Float(f64),
    /// An `int` or `uint`; a `bool` is 0 or all bits.
    Word(u32),
}

/// The execution trace of a pixel.
#[derive(Debug, Clone, Default)]
pub struct ExecutionTrace {
    /// The events in execution order.
    pub events: Vec<TraceEvent>,
    /// The color of the pixel; none if it was discarded.
    pub color: Option<[f64; 3]>,
    /// Whether the trace was truncated because it was too long.
    pub is_cut: bool,
    /// The faults of operations, in execution order; only recorded with all steps.
    pub faults: Vec<TraceFault>,
}

/// A fault of an operation in a traced pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TraceFault {
    /// The number of events before it.
    pub at: usize,
    /// The fault, and its source location.
    pub site: Site,
}

/// The maximum number of components recorded in a trace.
const MAX_TRACE_COMPONENTS: usize = 1 << 21;

/// A prefix of a different trace whose values a pixel is forced to take.
#[derive(Debug, Clone, Copy)]
pub struct ForcedPrefix<'a> {
    /// The other trace.
    pub trace: &'a ExecutionTrace,
    /// The number of events of that trace to force; clamped to the trace's length.
    pub length: usize,
}

/// Records the events of one lane of a batch.
#[derive(Debug)]
pub(crate) struct Recorder<'a> {
    chunk: usize,
    lane: usize,
    forced: &'a [TraceEvent],
    trace: RefCell<ExecutionTrace>,
    recorded: Cell<usize>,
    /// The faults, each with the number of events before it.
    faults: RefCell<Vec<(usize, SiteId)>>,
}

impl<'a> Recorder<'a> {
    /// Creates a recorder for the pixel at a position of a batch.
    pub(crate) fn new(position: usize, prefix: Option<ForcedPrefix<'a>>) -> Self {
        Self {
            chunk: position / LANES,
            lane: position % LANES,
            forced: prefix.map_or(&[], |prefix| {
                let events = &prefix.trace.events;
                &events[..prefix.length.min(events.len())]
            }),
            trace: RefCell::default(),
            recorded: Cell::new(0),
            faults: RefCell::default(),
        }
    }

    pub(crate) fn chunk(&self) -> usize {
        self.chunk
    }

    pub(crate) fn lane(&self) -> usize {
        self.lane
    }

    /// Records a component; component 0 begins a new event. Returns the value that the component is forced
    /// to, if any.
    pub(crate) fn record_component(
        &self,
        event: u32,
        component: u32,
        value: TraceValue,
    ) -> Option<TraceValue> {
        if component == 0 {
            self.record_event(event);
        } else {
            self.count();
        }
        let mut trace = self.trace.borrow_mut();
        if trace.is_cut {
            return None;
        }
        let at = trace.events.len().checked_sub(1)?;
        let forced = self
            .forced
            .get(at)
            .filter(|forced| forced.event == EventId(event));
        let forced = forced.and_then(|forced| forced.values.get(component as usize).copied());
        trace.events[at].values.push(forced.unwrap_or(value));
        forced
    }

    /// Records an event, still without a value.
    pub(crate) fn record_event(&self, event: u32) {
        if self.count() {
            self.trace.borrow_mut().events.push(TraceEvent {
                event: EventId(event),
                values: Vec::new(),
            });
        }
    }

    /// Counts a component or an event; returns whether it is recorded.
    fn count(&self) -> bool {
        self.recorded.set(self.recorded.get() + 1);
        let is_cut = self.recorded.get() > MAX_TRACE_COMPONENTS;
        self.trace.borrow_mut().is_cut |= is_cut;
        !is_cut
    }

    /// Records the faults of a chunk if the traced pixel is among them: its lane is not zero.
    pub(crate) fn record_fault(&self, site: SiteId, chunk: usize, hit: &Lanes<u32>) {
        if chunk == self.chunk && hit[self.lane] != 0 && self.count() {
            let before = self.trace.borrow().events.len();
            self.faults.borrow_mut().push((before, site));
        }
    }

    pub(crate) fn finish(self, sites: &[Site]) -> ExecutionTrace {
        let faults = self.faults.into_inner().into_iter();
        let faults = faults.map(|(at, SiteId(site))| TraceFault {
            at,
            site: sites[site as usize],
        });
        ExecutionTrace {
            faults: faults.collect(),
            ..self.trace.into_inner()
        }
    }
}

/// A component that can be recorded and forced.
pub(crate) trait TraceComponent: Sized {
    fn to_trace(self) -> TraceValue;
    /// Converts a recorded value back; none if the kinds differ.
    fn from_trace(value: TraceValue) -> Option<Self>;
}

impl<N: Arithmetic> TraceComponent for N {
    fn to_trace(self) -> TraceValue {
        TraceValue::Float(self.to_f64())
    }

    fn from_trace(value: TraceValue) -> Option<Self> {
        match value {
            TraceValue::Float(value) => Some(N::from_f64(value)),
            TraceValue::Word(_) => None,
        }
    }
}

impl TraceComponent for u32 {
    fn to_trace(self) -> TraceValue {
        TraceValue::Word(self)
    }

    fn from_trace(value: TraceValue) -> Option<Self> {
        match value {
            TraceValue::Word(word) => Some(word),
            TraceValue::Float(_) => None,
        }
    }
}
