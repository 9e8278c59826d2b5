//! The requirements of an assignment besides the image as a whole: rules, tests of functions, and features.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{grouped, plural};

use super::record::Position;
use super::{Mark, Record};

/// The rules of an assignment, and the violations of a shader.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RulesRecord {
    /// The points for a shader without violations.
    pub points: f64,
    /// The violations; null if the shader does not compile.
    pub violations: Option<Vec<Violation>>,
}

/// A violated rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// The rule's key in the assignment, such as `must_not_call`.
    pub rule: String,
    /// The violation, in one sentence.
    pub message: String,
    /// Where; null if the whole shader is meant.
    pub at: Option<Position>,
}

impl Violation {
    fn sentence(&self) -> String {
        match &self.at {
            Some(at) => format!("line {}: {}", at.line, self.message),
            None => self.message.clone(),
        }
    }
}

/// The test of a function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FunctionRecord {
    /// The function's name.
    pub name: String,
    /// The points for a function that is right in all cases.
    pub points: f64,
    /// Whether the function is right in all cases.
    pub passed: bool,
    /// The number of cases; 0 if the function was not tested.
    pub cases: u64,
    /// The number of cases in which it is right.
    pub right: u64,
    /// The fault, in one sentence; empty if there is none.
    pub message: String,
    /// Where the function is defined; null if it is missing.
    pub at: Option<Position>,
}

impl FunctionRecord {
    /// The test of a function that was not tested, and why.
    #[must_use]
    pub fn untested(name: &str, points: f64, message: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            points,
            passed: false,
            cases: 0,
            right: 0,
            message: message.into(),
            at: None,
        }
    }

    fn sentence(&self) -> String {
        match (self.passed, self.cases) {
            (true, cases) => format!(
                "{} is right in {} {}",
                self.name,
                grouped(cases),
                plural(cases, "case", "cases")
            ),
            (false, 0) => self.message.clone(),
            (false, cases) => format!(
                "{} is right in {} of {} {}: {}",
                self.name,
                grouped(self.right),
                grouped(cases),
                plural(cases, "case", "cases"),
                self.message
            ),
        }
    }
}

/// A feature of the image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FeatureRecord {
    /// The name.
    pub name: String,
    /// The points for a shader that is right in all pixels that the feature changes.
    pub points: f64,
    /// The number of these pixels in all frames.
    pub pixels: u64,
    /// The number of those in which the shader is right.
    pub right: u64,
}

impl FeatureRecord {
    fn sentence(&self) -> String {
        format!(
            "{}: {} of the {} {} that it changes {} right",
            self.name,
            grouped(self.right),
            grouped(self.pixels),
            plural(self.pixels, "pixel", "pixels"),
            plural(self.right, "is", "are"),
        )
    }

    /// The mark: the share of right pixels, rounded down to hundredths; all points if the image is right.
    fn mark(&self, is_right: bool) -> Mark {
        let share = self.right as f64 / self.pixels.max(1) as f64;
        let partial = (100.0 * self.points * share).floor() / 100.0;
        Mark {
            name: self.name.clone().into(),
            points: if is_right { self.points } else { partial },
            of: self.points,
            why: self.sentence(),
        }
    }
}

impl Record {
    /// Whether the shader has no fault: its verdict is good, no rule is violated, and all functions are
    /// right. A verdict that a teacher decided counts alone.
    #[must_use]
    pub fn is_passed(&self) -> bool {
        self.verdict.is_good() && (self.decided_verdict().is_some() || self.faults().is_empty())
    }

    /// The violated rules, the functions that are not right, and the features of a wrong image, each with a
    /// label. The violations of a shader that does not compile are not known.
    pub(super) fn faults(&self) -> Vec<(&'static str, String)> {
        let violations = self
            .rules
            .iter()
            .filter_map(|rules| rules.violations.as_ref())
            .flatten();
        let violations = violations.map(|violation| ("rule", violation.sentence()));
        let functions = self.functions.iter();
        let wrong = functions.filter(|function| !function.passed && self.is_compiled());
        let wrong = wrong.map(|function| ("function", function.sentence()));
        let is_shown = !self.verdict.is_good() && self.is_compiled();
        let features = self.features.iter().filter(|_| is_shown);
        let features = features.map(|feature| ("feature", feature.sentence()));
        violations.chain(wrong).chain(features).collect()
    }

    /// The functions that are right, each in a sentence.
    pub(super) fn right_functions(&self) -> impl Iterator<Item = String> {
        let right = self.functions.iter().filter(|function| function.passed);
        right.map(FunctionRecord::sentence)
    }

    fn is_compiled(&self) -> bool {
        self.verdict.is_compiled()
    }

    /// The marks for rules, functions and features that have points.
    pub(super) fn assigned_marks(&self) -> Vec<Mark> {
        let rules = self.rules.iter().map(|rules| {
            let (passed, why) = match rules.violations.as_deref() {
                None => (false, "the shader does not compile".to_owned()),
                Some([]) => (true, "no rule is violated".to_owned()),
                Some(violations) => {
                    let sentences: Vec<_> = violations.iter().map(Violation::sentence).collect();
                    (false, sentences.join("\n"))
                }
            };
            mark("rules".to_owned(), rules.points, passed, why)
        });
        let functions = self.functions.iter().map(|function| {
            let why = function.sentence();
            mark(function.name.clone(), function.points, function.passed, why)
        });
        let is_right = self.verdict.is_good();
        let features = self.features.iter().map(|feature| feature.mark(is_right));
        let marks = rules.chain(functions).chain(features);
        marks.filter(|mark| mark.of > 0.0).collect()
    }
}

/// A mark without partial points.
fn mark(name: String, max_points: f64, passed: bool, why: String) -> Mark {
    Mark {
        name: name.into(),
        points: if passed { max_points } else { 0.0 },
        of: max_points,
        why,
    }
}
