//! The marks of a student's shaders, from which the results of all platforms are made.

use super::super::rubric::Visibility;
use super::super::{Hints, Mark, Record, Rubric, Tally, Thumbnails, plain};

/// The marks of a student's shaders, as far as the hints permit.
pub(super) struct Graded<'a> {
    /// The verdict and its reason; of several shaders, how many have each verdict.
    pub(super) text: String,
    /// The marks of all shaders; of several, each name starts with its shader's.
    pub(super) tests: Vec<Mark>,
    /// The marks of the shader that counts: the one with the fewest points.
    pub(super) counted: Vec<Mark>,
    /// Whether the shader that counts compiles, and no error outside of it prevented its check.
    pub(super) is_checked: bool,
    /// Whether several shaders were submitted.
    pub(super) are_several: bool,
    /// The time that the checks took, in seconds.
    pub(super) seconds: f64,
    pub(super) visibility: Visibility,
    pub(super) images: &'a Thumbnails,
}

impl<'a> Graded<'a> {
    pub(super) fn new(records: &[Record], rubric: &Rubric, hints: Hints, images: &'a Thumbnails) -> Self {
        let text = match records {
            [record] => format!("{}: {}", record.verdict, record.reason),
            _ => format!(
                "{}\nSeveral shaders were submitted; the one with the fewest points counts.",
                plain(&Tally::new(records).summary())
            ),
        };
        let marks = records
            .iter()
            .map(|record| rubric.marks(&record.clone().redacted(hints)));
        let marks: Vec<Vec<Mark>> = marks.collect();
        let counted = (0..records.len()).min_by(|&a, &b| points(&marks[a]).total_cmp(&points(&marks[b])));
        let tests = records.iter().zip(&marks).flat_map(|(record, marks)| {
            marks.iter().cloned().map(|mark| match records.len() {
                1 => mark,
                _ => Mark {
                    name: format!("{}: {}", record.shader, mark.name).into(),
                    ..mark
                },
            })
        });
        let is_checked = |at: usize| {
            let verdict = records[at].verdict;
            verdict.is_compiled() && verdict != toyproof_verify::Verdict::Error
        };
        Self {
            text,
            tests: tests.collect(),
            counted: counted.map(|at| marks[at].clone()).unwrap_or_default(),
            is_checked: counted.is_some_and(is_checked),
            are_several: records.len() > 1,
            seconds: records.iter().map(|record| record.seconds.total()).sum(),
            visibility: rubric.visibility,
            images,
        }
    }

    /// The points that count, and the maximum, rounded to hundredths.
    pub(super) fn score(&self) -> [f64; 2] {
        let of = self.counted.iter().map(|mark| mark.of).sum::<f64>();
        [points(&self.counted), of].map(|points| (100.0 * points).round() / 100.0 + 0.0)
    }

    /// The share of the points that count, in [0, 1].
    pub(super) fn fraction(&self) -> f64 {
        match self.score() {
            [points, of] if of > 0.0 => (points / of).clamp(0.0, 1.0),
            _ => 0.0,
        }
    }
}

fn points(marks: &[Mark]) -> f64 {
    marks.iter().map(|mark| mark.points).sum()
}
