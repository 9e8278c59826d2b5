//! The recorded execution of a pixel: the stops between which a debugger moves, the calls that they are in,
//! and the values of all variables at each of them.

mod builder;
mod history;
mod incident;

use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use toyproof_diagnostic::{FileId, Files};
use toyproof_eval::{CallId, Failure, TraceSchema, TraceValue};
use toyproof_eval_native::Program;
use toyproof_glsl::tree::{FunctionId, Place, Tree, VariableId};
use toyproof_verify::debug;

use self::history::History;
pub(crate) use self::incident::differs;
pub use self::incident::{Incident, IncidentKind};
use crate::subject::Subject;

/// The execution of a pixel in f32, with the values that f64 has at the same points.
#[derive(Debug)]
pub struct Recording {
    schema: TraceSchema,
    /// Where the execution can stop, in its order.
    stops: Vec<Stop>,
    invocations: Vec<Invocation>,
    /// The outermost function.
    root: Option<u32>,
    /// The values of cells in f32 and in f64.
    history: [History; 2],
    /// The number of recorded events.
    events: u32,
    /// What happens that a user may want to stop at, in the order of stops.
    incidents: Vec<Incident>,
    /// The color of the pixel in f32 and in f64; `None` if it is discarded.
    pub colors: [Option<[f64; 3]>; 2],
    /// Whether the end is missing because the execution is too long.
    pub is_cut: bool,
}

/// A line of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Line {
    /// The file.
    pub file: FileId,
    /// The line, from 1.
    pub line: usize,
}

impl Line {
    /// The line in which a place begins, in the file of the user.
    pub(crate) fn of(files: &Files, at: Place) -> Self {
        Self {
            file: files.origin(at.span).file,
            line: files.position(at.span).line,
        }
    }
}

/// A point of the execution at which it can stop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stop {
    /// The number of events before it.
    pub(crate) at: u32,
    pub(crate) invocation: u32,
    /// The statement or condition that is executed next, or in which the execution goes on after a call.
    pub(crate) place: Place,
    pub(crate) line: Line,
    /// Whether a call has just returned, and the execution goes on inside of the line.
    pub(crate) is_return: bool,
}

/// One execution of a function.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Invocation {
    /// The call in the program; `None` for `mainImage`.
    pub(crate) call: Option<CallId>,
    pub(crate) function: FunctionId,
    /// The number of enclosing calls.
    pub(crate) depth: u32,
    pub(crate) caller: Option<Caller>,
}

/// Where a function was called.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Caller {
    pub(crate) invocation: u32,
    /// The place of the call.
    pub(crate) at: Place,
    /// The statement or condition that contains the call.
    pub(crate) step: Option<Place>,
}

/// A point of the recording: a stop, or the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Point(pub(crate) usize);

/// A function that is being executed at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StackFrame {
    pub(crate) invocation: u32,
    pub(crate) call: Option<CallId>,
    pub(crate) function: FunctionId,
    /// Where it is: the statement that is executed next, or the call of the function above it.
    pub(crate) at: Place,
    /// The statement or condition that contains this place; `None` at the end.
    pub(crate) step: Option<Place>,
}

impl Recording {
    /// Records a pixel.
    ///
    /// # Errors
    /// If the shader is too large, exceeds the deadline, or is interrupted.
    pub fn new(subject: &Subject, deadline: Instant, interrupt: &AtomicBool) -> Result<Self, Failure> {
        let limit = deadline.saturating_duration_since(Instant::now());
        let program = Program::within(&subject.checked, limit)?;
        let explanation = debug::record(&program, &subject.frame, subject.pixel, deadline, interrupt)?;
        Ok(builder::build(subject, &explanation))
    }

    /// The number of stops.
    #[must_use]
    pub fn len(&self) -> usize {
        self.stops.len()
    }

    /// Whether nothing can be stepped through.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.stops.is_empty()
    }

    /// The first stop; the end, if there is none.
    #[must_use]
    pub fn start(&self) -> Point {
        Point(0)
    }

    /// The point behind the last stop.
    #[must_use]
    pub fn end(&self) -> Point {
        Point(self.stops.len())
    }

    /// The stop at a point; `None` at the end.
    pub(crate) fn stop(&self, point: Point) -> Option<&Stop> {
        self.stops.get(point.0)
    }

    pub(crate) fn stops(&self) -> &[Stop] {
        &self.stops
    }

    pub(crate) fn invocation(&self, index: u32) -> &Invocation {
        &self.invocations[index as usize]
    }

    /// The incidents between two points, the first included.
    pub(crate) fn incidents(&self, points: Range<usize>) -> impl DoubleEndedIterator<Item = &Incident> {
        let before = |end: usize| self.incidents.partition_point(|incident| incident.stop < end);
        self.incidents[before(points.start)..before(points.end.max(points.start))].iter()
    }

    /// The line at a point; at the end, that of the last stop.
    #[must_use]
    pub fn line(&self, point: Point) -> Option<Line> {
        self.stop(point).or(self.stops.last()).map(|stop| stop.line)
    }

    /// The number of events before a point.
    pub(crate) fn events_before(&self, point: Point) -> u32 {
        self.stop(point).map_or(self.events, |stop| stop.at)
    }

    /// The functions that are being executed, innermost first; at the end, the outermost alone.
    pub(crate) fn stack(&self, tree: &Tree, main_image: FunctionId, point: Point) -> Vec<StackFrame> {
        let Some(stop) = self.stop(point) else {
            let root = self.root.map(|root| (root, self.invocation(root)));
            let (function, call) = root.map_or((main_image, None), |(_, root)| (root.function, root.call));
            let invocation = root.map_or(u32::MAX, |(root, _)| root);
            let mut stops = self.stops.iter().rev();
            let last = stops.find(|stop| stop.invocation == invocation);
            return vec![StackFrame {
                invocation,
                call,
                function,
                at: last.map_or(tree[function].at, |stop| stop.place),
                step: None,
            }];
        };
        let mut frames = Vec::new();
        let mut next = Some((stop.invocation, stop.place, Some(stop.place)));
        while let Some((index, at, step)) = next {
            let invocation = self.invocation(index);
            frames.push(StackFrame {
                invocation: index,
                call: invocation.call,
                function: invocation.function,
                at,
                step,
            });
            next = invocation
                .caller
                .map(|caller| (caller.invocation, caller.at, caller.step));
        }
        frames
    }

    /// The function that is executed at a stop.
    pub(crate) fn frame(&self, stop: &Stop) -> StackFrame {
        let Invocation { call, function, .. } = *self.invocation(stop.invocation);
        StackFrame {
            invocation: stop.invocation,
            call,
            function,
            at: stop.place,
            step: Some(stop.place),
        }
    }

    /// The cells of a variable as it is seen in a call.
    pub(crate) fn cells(&self, call: Option<CallId>, variable: VariableId) -> Option<Range<u32>> {
        let own = self.schema.cells(call, variable);
        own.or_else(|| self.schema.cells(None, variable))
    }

    /// The values of cells at a point, in f32 and in f64.
    pub(crate) fn values(&self, cells: Range<u32>, point: Point) -> [Vec<TraceValue>; 2] {
        let before = self.events_before(point);
        self.history
            .each_ref()
            .map(|history| cells.clone().map(|cell| history.value(cell, before)).collect())
    }

    /// The stops behind which the execution in f32 writes one of the cells, in order, each once.
    pub(crate) fn writes(&self, cells: Range<u32>) -> Vec<usize> {
        let events = cells.flat_map(|cell| self.history[0].writes(cell));
        let stops = events.filter_map(|event| {
            let after = self.stops.partition_point(|stop| stop.at <= event);
            after.checked_sub(1)
        });
        let mut stops: Vec<usize> = stops.collect();
        stops.sort_unstable();
        stops.dedup();
        stops
    }
}
