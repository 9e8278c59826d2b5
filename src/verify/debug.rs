//! Executes one pixel in f32 and in f64, side by side, and finds where the two diverge.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use toyproof_eval::{
    EventId, EventKind, ExecutionTrace, Failure, ForcedPrefix, Number, PixelDebugger, Settings, Site,
    TraceEvent, TraceSchema, TraceValue,
};
use toyproof_eval_native::Program;
use toyproof_glsl::tree::Place;
use toyproof_image::Frame;

use crate::compare::SEEN;
use crate::expected::NumberType;

/// The execution traces of a pixel in f32 and in f64.
#[derive(Debug, Clone)]
pub struct Explanation<'a> {
    /// The schema of the events.
    pub schema: &'a TraceSchema,
    /// The pixel's color in f32; `None` if it is discarded.
    pub single: Option<[f64; 3]>,
    /// The same in f64.
    pub double: Option<[f64; 3]>,
    /// The events in order of execution; an event of only one of the two traces is at its position in the
    /// other.
    pub steps: Vec<Step>,
    /// The first step where the two diverge by more than [`BOUND`].
    pub divergence: Option<usize>,
    /// The step that causes a visible difference of the colors.
    pub cause: Option<usize>,
    /// The step in which f32 first has a NaN, or, where the color is infinite, an infinity.
    pub not_finite: Option<usize>,
    /// Whether the traces were too long and are truncated.
    pub is_cut: bool,
    /// The faults of operations in f32, each with the number of steps before it; only found by [`record`].
    pub faults: Vec<(usize, Site)>,
}

/// Executes a pixel of a frame, y upwards from the bottom, in f32 and in f64.
///
/// # Errors
/// Fails if the shader is too large, or exceeds the deadline.
pub fn explain<'a>(
    program: &'a Program,
    frame: &'a Frame,
    pixel: [u32; 2],
    deadline: Option<Instant>,
) -> Result<Explanation<'a>, Failure> {
    explain_within(
        program,
        frame,
        pixel,
        Settings::<f64>::default().max_iterations,
        deadline,
    )
}

/// Like [`explain`], but also fails if the pixel runs more loop iterations.
///
/// # Errors
/// Fails if the shader is too large, or exceeds a limit.
pub fn explain_within<'a>(
    program: &'a Program,
    frame: &'a Frame,
    pixel: [u32; 2],
    max_iterations: u32,
    deadline: Option<Instant>,
) -> Result<Explanation<'a>, Failure> {
    let singles = program.pixel_debugger(frame, settings::<f32>(max_iterations, deadline))?;
    let doubles = program.pixel_debugger(frame, settings::<f64>(max_iterations, deadline))?;
    let single = singles.trace(pixel, None)?;
    let double = doubles.trace(pixel, None)?;
    let cause = find_cause(&doubles, pixel, &single, &double)?;
    Ok(explained(doubles.schema(), &single, &double, cause.as_ref()))
}

/// Like [`explain`], but records all steps: where statements and functions begin, which variables are
/// written, and which operations are undefined. Other threads may interrupt it. The cause of a visible
/// difference of the colors is left out if the deadline expires during its search.
///
/// # Errors
/// Fails if the shader is too large, exceeds the deadline, or is interrupted.
pub fn record<'a>(
    program: &'a Program,
    frame: &'a Frame,
    pixel: [u32; 2],
    deadline: Instant,
    interrupt: &'a AtomicBool,
) -> Result<Explanation<'a>, Failure> {
    let settings = (Some(deadline), Some(interrupt));
    let singles = program.step_debugger(frame, interruptible::<f32>(settings))?;
    let doubles = program.step_debugger(frame, interruptible::<f64>(settings))?;
    let single = singles.trace(pixel, None)?;
    let double = doubles.trace(pixel, None)?;
    let cause = find_cause(&doubles, pixel, &single, &double).ok().flatten();
    Ok(explained(doubles.schema(), &single, &double, cause.as_ref()))
}

/// Aligns two traces, and finds the steps that matter; `cause` is that of a visible difference.
fn explained<'a>(
    schema: &'a TraceSchema,
    single: &ExecutionTrace,
    double: &ExecutionTrace,
    cause: Option<&TracePosition>,
) -> Explanation<'a> {
    let steps = merge(schema, single, double);
    let infinite = single
        .color
        .is_some_and(|color| color.iter().any(|part| part.is_infinite()));
    let has_value = |step: &Step, is_bad: fn(f64) -> bool| {
        let value = step.single.iter().flatten();
        value
            .into_iter()
            .any(|value| matches!(value, TraceValue::Float(value) if is_bad(*value)))
    };
    let first = |is_bad| steps.iter().position(|step| has_value(step, is_bad));
    let in_single = steps.iter().enumerate().filter(|(_, step)| step.single.is_some());
    let in_single: Vec<usize> = in_single.map(|(at, _)| at).collect();
    let faults = single.faults.iter().map(|fault| {
        let before = fault.at.checked_sub(1).and_then(|at| in_single.get(at));
        (before.map_or(0, |at| at + 1), fault.site)
    });
    Explanation {
        schema,
        single: single.color,
        double: double.color,
        divergence: first_divergence(schema, &steps, false),
        cause: cause.and_then(|position| steps.iter().position(|step| step.position == *position)),
        not_finite: first(f64::is_nan).or_else(|| first(f64::is_infinite).filter(|_| infinite)),
        is_cut: single.is_cut || double.is_cut,
        faults: faults.collect(),
        steps,
    }
}

fn interruptible<N: Number>(
    (deadline, interrupt): (Option<Instant>, Option<&AtomicBool>),
) -> Settings<'_, N> {
    Settings {
        deadline,
        interrupt,
        ..Settings::default()
    }
}

fn settings<'a, N: Number>(max_iterations: u32, deadline: Option<Instant>) -> Settings<'a, N> {
    Settings {
        max_iterations,
        deadline,
        ..Settings::default()
    }
}

/// An event of one trace or of both.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The event.
    pub event: EventId,
    /// The position of the event in the execution.
    position: TracePosition,
    /// The values in f32; `None` if the event did not occur there.
    pub single: Option<Vec<TraceValue>>,
    /// The values in f64; `None` if the event did not occur there.
    pub double: Option<Vec<TraceValue>>,
}

impl Step {
    /// The iteration of each enclosing loop, the outermost first, from 1.
    #[must_use]
    pub fn iterations(&self) -> Vec<u32> {
        let iterations = self.position.iter().map(|&(_, iteration)| iteration);
        iterations.filter(|&iteration| iteration > 0).collect()
    }

    /// The values of both, component by component, if it occurred in both.
    pub fn pairs(&self) -> impl Iterator<Item = (TraceValue, TraceValue)> {
        let both = self.single.iter().flatten().zip(self.double.iter().flatten());
        both.map(|(&single, &double)| (single, double))
    }

    /// The component that differs most; `None` if the event occurred in one trace only.
    #[must_use]
    pub fn worst(&self) -> Option<Component> {
        let distance = |pair: (TraceValue, TraceValue)| match pair {
            (TraceValue::Float(single), TraceValue::Float(double)) => distance(single, double),
            (single, double) => f64::from(u8::from(single != double)),
        };
        let pairs = self.pairs().enumerate();
        let worst = pairs.reduce(|a, b| if distance(b.1) > distance(a.1) { b } else { a });
        worst.map(|(index, (single, double))| Component {
            index,
            single,
            double,
        })
    }

    /// The largest distance of a float from its f64, in units in the last place of f32; `None` without floats
    /// in both.
    #[must_use]
    pub fn ulps(&self) -> Option<f64> {
        let distances = self.pairs().filter_map(|pair| match pair {
            (TraceValue::Float(single), TraceValue::Float(double)) => Some(ulps(single, double)),
            _ => None,
        });
        distances.reduce(|a, b| if a >= b { a } else { b })
    }
}

/// A component of a step that occurred in both traces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// The number of the component.
    pub index: usize,
    /// The value in f32.
    pub single: TraceValue,
    /// The value in f64.
    pub double: TraceValue,
}

/// The distance of two numbers; infinite if exactly one is NaN or infinite.
fn distance(single: f64, double: f64) -> f64 {
    if single == double || (single.is_nan() && double.is_nan()) {
        return 0.0;
    }
    let distance = (single - double).abs();
    if distance.is_finite() {
        distance
    } else {
        f64::INFINITY
    }
}

/// The distance of an f32 from an f64, in units in the last place that f32 has at that f64; infinite if
/// exactly one is NaN or infinite.
#[must_use]
pub fn ulps(single: f64, double: f64) -> f64 {
    // For denormals, which are flushed, the unit is that of the smallest normal number.
    let scale = double.abs().max(f64::from(f32::MIN_POSITIVE));
    // An f64 has 52 bits of mantissa, and a biased exponent of 11 bits.
    let exponent = ((scale.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    // An f32 has 23 bits of mantissa.
    distance(single, double) / f64::from(exponent - 23).exp2()
}

/// The position of an event in the execution: the enclosing loops with their iterations, then the event.
/// Positions are ordered as in the execution.
type TracePosition = Vec<(EventId, u32)>;

/// Computes the position of each event of a trace.
struct PositionTracker<'a> {
    schema: &'a TraceSchema,
    /// The running loops, with their iterations.
    loops: TracePosition,
}

impl PositionTracker<'_> {
    fn position(&mut self, event: EventId) -> TracePosition {
        let enclosing = self.schema.loop_headers(event);
        let is_loop_header = self.schema.event(event).kind == EventKind::LoopHeader;
        let known = self.loops.iter().zip(&enclosing);
        let same = known
            .take_while(|((running, _), iteration)| running == *iteration)
            .count();
        self.loops.truncate(same);
        if is_loop_header {
            match self.loops.last_mut() {
                Some((running, iteration)) if *running == event => *iteration += 1,
                _ => self.loops.push((event, 1)),
            }
            return self.loops.clone();
        }
        let mut position = self.loops.clone();
        position.push((event, 0));
        position
    }
}

/// Merges two traces that are both in the order of their positions.
fn merge(schema: &TraceSchema, single: &ExecutionTrace, double: &ExecutionTrace) -> Vec<Step> {
    let (mut singles, mut doubles) = (with_positions(schema, single), with_positions(schema, double));
    let mut steps = Vec::new();
    loop {
        let order = match (singles.peek(), doubles.peek()) {
            (None, None) => return steps,
            (Some(_), None) => std::cmp::Ordering::Less,
            (None, Some(_)) => std::cmp::Ordering::Greater,
            (Some((single, _)), Some((double, _))) => single.cmp(double),
        };
        let single = if order.is_le() { singles.next() } else { None };
        let double = if order.is_ge() { doubles.next() } else { None };
        let Some((position, event)) = [&single, &double]
            .into_iter()
            .flatten()
            .map(|(position, event)| (position.clone(), event.event))
            .next()
        else {
            return steps;
        };
        let values =
            |event: Option<(TracePosition, &TraceEvent)>| event.map(|(_, event)| event.values.clone());
        steps.push(Step {
            event,
            position,
            single: values(single),
            double: values(double),
        });
    }
}

/// The events of a trace with their positions.
fn with_positions<'a>(
    schema: &'a TraceSchema,
    trace: &'a ExecutionTrace,
) -> std::iter::Peekable<impl Iterator<Item = (TracePosition, &'a TraceEvent)>> {
    let mut tracker = PositionTracker {
        schema,
        loops: TracePosition::new(),
    };
    let events = trace.events.iter();
    events
        .map(move |event| (tracker.position(event.event), event))
        .peekable()
}

/// Values diverge when they differ by more than this, relative to the largest component of the two: ten of
/// the 24 bits of an f32 are left.
pub const BOUND: f64 = 1e-3;

/// Returns the first step where f32 and f64 diverge.
fn first_divergence(schema: &TraceSchema, steps: &[Step], includes_flushed: bool) -> Option<usize> {
    steps
        .iter()
        .position(|step| diverges(schema, step, includes_flushed))
}

/// Whether the values of a step diverge, or only one of the two reaches it. `includes_flushed` is whether
/// differences count that arise because f32 flushes tiny numbers to zero, which hardly ever matters.
#[must_use]
pub fn diverges(schema: &TraceSchema, step: &Step, includes_flushed: bool) -> bool {
    if step.single.is_none() || step.double.is_none() {
        return true;
    }
    // Counters and packed values follow from floats; only the branches that depend on them count.
    let decides = schema.event(step.event).kind == EventKind::Branch;
    let (mut scale, mut most) = (0.0f64, 0.0f64);
    for pair in step.pairs() {
        match pair {
            (TraceValue::Word(single), TraceValue::Word(double)) if decides && single != double => {
                return true;
            }
            (TraceValue::Float(single), TraceValue::Float(double)) => {
                most = most.max(distance(single, double));
                scale = scale.max(single.abs()).max(double.abs());
            }
            _ => {}
        }
    }
    most == f64::INFINITY
        || most > BOUND * scale && (includes_flushed || scale > f64::from(f32::MIN_POSITIVE))
}

// The cause of a visible difference between f32 and f64.
//
// Many values diverge without harm: a random number, or a component near zero. So f64 is forced to follow f32
// up to an event, and then runs freely. If the color then no longer differs, the cause is before that event;
// bisection finds the last event from which it still differs, and the first value that diverges after it is
// the cause.

/// Returns the position of the cause; `None` if the colors do not differ visibly.
fn find_cause(
    doubles: &PixelDebugger<'_, f64>,
    pixel: [u32; 2],
    single: &ExecutionTrace,
    double: &ExecutionTrace,
) -> Result<Option<TracePosition>, Failure> {
    let whole = color_distance(single, double);
    if whole <= SEEN {
        return Ok(None);
    }
    let (differs, steps) = after_last_effective(doubles, pixel, single, whole.min(1.0) / 2.0)?;
    let divergence = first_divergence(doubles.schema(), &steps, true);
    let step = divergence.map(|at| &steps[at]);
    // Without a diverging value, the event that made the difference itself.
    let step = step.or_else(|| steps.iter().filter(|step| step.single.is_some()).nth(differs));
    Ok(step.map(|step| step.position.clone()))
}

/// Finds the last event up to which f64 may follow f32, and the color still differs by at least `distance`.
/// Returns the number of events before it, and the steps if f64 follows f32 up to there.
fn after_last_effective(
    doubles: &PixelDebugger<'_, f64>,
    pixel: [u32; 2],
    single: &ExecutionTrace,
    distance: f64,
) -> Result<(usize, Vec<Step>), Failure> {
    let forced = |length| {
        doubles.trace(
            pixel,
            Some(ForcedPrefix {
                trace: single,
                length,
            }),
        )
    };
    // With `differs` forced events, the color still differs; with `agrees`, it does not.
    let (mut differs, mut agrees) = (0, single.events.len());
    while agrees - differs > 1 {
        let middle = usize::midpoint(differs, agrees);
        if color_distance(single, &forced(middle)?) >= distance {
            differs = middle;
        } else {
            agrees = middle;
        }
    }
    Ok((differs, merge(doubles.schema(), single, &forced(differs)?)))
}

/// The operation at which a value loses its digits in f32.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DigitLoss {
    /// The operation.
    pub at: Place,
    /// Its result in f32, and in f64 from the operands that f32 has before the first harmful rounding; `None`
    /// if it is not a float, or only one of the two gets there.
    pub values: Option<[f64; 2]>,
}

/// The share of a color's error, in ULPs, from which on a value counts as the one that loses the digits.
const LOSS_SHARE: f64 = 0.25;

/// Finds the operation at which the red component of a pixel loses the digits that it lacks in f32, or, if it
/// is NaN or infinite in f32 alone, the first with such a result. Operations at or after the byte `end` of
/// the text do not count. `None` if no single operation does it.
///
/// # Errors
/// Fails if the shader is too large, or exceeds the deadline.
pub fn digit_loss(
    program: &Program,
    frame: &Frame,
    pixel: [u32; 2],
    end: u32,
    deadline: Option<Instant>,
) -> Result<Option<DigitLoss>, Failure> {
    let iterations = Settings::<f64>::default().max_iterations;
    let singles = program.pixel_debugger(frame, settings::<f32>(iterations, deadline))?;
    let doubles = program.pixel_debugger(frame, settings::<f64>(iterations, deadline))?;
    let (single, double) = (singles.trace(pixel, None)?, doubles.trace(pixel, None)?);
    let schema = doubles.schema();
    let (Some([red, ..]), Some([expected, ..])) = (single.color, double.color) else {
        return Ok(None);
    };
    let is_counted = |step: &&Step| schema.event(step.event).at.span.end <= end;
    let floats = |step: &Step| {
        let pairs = step.pairs();
        let floats = pairs.filter_map(|pair| match pair {
            (TraceValue::Float(single), TraceValue::Float(double)) => Some([single, double]),
            _ => None,
        });
        floats.max_by(|a, b| ulps(a[0], a[1]).total_cmp(&ulps(b[0], b[1])))
    };
    let loss = |step: &Step| DigitLoss {
        at: schema.event(step.event).at,
        values: floats(step),
    };
    if !red.is_finite() {
        let steps = merge(schema, &single, &double);
        let is_first = |step: &&Step| {
            floats(step).is_some_and(|[single, double]| !single.is_finite() && double.is_finite())
        };
        return Ok(steps.iter().filter(is_counted).find(is_first).map(loss));
    }
    let error = ulps(red, expected);
    let (_, steps) = after_last_effective(&doubles, pixel, &single, color_distance(&single, &double) / 2.0)?;
    let is_lost = |step: &&Step| {
        let is_branch = schema.event(step.event).kind == EventKind::Branch;
        let parts = step.single.is_none() || step.double.is_none();
        parts
            || (is_branch && step.pairs().any(|(single, double)| single != double))
            || step.ulps().is_some_and(|lost| lost >= LOSS_SHARE * error)
    };
    Ok(steps.iter().filter(is_counted).find(is_lost).map(loss))
}

/// The distance of two colors, in the largest component; infinite if exactly one is NaN or discarded.
fn color_distance(single: &ExecutionTrace, double: &ExecutionTrace) -> f64 {
    match (single.color, double.color) {
        (None, None) => 0.0,
        (Some(single), Some(double)) => {
            let pairs = single.into_iter().zip(double);
            pairs
                .map(|(single, double)| distance(single, double))
                .fold(0.0, f64::max)
        }
        _ => f64::INFINITY,
    }
}

/// Formats a number: an f32 with the digits that distinguish it from its neighbors, an f64 with ten.
#[must_use]
pub fn digits(value: f64, number_type: NumberType) -> String {
    match value {
        _ if value.is_nan() => "NaN".to_owned(),
        f64::INFINITY => "inf".to_owned(),
        f64::NEG_INFINITY => "-inf".to_owned(),
        _ => match number_type {
            NumberType::Single => shortest(value as f32),
            NumberType::Double => ten_digits(value),
        },
    }
}

/// Whether a number is written without an exponent.
fn is_plain(value: f64) -> bool {
    value == 0.0 || (1e-5..1e9).contains(&value.abs())
}

fn shortest(value: f32) -> String {
    if is_plain(f64::from(value)) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn ten_digits(value: f64) -> String {
    let scientific = format!("{value:.9e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    if is_plain(value) {
        // Rounded to ten digits first, so that its shortest form has no more.
        return format!("{}", scientific.parse::<f64>().unwrap_or(value));
    }
    format!(
        "{}e{exponent}",
        digits.trim_end_matches('0').trim_end_matches('.')
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_formatted_for_people() {
        let single = |value: f64| digits(value, NumberType::Single);
        let double = |value: f64| digits(value, NumberType::Double);
        assert_eq!(single(f64::from(0.1f32)), "0.1");
        assert_eq!(single(-36.0), "-36");
        assert_eq!(single(f64::from(1.5e-20f32)), "1.5e-20");
        assert_eq!(single(f64::NAN), "NaN");
        assert_eq!(double(1.0 / 3.0), "0.3333333333");
        assert_eq!(double(-2.0), "-2");
        assert_eq!(double(1e-7 / 3.0), "3.333333333e-8");
        assert_eq!(double(1e30), "1e30");
        assert_eq!(double(f64::NEG_INFINITY), "-inf");
    }

    #[test]
    fn distances_are_in_units_of_f32() {
        assert_eq!(ulps(1.0, 1.0), 0.0);
        assert_eq!(ulps(1.0 + f64::from(f32::EPSILON), 1.0), 1.0);
        assert_eq!(ulps(-2.0, -2.0 - 0.5 * f64::from(f32::EPSILON)), 0.25);
        assert_eq!(ulps(f64::NAN, f64::NAN), 0.0);
        assert_eq!(ulps(f64::NAN, 1.0), f64::INFINITY);
        assert_eq!(ulps(f64::INFINITY, f64::INFINITY), 0.0);
        assert_eq!(ulps(f64::INFINITY, 1.0), f64::INFINITY);
        // At zero, the unit is that of the smallest number that is not flushed.
        assert_eq!(ulps(f64::from(f32::MIN_POSITIVE), 0.0), f64::from(1u32 << 23));
    }
}
