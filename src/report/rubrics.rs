//! The points of all shaders of a run, which may belong to several assignments.

use std::collections::BTreeMap;

use super::{Mark, Record, Rubric};

/// The rubrics of a run: one for all shaders, or one for each assignment of a class.
#[derive(Debug, Clone, Default)]
pub struct Rubrics {
    /// The rubric of the shaders that no other rubric covers.
    all: Option<Rubric>,
    by_assignment: BTreeMap<String, Rubric>,
}

impl From<Option<Rubric>> for Rubrics {
    fn from(all: Option<Rubric>) -> Self {
        Self {
            all,
            by_assignment: BTreeMap::new(),
        }
    }
}

impl Rubrics {
    /// Adds the rubric of an assignment of a class.
    pub fn add(&mut self, assignment: String, rubric: Rubric) {
        self.by_assignment.insert(assignment, rubric);
    }

    /// The rubric of all shaders that no other rubric covers, if there is one.
    #[must_use]
    pub fn common(&self) -> Option<&Rubric> {
        self.all.as_ref()
    }

    /// Whether any shader has points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.all.is_none() && self.by_assignment.is_empty()
    }

    /// The rubric of a shader, if it has one.
    #[must_use]
    pub fn find(&self, record: &Record) -> Option<&Rubric> {
        let assignment = record.submitted.as_ref().and_then(|one| one.assignment.as_ref());
        let of_assignment = assignment.and_then(|name| self.by_assignment.get(name));
        of_assignment.or(self.all.as_ref())
    }

    /// The points of a shader and the maximum, rounded to hundredths; `None` without a rubric.
    #[must_use]
    pub fn total(&self, record: &Record) -> Option<[f64; 2]> {
        let marks = self.find(record)?.marks(record);
        let sum = |of: fn(&Mark) -> f64| (100.0 * marks.iter().map(of).sum::<f64>()).round() / 100.0;
        // The sum of no marks is −0.
        Some([sum(|mark| mark.points) + 0.0, sum(|mark| mark.of) + 0.0])
    }
}
