//! Execution traces of single pixels: every stored or computed value and every branch, in execution order.

use std::cell::{Cell, RefCell};

use toyproof_glsl::tree::{FunctionId, Place, Type};
use toyproof_image::Frame;

use crate::batch::LANES;
use crate::lower::isel::Prepared;
use crate::number::Number;
use crate::program::{Compiled, Program};
use crate::render::{Failure, Limits, Settings};
use crate::tile::FrameJob;

/// Identifies an event of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EventId(pub(crate) u32);

/// Identifies an inlined call.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CallId(pub(crate) u32);

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

/// A dynamic event: one execution of an [`Event`].
#[derive(Debug, Clone, PartialEq)]
pub struct TraceEvent {
    /// The static event.
    pub event: EventId,
    /// The components of its value.
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
}

/// The maximum number of components recorded in a trace.
const MAX_TRACE_COMPONENTS: usize = 1 << 21;

/// A prefix of a different trace whose values a pixel is forced to take.
#[derive(Debug, Clone, Copy)]
pub struct ForcedPrefix<'a> {
    /// The other trace.
    pub trace: &'a ExecutionTrace,
    /// The number of its events to force; clamped to its length.
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
        let mut trace = self.trace.borrow_mut();
        self.recorded.set(self.recorded.get() + 1);
        if self.recorded.get() > MAX_TRACE_COMPONENTS {
            trace.is_cut = true;
            return None;
        }
        if component == 0 {
            trace.events.push(TraceEvent {
                event: EventId(event),
                values: Vec::new(),
            });
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

    /// Records an event without a value.
    pub(crate) fn record_event(&self, event: u32) {
        let mut trace = self.trace.borrow_mut();
        self.recorded.set(self.recorded.get() + 1);
        if self.recorded.get() > MAX_TRACE_COMPONENTS {
            trace.is_cut = true;
            return;
        }
        trace.events.push(TraceEvent {
            event: EventId(event),
            values: Vec::new(),
        });
    }

    pub(crate) fn finish(self) -> ExecutionTrace {
        self.trace.into_inner()
    }
}

/// A component that can be recorded and forced.
pub(crate) trait TraceComponent: Sized {
    fn to_trace(self) -> TraceValue;
    /// Converts a recorded value back; none if the kinds differ.
    fn from_trace(value: TraceValue) -> Option<Self>;
}

impl<N: Number> TraceComponent for N {
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

// The debugger for single pixels.

/// A shader that is ready to trace the pixels of a frame.
#[derive(Debug)]
pub struct PixelDebugger<'a, N: Number> {
    compiled: &'a Compiled,
    prepared: Prepared<N>,
    frame: &'a Frame,
    settings: Settings<'a, N>,
}

impl Program {
    /// Prepares to trace the pixels of a frame.
    ///
    /// # Errors
    /// If the shader is too large.
    pub fn pixel_debugger<'a, N: Number>(
        &'a self,
        frame: &'a Frame,
        settings: Settings<'a, N>,
    ) -> Result<PixelDebugger<'a, N>, Failure> {
        let compiled = self.traced()?;
        Ok(PixelDebugger {
            compiled,
            prepared: N::prepare(compiled, frame),
            frame,
            settings,
        })
    }
}

impl<'a, N: Number> PixelDebugger<'a, N> {
    /// Returns all events that may occur.
    #[must_use]
    pub fn schema(&self) -> &'a TraceSchema {
        &self.compiled.schema
    }

    /// Traces the pixel at (x, y), y upwards from the bottom. With a prefix, its first values are forced to
    /// those of a different trace.
    ///
    /// # Errors
    /// If a limit is exceeded.
    ///
    /// # Panics
    /// If the pixel lies outside of the frame.
    pub fn trace(
        &self,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>,
    ) -> Result<ExecutionTrace, Failure> {
        N::trace(self, pixel, prefix)
    }

    pub(crate) fn run(
        &self,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>,
    ) -> Result<ExecutionTrace, Failure> {
        let (frame, settings) = (self.frame, &self.settings);
        assert!(pixel[0] < frame.size[0] && pixel[1] < frame.size[1], "{pixel:?}");
        let limits = Limits::of(settings);
        let job = FrameJob::new(
            self.compiled,
            &self.prepared,
            &frame.channels,
            &limits,
            settings,
            frame.size,
        );
        job.trace(pixel, prefix)
            .map_err(|end| end.failure(self.compiled, &limits, settings.max_iterations))
    }
}
