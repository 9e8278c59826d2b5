//! A story as a terminal shows it.

use std::fmt::Write;

use toyproof_verify::compare::grouped;

use super::{Component, Line, Story};

/// So many steps before and after the parting are shown of a long story, and as many at its beginning and end.
const CONTEXT: usize = 40;

/// The width of a name, and of a number.
const NAME: usize = 26;
const NUMBER: usize = 20;

impl Story {
    /// The story line by line: what each stored and decided. Of a long one, the beginning, the end and what is around the parting,
    /// unless `whole`.
    #[must_use]
    pub fn human(&self, whole: bool) -> String {
        let [x, y] = self.pixel;
        let [width, height] = self.size;
        let mut text = format!("{}, pixel ({x}, {y}) of {width}x{height}\n", self.shader);
        for (name, colour, single) in [("f32", self.f32, true), ("f64", self.f64, false)] {
            let _ = match colour {
                Some(colour) => {
                    let parts = colour.map(|part| part.digits(single));
                    writeln!(text, "  {name} paints ({})", parts.join(", "))
                }
                None => writeln!(text, "  {name} discards it"),
            };
        }
        text.push_str(&self.headline());
        text.push('\n');
        let mut writer = Writer { text, last: None };
        let mut skipped = 0;
        for (index, line) in self.steps.iter().enumerate() {
            let mark = self.mark(index);
            if line.what == "part" && !whole && mark.is_none() {
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
                .push_str("  … and so on: the rest was too long to be kept\n");
        }
        writer.text
    }

    fn is_near(&self, index: usize) -> bool {
        let from_end = self.steps.len() - index;
        let marked = [self.parts_at, self.cause_at, self.not_finite_at];
        let near = |step: usize| step.abs_diff(index) <= CONTEXT;
        index < CONTEXT || from_end <= CONTEXT || marked.into_iter().flatten().any(near)
    }

    /// Where the two part, and what is seen of it.
    fn headline(&self) -> String {
        let mut text = String::new();
        match self.parts_at {
            None => text.push_str("  they never part: float32 is enough here\n"),
            Some(at) => {
                let _ = writeln!(text, "  they first part in {}", self.steps[at].difference());
            }
        }
        if let Some(at) = self.cause_at {
            let _ = match self.parts_at {
                Some(first) if first == at => writeln!(text, "  and that is what is seen"),
                _ => writeln!(text, "  what is seen comes of {}", self.steps[at].difference()),
            };
        }
        if let Some(at) = self.not_finite_at {
            let Line {
                line,
                column,
                text: source,
                ..
            } = &self.steps[at];
            let _ = writeln!(
                text,
                "  what is not finite comes of line {line}, column {column}: `{source}`"
            );
        }
        text
    }

    /// The steps that are marked, each with its mark.
    fn mark(&self, index: usize) -> Option<&'static str> {
        let is = |step: Option<usize>| step == Some(index);
        match () {
            () if is(self.cause_at) => Some("  <- what is seen comes of this"),
            () if is(self.parts_at) => Some("  <- here they part"),
            () if is(self.not_finite_at) => Some("  <- no longer finite"),
            () => None,
        }
    }
}

impl Line {
    /// Where the two part here, in a sentence.
    fn difference(&self) -> String {
        let place = format!("line {}, column {}", self.line, self.column);
        let (Some(single), Some(double)) = (&self.f32, &self.f64) else {
            let only = if self.f32.is_some() { "f32" } else { "f64" };
            return format!("{place}: only {only} comes to `{}`", self.text);
        };
        let Some(worst) = self.worst else {
            return place;
        };
        let (single, double) = (&single[worst], &double[worst]);
        let component = &self.components[worst];
        let (single, double) = (single.digits(true), double.digits(false));
        let what = match &self.name {
            Some(name) => format!("{name}{component}"),
            None => format!("`{}`{component}", self.text),
        };
        format!("{place}: {what} is {single} in f32 and {double} in f64")
    }
}

struct Writer {
    text: String,
    /// The line, the calls and the rounds that were shown last.
    last: Option<(usize, Vec<usize>, Vec<u32>)>,
}

impl Writer {
    fn gap(&mut self, skipped: usize) {
        if skipped > 0 {
            let _ = writeln!(self.text, "        … {} steps …", grouped(skipped as u64));
            self.last = None;
        }
    }

    fn line(&mut self, line: &Line, mark: &str) {
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
                let _ = writeln!(self.text, "      {indent}{}{only}{mark}", line.what);
            }
            return;
        }
        let name = match line.what {
            "branch" => "?",
            "returned" => "return",
            "part" => &line.text,
            _ => line.name.as_deref().unwrap_or_default(),
        };
        for (at, component) in line.components.iter().enumerate() {
            let digits = |values: &Option<Vec<Component>>, single| {
                let value = values.as_ref().and_then(|values| values.get(at));
                value.map_or_else(|| "-".to_owned(), |value| value.digits(single))
            };
            let (single, double) = (digits(&line.f32, true), digits(&line.f64, false));
            let pair =
                |values: &Option<Vec<Component>>| values.as_ref().and_then(|values| values.get(at).copied());
            let distance = match (pair(&line.f32), pair(&line.f64)) {
                (Some(Component::Float(single)), Some(Component::Float(double))) => {
                    in_ulps(toyproof_verify::explain::ulps(single, double))
                }
                _ => String::new(),
            };
            let end = if at + 1 == count { mark } else { "" };
            let width = NAME.saturating_sub(indent.len());
            let row = format!(
                "      {indent}{:width$} {single:>NUMBER$} {double:>NUMBER$} {distance:>12}{only}{end}",
                format!("{name}{component}"),
            );
            self.text.push_str(row.trim_end());
            self.text.push('\n');
        }
    }

    /// The source line, where another one begins.
    fn heading(&mut self, line: &Line) {
        let here = (line.line, line.calls.clone(), line.rounds.clone());
        if self.last.as_ref() == Some(&here) {
            return;
        }
        let indent = "  ".repeat(line.calls.len());
        let calls_before = self.last.as_ref().map(|(_, calls, _)| calls);
        if calls_before != Some(&line.calls)
            && let Some(from) = line.calls.last()
        {
            let _ = writeln!(
                self.text,
                "     {indent}in {}, called in line {from}:",
                line.function
            );
        }
        let round = match line.rounds.last() {
            Some(round) if line.what == "round" => format!("   (round {round})"),
            _ => String::new(),
        };
        let _ = writeln!(self.text, "{:>5} {indent}{}{round}", line.line, line.source);
        self.last = Some(here);
    }
}

/// `0.4 ULP`, `2,104,000 ULP`.
fn in_ulps(ulps: f64) -> String {
    match ulps {
        0.0 => "same".to_owned(),
        _ if !ulps.is_finite() => "apart".to_owned(),
        _ if ulps < 0.05 => "<0.1 ULP".to_owned(),
        _ if ulps < 9.95 => format!("{ulps:.1} ULP"),
        _ if ulps < 1e9 => format!("{} ULP", grouped(ulps.round() as u64)),
        _ => format!("{ulps:.0e} ULP"),
    }
}
