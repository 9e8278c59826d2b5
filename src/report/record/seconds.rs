//! The times of the stages of a check.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Times in seconds; null for stages that did not run.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Seconds {
    /// naga: parse, validate, write.
    pub translate: Option<f64>,
    /// The driver: compile, render, read back.
    pub gpu: Option<f64>,
    /// The evaluator: compile, and render every image in f32 and f64.
    pub eval: Option<f64>,
    /// The reference: tracing a scene, or evaluating a shader.
    pub trace: Option<f64>,
    /// The whole time for the shader, also for the search for mistakes and fixes, and for its images; null if
    /// the shader cannot be read, or nothing is written.
    pub all: Option<f64>,
}

impl Seconds {
    /// The sum of all stages, without `all`; some stages ran in parallel.
    #[must_use]
    pub fn total(&self) -> f64 {
        let parts = [self.translate, self.gpu, self.eval, self.trace];
        // The sum of an empty iterator is −0.
        parts.into_iter().flatten().fold(0.0, |sum, part| sum + part)
    }
}

impl AddAssign for Seconds {
    fn add_assign(&mut self, other: Self) {
        let sum = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(|a, b| a + b);
        self.translate = sum(self.translate, other.translate);
        self.gpu = sum(self.gpu, other.gpu);
        self.eval = sum(self.eval, other.eval);
        self.trace = sum(self.trace, other.trace);
        self.all = sum(self.all, other.all);
    }
}
