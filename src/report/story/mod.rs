//! The story of a pixel, for people and for programs.

mod component;
mod human;

use serde::Serialize;
use toyproof_diagnostic::{Files, Span};
use toyproof_eval::{Event, Plot, Told, What};
use toyproof_glsl::tree::Tree;
use toyproof_verify::explain::{Explanation, Step};

use self::component::{Component, components, typed};

/// What a pixel does in f32 and in f64, with the author's words and lines.
#[derive(Debug, Serialize)]
pub struct Story {
    version: u32,
    shader: String,
    /// From the left and from the bottom.
    pixel: [u32; 2],
    size: [u32; 2],
    /// The colours that it ends with.
    /// Null if the pixel is discarded.
    f32: Option<[Component; 3]>,
    f64: Option<[Component; 3]>,
    /// The step where the two first part; null if they do not.
    parts_at: Option<usize>,
    /// The step that a visible difference of the colours comes of; null if there is none.
    cause_at: Option<usize>,
    /// The first step with a NaN in f32, or with an infinity if the colour is infinite; null if there is none.
    not_finite_at: Option<usize>,
    /// Whether there were too many steps, and the last are missing.
    cut: bool,
    steps: Vec<Line>,
}

/// One step.
#[derive(Debug, Serialize)]
#[expect(clippy::struct_field_names, reason = "the names are those of the JSON")]
struct Line {
    /// `stored`, `part`, `branch`, `round`, `returned` or `ran`.
    what: &'static str,
    line: usize,
    column: usize,
    /// The whole line.
    #[serde(skip)]
    source: String,
    /// The text that it comes from.
    text: String,
    /// The variable, or the part of one, that is stored to.
    name: Option<String>,
    /// The function that runs.
    function: String,
    /// The lines of the calls around it, the outermost first.
    calls: Vec<usize>,
    /// The round of each loop around it, the outermost first, from 1.
    rounds: Vec<u32>,
    /// The names of the components, as they stand behind the variable's: `.x`.
    components: Vec<String>,
    /// Null if it did not happen in f32.
    f32: Option<Vec<Component>>,
    f64: Option<Vec<Component>>,
    /// The component that differs most.
    #[serde(skip)]
    worst: Option<usize>,
    /// The largest distance in units in the last place of f32; null without floats in both, and of what is infinitely far.
    ulp: Option<f64>,
}

/// Whose story is told.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The shader's name.
    pub shader: &'a str,
    /// Its text.
    pub files: &'a Files,
    /// Its tree.
    pub tree: &'a Tree,
    /// Pixels from the left and from the bottom.
    pub pixel: [u32; 2],
    /// The frame's.
    pub size: [u32; 2],
}

impl Story {
    /// Puts an explanation into the author's words.
    #[must_use]
    pub fn new(subject: &Subject<'_>, explanation: &Explanation<'_>) -> Self {
        let plot = explanation.plot;
        let lines = explanation
            .steps
            .iter()
            .map(|step| Line::new(subject, plot, step));
        let colour = |colour: [f64; 3]| colour.map(Component::Float);
        Self {
            version: 1,
            shader: subject.shader.to_owned(),
            pixel: subject.pixel,
            size: subject.size,
            f32: explanation.single.map(colour),
            f64: explanation.double.map(colour),
            parts_at: explanation.parting,
            cause_at: explanation.cause,
            not_finite_at: explanation.not_finite,
            cut: explanation.is_cut,
            steps: lines.collect(),
        }
    }

    /// As the text of a JSON file.
    #[must_use]
    pub fn json(&self) -> String {
        // Strings, numbers and options always serialise.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

impl Line {
    fn new(subject: &Subject<'_>, plot: &Plot, step: &Step) -> Self {
        let Subject { files, tree, .. } = *subject;
        let event = plot.event(step.event);
        let at = files.position(event.at.span);
        let name = match event.what {
            What::Stored(target) => Some(one_line(files.text(target.span))),
            _ => None,
        };
        let (function, calls) = calls(subject, plot, event);
        let ty = event.ty;
        let values = |told: &Option<Vec<Told>>| told.as_ref().map(|told| typed(tree, ty, told));
        let (single, double) = (values(&step.single), values(&step.double));
        let count = single.as_ref().or(double.as_ref()).map_or(0, Vec::len);
        Self {
            what: match event.what {
                What::Stored(_) => "stored",
                What::Part => "part",
                What::Branch => "branch",
                What::Round => "round",
                What::Returned => "returned",
                What::Ran => "ran",
            },
            line: at.line,
            column: at.column,
            source: whole_line(files, event.at.span),
            text: one_line(files.text(event.at.span)),
            name,
            function,
            calls,
            rounds: step.rounds(),
            components: if count == 0 {
                Vec::new()
            } else {
                components(tree, ty)
            },
            f32: single,
            f64: double,
            worst: step.worst().map(|(at, ..)| at),
            ulp: step.ulps().filter(|ulps| ulps.is_finite()),
        }
    }
}

/// The function that an event is in, and the lines of the calls that lead there.
fn calls(subject: &Subject<'_>, plot: &Plot, event: &Event) -> (String, Vec<usize>) {
    let mut lines = Vec::new();
    let mut next = event.call;
    while let Some(id) = next {
        let call = plot.call(id);
        lines.push(subject.files.position(call.at.span).line);
        next = call.parent;
    }
    lines.reverse();
    let function = event
        .call
        .map_or("mainImage", |id| &subject.tree[plot.call(id).function].name);
    (function.to_owned(), lines)
}

/// The line that a span begins in.
fn whole_line(files: &Files, span: Span) -> String {
    let text = files.get(span.file).text();
    let (before, after) = text.split_at(span.start as usize);
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let end = after.find('\n').map_or(text.len(), |at| before.len() + at);
    one_line(&text[start..end])
}

/// A text without its line breaks, shortened in the middle of nowhere if it is long.
fn one_line(text: &str) -> String {
    const LONGEST: usize = 100;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.chars().count() <= LONGEST {
        return text;
    }
    text.chars().take(LONGEST - 1).chain(['…']).collect()
}
