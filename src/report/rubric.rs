//! What a shader earns: points for each question, from a short TOML file.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toml::Spanned;
use toyproof_diagnostic::{Diagnostic, FileId, Files, Span};
use toyproof_scene::of_toml;
use toyproof_verify::compare::{Answer, MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, Verdict};

use super::{Record, details, terminal};

/// The most points of a question.
const MAX_POINTS: f64 = 1e6;

/// Points for what a shader gets right.
#[derive(Debug, Clone)]
pub struct Rubric {
    compiles: f64,
    maths: Question,
    rounding: Question,
    /// Who sees the marks, and when.
    pub visibility: Visibility,
}

/// What a question earns.
#[derive(Debug, Clone, Copy)]
struct Question {
    points: f64,
    /// The share of agreeing pixels that earns nothing, in [0, 1); from there points grow evenly. None: all or nothing.
    partial_from: Option<f64>,
}

/// Who sees the marks, and when, in Gradescope's words.
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

/// What a shader earned for one thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// `compiles`, `maths` or `rounding`.
    pub name: &'static str,
    /// What was earned, in [0, `of`], in hundredths.
    pub points: f64,
    /// What could be.
    pub of: f64,
    /// Why, in words for the author of the shader.
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
    /// Reads a rubric.
    ///
    /// # Errors
    /// What the file should have said, for the first thing that TOML or its schema refuses, or for every value
    /// that is out of range.
    pub fn parse(files: &Files, file: FileId) -> Result<Self, Vec<Diagnostic>> {
        let document: Document = toml::from_str(files.get(file).text())
            .map_err(|error| vec![of_toml("E0503", &error, files, file)])?;
        let mut refused = Vec::new();
        let mut checks = Checks {
            file,
            refused: &mut refused,
        };
        let compiles = document
            .compiles
            .map_or(0.0, |table| checks.points(&table.points));
        let maths = checks.question(document.maths);
        let rounding = checks.question(document.rounding);
        if checks.refused.is_empty() && compiles + maths.points + rounding.points == 0.0 {
            checks.refuse(
                0..0,
                "a rubric needs points for compiles, maths or rounding".to_owned(),
            );
        }
        if refused.is_empty() {
            Ok(Self {
                compiles,
                maths,
                rounding,
                visibility: document.visibility,
            })
        } else {
            Err(refused)
        }
    }

    /// What a shader earned, for each thing that there are points for.
    #[must_use]
    pub fn marks(&self, record: &Record) -> Vec<Mark> {
        let maths = maths(self.maths, record);
        let mut rounding = rounding(self.rounding, record);
        // A black picture loses no digits.
        if maths.points == 0.0 && maths.of > 0.0 {
            rounding.points = 0.0;
            "counts once maths does".clone_into(&mut rounding.why);
        }
        let marks = [compiles(self.compiles, record), maths, rounding];
        marks.into_iter().filter(|mark| mark.of > 0.0).collect()
    }
}

struct Checks<'a> {
    file: FileId,
    refused: &'a mut Vec<Diagnostic>,
}

impl Checks<'_> {
    fn refuse(&mut self, bytes: Range<usize>, message: String) {
        let span = Span::new(self.file, bytes.start as u32, bytes.end as u32);
        self.refused.push(Diagnostic::error("E0504", message).at(span));
    }

    fn points(&mut self, value: &Spanned<f64>) -> f64 {
        let points = *value.get_ref();
        if !(0.0..=MAX_POINTS).contains(&points) {
            let words = format!("points must be a number from 0 to {MAX_POINTS}, not {points}");
            self.refuse(value.span(), words);
        }
        points
    }

    fn question(&mut self, table: Option<QuestionTable>) -> Question {
        let Some(QuestionTable { points, partial_from }) = table else {
            return Question {
                points: 0.0,
                partial_from: None,
            };
        };
        if let Some(from) = &partial_from
            && !(0.0..1.0).contains(from.get_ref())
        {
            let words = format!(
                "partial_from must be a share of the pixels, at least 0 and below 1, not {}",
                from.get_ref()
            );
            self.refuse(from.span(), words);
        }
        Question {
            points: self.points(&points),
            partial_from: partial_from.map(Spanned::into_inner),
        }
    }
}

impl Question {
    /// The points for that share of agreeing pixels, in hundredths, rounded down so that nothing but all is all.
    fn partial(self, agreeing: f64) -> f64 {
        let from = match self.partial_from {
            Some(from) if agreeing > from => from,
            _ => return 0.0,
        };
        (100.0 * self.points * (agreeing - from) / (1.0 - from)).floor() / 100.0
    }

    /// What an answer earns; `lost` is the share of the pixels that do not agree.
    fn mark(self, name: &'static str, right: bool, lost: f64, why: String) -> Mark {
        let points = if right {
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

    /// What a question earns that has no answer.
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

/// What is said of an answer; of one that has nothing to tell, that.
fn said(words: String) -> String {
    if words.is_empty() {
        "no pixel differs".to_owned()
    } else {
        words
    }
}

fn compiles(points: f64, record: &Record) -> Mark {
    let question = Question {
        points,
        partial_from: None,
    };
    let right = record.verdict != Verdict::Invalid;
    let why = if right {
        "the shader compiles".to_owned()
    } else {
        details(record)
    };
    question.mark("compiles", right, 1.0, why)
}

fn maths(question: Question, record: &Record) -> Mark {
    let name = "maths";
    let Some(answer) = &record.maths else {
        return question.unanswered(name, record);
    };
    let right =
        answer.share(answer.differing) <= MAX_DIFFERING && answer.share(answer.undefined) <= MAX_UNDEFINED;
    let lost = answer.share(answer.differing + answer.undefined);
    let mistake = record.mistake.iter().map(|mistake| mistake.says.clone());
    let why: Vec<_> = [said(terminal::maths(answer))]
        .into_iter()
        .chain(mistake)
        .collect();
    question.mark(name, right, lost, why.join("; "))
}

/// A pixel that hangs by a hair is lost to rounding, too.
fn rounding(question: Question, record: &Record) -> Mark {
    let name = "rounding";
    let Some(answer) = &record.rounding else {
        return question.unanswered(name, record);
    };
    let hanging = record
        .maths
        .as_ref()
        .map_or(0.0, |answer: &Answer| answer.share(answer.undecided));
    let lost = answer.share(answer.differing).max(hanging);
    question.mark(name, lost <= MAX_UNSTABLE, lost, said(terminal::rounding(answer)))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, short};

    use super::*;
    use crate::report::tests::{correct, invalid, question, record};

    fn read(text: &str) -> Result<Rubric, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("r.toml", text));
        Rubric::parse(&files, file).map_err(|told| told.iter().map(|told| short(told, &files)).collect())
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
    fn each_mistake_is_told_by_line_column_and_what_was_expected() {
        for (text, place, words) in [
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
                errors[0].starts_with(place) && errors[0].contains(words),
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
    fn all_that_is_right_earns_all_and_nothing_that_does_not_compile() {
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
    fn partial_points_grow_evenly_and_never_reach_all() {
        let wrong = |differing| {
            let mut record = record(Verdict::Wrong);
            record.maths = Some(question([differing, 0, 0]));
            record.rounding = Some(question([0; 3]));
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
    fn what_hangs_by_a_hair_is_rounding_and_what_is_undefined_is_maths() {
        let of = |maths, rounding| {
            let mut record = record(Verdict::Unstable);
            record.maths = Some(question(maths));
            record.rounding = Some(question(rounding));
            let earned = points(RUBRIC, &record);
            (earned[1].1, earned[2].1)
        };
        assert_eq!(of([0, 10, 0], [0; 3]), (6.0, 0.0));
        assert_eq!(of([0; 3], [10, 0, 0]), (6.0, 0.0));
        assert_eq!(of([0, 0, 100], [0; 3]), (4.8, 2.0));
    }
}
