//! Finds where the values of a wrong shader depart from those of a reference shader.
//!
//! Both compute a pixel. A value of the one is *known* if the other has it, too, at the same pixel; names,
//! order and structure do not matter. From a wrong color, the data flow leads back over unknown values to one
//! whose inputs are all known: there the two depart, as in algorithmic debugging (Shapiro, *Algorithmic
//! Program Debugging*, 1982), with the reference in place of the person who is asked. Values that are unknown
//! in right pixels, too, are a matter of style, and count less.

mod flow;
mod matching;
mod picture;

use std::collections::{HashMap, HashSet};
use std::time::Instant;

use toyproof_diagnostic::Span;
use toyproof_eval::{ExecutionTrace, Number, PixelDebugger, Settings, TraceEvent, TraceValue};
use toyproof_eval_native::Program;
use toyproof_image::Frame;
use toyproof_verify::{CheckResult, Expected};

use self::flow::{Execution, Flow};
use self::matching::{Matching, has};
pub use self::picture::ValueImages;
use self::picture::Values;

/// The largest number of wrong pixels that are traced.
const MAX_WRONG: usize = 8;

/// The largest number of right pixels that are traced.
const MAX_RIGHT: usize = 8;

/// The number of events after which no more pixels are traced: about 200 MB.
const MAX_EVENTS: usize = 1 << 20;

/// The least number of pixels in which a shader has a common value, which says little.
const COMMON: usize = 3;

/// The largest number of values through which unknown ones are searched for.
const MAX_COMMON: usize = 5000;

/// Where a shader departs from its reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Departure {
    /// The first value of the shader that the reference does not have.
    pub unknown: Option<UnknownValue>,
    /// The first value of the reference that the shader does not have.
    pub missing: Option<MissingValue>,
    /// Both values in all pixels; `None` if they were not asked for.
    pub images: Option<ValueImages>,
}

/// A value of a shader that its reference does not have.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownValue {
    /// The statement or expression of the shader.
    pub span: Span,
    /// The call of the function that contains the statement; `None` in `mainImage`.
    pub call: Option<Span>,
    /// The value.
    pub value: Vec<f64>,
    /// The pixel, from the left and from the bottom.
    pub pixel: [u32; 2],
}

/// A value of the reference that the shader does not have.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingValue {
    /// The statement or expression of the shader that uses what the reference computes the value from.
    pub user: Option<Span>,
    /// The statement or expression of the reference.
    pub span: Span,
    /// The value.
    pub value: Vec<f64>,
    /// The pixel, from the left and from the bottom.
    pub pixel: [u32; 2],
}

impl Departure {
    /// The places in the shader.
    pub(crate) fn spans(&self) -> impl Iterator<Item = Span> {
        let unknown = self.unknown.iter();
        let unknown = unknown.flat_map(|unknown| [Some(unknown.span), unknown.call]);
        let missing = self.missing.iter().map(|missing| missing.user);
        unknown.chain(missing).flatten()
    }
}

/// Finds the departure of a shader whose algorithm differs from its reference in this frame; `None` if the
/// reference is no shader, or the place was not found before the deadline. `with_images` selects whether the
/// values are rendered.
pub(crate) fn find(
    program: &Program,
    frame: &Frame,
    expected: &Expected,
    check: &CheckResult,
    with_images: bool,
    deadline: Instant,
) -> Option<Departure> {
    let (reference, reference_frame) = expected.program()?;
    let pixels = [
        check.sample_pixels(frame.size, MAX_WRONG),
        check.sample_agreeing(frame.size, MAX_RIGHT),
    ];
    let reference = (reference, reference_frame);
    find_in::<f64>(
        (program, frame),
        reference,
        pixels,
        Matching::Rounded,
        with_images,
        deadline,
    )
}

/// Finds the departure of a shader from a reference shader in one pixel with a wrong color; both have their
/// frames.
#[must_use]
pub fn in_pixel(
    shader: (&Program, &Frame),
    reference: (&Program, &Frame),
    pixel: [u32; 2],
    deadline: Instant,
) -> Option<Departure> {
    let pixels = [vec![pixel], Vec::new()];
    find_in::<f64>(shader, reference, pixels, Matching::Rounded, false, deadline)
}

/// Finds the departure of a shader from another one in a pixel whose bits differ in float32; both have their
/// frames. Values are known if the other shader has them to the bit.
#[must_use]
pub fn in_bits(
    shader: (&Program, &Frame),
    other: (&Program, &Frame),
    pixel: [u32; 2],
    deadline: Instant,
) -> Option<Departure> {
    let pixels = [vec![pixel], Vec::new()];
    find_in::<f32>(shader, other, pixels, Matching::Exact, false, deadline)
}

/// Finds the departure in some wrong and some right pixels.
fn find_in<N: Number>(
    (program, frame): (&Program, &Frame),
    (reference, reference_frame): (&Program, &Frame),
    [wrong, right]: [Vec<[u32; 2]>; 2],
    matching: Matching,
    with_images: bool,
    deadline: Instant,
) -> Option<Departure> {
    let settings = || Settings::<N> {
        deadline: Some(deadline),
        ..Settings::default()
    };
    let own = program.pixel_debugger(frame, settings()).ok()?;
    let other = reference.pixel_debugger(reference_frame, settings()).ok()?;
    let mut events = 0;
    let mut traced = |pixels: Vec<[u32; 2]>| -> Vec<Pixel> {
        let mut all = Vec::new();
        for at in pixels {
            if events > MAX_EVENTS {
                break;
            }
            let pixel = Pixel::new(at, &own, &other);
            events += pixel
                .as_ref()
                .map_or(0, |pixel| pixel.own.events.len() + pixel.other.events.len());
            all.extend(pixel);
        }
        all
    };
    let (wrong, right) = (traced(wrong), traced(right));
    let [own_traces, other_traces] = [Pixel::own, Pixel::other].map(|side| {
        let all = wrong.iter().chain(&right);
        all.flat_map(move |pixel| &side(pixel).events)
    });
    let own_flow = Flow::new(program.checked(), own.schema(), own_traces);
    let other_flow = Flow::new(reference.checked(), other.schema(), other_traces);
    let own_side = Side::new(&own_flow, matching, [&wrong, &right], |pixel| {
        [&pixel.own, &pixel.other]
    });
    let other_side = Side::new(&other_flow, matching, [&wrong, &right], |pixel| {
        [&pixel.other, &pixel.own]
    });
    let (own_leaves, other_leaves) = (own_side.leaves(), other_side.leaves());
    let unknown = own_side.most_suspicious(&own_leaves, &other_leaves);
    let unknown = unknown.map(|leaf| UnknownValue {
        span: own_side.span(leaf),
        call: own_side.call(leaf),
        value: numbers(own_side.event(leaf)),
        pixel: wrong[leaf.pixel].at,
    });
    let missing = other_side.most_suspicious(&other_leaves, &own_leaves);
    let missing = missing.map(|leaf| {
        let user = own_side
            .execution(leaf.pixel)
            .user(&other_side.known_inputs(leaf), matching);
        let user = user.map(|position| own_side.span(Event { position, ..leaf }));
        MissingValue {
            user,
            span: other_side.span(leaf),
            value: numbers(other_side.event(leaf)),
            pixel: wrong[leaf.pixel].at,
        }
    });
    if unknown.is_none() && missing.is_none() {
        return None;
    }
    let images = with_images.then(|| {
        let span = unknown.as_ref().map(|unknown| unknown.span);
        let own = span.and_then(|span| Values::new(program, frame, span, deadline));
        let span = missing.as_ref().map(|missing| missing.span);
        let other = span.and_then(|span| Values::new(reference, reference_frame, span, deadline));
        ValueImages::new(own.as_ref(), other.as_ref())
    });
    Some(Departure {
        unknown,
        missing,
        images,
    })
}

/// A pixel in both shaders.
struct Pixel {
    at: [u32; 2],
    own: ExecutionTrace,
    other: ExecutionTrace,
}

impl Pixel {
    fn new<N: Number>(at: [u32; 2], own: &PixelDebugger<N>, other: &PixelDebugger<N>) -> Option<Self> {
        let (own, other) = (own.trace(at, None).ok()?, other.trace(at, None).ok()?);
        (!own.is_cut && !other.is_cut).then_some(Self { at, own, other })
    }

    fn own(&self) -> &ExecutionTrace {
        &self.own
    }

    fn other(&self) -> &ExecutionTrace {
        &self.other
    }
}

/// An event in a wrong pixel.
#[derive(Debug, Clone, Copy)]
struct Event {
    /// The index of the pixel among the wrong ones.
    pixel: usize,
    /// The position in the trace of the pixel.
    position: usize,
}

/// A departure, with the known values from which it is computed.
struct Leaf {
    at: Event,
    inputs: HashSet<u64>,
}

impl Leaf {
    /// The share of the inputs that two departures have in common (Jaccard's index).
    fn similarity(&self, other: &Self, matching: Matching) -> f64 {
        let is_common = |&&bucket: &&u64| {
            let near = matching.near(bucket);
            near.iter().any(|near| other.inputs.contains(near))
        };
        let common = self.inputs.iter().filter(is_common).count();
        let all = self.inputs.len() + other.inputs.len() - common;
        common as f64 / all.max(1) as f64
    }
}

/// What a value says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Familiarity {
    /// The other shader has the value in this pixel.
    Known,
    /// The other shader does not have the value.
    Unknown,
    /// The value may be right or wrong: one of the shaders has it in several pixels, such as 0, 1 and the
    /// colors of the scene; or it is no float.
    Common,
}

/// One of the shaders, in comparison with the other.
struct Side<'p> {
    matching: Matching,
    wrong: Vec<(Execution<'p>, HashSet<u64>)>,
    right: Vec<(Execution<'p>, HashSet<u64>)>,
    /// The values that one of the shaders has in several pixels.
    common: HashSet<u64>,
}

impl<'p> Side<'p> {
    /// `sides` returns the trace of this shader and that of the other.
    fn new(
        flow: &'p Flow<'p>,
        matching: Matching,
        [wrong, right]: [&'p [Pixel]; 2],
        sides: impl Fn(&'p Pixel) -> [&'p ExecutionTrace; 2],
    ) -> Self {
        let mut counts: HashMap<u64, usize> = HashMap::new();
        let mut side = |pixel| {
            let [own, other] = sides(pixel);
            let buckets = |trace: &ExecutionTrace| -> HashSet<u64> {
                let numbers = trace.events.iter().flat_map(numbers);
                numbers.map(|value| matching.bucket(value)).collect()
            };
            let known = buckets(other);
            for &bucket in known.union(&buckets(own)) {
                *counts.entry(bucket).or_default() += 1;
            }
            (Execution::new(flow, &own.events), known)
        };
        let wrong = wrong.iter().map(&mut side).collect();
        let right = right.iter().map(&mut side).collect();
        let common = counts.into_iter().filter(|&(_, count)| count >= COMMON);
        Self {
            matching,
            wrong,
            right,
            common: common.map(|(bucket, _)| bucket).collect(),
        }
    }

    fn execution(&self, pixel: usize) -> &Execution<'p> {
        &self.wrong[pixel].0
    }

    fn event(&self, at: Event) -> &TraceEvent {
        &self.execution(at.pixel).events[at.position]
    }

    fn span(&self, at: Event) -> Span {
        self.execution(at.pixel).flow.span(self.event(at).event)
    }

    fn call(&self, at: Event) -> Option<Span> {
        self.execution(at.pixel).flow.call(self.event(at).event)
    }

    fn familiarity(&self, event: &TraceEvent, known: &HashSet<u64>) -> Familiarity {
        let numbers = numbers(event);
        let is_in = |all: &HashSet<u64>| numbers.iter().all(|&value| has(all, value, self.matching));
        if is_in(&self.common) {
            Familiarity::Common
        } else if is_in(known) {
            Familiarity::Known
        } else {
            Familiarity::Unknown
        }
    }

    /// The departures of each wrong pixel.
    fn leaves(&self) -> Vec<Vec<Leaf>> {
        let pixels = self.wrong.iter().enumerate();
        let leaves = pixels.map(|(pixel, (execution, known))| {
            let positions = self.departures(execution, known).into_iter();
            let leaf = |position| {
                let at = Event { pixel, position };
                let inputs = self.known_inputs(at).concat();
                Leaf {
                    at,
                    inputs: inputs
                        .into_iter()
                        .map(|value| self.matching.bucket(value))
                        .collect(),
                }
            };
            positions.map(leaf).collect()
        });
        leaves.collect()
    }

    /// The first departure at the place at which most wrong pixels, and few right ones, depart, with inputs
    /// from which the other shader computes a missing value; the earliest of equals.
    fn most_suspicious(&self, leaves: &[Vec<Leaf>], others: &[Vec<Leaf>]) -> Option<Event> {
        /// The number of wrong pixels that depart at a place, how well the inputs match, and the first event.
        struct Count {
            wrong: usize,
            matches: f64,
            first: Event,
        }
        let mut counts: HashMap<Span, Count> = HashMap::new();
        for (leaves, others) in leaves.iter().zip(others) {
            let mut seen = HashSet::new();
            for leaf in leaves {
                let span = self.span(leaf.at);
                if seen.insert(span) {
                    let first = leaf.at;
                    let count = counts.entry(span).or_insert(Count {
                        wrong: 0,
                        matches: 0.0,
                        first,
                    });
                    count.wrong += 1;
                    let matches = others.iter().map(|other| leaf.similarity(other, self.matching));
                    count.matches += matches.fold(0.0, f64::max);
                }
            }
        }
        let mut in_right: HashMap<Span, usize> = HashMap::new();
        for (execution, known) in &self.right {
            let mut seen = HashSet::new();
            for event in execution.events {
                let span = execution.flow.span(event.event);
                if self.familiarity(event, known) == Familiarity::Unknown && seen.insert(span) {
                    *in_right.entry(span).or_default() += 1;
                }
            }
        }
        let score = |span: Span, count: &Count| {
            let (w, r) = (
                count.wrong as f64,
                in_right.get(&span).map_or(0.0, |&count| count as f64),
            );
            // Ochiai's coefficient, as for suspects.
            let ochiai = w / (self.wrong.len() as f64 * (w + r)).sqrt();
            ochiai * (1.0 + count.matches / w)
        };
        let all = counts
            .iter()
            .map(|(&span, count)| (score(span, count), count.first));
        let order = |first: &Event| (first.position, first.pixel);
        all.max_by(|a, b| a.0.total_cmp(&b.0).then(order(&b.1).cmp(&order(&a.1))))
            .map(|(_, first)| first)
    }

    /// The positions of unknown values on which the color depends, and which depend on no other unknown
    /// value, in the order of execution.
    fn departures(&self, execution: &Execution, known: &HashSet<u64>) -> Vec<usize> {
        let mut found = Vec::new();
        let mut seen = HashSet::new();
        let mut pending: Vec<usize> = Vec::new();
        for color in execution.color() {
            match self.familiarity(&execution.events[color], known) {
                Familiarity::Unknown => pending.push(color),
                // The wrong color is one of the scene.
                _ => pending.extend(self.unknown_inputs(execution, known, color)),
            }
        }
        while let Some(at) = pending.pop() {
            if !seen.insert(at) {
                continue;
            }
            let inputs = self.unknown_inputs(execution, known, at);
            if inputs.is_empty() {
                found.push(at);
            }
            pending.extend(inputs);
        }
        found.sort_unstable();
        found
    }

    /// The positions of unknown values on which a value depends directly, or over common values.
    fn unknown_inputs(&self, execution: &Execution, known: &HashSet<u64>, at: usize) -> Vec<usize> {
        let mut unknown = Vec::new();
        let mut seen = HashSet::new();
        let mut pending = vec![at];
        while let Some(at) = pending.pop() {
            for input in execution.inputs(at).into_iter().chain(execution.conditions(at)) {
                if seen.len() >= MAX_COMMON || !seen.insert(input) {
                    continue;
                }
                match self.familiarity(&execution.events[input], known) {
                    Familiarity::Unknown => unknown.push(input),
                    Familiarity::Common => pending.push(input),
                    Familiarity::Known => {}
                }
            }
        }
        unknown
    }

    /// The values that are known at a departure, from which its value is computed.
    fn known_inputs(&self, at: Event) -> Vec<Vec<f64>> {
        let (execution, known) = &self.wrong[at.pixel];
        let inputs = execution.inputs(at.position).into_iter();
        let events = inputs.map(|input| &execution.events[input]);
        events
            .filter(|event| self.familiarity(event, known) == Familiarity::Known)
            .map(numbers)
            .collect()
    }
}

impl Execution<'_> {
    /// The first position whose inputs have most of these values; `None` if none has any.
    fn user(&self, values: &[Vec<f64>], matching: Matching) -> Option<usize> {
        let has_all = |event: &TraceEvent, wanted: &[f64]| {
            let own: HashSet<u64> = numbers(event)
                .into_iter()
                .map(|value| matching.bucket(value))
                .collect();
            wanted.iter().all(|&value| has(&own, value, matching))
        };
        // Whether each event has each value.
        let has: Vec<Vec<bool>> = values
            .iter()
            .map(|wanted| self.events.iter().map(|event| has_all(event, wanted)).collect())
            .collect();
        let count = |at: usize| {
            // The statement that makes a value does not use it.
            if has.iter().any(|has| has[at]) {
                return 0;
            }
            let inputs = self.inputs(at);
            has.iter().filter(|has| inputs.iter().any(|&at| has[at])).count()
        };
        let all = (0..self.events.len()).map(|at| (count(at), at));
        let best = all.max_by(|a, b| a.0.cmp(&b.0).then(b.1.cmp(&a.1)));
        best.filter(|&(count, _)| count > 0).map(|(_, at)| at)
    }
}

/// The floats of a value.
pub(crate) fn numbers(event: &TraceEvent) -> Vec<f64> {
    let floats = event.values.iter().filter_map(|value| match value {
        TraceValue::Float(value) => Some(*value),
        TraceValue::Word(_) => None,
    });
    floats.collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::Checked;
    use toyproof_lint::Lints;
    use toyproof_verify::{Case, DEFAULT_TOLERANCE, ShaderReference, verify};

    use super::*;

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        toyproof_glsl::check(&files, file, &Default::default()).unwrap()
    }

    /// The texts of the unknown value, of its call, of the missing value, and of its user.
    fn departure<'t>(shader: &'t str, reference: &'t str) -> [Option<&'t str>; 4] {
        let (own, other) = (checked(shader), checked(reference));
        let frame = Frame {
            size: [32, 18],
            ..Frame::default()
        };
        let (lints, timeout) = (Lints::default(), Duration::from_secs(60));
        let expected = ShaderReference::new(&other, &lints, &frame, DEFAULT_TOLERANCE, timeout)
            .unwrap()
            .0;
        let expected = Expected::Shader(Box::new(expected));
        let case = Case::new(&own, &lints, &frame)
            .with_expected(&expected)
            .with_timeout(timeout);
        let verified = verify(None, &case).unwrap();
        let subject = verified.subject().unwrap();
        let check = subject.results.algorithm.as_ref().unwrap();
        let found = find(
            subject.program,
            &frame,
            &expected,
            check,
            true,
            Instant::now() + timeout,
        )
        .unwrap();
        let images = found.images.as_ref().unwrap();
        assert_eq!(images.own.is_some(), found.unknown.is_some());
        assert_eq!(images.reference.is_some(), found.missing.is_some());
        let text = |text: &'t str, span: Span| &text[span.start as usize..span.end as usize];
        let unknown = found.unknown.as_ref();
        let missing = found.missing.as_ref();
        [
            unknown.map(|unknown| text(shader, unknown.span)),
            unknown.and_then(|unknown| Some(text(shader, unknown.call?))),
            missing.map(|missing| text(reference, missing.span)),
            missing.and_then(|missing| Some(text(shader, missing.user?))),
        ]
    }

    const REFERENCE: &str = "float wave(vec2 p) { return 0.5 + 0.5 * sin(7.0 * p.x); }
        void mainImage(out vec4 c, in vec2 p) {
            vec2 uv = p / iResolution.y;
            float d = length(uv - vec2(0.9, 0.4));
            vec3 color = vec3(wave(uv), d, 0.2);
            c = vec4(color * (1.0 - 0.3 * uv.y), 1.0);
        }";

    #[test]
    fn the_first_unknown_value_is_found_whatever_the_style() {
        // Another structure, other names and a formula of its own; `+` for `-` in the distance.
        let shader = "#define SHADE(k, v) ((k) * (1. - .3 * (v)))
            void mainImage(out vec4 o, in vec2 pixel) {
                vec2 q = pixel / iResolution.y;
                float w = sin(q.x * 7.0);
                w = (1.0 + w) / 2.0;
                vec2 r = q + vec2(0.9, 0.4);
                float away = sqrt(dot(r, r));
                o = vec4(SHADE(vec3(w, away, .2), q.y), 1.0);
            }";
        let [unknown, call, missing, user] = departure(shader, REFERENCE);
        assert_eq!(unknown, Some("q + vec2(0.9, 0.4)"));
        assert_eq!(call, None);
        assert_eq!(missing, Some("uv - vec2(0.9, 0.4)"));
        // The first of the places that use `q`.
        assert_eq!(user, Some("q.x * 7.0"));
    }

    #[test]
    fn a_value_in_a_function_has_its_call() {
        let shader = REFERENCE.replace("wave(uv)", "wave(uv.yx)");
        let [unknown, call, missing, _] = departure(&shader, REFERENCE);
        assert_eq!(unknown, Some("7.0 * p.x"));
        assert_eq!(call, Some("wave(uv.yx)"));
        assert_eq!(missing, Some("7.0 * p.x"));
    }

    #[test]
    fn the_condition_of_a_wrong_branch_is_found() {
        let with = |limit: &str| {
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{
                    vec2 uv = p / iResolution.y;
                    float d = length(uv - vec2(0.9, 0.5));
                    c = vec4(0.1, 0.2, 0.3, 1.0);
                    if ({limit} < 0.3) {{ c = vec4(0.8, 0.6, 0.1, 1.0); }}
                }}"
            )
        };
        let (shader, reference) = (with("d * 2.0"), with("d"));
        assert_eq!(departure(&shader, &reference)[0], Some("d * 2.0"));
    }

    /// The texts of the first value of each shader that the other does not have to the bit, in one pixel.
    fn departure_in_bits<'t>(shader: &'t str, other: &'t str) -> [Option<&'t str>; 2] {
        let programs = [shader, other].map(|text| Program::new(&checked(text)).unwrap());
        let frame = Frame {
            size: [32, 18],
            ..Frame::default()
        };
        let deadline = Instant::now() + Duration::from_secs(60);
        let [own, reference] = programs.each_ref().map(|program| (program, &frame));
        let Some(found) = in_bits(own, reference, [17, 5], deadline) else {
            return [None, None];
        };
        let text = |text: &'t str, span: Span| &text[span.start as usize..span.end as usize];
        [
            found.unknown.map(|unknown| text(shader, unknown.span)),
            found.missing.map(|missing| text(other, missing.span)),
        ]
    }

    /// In double precision, the values count as equal.
    #[test]
    fn a_difference_of_the_last_bits_is_found_in_float32() {
        let other = REFERENCE.replace("0.5 + 0.5", "(0.5 + 1e-7) + 0.5");
        let [unknown, missing] = departure_in_bits(&other, REFERENCE);
        assert_eq!(unknown, Some("return (0.5 + 1e-7) + 0.5 * sin(7.0 * p.x);"));
        assert_eq!(missing, Some("return 0.5 + 0.5 * sin(7.0 * p.x);"));
        let renamed = REFERENCE
            .replace("color", "x")
            .replace("uv", "q")
            .replace("0.5 *", ".5*");
        assert_eq!(departure_in_bits(&renamed, REFERENCE), [None, None]);
    }

    #[test]
    fn a_long_chain_that_is_not_evaluated_is_no_problem() {
        let with = |blue: &str| {
            let chain = vec!["p.x"; 20_000].join(" + ");
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{
                    c = vec4(p.x < -1.0 ? {chain} : p.y / 18.0, 0.2, {blue} * p.x / 32.0, 1.0);
                }}"
            )
        };
        let (shader, reference) = (with("0.5"), with("0.7"));
        assert_eq!(departure(&shader, &reference)[0], Some("0.5 * p.x"));
    }

    #[test]
    fn a_missing_statement_is_found_by_the_value_that_the_reference_has() {
        let with = |falloff: &str| {
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{
                    float sum = 0.0, weight = 1.0;
                    for (int i = 0; i < 4; i++) {{
                        sum += weight * fract(0.37 * p.x + 0.21 * p.y * float(i));
                        {falloff}
                    }}
                    c = vec4(sum / 4.0, 0.2, 0.3, 1.0);
                }}"
            )
        };
        let (shader, reference) = (with(""), with("weight *= 0.5;"));
        let [unknown, _, missing, _] = departure(&shader, &reference);
        assert!(unknown.unwrap().starts_with("sum += weight"), "{unknown:?}");
        assert!(missing.unwrap().starts_with("weight * fract"), "{missing:?}");
    }
}
