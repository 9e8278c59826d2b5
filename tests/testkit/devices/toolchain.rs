//! Shaders in strict mode: the course and random programs.

use std::fmt;
use std::time::Duration;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, TestRunner};
use toyproof::diagnostic::{grouped, plural};
use toyproof::gpu::Worker;
use toyproof::image::Frame;
use toyproof::verify::compare::CheckSummary;

use super::Stop;
use crate::generate::{self, Arithmetic};
use crate::toolchain::compare_bits;
use crate::{Exercise, checked, frame};

/// The seed of the random programs.
pub const SEED: u64 = 0;

/// The maximum number of decisions of a random program.
const LONGEST: usize = 900;

/// The shaders that were compared with the evaluator.
#[derive(Debug, Clone, Default)]
pub struct Toolchain {
    /// What they are called.
    pub kind: &'static str,
    /// The sums over all of them.
    pub sum: CheckSummary,
    /// The number of shaders with an image.
    pub shaders: usize,
    /// Those of which no bit differs.
    pub equal: usize,
    /// The first that differs, and the number of its pixels that do.
    pub first: Option<(String, u64)>,
    /// The number of those without an image.
    pub failed: usize,
    /// The first of them, and the reason.
    pub failure: Option<(String, String)>,
    /// Why not all of them were compared.
    pub stopped: Option<String>,
}

impl Toolchain {
    /// Adds the comparison of a shader.
    pub fn add(&mut self, name: &str, result: Result<CheckSummary, String>) {
        match result {
            Ok(summary) => {
                self.shaders += 1;
                self.equal += usize::from(summary.differing == 0);
                if summary.differing > 0 {
                    self.first
                        .get_or_insert_with(|| (name.to_owned(), summary.differing));
                }
                self.sum.extend(&summary, 0);
            }
            Err(why) => {
                self.failed += 1;
                self.failure.get_or_insert_with(|| (name.to_owned(), why));
            }
        }
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let compared = self.sum.pixels - self.sum.undefined;
        write!(
            f,
            "{} of {} {}, {} of {} pixels",
            self.equal,
            self.shaders + self.failed,
            self.kind,
            grouped(compared - self.sum.differing),
            grouped(compared)
        )?;
        if let Some((name, pixels)) = &self.first {
            write!(
                f,
                "; **{} {}** by at most {:.1e}, first {name} in {} pixels",
                self.shaders - self.equal,
                plural((self.shaders - self.equal) as u64, "differs", "differ"),
                self.sum.max_abs,
                grouped(*pixels)
            )?;
        }
        if let Some((name, why)) = &self.failure {
            write!(
                f,
                "; **{} {} no image**, first {name}: {why}",
                self.failed,
                plural(self.failed as u64, "has", "have")
            )?;
        }
        match &self.stopped {
            Some(why) => write!(f, "; the others were not measured: {why}"),
            None => Ok(()),
        }
    }
}

/// Compares exercises of the course.
pub fn course(worker: &mut Worker, exercises: &[&Exercise], timeout: Duration, stop: Stop) -> Toolchain {
    let mut sum = Toolchain {
        kind: "shaders",
        ..Toolchain::default()
    };
    for exercise in exercises {
        sum.stopped = stop();
        if sum.stopped.is_some() {
            break;
        }
        let frame = frame(exercise, exercise.size);
        let result = compare_bits(worker, &checked(exercise.shader), &frame, timeout);
        sum.add(exercise.name, result);
    }
    sum
}

/// Compares random programs, made as those of the test suite.
///
/// # Panics
/// If the generator makes an invalid program.
pub fn programs(worker: &mut Worker, count: u32, timeout: Duration, stop: Stop) -> Toolchain {
    let mut runner = TestRunner::new_with_rng(Config::default(), generate::rng(SEED));
    let mut sum = Toolchain {
        kind: "programs",
        ..Toolchain::default()
    };
    let frame = Frame {
        size: [8, 8],
        time: 2.5,
        frame: 7,
        ..Frame::default()
    };
    for number in 0..count {
        sum.stopped = stop();
        if sum.stopped.is_some() {
            break;
        }
        let strategy = generate::programs(generate::effects(number), Arithmetic::AnyOnDrivers, LONGEST);
        let text = strategy
            .new_tree(&mut runner)
            .expect("the strategy filters nothing")
            .current();
        let result = compare_bits(worker, &checked(&text), &frame, timeout);
        sum.add(&format!("program {number}"), result);
    }
    sum
}
