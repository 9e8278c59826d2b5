//! The trace of a pixel, as text and as JSON.

use std::fmt::Write;

use serde::{Serialize, Serializer};
use toyproof_diagnostic::{Files, Span, grouped};
use toyproof_eval::{Event, EventKind, TraceSchema, TraceValue};
use toyproof_explain::departure;
use toyproof_explain::trail::Trail;
use toyproof_glsl::tree::{Scalar, Tree, Type};
use toyproof_verify::NumberType;
use toyproof_verify::debug::{Explanation, Step, digits};

use super::departure::{Departure, DepartureKind};

/// The trace of a pixel in f32 and in f64, in terms of the source text.
#[derive(Debug, Serialize)]
pub struct PixelTrace {
    version: u32,
    shader: String,
    /// The pixel, from the left and from the bottom.
    pixel: [u32; 2],
    /// The size of the frame, in pixels.
    size: [u32; 2],
    /// The color of the reference; null without one.
    expected: Option<[Component; 3]>,
    /// The final color in f32; null if the pixel is discarded.
    f32: Option<[Component; 3]>,
    /// The final color in f64; null if the pixel is discarded.
    f64: Option<[Component; 3]>,
    /// The index of the first step where f32 and f64 differ; null if there is none.
    divergence_at: Option<usize>,
    /// The index of the step that causes a visible difference of the colors; null if there is none.
    cause_at: Option<usize>,
    /// The index of the first step with a NaN in f32, or with an infinity if the color is infinite; null if
    /// there is none.
    not_finite_at: Option<usize>,
    /// Whether the last steps are missing because there were too many.
    cut: bool,
    steps: Vec<TraceStep>,
    /// The trace of the reference shader in the same pixel; null without one.
    reference: Option<Box<PixelTrace>>,
    /// Where the values depart from those of the reference shader; null without one, or if the color is right.
    departure: Option<Departure>,
    /// Where the difference of a project's pixel comes from, back through passes and frames; null for a
    /// single shader.
    trail: Option<Vec<TrailStep>>,
    /// Whether the difference comes from an earlier frame than the trail has.
    trail_cut: bool,
}

/// A pixel through which a difference came.
#[derive(Debug, Serialize)]
struct TrailStep {
    frame: i32,
    pass: String,
    pixel: [u32; 2],
    f32: [Component; 4],
    f64: [Component; 4],
}

/// One step.
#[derive(Debug, Serialize)]
struct TraceStep {
    /// `assignment`, `subexpression`, `branch`, `iteration`, `return` or `statement`.
    kind: &'static str,
    /// The name of the file, if the shader has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    line: usize,
    column: usize,
    /// The whole line.
    #[serde(skip)]
    source: String,
    /// The source text of the expression.
    text: String,
    /// The variable, or its component, that is assigned.
    name: Option<String>,
    /// The function that contains it.
    function: String,
    /// The lines of the enclosing calls, outermost first.
    calls: Vec<usize>,
    /// The iteration of each enclosing loop, outermost first, from 1.
    iterations: Vec<u32>,
    /// The accessors of the components, as appended to the variable's name: `.x`.
    components: Vec<String>,
    /// The values in f32; null if the step did not run in f32.
    f32: Option<Vec<Component>>,
    f64: Option<Vec<Component>>,
    /// The index of the component that differs most.
    #[serde(skip)]
    worst: Option<usize>,
    /// The largest difference in units in the last place of f32; null if not both values are floats, or if it
    /// is infinite.
    ulp: Option<f64>,
}

/// The pixel that is traced.
#[derive(Debug, Clone, Copy)]
pub struct TracedPixel<'a> {
    /// The shader's name.
    pub shader: &'a str,
    /// The source files.
    pub files: &'a Files,
    /// The tree.
    pub tree: &'a Tree,
    /// The pixel, from the left and from the bottom.
    pub pixel: [u32; 2],
    /// The size of the frame in pixels.
    pub size: [u32; 2],
    /// The color of the reference; `None` without one.
    pub expected: Option<[f64; 3]>,
}

impl PixelTrace {
    /// Resolves the positions and names of an explanation.
    #[must_use]
    pub fn new(subject: &TracedPixel<'_>, explanation: &Explanation<'_>) -> Self {
        let schema = explanation.schema;
        let lines = explanation
            .steps
            .iter()
            .map(|step| TraceStep::new(subject, schema, step));
        let color = |color: [f64; 3]| color.map(Component::Float);
        Self {
            version: 2,
            shader: subject.shader.to_owned(),
            pixel: subject.pixel,
            size: subject.size,
            expected: subject.expected.map(color),
            f32: explanation.single.map(color),
            f64: explanation.double.map(color),
            divergence_at: explanation.divergence,
            cause_at: explanation.cause,
            not_finite_at: explanation.not_finite,
            cut: explanation.is_cut,
            steps: lines.collect(),
            reference: None,
            departure: None,
            trail: None,
            trail_cut: false,
        }
    }

    /// Adds where the difference comes from, from the first frame on.
    #[must_use]
    pub fn after(self, trail: &Trail) -> Self {
        let steps = trail.hops.iter().map(|hop| TrailStep {
            frame: hop.frame,
            pass: hop.target.to_string(),
            pixel: hop.pixel,
            f32: hop.single.map(Component::Float),
            f64: hop.double.map(Component::Float),
        });
        Self {
            trail: Some(steps.collect()),
            trail_cut: trail.is_cut,
            ..self
        }
    }

    /// Adds the trace of the reference shader in the same pixel.
    #[must_use]
    pub fn beside(self, reference: Option<Self>) -> Self {
        Self {
            reference: reference.map(Box::new),
            ..self
        }
    }

    /// Adds where the values depart from those of the reference shader; the files are those of both.
    #[must_use]
    pub fn departing(self, departure: &departure::Departure, [files, reference]: [&Files; 2]) -> Self {
        Self {
            departure: Some(Departure::new(departure, files, reference)),
            ..self
        }
    }

    /// Formats the trace as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        // Strings, numbers and options always serialize.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

impl TraceStep {
    fn new(subject: &TracedPixel<'_>, schema: &TraceSchema, step: &Step) -> Self {
        let TracedPixel { files, tree, .. } = *subject;
        let event = schema.event(step.event);
        let at = files.position(event.at.span);
        let name = match event.kind {
            EventKind::Assignment(target) => Some(one_line(files.text(target.span))),
            _ => None,
        };
        let (function, calls) = calls(subject, schema, event);
        let ty = event.ty;
        let values = |values: &Option<Vec<TraceValue>>| {
            values.as_ref().map(|values| typed_components(tree, ty, values))
        };
        let (single, double) = (values(&step.single), values(&step.double));
        let count = single.as_ref().or(double.as_ref()).map_or(0, Vec::len);
        Self {
            kind: match event.kind {
                EventKind::Assignment(_) => "assignment",
                EventKind::Subexpression => "subexpression",
                EventKind::Branch => "branch",
                EventKind::LoopHeader => "iteration",
                EventKind::Return => "return",
                EventKind::Statement | EventKind::Step | EventKind::Entry | EventKind::Store(_) => {
                    "statement"
                }
            },
            file: files.is_several().then(|| files.name(event.at.span).to_owned()),
            line: at.line,
            column: at.column,
            source: source_line(files, event.at.span),
            text: one_line(files.text(event.at.span)),
            name,
            function,
            calls,
            iterations: step.iterations(),
            components: if count == 0 {
                Vec::new()
            } else {
                components(tree, ty)
            },
            f32: single,
            f64: double,
            worst: step.worst().map(|worst| worst.index),
            ulp: step.ulps().filter(|ulps| ulps.is_finite()),
        }
    }
}

/// The function that contains an event, and the lines of the calls that lead to it.
fn calls(subject: &TracedPixel<'_>, schema: &TraceSchema, event: &Event) -> (String, Vec<usize>) {
    let mut lines = Vec::new();
    let mut next = event.call;
    while let Some(id) = next {
        let call = schema.call(id);
        lines.push(subject.files.position(call.at.span).line);
        next = call.parent;
    }
    lines.reverse();
    let function = event
        .call
        .map_or("mainImage", |id| &subject.tree[schema.call(id).function].name);
    (function.to_owned(), lines)
}

/// The most pixels of a trail that are shown, half of them at each end: those between repeat their neighbors.
const MAX_TRAIL: usize = 12;

/// Formats the origin of a difference: the pixels that pass it on, the last frame first. Empty if the
/// pixel does not differ.
fn trail_lines(trail: &[TrailStep]) -> String {
    let Some(first) = trail.first().filter(|first| first.f32 != first.f64) else {
        return "\nFrom the first frame on, float32 and double precision render the same here.\n".to_owned();
    };
    let mut text = format!(
        "\nFrom the first frame on, the difference comes from\n{:>7}  {:10} {:>12}  {:>NUMBER_WIDTH$} {:>NUMBER_WIDTH$}\n",
        "frame", "pass", "pixel", "f32", "f64"
    );
    // The component that differs most in the requested pixel.
    let difference = |at: usize| match (first.f32[at], first.f64[at]) {
        (Component::Float(single), Component::Float(double)) => (single - double).abs(),
        _ => 0.0,
    };
    let component = (0..3).fold(0, |most, at| {
        if difference(at) > difference(most) {
            at
        } else {
            most
        }
    });
    for (index, step) in trail.iter().enumerate() {
        if trail.len() > MAX_TRAIL && index >= MAX_TRAIL / 2 && index < trail.len() - MAX_TRAIL / 2 {
            if index == MAX_TRAIL / 2 {
                let hidden = trail.len() - MAX_TRAIL;
                let _ = writeln!(text, "{:>7}  {hidden} more", "…");
            }
            continue;
        }
        let [x, y] = step.pixel;
        let _ = writeln!(
            text,
            "{:>7}  {:10} {:>12}  {:>NUMBER_WIDTH$} {:>NUMBER_WIDTH$}",
            step.frame,
            step.pass,
            format!("({x}, {y})"),
            step.f32[component].digits(NumberType::Single),
            step.f64[component].digits(NumberType::Double)
        );
    }
    text
}

/// The line that a span starts in.
fn source_line(files: &Files, span: Span) -> String {
    let text = files.get(span.file).text();
    let (before, after) = text.split_at(span.start as usize);
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let end = after.find('\n').map_or(text.len(), |at| before.len() + at);
    one_line(&text[start..end])
}

/// Joins a text to one line, truncated to `MAX_CHARS`.
fn one_line(text: &str) -> String {
    const MAX_CHARS: usize = 100;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.chars().count() <= MAX_CHARS {
        return text;
    }
    text.chars().take(MAX_CHARS - 1).chain(['…']).collect()
}

// Scalar components of values.

/// A scalar component with its type.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Component {
    Float(f64),
    Int(i32),
    Uint(u32),
    Bool(bool),
}

impl Serialize for Component {
    /// Writes a number or a boolean; NaN and infinities are written as strings.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Float(value) if value.is_finite() => serializer.serialize_f64(value),
            Self::Float(value) => serializer.serialize_str(&digits(value, NumberType::Double)),
            Self::Int(value) => serializer.serialize_i32(value),
            Self::Uint(value) => serializer.serialize_u32(value),
            Self::Bool(value) => serializer.serialize_bool(value),
        }
    }
}

impl Component {
    /// Formats the value: an f32 with enough digits to identify it, an f64 with ten.
    fn digits(self, number_type: NumberType) -> String {
        match self {
            Self::Float(value) => digits(value, number_type),
            Self::Int(value) => value.to_string(),
            Self::Uint(value) => format!("{value}u"),
            Self::Bool(value) => value.to_string(),
        }
    }
}

/// Converts a value to typed components.
fn typed_components(tree: &Tree, ty: Type, values: &[TraceValue]) -> Vec<Component> {
    let mut scalars = tree.scalars(ty).into_iter();
    let each = values.iter().map(|&values| match (values, scalars.next()) {
        (TraceValue::Float(value), _) => Component::Float(value),
        (TraceValue::Word(word), Some(Scalar::Bool)) => Component::Bool(word != 0),
        (TraceValue::Word(word), Some(Scalar::Uint)) => Component::Uint(word),
        (TraceValue::Word(word), _) => Component::Int(word.cast_signed()),
    });
    each.collect()
}

/// The accessors of a type's components, as appended to a variable's name: `.x`, `[2].center.y`, or an empty
/// string for a scalar.
fn components(tree: &Tree, ty: Type) -> Vec<String> {
    let within = |name: String, ty: Type| {
        let inner = components(tree, ty).into_iter();
        inner.map(move |component| format!("{name}{component}"))
    };
    match ty {
        Type::Scalar(_) => vec![String::new()],
        Type::Vector(_, size) => ["x", "y", "z", "w"][..usize::from(size)]
            .iter()
            .map(|name| format!(".{name}"))
            .collect(),
        Type::Matrix { columns, rows } => (0..columns)
            .flat_map(|column| within(format!("[{column}]"), Type::vector(Scalar::Float, rows)))
            .collect(),
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            members
                .flat_map(|member| within(format!(".{}", member.name), member.ty))
                .collect()
        }
        Type::Array(id) => {
            let array = tree.array(id);
            (0..array.size)
                .flat_map(|at| within(format!("[{at}]"), array.element))
                .collect()
        }
        Type::Void | Type::Sampler(_) | Type::Error => Vec::new(),
    }
}

// The trace as text for a terminal.

/// The number of steps of a long trace that are shown around each marked step, at the start and at the end:
/// about a screen.
const CONTEXT_STEPS: usize = 40;

/// The width of the column of names, in characters.
const NAME_WIDTH: usize = 26;

/// The width of a column of numbers, in characters.
const NUMBER_WIDTH: usize = 20;

impl PixelTrace {
    /// Formats the trace line by line: the values that each line stores and the branches that it takes. A
    /// long trace is reduced to its start, its end and the steps around the marked ones, unless `whole`.
    #[must_use]
    pub fn human(&self, whole: bool) -> String {
        let [x, y] = self.pixel;
        let [width, height] = self.size;
        let mut text = format!("{}, pixel ({x}, {y}) of {width}×{height}\n", self.shader);
        if let Some(expected) = self.expected {
            let expected = expected.map(|part| part.digits(NumberType::Double)).join(", ");
            let _ = writeln!(text, "  expected color     ({expected})");
        }
        for (name, color, number_type) in [
            ("f32", self.f32, NumberType::Single),
            ("f64", self.f64, NumberType::Double),
        ] {
            let color = color.map(|color| color.map(|part| part.digits(number_type)).join(", "));
            let color = color.map_or_else(|| "discarded".to_owned(), |color| format!("({color})"));
            let _ = writeln!(text, "  color in {name}       {color}");
        }
        text.push_str(&self.headline());
        let _ = writeln!(
            text,
            "\n{:>5} {:NAME_WIDTH$} {:>NUMBER_WIDTH$} {:>NUMBER_WIDTH$} {:>12}",
            "line", "", "f32", "f64", "difference"
        );
        let mut writer = Writer {
            text,
            whole,
            last: None,
        };
        let mut skipped = 0;
        for (index, line) in self.steps.iter().enumerate() {
            let mark = self.mark(index);
            if line.kind == "subexpression" && !whole && mark.is_none() {
                continue;
            }
            if !whole && !self.is_near(index) {
                skipped += 1;
                continue;
            }
            writer.gap(std::mem::take(&mut skipped));
            writer.line(line, mark.unwrap_or_default());
        }
        writer.gap(skipped);
        if self.cut {
            writer
                .text
                .push_str("  … the remaining steps were not recorded: the trace is too long\n");
        }
        if let Some(trail) = &self.trail {
            writer.text.push_str(&trail_lines(trail));
            if self.trail_cut {
                let line =
                    "  … it comes from earlier frames, which were not kept: they take too much memory\n";
                writer.text.push_str(line);
            }
        }
        if let Some(reference) = &self.reference {
            writer.text.push_str("\nreference: ");
            writer.text.push_str(&reference.human(whole));
        }
        writer.text
    }

    fn is_near(&self, index: usize) -> bool {
        let from_end = self.steps.len() - index;
        let marked = [self.divergence_at, self.cause_at, self.not_finite_at];
        let near = |step: usize| step.abs_diff(index) <= CONTEXT_STEPS;
        index < CONTEXT_STEPS || from_end <= CONTEXT_STEPS || marked.into_iter().flatten().any(near)
    }

    /// Summarizes where the two first differ, and the cause of a visible difference.
    fn headline(&self) -> String {
        let mut text = String::new();
        match self.divergence_at {
            None => text.push_str("  first difference   none: float32 is precise enough here\n"),
            Some(at) => {
                let _ = writeln!(text, "  first difference   {}", self.steps[at].difference());
            }
        }
        if let Some(at) = self.cause_at {
            let _ = match self.divergence_at {
                Some(first) if first == at => writeln!(text, "  visible cause      the first difference"),
                _ => writeln!(text, "  visible cause      {}", self.steps[at].difference()),
            };
        }
        if let Some(at) = self.not_finite_at {
            let TraceStep {
                line,
                column,
                text: source,
                ..
            } = &self.steps[at];
            let _ = writeln!(
                text,
                "  first not finite   line {line}, column {column}: `{source}`"
            );
        }
        for (kind, sentence) in self.departure.iter().flat_map(Departure::sentences) {
            // The first difference is that of the two precisions here.
            let label = match kind {
                DepartureKind::FirstDifference => "wrong value",
                DepartureKind::MissingValue => kind.label(),
            };
            let _ = writeln!(text, "  {label:18} {sentence}");
        }
        text
    }

    /// The mark of a step, if it has one.
    fn mark(&self, index: usize) -> Option<&'static str> {
        let is = |step: Option<usize>| step == Some(index);
        match () {
            () if is(self.cause_at) => Some("  <- visible cause"),
            () if is(self.divergence_at) => Some("  <- first difference"),
            () if is(self.not_finite_at) => Some("  <- first not finite"),
            () => None,
        }
    }
}

impl TraceStep {
    /// Whether a component has the same value in f32 and f64.
    fn agrees(&self, at: usize) -> bool {
        let component =
            |values: &Option<Vec<Component>>| values.as_ref().and_then(|values| values.get(at).copied());
        match (component(&self.f32), component(&self.f64)) {
            (Some(Component::Float(single)), Some(Component::Float(double))) => {
                toyproof_verify::debug::ulps(single, double) == 0.0
            }
            (single, double) => single == double,
        }
    }

    /// Describes how the two differ at this step.
    fn difference(&self) -> String {
        let place = format!("line {}, column {}", self.line, self.column);
        let (Some(single), Some(double)) = (&self.f32, &self.f64) else {
            let only = if self.f32.is_some() { "f32" } else { "f64" };
            return format!("{place}: only {only} reaches `{}`", self.text);
        };
        let Some(worst) = self.worst else {
            return place;
        };
        let (single, double) = (&single[worst], &double[worst]);
        let component = &self.components[worst];
        let (single, double) = (
            single.digits(NumberType::Single),
            double.digits(NumberType::Double),
        );
        let what = match &self.name {
            Some(name) => format!("{name}{component}"),
            None => format!("`{}`{component}", self.text),
        };
        format!("{place}: {what} is {single} in f32 and {double} in f64")
    }
}

struct Writer {
    text: String,
    /// Whether components that are the same in f32 and f64 have their own rows.
    whole: bool,
    /// The line, the calls and the iterations of the last heading.
    last: Option<(usize, Vec<usize>, Vec<u32>)>,
}

impl Writer {
    fn gap(&mut self, skipped: usize) {
        if skipped > 0 {
            let _ = writeln!(self.text, "        … {} steps …", grouped(skipped as u64));
            self.last = None;
        }
    }

    fn line(&mut self, line: &TraceStep, mark: &str) {
        self.heading(line);
        let indent = "  ".repeat(line.calls.len() + 1);
        let only = match (&line.f32, &line.f64) {
            (Some(_), None) => "  only in f32",
            (None, Some(_)) => "  only in f64",
            _ => "",
        };
        let count = line.components.len();
        if count == 0 {
            if !mark.is_empty() || !only.is_empty() {
                let _ = writeln!(self.text, "      {indent}{}{only}{mark}", line.kind);
            }
            return;
        }
        let name = match line.kind {
            "branch" => "condition",
            "return" => "return",
            "subexpression" => &line.text,
            _ => line.name.as_deref().unwrap_or_default(),
        };
        let shown: Vec<usize> = (0..count).filter(|&at| self.whole || !line.agrees(at)).collect();
        if shown.is_empty() && only.is_empty() {
            self.write_equal(&indent, name, line, mark);
            return;
        }
        for &at in &shown {
            let component = &line.components[at];
            let digits = |values: &Option<Vec<Component>>, number_type| {
                let value = values.as_ref().and_then(|values| values.get(at));
                value.map_or_else(|| "-".to_owned(), |value| value.digits(number_type))
            };
            let single = digits(&line.f32, NumberType::Single);
            let double = digits(&line.f64, NumberType::Double);
            let pair =
                |values: &Option<Vec<Component>>| values.as_ref().and_then(|values| values.get(at).copied());
            let distance = match (pair(&line.f32), pair(&line.f64)) {
                (Some(Component::Float(single)), Some(Component::Float(double))) => {
                    in_ulps(toyproof_verify::debug::ulps(single, double))
                }
                _ => String::new(),
            };
            let end = if Some(&at) == shown.last() { mark } else { "" };
            let width = NAME_WIDTH.saturating_sub(indent.len());
            let row = format!(
                "      {indent}{:width$} {single:>NUMBER_WIDTH$} {double:>NUMBER_WIDTH$} {distance:>12}{only}{end}",
                format!("{name}{component}"),
            );
            self.text.push_str(row.trim_end());
            self.text.push('\n');
        }
    }

    /// Writes a value that is the same in f32 and f64, on one line.
    fn write_equal(&mut self, indent: &str, name: &str, line: &TraceStep, mark: &str) {
        let values = line.f32.iter().flatten();
        let values: Vec<_> = values.map(|value| value.digits(NumberType::Single)).collect();
        let values = match &values[..] {
            [value] => value.clone(),
            values => format!("({})", values.join(", ")),
        };
        let _ = writeln!(self.text, "      {indent}{name} = {}{mark}", one_line(&values));
    }

    /// Writes the source line, if it differs from the previous heading.
    fn heading(&mut self, line: &TraceStep) {
        let here = (line.line, line.calls.clone(), line.iterations.clone());
        if self.last.as_ref() == Some(&here) {
            return;
        }
        let indent = "  ".repeat(line.calls.len());
        let calls_before = self.last.as_ref().map(|(_, calls, _)| calls);
        if calls_before != Some(&line.calls)
            && let Some(from) = line.calls.last()
        {
            let _ = writeln!(self.text, "     {indent}{}() at line {from}", line.function);
        }
        let iteration = match line.iterations.last() {
            Some(iteration) if line.kind == "iteration" => format!("   (iteration {iteration})"),
            _ => String::new(),
        };
        let _ = writeln!(self.text, "{:>5} {indent}{}{iteration}", line.line, line.source);
        self.last = Some(here);
    }
}

/// Formats a distance: `0.4 ULP`, `2,104,000 ULP`.
fn in_ulps(ulps: f64) -> String {
    match ulps {
        0.0 => "same".to_owned(),
        _ if !ulps.is_finite() => "different".to_owned(),
        _ if ulps < 0.05 => "<0.1 ULP".to_owned(),
        _ if ulps < 9.95 => format!("{ulps:.1} ULP"),
        _ if ulps < 1e9 => format!("{} ULP", grouped(ulps.round() as u64)),
        _ => format!("{ulps:.0e} ULP"),
    }
}
