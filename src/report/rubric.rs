//! The points that a shader earns for each check, defined by a short TOML file.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toml::Spanned;
use toyproof_diagnostic::{Diagnostic, Diagnostics, FileId, Files, Span};
use toyproof_scene::toml_diagnostic;
use toyproof_verify::compare::CheckSummary;
use toyproof_verify::{MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, Verdict};

use super::{Record, details, terminal};

/// The maximum points of a check.
const MAX_POINTS: f64 = 1e6;

/// The points of each check.
#[derive(Debug, Clone)]
pub struct Rubric {
    compiles: f64,
    maths: CheckPoints,
    rounding: CheckPoints,
    /// Who sees the marks, and when.
    pub visibility: Visibility,
}

/// The points of one check.
#[derive(Debug, Clone, Copy)]
struct CheckPoints {
    points: f64,
    /// The share of agreeing pixels up to which nothing is earned, in [0, 1); from there points grow
    /// linearly. None: no partial points.
    partial_from: Option<f64>,
}

/// Who sees the marks, and when; the names are Gradescope's.
#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Students, at once.
    #[default]
    Visible,
    /// Teachers alone.
    Hidden,
    /// Students, once the assignment is due.
    AfterDueDate,
    /// Students, once marks are published.
    AfterPublished,
}

/// The points that a shader earned for one check.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// `compiles`, `maths` or `rounding`.
    pub name: &'static str,
    /// The points earned, in [0, `of`], rounded to hundredths.
    pub points: f64,
    /// The maximum points.
    pub of: f64,
    /// The reason, for the author of the shader.
    pub why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    visibility: Visibility,
    compiles: Option<CompilesTable>,
    maths: Option<QuestionTable>,
    rounding: Option<QuestionTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CompilesTable {
    points: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct QuestionTable {
    points: Spanned<f64>,
    partial_from: Option<Spanned<f64>>,
}

impl Rubric {
    /// Parses a rubric.
    ///
    /// # Errors
    /// The first syntax or schema error of the TOML, or all values that are out of range.
    pub fn parse(files: &Files, file: FileId) -> Result<Self, Diagnostics> {
        let document: Document = toml::from_str(files.get(file).text())
            .map_err(|error| Diagnostics::new(vec![toml_diagnostic("E0503", &error, files, file)], files))?;
        let mut errors = Vec::new();
        let mut parser = Parser {
            file,
            errors: &mut errors,
        };
        let compiles = document
            .compiles
            .map_or(0.0, |table| parser.points(&table.points));
        let maths = parser.check(document.maths);
        let rounding = parser.check(document.rounding);
        if parser.errors.is_empty() && compiles + maths.points + rounding.points == 0.0 {
            parser.reject(
                0..0,
                "a rubric needs points for compiles, maths or rounding".to_owned(),
            );
        }
        if errors.is_empty() {
            Ok(Self {
                compiles,
                maths,
                rounding,
                visibility: document.visibility,
            })
        } else {
            Err(Diagnostics::new(errors, files))
        }
    }

    /// Computes the marks of a shader, one for each check that has points.
    #[must_use]
    pub fn marks(&self, record: &Record) -> Vec<Mark> {
        let maths = maths(self.maths, record);
        let mut rounding = rounding(self.rounding, record);
        // A black image has no rounding errors.
        if maths.points == 0.0 && maths.of > 0.0 {
            rounding.points = 0.0;
            "counts once maths does".clone_into(&mut rounding.why);
        }
        let marks = [compiles(self.compiles, record), maths, rounding];
        marks.into_iter().filter(|mark| mark.of > 0.0).collect()
    }
}

struct Parser<'a> {
    file: FileId,
    errors: &'a mut Vec<Diagnostic>,
}

impl Parser<'_> {
    fn reject(&mut self, bytes: Range<usize>, message: String) {
        let span = Span::new(self.file, bytes.start as u32, bytes.end as u32);
        self.errors.push(Diagnostic::error("E0504", message).at(span));
    }

    fn points(&mut self, value: &Spanned<f64>) -> f64 {
        let points = *value.get_ref();
        if !(0.0..=MAX_POINTS).contains(&points) {
            let message = format!("points must be a number from 0 to {MAX_POINTS}, not {points}");
            self.reject(value.span(), message);
        }
        points
    }

    fn check(&mut self, table: Option<QuestionTable>) -> CheckPoints {
        let Some(QuestionTable { points, partial_from }) = table else {
            return CheckPoints {
                points: 0.0,
                partial_from: None,
            };
        };
        if let Some(from) = &partial_from
            && !(0.0..1.0).contains(from.get_ref())
        {
            let message = format!(
                "partial_from must be a share of the pixels, at least 0 and below 1, not {}",
                from.get_ref()
            );
            self.reject(from.span(), message);
        }
        CheckPoints {
            points: self.points(&points),
            partial_from: partial_from.map(Spanned::into_inner),
        }
    }
}

impl CheckPoints {
    /// The points for a share of agreeing pixels, in hundredths, rounded down so that only full agreement
    /// earns all.
    fn partial(self, agreeing: f64) -> f64 {
        let from = match self.partial_from {
            Some(from) if agreeing > from => from,
            _ => return 0.0,
        };
        (100.0 * self.points * (agreeing - from) / (1.0 - from)).floor() / 100.0
    }

    /// The mark of an answer; `lost` is the share of the pixels that do not agree.
    fn mark(self, name: &'static str, passed: bool, lost: f64, why: String) -> Mark {
        let points = if passed {
            self.points
        } else {
            self.partial(1.0 - lost)
        };
        Mark {
            name,
            points,
            of: self.points,
            why,
        }
    }

    /// The mark of a check without an answer.
    fn unanswered(self, name: &'static str, record: &Record) -> Mark {
        let why = match record.verdict {
            Verdict::Invalid => "the shader does not compile".to_owned(),
            Verdict::Error => format!(
                "could not be judged, which is not the shader's fault: {}",
                record.reason
            ),
            _ => record.reason.clone(),
        };
        self.mark(name, false, 1.0, why)
    }
}

/// Replaces the empty description of an answer without differences.
fn or_no_difference(message: String) -> String {
    if message.is_empty() {
        "no pixel differs".to_owned()
    } else {
        message
    }
}

fn compiles(points: f64, record: &Record) -> Mark {
    let check = CheckPoints {
        points,
        partial_from: None,
    };
    let passed = record.verdict != Verdict::Invalid;
    let why = if passed {
        "the shader compiles".to_owned()
    } else {
        details(record)
    };
    check.mark("compiles", passed, 1.0, why)
}

fn maths(check: CheckPoints, record: &Record) -> Mark {
    let name = "maths";
    let Some(answer) = &record.algorithm else {
        return check.unanswered(name, record);
    };
    let passed =
        answer.share(answer.differing) <= MAX_DIFFERING && answer.share(answer.undefined) <= MAX_UNDEFINED;
    let lost = answer.share(answer.differing + answer.undefined);
    let mistake = record.mistake.iter().map(|mistake| mistake.text.clone());
    let why: Vec<_> = [or_no_difference(terminal::algorithm(answer))]
        .into_iter()
        .chain(mistake)
        .collect();
    check.mark(name, passed, lost, why.join("; "))
}

/// Ill-conditioned pixels count as lost to rounding, too.
fn rounding(check: CheckPoints, record: &Record) -> Mark {
    let name = "rounding";
    let Some(answer) = &record.precision else {
        return check.unanswered(name, record);
    };
    let ill_conditioned = record
        .algorithm
        .as_ref()
        .map_or(0.0, |answer: &CheckSummary| answer.share(answer.ill_conditioned));
    let lost = answer.share(answer.differing).max(ill_conditioned);
    check.mark(
        name,
        lost <= MAX_UNSTABLE,
        lost,
        or_no_difference(terminal::precision(answer)),
    )
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, short};

    use super::*;
    use crate::report::record::samples::{correct, invalid, question, record};

    fn read(text: &str) -> Result<Rubric, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("r.toml", text));
        Rubric::parse(&files, file)
            .map_err(|errors| errors.iter().map(|error| short(error, &files)).collect())
    }

    fn points(rubric: &str, record: &Record) -> Vec<(&'static str, f64, f64)> {
        let marks = read(rubric).unwrap().marks(record);
        marks
            .into_iter()
            .map(|mark| (mark.name, mark.points, mark.of))
            .collect()
    }

    const RUBRIC: &str =
        "[compiles]\npoints = 2\n[maths]\npoints = 6\npartial_from = 0.5\n[rounding]\npoints = 2";

    #[test]
    fn errors_have_a_position_and_the_expected_value() {
        for (text, place, message) in [
            (
                "[maths]\npoint = 1",
                "r.toml:2:1: error[E0503]",
                "unknown field `point`",
            ),
            (
                "[style]\npoints = 1",
                "r.toml:1:2: error[E0503]",
                "expected one of",
            ),
            (
                "[maths]\npoints = \"all\"",
                "r.toml:2:10: error[E0503]",
                "expected a number",
            ),
            (
                "[maths]\npartial_from = 0.5",
                "r.toml:1:1: error[E0503]",
                "missing field `points`",
            ),
            (
                "visibility = \"all\"",
                "r.toml:1:14: error[E0503]",
                "unknown variant `all`",
            ),
            (
                "[maths]\npoints = -1",
                "r.toml:2:10: error[E0504]",
                "from 0 to 1000000, not -1",
            ),
            ("[maths]\npoints = nan", "r.toml:2:10: error[E0504]", "not NaN"),
            (
                "[maths]\npoints = 1\npartial_from = 1",
                "r.toml:3:16: error[E0504]",
                "below 1, not 1",
            ),
            ("", "r.toml:1:1: error[E0504]", "needs points"),
            ("[maths]\npoints = 0", "r.toml:1:1: error[E0504]", "needs points"),
        ] {
            let errors = read(text).unwrap_err();
            assert!(
                errors[0].starts_with(place) && errors[0].contains(message),
                "{text}: {errors:?}"
            );
        }
        assert_eq!(
            read("[maths]\npoints = -1\npartial_from = 2").unwrap_err().len(),
            2,
            "all at once"
        );
    }

    #[test]
    fn correct_shaders_earn_all_points_and_invalid_ones_none() {
        let all = [
            ("compiles", 2.0, 2.0),
            ("maths", 6.0, 6.0),
            ("rounding", 2.0, 2.0),
        ];
        assert_eq!(points(RUBRIC, &correct()), all);
        assert_eq!(
            points(RUBRIC, &invalid()),
            all.map(|(name, _, of)| (name, 0.0, of))
        );
        assert_eq!(points("[maths]\npoints = 1", &correct()), [("maths", 1.0, 1.0)]);
    }

    #[test]
    fn partial_points_grow_linearly_and_never_reach_all() {
        let wrong = |differing| {
            let mut record = record(Verdict::Wrong);
            record.algorithm = Some(question([differing, 0, 0]));
            record.precision = Some(question([0; 3]));
            record
        };
        let maths = |rubric, differing| points(rubric, &wrong(differing))[1];
        assert_eq!(maths(RUBRIC, 1), ("maths", 6.0, 6.0), "within what is allowed");
        assert_eq!(maths(RUBRIC, 2), ("maths", 5.97, 6.0));
        assert_eq!(maths(RUBRIC, 250), ("maths", 3.0, 6.0));
        assert_eq!(maths(RUBRIC, 500), ("maths", 0.0, 6.0));
        assert_eq!(maths(RUBRIC, 1000), ("maths", 0.0, 6.0));
        let strict = RUBRIC.replace("partial_from = 0.5", "");
        assert_eq!(maths(&strict, 2), ("maths", 0.0, 6.0));
        let rounding = |differing| points(RUBRIC, &wrong(differing))[2].1;
        assert_eq!(
            (rounding(250), rounding(500)),
            (2.0, 0.0),
            "a black picture loses no digits"
        );
    }

    #[test]
    fn ill_conditioned_pixels_are_rounding_and_undefined_ones_maths() {
        let of = |maths, rounding| {
            let mut record = record(Verdict::Unstable);
            record.algorithm = Some(question(maths));
            record.precision = Some(question(rounding));
            let earned = points(RUBRIC, &record);
            (earned[1].1, earned[2].1)
        };
        assert_eq!(of([0, 10, 0], [0; 3]), (6.0, 0.0));
        assert_eq!(of([0; 3], [10, 0, 0]), (6.0, 0.0));
        assert_eq!(of([0, 0, 100], [0; 3]), (4.8, 2.0));
    }
}
