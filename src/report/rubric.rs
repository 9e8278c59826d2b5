//! The points that a shader earns for each check, defined by a short TOML file.

use std::borrow::Cow;

use serde::Serialize;
use toyproof_diagnostic::{Code, Diagnostics, FileId, Files, grouped};
use toyproof_toml::{Format, Located, Table};
use toyproof_verify::compare::CheckSummary;
use toyproof_verify::{MAX_UNDEFINED, MAX_UNSTABLE, Verdict, is_different};

use super::frames::FrameChecks;
use super::{Late, Record, details, terminal};

/// The maximum points of a check: a larger number is a typing error.
const MAX_POINTS: u32 = 1_000_000;

/// Rubrics.
static FORMAT: Format = Format {
    form_code: Code::RubricSyntax,
    value_code: Code::RubricValue,
    aliases: &[],
};

/// The points of each check.
#[derive(Debug, Clone, Default)]
pub struct Rubric {
    compiles: f64,
    algorithm: CheckPoints,
    precision: CheckPoints,
    late: Option<LateDeduction>,
    /// Who sees the marks, and when.
    pub visibility: Visibility,
    /// The images that students see next to their marks.
    pub images: StudentImages,
}

/// The points of one check.
#[derive(Debug, Clone, Copy, Default)]
struct CheckPoints {
    points: f64,
    /// The share of agreeing pixels up to which nothing is earned, in [0, 1); from there points grow
    /// linearly. `None`: no partial points.
    partial_from: Option<f64>,
}

/// Who sees the marks, and when; the names are Gradescope's.
#[derive(Debug, Clone, Copy, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Students, immediately.
    #[default]
    Visible,
    /// Teachers alone.
    Hidden,
    /// Students, once the assignment is due.
    AfterDueDate,
    /// Students, once marks are published.
    AfterPublished,
}

/// The images that students see next to their marks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum StudentImages {
    /// The rendered image, the reference, and the difference.
    #[default]
    All,
    /// The rendered image.
    Rendered,
    /// None.
    None,
}

/// The deduction for a late submission.
#[derive(Debug, Clone, Copy)]
struct LateDeduction {
    /// The share of the maximum points for each day, in percent; the last day may have only begun.
    percent_per_day: f64,
    /// The largest share, in percent.
    max_percent: f64,
}

/// The points that a shader earned for one check.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// `compiles`, `algorithm` or `precision`; of an assignment also `rules`, or the name of a function;
    /// `late` for the deduction for a late submission, and `decision` for what a teacher's decision adds.
    pub name: Cow<'static, str>,
    /// The points earned, in [0, `of`], rounded to hundredths; negative for `late`, and any for `decision`.
    pub points: f64,
    /// The maximum points.
    pub of: f64,
    /// The reason, for the author of the shader.
    pub why: String,
}

const VISIBILITIES: [(&str, Visibility); 4] = [
    ("visible", Visibility::Visible),
    ("hidden", Visibility::Hidden),
    ("after_due_date", Visibility::AfterDueDate),
    ("after_published", Visibility::AfterPublished),
];

const STUDENT_IMAGES: [(&str, StudentImages); 3] = [
    ("all", StudentImages::All),
    ("rendered", StudentImages::Rendered),
    ("none", StudentImages::None),
];

impl Rubric {
    /// Parses a rubric.
    ///
    /// # Errors
    /// The first syntax error of the TOML, or all other errors.
    pub fn parse(files: &Files, file: FileId) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let rubric = Self::read(document);
            document.report_unknown_keys();
            if document.is_valid() && rubric.check_points() == 0.0 {
                let help = "add a table such as [algorithm] with `points = 6`";
                document.reject(document.span(), "the rubric gives no points", help);
            }
            rubric
        })
    }

    /// Reads a rubric that is a table of a file.
    #[must_use]
    pub fn read(table: &mut Table) -> Self {
        let visibility = table.choice("visibility", "visibility", &VISIBILITIES);
        let images = table.choice("images", "choice of images", &STUDENT_IMAGES);
        let compiles = table.table("compiles", points);
        let algorithm = table.table("algorithm", check_points);
        let precision = table.table("precision", check_points);
        let late = table.table("late", late_deduction);
        Self {
            compiles: compiles.unwrap_or_default(),
            algorithm: algorithm.unwrap_or_default(),
            precision: precision.unwrap_or_default(),
            late,
            visibility: visibility.map_or_else(Visibility::default, |visibility| visibility.value),
            images: images.map_or_else(StudentImages::default, |images| images.value),
        }
    }

    /// The maximum points of all checks.
    #[must_use]
    pub fn check_points(&self) -> f64 {
        self.compiles + self.algorithm.points + self.precision.points
    }

    /// What a late submission loses, such as “10 % of all points for each day that has begun”.
    #[must_use]
    pub fn late_deduction(&self) -> Option<String> {
        let LateDeduction {
            percent_per_day,
            max_percent,
        } = self.late?;
        let most = if max_percent < 100.0 {
            format!(", at most {max_percent} %")
        } else {
            String::new()
        };
        Some(format!(
            "{percent_per_day} % of all points for each day that has begun{most}"
        ))
    }

    /// Computes the marks of a shader, one for each check, and each part of an assignment, that has points.
    #[must_use]
    pub fn marks(&self, record: &Record) -> Vec<Mark> {
        let marks = match record.decided_verdict() {
            Some(verdict) => self.decided_marks(verdict, record),
            None => self.check_marks(record),
        };
        let marks = marks.into_iter().filter(|mark| mark.of > 0.0);
        let mut marks: Vec<_> = marks.chain(record.assigned_marks()).collect();
        let late = self.late.zip(record.late());
        marks.extend(late.map(|(deduction, late)| deduction.mark(late, &marks)));
        marks.extend(decision(record, &marks));
        marks
    }

    /// The marks of the checks.
    fn check_marks(&self, record: &Record) -> [Mark; 3] {
        let algorithm = algorithm(self.algorithm, record);
        let mut precision = precision(self.precision, record);
        // A black image has no rounding errors.
        if algorithm.points == 0.0 && algorithm.of > 0.0 {
            precision.points = 0.0;
            "not graded: the algorithm check must earn points first".clone_into(&mut precision.why);
        }
        [compiles(self.compiles, record), algorithm, precision]
    }

    /// The marks of the checks that a verdict stands for, which a teacher decided.
    fn decided_marks(&self, verdict: Verdict, record: &Record) -> [Mark; 3] {
        let is_right = verdict.is_good() || matches!(verdict, Verdict::Unstable | Verdict::Chaotic);
        let mark = |name: &'static str, points: f64, passed: bool| Mark {
            name: name.into(),
            points: if passed { points } else { 0.0 },
            of: points,
            why: record.reason.clone(),
        };
        [
            mark("compiles", self.compiles, verdict.is_compiled()),
            mark("algorithm", self.algorithm.points, is_right),
            mark("precision", self.precision.points, verdict.is_good()),
        ]
    }
}

impl LateDeduction {
    /// The mark of a late submission, which loses at most its earned points.
    fn mark(self, late: Late, marks: &[Mark]) -> Mark {
        let percent = (self.percent_per_day * late.days() as f64).min(self.max_percent);
        let sum = |of: fn(&Mark) -> f64| marks.iter().map(of).sum::<f64>();
        let lost = (sum(|mark| mark.of) * percent).round() / 100.0;
        Mark {
            name: "late".into(),
            // Without points, −0 would be shown.
            points: 0.0 - lost.min(sum(|mark| mark.points)),
            of: 0.0,
            why: format!("{late}: {percent} % of all points are deducted"),
        }
    }
}

/// The mark that turns the sum of all others into the points that a teacher decided, if any.
fn decision(record: &Record, marks: &[Mark]) -> Option<Mark> {
    let decision = record.decision.as_ref()?;
    let points = decision.points?;
    let sum = (100.0 * marks.iter().map(|mark| mark.points).sum::<f64>()).round() / 100.0 + 0.0;
    Some(Mark {
        name: "decision".into(),
        points: (100.0 * (points - sum)).round() / 100.0,
        of: 0.0,
        why: format!("{points} points instead of {sum}: {}", decision.reason),
    })
}

/// Reads the deduction for a late submission.
fn late_deduction(table: &mut Table) -> LateDeduction {
    let percent = |table: &Table, key: &str, percent: &Located<f64>| {
        if !(0.0..=100.0).contains(&percent.value) {
            table.reject_value(key, percent, "must be a number of percent from 0 to 100");
        }
        percent.value
    };
    let per_day = table.required::<f64>("percent_per_day");
    let max = table.optional::<f64>("max_percent");
    LateDeduction {
        percent_per_day: per_day.map_or(0.0, |found| percent(table, "percent_per_day", &found)),
        max_percent: max.map_or(100.0, |found| percent(table, "max_percent", &found)),
    }
}

/// Reads the points of a table, which must give them.
fn points(table: &mut Table) -> f64 {
    let points = table.required::<f64>("points");
    points.map_or(0.0, |points| valid_points(table, &points))
}

/// Reads the points of a table, if it gives any.
#[must_use]
pub fn optional_points(table: &mut Table) -> Option<f64> {
    let points = table.optional::<f64>("points");
    points.map(|points| valid_points(table, &points))
}

/// Rejects points out of range.
fn valid_points(table: &Table, points: &Located<f64>) -> f64 {
    if !(0.0..=f64::from(MAX_POINTS)).contains(&points.value) {
        let (max, found) = (grouped(u64::from(MAX_POINTS)), table.excerpt(points.span));
        table.reject(
            points.span,
            format!("`points` must be from 0 to {max}, found {found}"),
            "",
        );
    }
    points.value
}

/// Reads the points of a check, and where partial points begin.
fn check_points(table: &mut Table) -> CheckPoints {
    let points = points(table);
    let partial_from = table.optional::<f64>("partial_from");
    if let Some(from) = &partial_from
        && !(0.0..1.0).contains(&from.value)
    {
        let found = table.excerpt(from.span);
        let message = format!("`partial_from` must be at least 0 and less than 1, found {found}");
        let help = "it is the share of matching pixels at which partial points begin, such as 0.9 for 90 %";
        table.reject(from.span, message, help);
    }
    CheckPoints {
        points,
        partial_from: partial_from.map(|from| from.value),
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

    /// The mark of a check that was performed; `lost` is the share of the pixels that do not agree.
    fn mark(self, name: &'static str, passed: bool, lost: f64, why: String) -> Mark {
        let points = if passed {
            self.points
        } else {
            self.partial(1.0 - lost)
        };
        Mark {
            name: name.into(),
            points,
            of: self.points,
            why,
        }
    }

    /// The mark of a check that was not performed.
    fn not_performed(self, name: &'static str, record: &Record) -> Mark {
        let why = match record.verdict {
            Verdict::Invalid => "the shader does not compile".to_owned(),
            Verdict::Error => format!(
                "not graded because of an error outside the shader: {}",
                record.reason
            ),
            _ => record.reason.clone(),
        };
        self.mark(name, false, 1.0, why)
    }
}

/// Replaces the empty description of a check that found no differences.
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
    let passed = record.verdict.is_compiled();
    let why = if passed {
        "the shader compiles".to_owned()
    } else {
        details(record)
    };
    check.mark("compiles", passed, 1.0, why)
}

fn algorithm(check: CheckPoints, record: &Record) -> Mark {
    let name = "algorithm";
    let mistake = record.mistake.iter().map(|mistake| mistake.text.clone());
    let mistake: Vec<_> = mistake.collect();
    let hints = terminal::fix_lines(record).into_iter();
    let hints = hints.map(|(label, sentence)| format!("\n{label}: {sentence}"));
    let hints = hints.collect::<String>();
    lowest(check, name, record, |frame| {
        let result = frame.algorithm?;
        let passed = !is_different(result) && result.share(result.undefined) <= MAX_UNDEFINED;
        let lost = result.share(result.differing + result.undefined);
        let found = or_no_difference(terminal::algorithm(result));
        let why: Vec<_> = [found].into_iter().chain(mistake.clone()).collect();
        Some(check.mark(name, passed, lost, why.join("; ") + &hints))
    })
}

/// Ill-conditioned pixels also count as lost to the precision check.
fn precision(check: CheckPoints, record: &Record) -> Mark {
    let name = "precision";
    lowest(check, name, record, |frame| {
        let result = frame.precision?;
        let ill_conditioned = frame
            .algorithm
            .map_or(0.0, |result: &CheckSummary| result.share(result.ill_conditioned));
        let lost = result.share(result.differing).max(ill_conditioned);
        let why = or_no_difference(terminal::precision(result));
        Some(check.mark(name, lost <= MAX_UNSTABLE, lost, why))
    })
}

/// The lowest mark of a check in all frames; that of a check that was not performed, if it was not in any.
fn lowest(
    check: CheckPoints,
    name: &'static str,
    record: &Record,
    mark: impl Fn(&FrameChecks) -> Option<Mark>,
) -> Mark {
    let marks = record.checks_in_frames().into_iter().map(|frame| {
        let mut mark = mark(&frame)?;
        if let Some(label) = frame.label.filter(|_| mark.points < mark.of) {
            mark.why = format!("at {label}: {}", mark.why);
        }
        Some(mark)
    });
    let marks: Option<Vec<_>> = marks.collect();
    let lowest = marks.and_then(|marks| marks.into_iter().min_by(|a, b| a.points.total_cmp(&b.points)));
    lowest.unwrap_or_else(|| check.not_performed(name, record))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{Diagnostic, File};

    use super::*;
    use crate::StudentSubmission;
    use crate::record::samples::{check_summary, correct, invalid, record};

    /// The rubric, or its errors: `line:column code message; help: …`.
    fn read(text: &str) -> Result<Rubric, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("r.toml", text));
        let described = |error: &Diagnostic| {
            let at = files.position(error.span.unwrap());
            let message = format!("{}:{} {} {}", at.line, at.column, error.code, error.message);
            let helps = error.helps.iter().map(|help| format!("; help: {help}"));
            message + &helps.collect::<String>()
        };
        Rubric::parse(&files, file).map_err(|errors| errors.iter().map(described).collect())
    }

    fn points(rubric: &str, record: &Record) -> Vec<(&'static str, f64, f64)> {
        let marks = read(rubric).unwrap().marks(record);
        marks
            .into_iter()
            .map(|mark| match mark.name {
                Cow::Borrowed(name) => (name, mark.points, mark.of),
                Cow::Owned(name) => panic!("{name} is not a check"),
            })
            .collect()
    }

    const RUBRIC: &str =
        "[compiles]\npoints = 2\n[algorithm]\npoints = 6\npartial_from = 0.5\n[precision]\npoints = 2";

    #[test]
    fn each_error_has_its_place_message_and_advice() {
        for (text, expected) in [
            (
                "[algorithm]\npoint = 1",
                "2:1 E0503 unknown key `point` in [algorithm]; help: did you mean `points`?",
            ),
            (
                "[style]\npoints = 1",
                "1:2 E0503 unknown table [style]; \
                 help: expected `visibility`, `images`, [compiles], [algorithm], [precision] or [late]",
            ),
            (
                "[[algorithm]]\npoints = 1",
                "1:1 E0503 [algorithm] can be given only once; help: write `[algorithm]`, with single brackets",
            ),
            (
                "algorithm = 6",
                "1:13 E0503 `algorithm` must be a table, found 6; \
                 help: write `[algorithm]` on a line of its own, and its keys below",
            ),
            (
                "[algorithm]\npoints = \"all\"",
                "2:10 E0503 `points` must be a number, found a string; help: for example `points = 1.0`",
            ),
            (
                "[algorithm]\npoints = \"6\"",
                "2:10 E0503 `points` must be a number, found a string; help: remove the quotes around the number",
            ),
            (
                "[algorithm]\npartial_from = 0.5",
                "1:1 E0503 missing key `points` in [algorithm]; help: add `points = 1.0`",
            ),
            (
                "visibility = \"all\"",
                "1:14 E0503 unknown visibility `all`; \
                 help: expected `visible`, `hidden`, `after_due_date` or `after_published`",
            ),
            (
                "visibility = \"after_duedate\"",
                "1:14 E0503 unknown visibility `after_duedate`; help: did you mean `after_due_date`?",
            ),
            (
                "[algorithm]\npoints: 1",
                "2:1 E0503 missing `=` after `points`; help: write `=` instead of `:`",
            ),
            (
                "[algorithm]\npoints = -1",
                "2:10 E0504 `points` must be from 0 to 1,000,000, found -1",
            ),
            (
                "[algorithm]\npoints = nan",
                "2:10 E0504 `points` must be from 0 to 1,000,000, found nan",
            ),
            (
                "[algorithm]\npoints = 1\npartial_from = 90",
                "3:16 E0504 `partial_from` must be at least 0 and less than 1, found 90; \
                 help: it is the share of matching pixels at which partial points begin, such as 0.9 for 90 %",
            ),
            (
                "[late]\npercent_per_day = 200",
                "2:19 E0504 `percent_per_day` must be a number of percent from 0 to 100, found 200",
            ),
            (
                "[late]\nmax_percent = 50",
                "1:1 E0503 missing key `percent_per_day` in [late]; help: add `percent_per_day = 1.0`",
            ),
            (
                "",
                "1:1 E0504 the rubric gives no points; help: add a table such as [algorithm] with `points = 6`",
            ),
            (
                "[algorithm]\npoints = 0",
                "1:1 E0504 the rubric gives no points; help: add a table such as [algorithm] with `points = 6`",
            ),
        ] {
            assert_eq!(read(text).unwrap_err(), [expected], "{text}");
        }
        let both = read("[algorithm]\npoints = -1\npartial_from = 2").unwrap_err();
        assert_eq!(both.len(), 2, "all at once");
    }

    #[test]
    fn correct_shaders_earn_all_points_and_invalid_ones_none() {
        let all = [
            ("compiles", 2.0, 2.0),
            ("algorithm", 6.0, 6.0),
            ("precision", 2.0, 2.0),
        ];
        assert_eq!(points(RUBRIC, &correct()), all);
        assert_eq!(
            points(RUBRIC, &invalid()),
            all.map(|(name, _, of)| (name, 0.0, of))
        );
        assert_eq!(
            points("[algorithm]\npoints = 1", &correct()),
            [("algorithm", 1.0, 1.0)]
        );
    }

    #[test]
    fn partial_points_grow_linearly_and_never_reach_all() {
        let wrong = |differing| {
            let mut record = record(Verdict::Wrong);
            record.algorithm = Some(check_summary([differing, 0, 0]));
            record.precision = Some(check_summary([0; 3]));
            record
        };
        let algorithm = |rubric, differing| points(rubric, &wrong(differing))[1];
        assert_eq!(
            algorithm(RUBRIC, 1),
            ("algorithm", 6.0, 6.0),
            "within what is allowed"
        );
        assert_eq!(algorithm(RUBRIC, 2), ("algorithm", 5.97, 6.0));
        assert_eq!(algorithm(RUBRIC, 250), ("algorithm", 3.0, 6.0));
        assert_eq!(algorithm(RUBRIC, 500), ("algorithm", 0.0, 6.0));
        assert_eq!(algorithm(RUBRIC, 1000), ("algorithm", 0.0, 6.0));
        let strict = RUBRIC.replace("partial_from = 0.5", "");
        assert_eq!(algorithm(&strict, 2), ("algorithm", 0.0, 6.0));
        let precision = |differing| points(RUBRIC, &wrong(differing))[2].1;
        assert_eq!(
            (precision(250), precision(500)),
            (2.0, 0.0),
            "a black image has no rounding errors"
        );
    }

    #[test]
    fn late_submissions_lose_a_share_of_all_points_but_not_more_than_they_earned() {
        let rubric = format!("{RUBRIC}\n[late]\npercent_per_day = 10\nmax_percent = 25");
        let late = |record: Record, seconds| Record {
            submitted: Some(StudentSubmission {
                assignment: None,
                student: "Anna".to_owned(),
                id: None,
                late: Some(Late { seconds }),
            }),
            ..record
        };
        let lost = |record: &Record| match &points(&rubric, record)[..] {
            [_, _, _] => 0.0,
            [_, _, _, ("late", lost, of)] => lost + of,
            marks => panic!("{marks:?}"),
        };
        assert_eq!(lost(&correct()), 0.0);
        assert_eq!(lost(&late(correct(), Some(1))), -1.0);
        assert_eq!(lost(&late(correct(), Some(86_401))), -2.0);
        assert_eq!(lost(&late(correct(), Some(864_000))), -2.5);
        assert_eq!(lost(&late(correct(), None)), -1.0);
        assert_eq!(lost(&late(invalid(), Some(1))), 0.0);
        let why = read(&rubric).unwrap().marks(&late(correct(), Some(7_500)));
        assert_eq!(why[3].why, "late by 2 h 5 min: 10 % of all points are deducted");
    }

    #[test]
    fn ill_conditioned_pixels_count_for_precision_and_undefined_ones_for_the_algorithm() {
        let of = |algorithm, precision| {
            let mut record = record(Verdict::Unstable);
            record.algorithm = Some(check_summary(algorithm));
            record.precision = Some(check_summary(precision));
            let earned = points(RUBRIC, &record);
            (earned[1].1, earned[2].1)
        };
        assert_eq!(of([0, 10, 0], [0; 3]), (6.0, 0.0));
        assert_eq!(of([0; 3], [10, 0, 0]), (6.0, 0.0));
        assert_eq!(of([0, 0, 100], [0; 3]), (4.8, 2.0));
    }
}
