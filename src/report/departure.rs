//! Where the values of a wrong shader depart from those of its reference.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::Files;
use toyproof_explain::departure;

use super::reason::excerpt;
use super::repair::SourceRange;

/// Where a wrong shader departs from its reference, at pixels in which they differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Departure {
    /// The first value of the shader that the reference does not have; null if that was not found.
    pub unknown: Option<UnknownValue>,
    /// The first value of the reference that the shader does not have; null if that was not found.
    pub missing: Option<MissingValue>,
}

/// A value of a shader that its reference does not have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnknownValue {
    /// The statement or expression.
    #[serde(flatten)]
    pub range: SourceRange,
    /// The text on one line, shortened, in backticks.
    pub text: String,
    /// The line of the call of the function that contains the statement; null in `mainImage`.
    pub called_at: Option<usize>,
    /// The value; null for a component that is not finite.
    pub value: Vec<Option<f64>>,
    /// The pixel, from the left.
    pub x: u32,
    /// The pixel, from the bottom.
    pub y: u32,
}

/// A value of the reference that the shader does not have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissingValue {
    /// The line of the shader that uses what the reference computes the value from; null if none does.
    pub line: Option<usize>,
    /// The line in the reference.
    pub reference_line: usize,
    /// The text of the statement or expression on one line, shortened, in backticks.
    pub text: String,
    /// The value; null for a component that is not finite.
    pub value: Vec<Option<f64>>,
    /// The pixel, from the left.
    pub x: u32,
    /// The pixel, from the bottom.
    pub y: u32,
}

/// What a sentence about a departure describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DepartureKind {
    /// [`Departure::unknown`]
    FirstDifference,
    /// [`Departure::missing`]
    MissingValue,
}

impl DepartureKind {
    /// The label of the sentence.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::FirstDifference => "first difference",
            Self::MissingValue => "missing value",
        }
    }
}

impl Departure {
    /// Creates the record; `reference` are the files of the reference.
    pub(super) fn new(departure: &departure::Departure, files: &Files, reference: &Files) -> Self {
        let unknown = departure.unknown.as_ref().map(|unknown| UnknownValue {
            range: SourceRange::new(unknown.span, files),
            text: excerpt(files.text(unknown.span)),
            called_at: unknown.call.map(|call| files.position(call).line),
            value: finite(&unknown.value),
            x: unknown.pixel[0],
            y: unknown.pixel[1],
        });
        let missing = departure.missing.as_ref().map(|missing| MissingValue {
            line: missing.user.map(|user| files.position(user).line),
            reference_line: reference.position(missing.span).line,
            text: excerpt(reference.text(missing.span)),
            value: finite(&missing.value),
            x: missing.pixel[0],
            y: missing.pixel[1],
        });
        Self { unknown, missing }
    }

    /// Hides what the reference computes, which is a part of the solution.
    pub(super) fn hide_reference(&mut self) {
        self.missing = None;
    }

    /// The pixel in which the shader departs from its reference.
    #[must_use]
    pub fn pixel(&self) -> Option<[u32; 2]> {
        let unknown = self.unknown.as_ref().map(|unknown| [unknown.x, unknown.y]);
        unknown.or_else(|| self.missing.as_ref().map(|missing| [missing.x, missing.y]))
    }

    /// Sentences, each with what it describes.
    pub(super) fn sentences(&self) -> Vec<(DepartureKind, String)> {
        let unknown = self.unknown.as_ref().map(|unknown| {
            let UnknownValue {
                range,
                text,
                called_at,
                value,
                x,
                y,
            } = unknown;
            let (line, value) = (range.line, tuple(value));
            let call = called_at.map_or_else(String::new, |call| format!(", called in line {call}"));
            let text = format!(
                "line {line}{call}: {text} is {value} at ({x}, {y}), which nothing in the reference is equal to"
            );
            (DepartureKind::FirstDifference, text)
        });
        let missing = self.missing.as_ref().map(|missing| {
            let MissingValue {
                line,
                reference_line,
                text,
                value,
                x,
                y,
            } = missing;
            let value = tuple(value);
            let place = line.map_or_else(String::new, |line| format!("line {line}: "));
            let computed =
                format!("{text} is {value} at ({x}, {y}) in line {reference_line} of the reference");
            (
                DepartureKind::MissingValue,
                format!("{place}{computed}, which nothing in the shader is equal to"),
            )
        });
        unknown.into_iter().chain(missing).collect()
    }
}

fn finite(value: &[f64]) -> Vec<Option<f64>> {
    value
        .iter()
        .map(|&part| part.is_finite().then_some(part))
        .collect()
}

/// A number, or a tuple of them: `0.25`, `(0.25, 1)`.
fn tuple(value: &[Option<f64>]) -> String {
    let number = |part: &Option<f64>| part.map_or_else(|| "not finite".to_owned(), four_digits);
    let parts: Vec<String> = value.iter().map(number).collect();
    match &parts[..] {
        [only] => only.clone(),
        _ => format!("({})", parts.join(", ")),
    }
}

/// Four digits, which distinguish the values that a reader compares.
fn four_digits(number: f64) -> String {
    let text = format!("{number:.3e}");
    let rounded: f64 = text.parse().unwrap_or(number);
    format!("{rounded}")
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Span};

    use super::*;

    #[test]
    fn sentences_name_both_lines_and_values() {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", "float a;\nb = c +\n d;"));
        let mut reference = Files::default();
        let other = reference.add(File::new("r.glsl", "x = c - d;"));
        let found = departure::Departure {
            unknown: Some(departure::UnknownValue {
                span: Span::new(file, 13, 19),
                call: Some(Span::new(file, 0, 5)),
                value: vec![0.123_456, f64::NAN],
                pixel: [3, 4],
            }),
            images: None,
            missing: Some(departure::MissingValue {
                user: Some(Span::new(file, 9, 10)),
                span: Span::new(other, 4, 9),
                value: vec![1.0 / 3.0],
                pixel: [5, 6],
            }),
        };
        let mut record = Departure::new(&found, &files, &reference);
        let sentences: Vec<String> = record.sentences().into_iter().map(|(_, text)| text).collect();
        assert_eq!(
            sentences,
            [
                "line 2, called in line 1: `c + d` is (0.1235, not finite) at (3, 4), which nothing in the reference \
                 is equal to",
                "line 2: `c - d` is 0.3333 at (5, 6) in line 1 of the reference, which nothing in the shader is \
                 equal to",
            ]
        );
        record.hide_reference();
        assert_eq!(record.sentences().len(), 1);
    }
}
