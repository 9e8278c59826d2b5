//! Accuracy against time: measures the cost and the error of every rendering method that a scene or a shader
//! allows, and of other values of the shader's parameters, relative to a reference image.

mod advice;
mod features;
mod half;
mod method;
mod parameter;
mod reference;
mod schedule;
mod screening;
mod source;
mod table;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub use features::{FeatureReport, FeatureSubject, features};
pub use half::{Evaluated, HalfRun, half_run};
pub use method::Configuration;
use method::{Backend, Group, Method, RenderContext};
pub use parameter::{Setting, Vary, VaryError, VaryParseError};
pub use reference::ErrorStatistics;
use reference::Reference;
use schedule::{Cost, RunKind, Runner};
pub use schedule::{TimeStatistics, median};
pub use screening::Tried;
use screening::{Screened, screen};
use serde::Serialize;
use source::Shader;
pub use source::Source;
use toyproof_eval as eval;
use toyproof_glsl as glsl;
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::Scene;
use toyproof_stress as stress;
use toyproof_verify::compare::visible_pixels;

/// The scene or shader to measure.
#[derive(Debug)]
pub struct Subject<'a> {
    /// The name shown to users.
    pub name: String,
    /// The scene, at the frame's size; `None` for a shader alone.
    pub scene: Option<&'a Scene>,
    /// The shader that renders it.
    pub shader: Option<Source<'a>>,
    /// Whether to look for parameters of the shader that make it faster.
    pub proposes_settings: bool,
    /// The parameters of the shader to vary, instead of those.
    pub vary: Vec<Vary>,
    /// A shader whose image in double precision is the reference, instead of the scene's or the shader's own.
    pub reference: Option<Source<'a>>,
    /// The options of the shader's language.
    pub options: glsl::Options,
    /// The frame.
    pub frame: &'a Frame,
    /// Devices by name, each with its worker; the first is the GPU, the others are additional devices.
    pub workers: Vec<(String, Worker)>,
    /// The start of the time budget.
    pub start: Instant,
    /// The time budget of the whole study, from `start`.
    pub budget: Duration,
}

/// The reason why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub enum TradeError {
    /// The shader cannot be evaluated.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The shader's ray–sphere function cannot be evaluated.
    #[error(transparent)]
    Function(#[from] stress::RunError),
    /// A parameter cannot be varied.
    #[error(transparent)]
    Vary(#[from] VaryError),
    /// The shader of the reference cannot be compiled for the evaluator.
    #[error("the shader of the reference is too large")]
    LargeReference,
    /// The user interrupted the study.
    #[error("interrupted")]
    Interrupted,
}

/// A method with its measured time and error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodResult {
    /// The settings of the method.
    #[serde(flatten)]
    pub configuration: Configuration,
    /// The group in charts: the renderer and precision.
    pub group: String,
    /// The time of a frame.
    pub seconds_per_frame: TimeStatistics,
    /// The error relative to the reference.
    pub error: ErrorStatistics,
    /// The number of pixels that look different from the shader's own settings on the same renderer; `None`
    /// for these.
    pub changed_pixels: Option<u64>,
    /// Whether the method is on the Pareto front: no other is both faster and more accurate.
    pub on_pareto_front: bool,
}

/// The results of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The name of the subject.
    pub subject: String,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// A description of the reference image.
    pub reference: String,
    /// The error of the reference itself: a root mean square, in [0, 1].
    pub reference_error: f64,
    /// How that error was estimated.
    pub reference_error_estimate: &'static str,
    /// The time that the whole study took, in seconds.
    pub seconds: f64,
    /// What is to be said about the values of parameters.
    pub notes: Vec<String>,
    /// The settings that were tried on small images, from which those to measure were chosen.
    pub tried: Vec<Tried>,
    /// Methods that failed or exceeded the time budget.
    pub skipped: Vec<String>,
    /// The methods, fastest first.
    #[serde(rename = "configurations")]
    pub results: Vec<MethodResult>,
}

/// The share of the time budget for the reference image, in [0, 1].
const REFERENCE_BUDGET_SHARE: f64 = 0.35;

/// The share of the time budget for trying settings on small images.
const SCREENING_BUDGET_SHARE: f64 = 0.3;

/// Measures all methods within the time budget; calls `progress` with the share of the budget that has
/// elapsed.
///
/// # Errors
///
/// [`TradeError`] if nothing was measured; [`TradeError::Interrupted`] soon after `interrupt` is set.
pub fn study(subject: Subject, interrupt: &AtomicBool, progress: impl Fn(f64)) -> Result<Report, TradeError> {
    let Subject {
        name,
        scene,
        shader,
        proposes_settings,
        vary,
        reference,
        options,
        frame,
        workers,
        start,
        budget,
    } = subject;
    // The reserve is for drawing charts and writing files.
    let budget = budget.mul_f64(0.97).saturating_sub(Duration::from_millis(100));
    let screened = match shader {
        Some(source) if proposes_settings || !vary.is_empty() => {
            let until = start + budget.mul_f64(SCREENING_BUDGET_SHARE);
            screen(source, (frame, &options), &vary, until, interrupt)?
        }
        _ => Screened::default(),
    };
    let shaders = match shader {
        Some(source) => shaders(source, &screened.settings, &options)?,
        None => Vec::new(),
    };
    let mut context = RenderContext {
        frame,
        shaders,
        workers,
        frame_timeout: budget,
    };
    let reference_time = budget.mul_f64(REFERENCE_BUDGET_SHARE);
    let own = context.shaders.first();
    let reference = match (reference, scene, shader.zip(own)) {
        (Some(source), ..) => {
            let shader = source.compile(&[], &options).ok_or(TradeError::LargeReference)?;
            Reference::from_shader(&shader, frame, reference_time)?
        }
        (_, Some(scene), _) => Reference::from_scene(scene, frame, reference_time),
        (_, _, Some((source, own))) => {
            let generous =
                (!screened.generous.is_empty()).then(|| source.compile(&screened.generous, &options));
            let generous = generous.flatten();
            Reference::from_shader(generous.as_ref().unwrap_or(own), frame, reference_time)?
        }
        (None, None, None) => return Err(eval::Failure::TimeUp.into()),
    };
    let background = scene.map(background);
    let background = background.map(|scene| {
        let tracer = toyproof_tracer::Tracer::<f64>::at(&scene, RenderContext::frame_time(frame));
        tracer.render(|| ())
    });
    let samples = scene.map_or(1.0, |scene| f64::from(scene.film.samples));
    let mut methods = scene.map_or_else(Vec::new, method::scene_methods);
    methods.extend(context.shader_methods(samples));
    let own_images = if screened.settings.is_empty() {
        Vec::new()
    } else {
        own_images(&mut context, &methods)
    };
    let costs: Vec<Cost> = methods.iter().map(Method::scheduled_cost).collect();
    let mut bench = Bench {
        start,
        budget,
        context,
        measured: vec![None; methods.len()],
        methods,
        reference: &reference.image,
        background,
        own_images,
        interrupt,
        progress,
    };
    let seconds = schedule::measure(&mut bench, &costs, budget.as_secs_f64())?;
    let (results, skipped) = bench.results(&seconds);
    Ok(Report {
        subject: name,
        size: frame.size,
        reference: reference.description,
        reference_error: reference.error,
        reference_error_estimate: reference.error_estimate,
        seconds: start.elapsed().as_secs_f64(),
        notes: screened.notes,
        tried: screened.tried,
        skipped,
        results,
    })
}

impl<P> Bench<'_, P> {
    /// The measured methods, fastest first, and the names of the others.
    fn results(&self, seconds: &[Vec<f64>]) -> (Vec<MethodResult>, Vec<String>) {
        let mut results = Vec::new();
        let mut skipped = Vec::new();
        for ((method, measured), seconds) in self.methods.iter().zip(&self.measured).zip(seconds) {
            match measured {
                &Some((error, changed_pixels)) if !seconds.is_empty() => results.push(MethodResult {
                    configuration: method.configuration.clone(),
                    group: self.context.group_name(method.group),
                    seconds_per_frame: TimeStatistics::new(seconds),
                    error,
                    changed_pixels,
                    on_pareto_front: false,
                }),
                _ => skipped.push(method.configuration.to_string()),
            }
        }
        results.sort_by(|a, b| {
            let [a, b] = [a, b].map(|result| result.seconds_per_frame.median);
            a.total_cmp(&b)
        });
        mark_pareto_front(&mut results);
        (results, skipped)
    }
}

/// The shader, also with each formula of ray–sphere intersection, and with each of the settings.
fn shaders(
    source: Source<'_>,
    settings: &[Vec<Setting>],
    options: &glsl::Options,
) -> Result<Vec<Shader>, TradeError> {
    let mut shaders: Vec<Shader> = source.compile(&[], options).into_iter().collect();
    if let Some((text, checked)) = source.single() {
        let replacements = match stress::function::replacements(text, checked, options) {
            // The scene's own methods need no shader.
            Err(_) if options.deadline.check().is_err() => Vec::new(),
            replacements => replacements?,
        };
        let replaced = replacements.iter();
        shaders.extend(replaced.filter_map(|(formula, text)| Shader::new(Some(formula), text, options)));
    }
    shaders.extend(
        settings
            .iter()
            .filter_map(|settings| source.compile(settings, options)),
    );
    Ok(shaders)
}

/// The images of the shader with its own settings, by each renderer that other settings have.
fn own_images(context: &mut RenderContext<'_>, methods: &[Method]) -> Vec<(Group, Image)> {
    let has_settings = |group| {
        let mut of_group = methods.iter().filter(|method| method.group == group);
        of_group.any(|method| !method.configuration.settings.is_empty())
    };
    let is_own = |method: &&Method| match method.backend {
        Backend::Tracer { .. } => false,
        Backend::Evaluator { shader, .. } | Backend::Gpu { shader, .. } => shader == 0,
    };
    let own = methods
        .iter()
        .filter(is_own)
        .filter(|method| has_settings(method.group));
    let images = own.filter_map(|method| Some((method.group, context.render(&method.backend)?.0)));
    images.collect()
}

/// The scene without objects.
fn background(scene: &Scene) -> Scene {
    let mut empty = scene.clone();
    empty.objects.clear();
    empty.figures.clear();
    empty.film.samples = 1;
    empty.film.sampler = toyproof_scene::Sampler::Center;
    empty.film.integrator = toyproof_scene::Integrator::Whitted;
    empty
}

/// The minimum relative reduction of the error that puts a slower method on the Pareto front.
const MIN_ERROR_REDUCTION: f64 = 0.01;

/// Marks the Pareto front of methods that are sorted by time.
fn mark_pareto_front(measured: &mut [MethodResult]) {
    let mut least = f64::INFINITY;
    for result in measured {
        result.on_pareto_front = result.error.rmse < (1.0 - MIN_ERROR_REDUCTION) * least;
        if result.on_pareto_front {
            least = result.error.rmse;
        }
    }
}

/// Runs methods, measured by the machine's clock.
struct Bench<'a, P> {
    start: Instant,
    budget: Duration,
    context: RenderContext<'a>,
    methods: Vec<Method>,
    /// The error of each method, and the pixels that its settings change.
    measured: Vec<Option<(ErrorStatistics, Option<u64>)>>,
    reference: &'a Image,
    background: Option<Image>,
    own_images: Vec<(Group, Image)>,
    interrupt: &'a AtomicBool,
    progress: P,
}

impl<P: Fn(f64)> Runner for Bench<'_, P> {
    type Error = TradeError;

    fn run(&mut self, method: usize, kind: RunKind) -> Result<Option<f64>, TradeError> {
        if self.interrupt.load(Ordering::Relaxed) {
            return Err(TradeError::Interrupted);
        }
        let left = self.budget.saturating_sub(self.start.elapsed());
        self.context.frame_timeout = left.max(Duration::from_millis(100));
        let rendered = self.context.render(&self.methods[method].backend);
        (self.progress)(self.now() / self.budget.as_secs_f64());
        let Some((image, took)) = rendered else {
            return Ok(None);
        };
        if kind == RunKind::WarmUp {
            let Method {
                configuration, group, ..
            } = &self.methods[method];
            let own = self.own_images.iter().find(|(own, _)| own == group);
            let own = own.filter(|_| !configuration.settings.is_empty());
            let changed = own.map(|(_, own)| visible_pixels(own, &image));
            let error = ErrorStatistics::new(self.reference, &image, self.background.as_ref());
            self.measured[method] = Some((error, changed));
        }
        Ok(Some(took.as_secs_f64()))
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

impl Report {
    /// The fastest method whose root mean square error is at most `error`; `None` if there is none.
    #[must_use]
    pub fn fastest(&self, error: f64) -> Option<&MethodResult> {
        self.results.iter().find(|result| result.error.rmse <= error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn result(renderer: &str, median: f64, rmse: f64) -> MethodResult {
        MethodResult {
            configuration: Configuration {
                renderer: renderer.to_owned(),
                precision: "f32",
                ..Configuration::default()
            },
            group: String::new(),
            seconds_per_frame: TimeStatistics {
                median,
                ..TimeStatistics::default()
            },
            error: ErrorStatistics {
                rmse,
                max: 0.0,
                differing_pixels_8bit: 0,
                visible_pixels: 0,
                flip: None,
                silhouette_flips: None,
            },
            changed_pixels: None,
            on_pareto_front: false,
        }
    }

    pub(super) fn report(mut results: Vec<MethodResult>) -> Report {
        mark_pareto_front(&mut results);
        Report {
            subject: "s".to_owned(),
            size: [1, 1],
            reference: "tracer f64".to_owned(),
            reference_error: 0.0,
            reference_error_estimate: "",
            seconds: 1.0,
            notes: Vec::new(),
            tried: Vec::new(),
            skipped: Vec::new(),
            results,
        }
    }

    #[test]
    fn pareto_front_omits_dominated_methods() {
        let report = report(vec![
            result("a", 1.0, 0.1),
            result("b", 2.0, 0.2),
            result("c", 3.0, 0.1),
            result("d", 4.0, 0.01),
            result("e", 5.0, 0.0),
        ]);
        let names = |on_front: bool| -> Vec<_> {
            let results = report.results.iter();
            let found = results.filter(|result| result.on_pareto_front == on_front);
            found.map(|result| &*result.configuration.renderer).collect()
        };
        assert_eq!((names(true), names(false)), (vec!["a", "d", "e"], vec!["b", "c"]));
        let fastest = |error| Some(&*report.fastest(error)?.configuration.renderer);
        assert_eq!(
            (fastest(0.05), fastest(0.0), fastest(-1.0)),
            (Some("d"), Some("e"), None)
        );
        assert!(report.csv().starts_with("renderer,precision,") && report.csv().lines().count() == 6);
        let line = report.fastest_line(0.05);
        assert!(
            line.starts_with("fastest configuration with RMSE ≤ 0.05: d f32 ("),
            "{line}"
        );
    }

    #[test]
    fn summary_names_the_role_of_each_configuration() {
        let mut report = report(vec![
            result("a", 0.001, 0.1),
            result("b", 0.002, 0.003),
            result("c", 0.003, 0.0015),
        ]);
        let summary = report.summary().join("\n");
        for row in [
            "1.0e-1         1.00 ms  a f32              fastest",
            "3.0e-3         2.00 ms  b f32              fastest below 1/255",
            "1.5e-3         3.00 ms  c f32              fastest below 0.5/255, most accurate",
            "     –               –  none below 1/1000",
        ] {
            assert!(summary.contains(row), "{row}\n{summary}");
        }
        report.skipped = vec!["d f32".to_owned(), "e f32".to_owned()];
        let summary = report.summary().join("\n");
        assert!(
            summary.contains("2 configurations did not fit in the time budget"),
            "{summary}"
        );
    }

    #[test]
    fn costs_of_f64_and_of_the_stable_formula_are_measured_in_pairs() {
        let mut results = vec![
            result("tracer", 0.001, 0.01),
            result("tracer", 0.0013, 0.0101),
            result("lavapipe strict", 1.0, 0.1),
            result("lavapipe strict", 1.5, 0.01),
        ];
        results[1].configuration.precision = "f64";
        results[3].configuration.sphere_formula = Some("recentered");
        let report = report(results);
        assert_eq!(
            report.double_precision_cost().unwrap(),
            "f64 takes 1.3× the time of f32 and changes the RMSE by at most 1.0e-4."
        );
        let line = report.stable_formula_cost().unwrap();
        assert!(line.contains("takes 50 % longer"), "{line}");
    }
}
