//! The trade of accuracy for time: every way to a picture that a scene or a shader allows, what it costs, and how far it is from the truth.

mod error;
mod schedule;
mod statistics;
mod table;
mod truth;
mod way;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub use error::Error;
use serde::Serialize;
pub use statistics::{Times, median};
pub use table::ERRORS;
use thiserror::Error as Failing;
use toyproof_eval as eval;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::Scene;

use self::schedule::{Cost, Runner};
use self::truth::Truth;
use self::way::{Group, Shader, Way, Workshop};
use crate::stress;

/// What is to be measured.
#[derive(Debug)]
pub struct Subject<'a> {
    /// What people call it.
    pub name: String,
    /// The scene, of the frame's size; none for a shader alone.
    pub scene: Option<&'a Scene>,
    /// The shader that paints it: its text and its tree.
    pub shader: Option<(&'a str, &'a Checked)>,
    /// What the shader's language is.
    pub options: glsl::Options,
    /// The frame.
    pub frame: &'a Frame,
    /// Devices by name, each with its worker; what counts as the GPU comes first.
    pub workers: Vec<(String, Worker)>,
    /// When the time began to run.
    pub start: Instant,
    /// How long everything may take, counted from then.
    pub budget: Duration,
}

/// Why nothing was measured.
#[derive(Debug, Failing)]
pub enum Failure {
    /// The shader cannot be evaluated.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The function that meets spheres cannot be asked.
    #[error(transparent)]
    Function(#[from] stress::Failure),
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

/// A way and what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// What it is.
    pub way: String,
    /// What runs it.
    pub group: &'static str,
    /// What a frame takes.
    pub seconds: Times,
    /// How far it is from the truth.
    pub error: Error,
    /// Whether no other way is both faster and nearer to the truth.
    pub best: bool,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// What was measured.
    pub subject: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How the truth was made.
    pub truth: String,
    /// The truth's own error: a root mean square, in [0, 1].
    pub truth_error: f64,
    /// Ways that there was no time for, or that failed.
    pub left_out: Vec<String>,
    /// The ways, the fastest first.
    pub ways: Vec<Measured>,
}

/// The share of the budget that the truth may take.
const FOR_TRUTH: f64 = 0.35;

/// Measures; `passed` is told now and then what share of the budget is gone.
///
/// # Errors
/// Why nothing was measured; [`Failure::Interrupted`] soon after `interrupt` is set.
pub fn study(subject: Subject, interrupt: &AtomicBool, passed: impl Fn(f64)) -> Result<Report, Failure> {
    let Subject {
        name,
        scene,
        shader,
        options,
        frame,
        workers,
        start,
        budget,
    } = subject;
    // Charts are drawn and files written afterwards.
    let budget = budget.mul_f64(0.97).saturating_sub(Duration::from_millis(100));
    let mut shaders = Vec::new();
    if let Some((text, checked)) = shader {
        shaders.extend(Shader::new("", text, &options));
        let replacements = match stress::function::replacements(text, checked, &options) {
            // There are ways that need no shader.
            Err(_) if options.deadline.check().is_err() => Vec::new(),
            replacements => replacements?,
        };
        for (formula, text) in replacements {
            shaders.extend(Shader::new(formula, &text, &options));
        }
    }
    let workshop = Workshop {
        frame,
        shaders,
        workers,
        patience: budget,
    };
    let for_truth = budget.mul_f64(FOR_TRUTH);
    let truth = match (scene, workshop.shaders.first()) {
        (Some(scene), _) => Truth::of_scene(scene, frame, for_truth),
        (None, Some(shader)) => Truth::of_shader(shader, frame, for_truth)?,
        (None, None) => return Err(eval::Failure::TimeUp.into()),
    };
    let background = scene.map(background);
    let background = background.map(|scene| {
        let tracer = toyproof_tracer::Tracer::<f64>::at(&scene, Workshop::moment(frame));
        tracer.picture(|| ())
    });
    let samples = scene.map_or(1.0, |scene| f64::from(scene.film.samples));
    let mut ways = scene.map_or_else(Vec::new, way::of_scene);
    ways.extend(workshop.of_shaders(samples));
    let costs: Vec<Cost> = ways.iter().map(Way::cost).collect();
    let mut bench = Bench {
        start,
        budget,
        workshop,
        errors: vec![None; ways.len()],
        ways,
        truth: &truth.picture,
        background,
        interrupt,
        passed,
    };
    let seconds = schedule::measure(&mut bench, &costs, budget.as_secs_f64())?;
    let mut measured = Vec::new();
    let mut left_out = Vec::new();
    for ((way, error), seconds) in bench.ways.iter().zip(&bench.errors).zip(seconds) {
        match error {
            Some(error) if !seconds.is_empty() => measured.push(Measured {
                way: way.name.clone(),
                group: word(way.group),
                seconds: Times::of(&seconds),
                error: *error,
                best: false,
            }),
            _ => left_out.push(way.name.clone()),
        }
    }
    measured.sort_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median));
    mark_best(&mut measured);
    Ok(Report {
        subject: name,
        size: frame.size,
        truth: truth.says,
        truth_error: truth.error,
        left_out,
        ways: measured,
    })
}

fn word(group: Group) -> &'static str {
    let found = Group::ALL.iter().find(|(other, _)| *other == group);
    found.map_or("", |(_, word)| word)
}

/// The scene with nothing in it.
fn background(scene: &Scene) -> Scene {
    let mut empty = scene.clone();
    empty.objects.clear();
    empty.figures.clear();
    empty.film.samples = 1;
    empty.film.sampler = toyproof_scene::Sampler::Center;
    empty.film.integrator = toyproof_scene::Integrator::Whitted;
    empty
}

/// A way that takes longer is worth its time only if its error is smaller by more than this share.
const WORTH: f64 = 0.01;

/// Pareto's front, of ways by their time.
fn mark_best(measured: &mut [Measured]) {
    let mut least = f64::INFINITY;
    for way in measured {
        way.best = way.error.rmse < (1.0 - WORTH) * least;
        if way.best {
            least = way.error.rmse;
        }
    }
}

/// Runs ways, on the clock of the machine.
struct Bench<'a, P> {
    start: Instant,
    budget: Duration,
    workshop: Workshop<'a>,
    ways: Vec<Way>,
    errors: Vec<Option<Error>>,
    truth: &'a Image,
    background: Option<Image>,
    interrupt: &'a AtomicBool,
    passed: P,
}

impl<P: Fn(f64)> Runner for Bench<'_, P> {
    type Failure = Failure;

    fn run(&mut self, way: usize, first: bool) -> Result<Option<f64>, Failure> {
        if self.interrupt.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        let left = self.budget.saturating_sub(self.start.elapsed());
        self.workshop.patience = left.max(Duration::from_millis(100));
        let made = self.workshop.make(&self.ways[way].how);
        (self.passed)(self.now() / self.budget.as_secs_f64());
        let Some((picture, took)) = made else {
            return Ok(None);
        };
        if first {
            self.errors[way] = Some(Error::of(self.truth, &picture, self.background.as_ref()));
        }
        Ok(Some(took.as_secs_f64()))
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

impl Report {
    /// The fastest way whose root mean square error is at most that; none if none is near enough.
    #[must_use]
    pub fn cheapest(&self, error: f64) -> Option<&Measured> {
        self.ways.iter().find(|way| way.error.rmse <= error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(name: &str, median: f64, rmse: f64) -> Measured {
        Measured {
            way: name.to_owned(),
            group: "",
            seconds: Times {
                median,
                ..Times::default()
            },
            error: Error {
                rmse,
                max: 0.0,
                mismatches_8bit: 0,
                flips: None,
            },
            best: false,
        }
    }

    #[test]
    fn the_front_holds_what_nothing_faster_beats() {
        let mut ways = [
            way("a", 1.0, 0.1),
            way("b", 2.0, 0.2),
            way("c", 3.0, 0.1),
            way("d", 4.0, 0.01),
            way("e", 5.0, 0.0),
        ];
        mark_best(&mut ways);
        let best: Vec<_> = ways.iter().filter(|way| way.best).map(|way| &*way.way).collect();
        assert_eq!(best, ["a", "d", "e"]);
        let report = Report {
            subject: "s".to_owned(),
            size: [1, 1],
            truth: String::new(),
            truth_error: 0.0,
            left_out: Vec::new(),
            ways: ways.to_vec(),
        };
        assert_eq!(report.cheapest(0.05).map(|way| &*way.way), Some("d"));
        assert_eq!(report.cheapest(0.0).map(|way| &*way.way), Some("e"));
        assert_eq!(report.cheapest(-1.0), None);
        assert_eq!(report.stability(), None);
        let mut pair = report.clone();
        pair.ways = vec![
            way("gpu strict", 1.0, 0.1),
            way("gpu strict, recentred", 1.5, 0.01),
        ];
        for way in &mut pair.ways {
            way.group = word(Group::Strict);
        }
        assert!(
            pair.stability().unwrap().contains("(+50 %)"),
            "{:?}",
            pair.stability()
        );
        assert!(report.csv().starts_with("way,group,") && report.csv().lines().count() == 6);
        assert!(
            report
                .line(0.05, "0.05")
                .contains("within 0.05 of the truth is d:")
        );
        let few = Report {
            ways: vec![way("a", 1.0, 0.1)],
            left_out: vec!["b".to_owned(), "c".to_owned()],
            ..report
        };
        assert!(few.line(0.2, "0.2").starts_with("a, the only way"));
        assert!(few.line(0.05, "0.05").contains("no time for 2 ways"));
    }
}
