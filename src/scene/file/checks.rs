//! Checked values of a scene file, and diagnostics for those that are refused.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;
use toyproof_diagnostic::{Diagnostic, Diagnostics, FileId, Files, Span};
use toyproof_image::check_size;

use super::super::{Color, Point, Scene};

pub(super) type Pair = Spanned<[f64; 2]>;
pub(super) type Triple = Spanned<[f64; 3]>;

pub(super) fn span(file: FileId, bytes: Range<usize>) -> Span {
    Span::new(file, bytes.start as u32, bytes.end.max(bytes.start) as u32)
}

pub(super) struct Checks {
    file: FileId,
    diagnostics: Vec<Diagnostic>,
}

impl Checks {
    pub(super) fn new(file: FileId) -> Self {
        Self {
            file,
            diagnostics: Vec::new(),
        }
    }

    /// Returns the scene, or the diagnostics if anything was refused.
    pub(super) fn finish(self, scene: Scene, files: &Files) -> Result<Scene, Diagnostics> {
        if self.diagnostics.is_empty() {
            Ok(scene)
        } else {
            Err(Diagnostics::new(self.diagnostics, files))
        }
    }

    pub(super) fn refuse(&mut self, bytes: Range<usize>, message: String) {
        self.diagnostics
            .push(Diagnostic::error("E0502", message).at(span(self.file, bytes)));
    }

    /// Refuses a valid file that shows nothing: most likely it is unfinished, or not a scene.
    pub(super) fn refuse_empty(&mut self) {
        if self.diagnostics.is_empty() {
            let message =
                "this scene shows nothing; give it a surface such as `[[sphere]]`, or a `[background]`";
            self.refuse(0..0, message.to_owned());
        }
    }

    /// Refuses a key that belongs to a different kind of the item.
    pub(super) fn refuse_key<T>(&mut self, key: &str, value: Option<&Spanned<T>>, owner: &str, actual: &str) {
        if let Some(value) = value {
            self.refuse(
                value.span(),
                format!("{key} belongs to \"{owner}\", not to \"{actual}\""),
            );
        }
    }

    /// Returns the value of a required key; `place` is where the kind is named.
    pub(super) fn required<T>(&mut self, key: &str, value: Option<T>, place: &Range<usize>) -> Option<T> {
        if value.is_none() {
            self.refuse(place.clone(), format!("{key} is missing"));
        }
        value
    }

    pub(super) fn finite(&mut self, what: &str, value: &Spanned<f64>) -> f64 {
        let number = *value.get_ref();
        if !number.is_finite() {
            self.refuse(
                value.span(),
                format!("{what} must be a finite number, not {number}"),
            );
        }
        number
    }

    pub(super) fn pair(&mut self, what: &str, value: &Pair) -> [f64; 2] {
        if !value.get_ref().iter().all(|x| x.is_finite()) {
            self.refuse(value.span(), format!("{what} must be two finite numbers"));
        }
        *value.get_ref()
    }

    pub(super) fn point(&mut self, what: &str, value: Option<Triple>, default: Point) -> Point {
        let Some(value) = value else {
            return default;
        };
        if !value.get_ref().iter().all(|x| x.is_finite()) {
            self.refuse(value.span(), format!("{what} must be three finite numbers"));
        }
        value.into_inner()
    }

    /// Returns a direction, normalized; it may have any length but 0.
    pub(super) fn direction(&mut self, what: &str, value: Option<Triple>, default: Point) -> Point {
        let Some(value) = value else {
            return default;
        };
        let vector = DVec3::from_array(*value.get_ref());
        let largest = vector.abs().max_element();
        if !(vector.is_finite() && largest > 0.0) {
            self.refuse(
                value.span(),
                format!("{what} must be three finite numbers, not all of them 0"),
            );
            return default;
        }
        (vector / largest).normalize().to_array()
    }

    pub(super) fn color(&mut self, what: &str, value: Option<Triple>, default: Color) -> Color {
        let Some(value) = value else {
            return default;
        };
        if !value.get_ref().iter().all(|x| x.is_finite() && *x >= 0.0) {
            self.refuse(
                value.span(),
                format!("{what} must be three finite numbers, none below 0"),
            );
        }
        value.into_inner()
    }

    pub(super) fn positive(&mut self, what: &str, value: &Spanned<f64>) -> f64 {
        let number = *value.get_ref();
        if !(number.is_finite() && number > 0.0) {
            self.refuse(
                value.span(),
                format!("{what} must be a finite number above 0, not {number}"),
            );
        }
        number
    }

    /// Returns a number from 0 to 1.
    pub(super) fn share(&mut self, what: &str, value: &Spanned<f64>) -> f64 {
        let number = *value.get_ref();
        if !(0.0..=1.0).contains(&number) {
            self.refuse(
                value.span(),
                format!("{what} must be a number from 0 to 1, not {number}"),
            );
        }
        number
    }

    pub(super) fn count(&mut self, what: &str, value: Option<Spanned<i64>>, max: i64) -> u32 {
        let Some(value) = value else {
            return 1;
        };
        let number = *value.get_ref();
        if !(1..=max).contains(&number) {
            self.refuse(
                value.span(),
                format!("{what} must be a whole number from 1 to {max}, not {number}"),
            );
        }
        number as u32
    }

    pub(super) fn size(&mut self, value: Option<Spanned<[i64; 2]>>) -> [u32; 2] {
        let Some(value) = value else {
            return [640, 360];
        };
        let [width, height] = value.get_ref().map(|side| side.max(0) as u64);
        check_size(width, height).unwrap_or_else(|error| {
            self.refuse(value.span(), error.to_string());
            [1, 1]
        })
    }
}

// Diagnostics for errors of the TOML parser.

/// Converts an error of the TOML parser or of deserialization to a diagnostic.
#[must_use]
pub fn toml_diagnostic(
    code: &'static str,
    error: &::toml::de::Error,
    files: &Files,
    file: FileId,
) -> Diagnostic {
    let lines: Vec<_> = error.message().lines().map(str::trim).collect();
    let bytes = error.span().unwrap_or_default();
    let span = span(file, bytes);
    let message = header_hint(error.message(), files.text(span)).unwrap_or_else(|| {
        let terms = RUST_TERMS.iter();
        terms.fold(lines.join("; "), |message, (rust, toml)| {
            message.replace(rust, toml)
        })
    });
    Diagnostic::error(code, message).at(span)
}

/// Rust's names of types, and TOML's.
const RUST_TERMS: [(&str, &str); 4] = [
    ("invalid type: map", "invalid type: a table"),
    ("expected f64", "expected a number"),
    ("expected i64", "expected a whole number"),
    ("expected a sequence", "expected a list"),
];

/// Returns the message for a table whose header is that of an array of tables, or the reverse.
fn header_hint(message: &str, written: &str) -> Option<String> {
    let is_table = message.starts_with("invalid type: map, expected ");
    let name = written.trim().trim_matches(['[', ']']);
    if !is_table || !written.starts_with('[') {
        None
    } else if written.starts_with("[[") {
        Some(format!("there is only one such table: write `[{name}]`"))
    } else {
        Some(format!("there may be several such tables: write `[[{name}]]`"))
    }
}
