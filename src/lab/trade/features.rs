//! The price of each feature of a scene: the time of a frame without it and with it, and the pixels that it
//! changes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_diagnostic::{columns, grouped, spreadsheet_text};
use toyproof_glsl as glsl;
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Integrator, Model, Requirements, Sampler, Scene, Shape, ToneMap, export};
use toyproof_translate::FloatMode;
use toyproof_verify::compare;

use super::method::{Backend, RenderContext};
use super::schedule::{self, Cost, RunKind, Runner, TimeStatistics};
use super::source::Shader;
use super::{TradeError, median};
use crate::{csv_table, json_file};

/// A scene, and what renders it.
#[derive(Debug)]
pub struct FeatureSubject<'a> {
    /// The name shown to users.
    pub name: String,
    /// The scene, at the frame's size.
    pub scene: &'a Scene,
    /// The options of the exported shaders' language.
    pub options: glsl::Options,
    /// The frame.
    pub frame: &'a Frame,
    /// Devices by name, each with its worker.
    pub workers: Vec<(String, Worker)>,
    /// The start of the time budget.
    pub start: Instant,
    /// The time budget of the whole measurement, from `start`.
    pub budget: Duration,
}

/// The prices of the features of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureReport {
    /// The name of the scene.
    pub subject: String,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// The renderers, each with its time for the scene with all features.
    pub renderers: Vec<RendererTime>,
    /// The features that the scene uses.
    pub features: Vec<Feature>,
}

/// The time of a renderer for a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RendererTime {
    /// The name of the renderer.
    pub renderer: String,
    /// The time of a frame.
    pub seconds_per_frame: TimeStatistics,
}

/// A feature that a scene uses.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Feature {
    /// The name.
    pub name: &'static str,
    /// The number of pixels whose 8-bit values change without it.
    pub changed_pixels: u64,
    /// Its price for each renderer that was measured.
    pub prices: Vec<Price>,
}

/// The price of a feature for a renderer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Price {
    /// The name of the renderer.
    pub renderer: String,
    /// The time of a frame without the feature.
    pub without: TimeStatistics,
    /// The median ratio of the times with and without it, of runs that followed each other.
    pub ratio: f64,
    /// The median absolute deviation of the ratio.
    pub deviation: f64,
}

/// Returns the scene without each feature that it uses and that can be removed alone.
fn variants(scene: &Scene) -> Vec<(&'static str, Scene)> {
    let requirements = Requirements::new(scene);
    let is_stochastic = requirements.soft_shadows || requirements.path_tracing;
    let mut variants = Vec::new();
    let mut add = |is_used: bool, name: &'static str, remove: &dyn Fn(&mut Scene)| {
        if is_used {
            let mut without = scene.clone();
            remove(&mut without);
            without.release_changed_scatters();
            variants.push((name, without));
        }
    };
    add(requirements.figures, "figures", &|scene| scene.figures.clear());
    add(requirements.shapes, "planes, quadrics and boxes", &|scene| {
        let spheres = scene
            .objects
            .iter()
            .map(|object| matches!(object.shape, Shape::Sphere { .. }));
        let spheres: Vec<_> = spheres.collect();
        scene.retain_objects(|at| spheres[at]);
    });
    add(requirements.patterns, "patterns", &|scene| {
        for object in &mut scene.objects {
            object.material.pattern = None;
        }
    });
    add(requirements.secondary_rays, "secondary rays", &|scene| {
        scene.film.max_depth = 1;
    });
    add(requirements.branches, "glass (as mirrors)", &|scene| {
        for object in &mut scene.objects {
            if let Model::Glass { .. } = object.material.model {
                object.material.model = Model::Mirror;
            }
        }
    });
    // In path tracing every surface casts shadows.
    add(
        requirements.shadows && !requirements.path_tracing,
        "shadows",
        &|scene| {
            for light in &mut scene.lights {
                light.shadow = false;
            }
        },
    );
    add(requirements.soft_shadows, "soft shadows", &|scene| {
        for light in &mut scene.lights {
            light.radius = 0.0;
        }
    });
    add(requirements.path_tracing, "path tracing", &|scene| {
        scene.film.integrator = Integrator::Whitted;
    });
    add(requirements.samples, "multiple samples", &|scene| {
        scene.film.samples = 1;
        if !is_stochastic {
            scene.film.sampler = Sampler::Center;
        }
    });
    add(requirements.transfer, "tone mapping and gamma", &|scene| {
        scene.film.tone_map = ToneMap::None;
        scene.film.gamma = 1.0;
    });
    add(requirements.motion, "motion", &|scene| {
        for light in &mut scene.lights {
            light.motion = None;
        }
        for object in &mut scene.objects {
            object.motion = None;
        }
    });
    variants
}

/// A scene, or one without a feature, by a renderer.
struct Task {
    /// The number of the scene: 0 for the one with all features.
    variant: usize,
    renderer: usize,
    cost: Cost,
    backend: Backend,
}

/// Measures the price of each feature of a scene within the time budget; calls `progress` with the share of the
/// budget that has elapsed.
///
/// # Errors
///
/// [`TradeError::Interrupted`] soon after `interrupt` is set.
pub fn features(
    subject: FeatureSubject,
    interrupt: &AtomicBool,
    progress: impl Fn(f64),
) -> Result<FeatureReport, TradeError> {
    let budget = subject.budget.mul_f64(0.97);
    let variants = variants(subject.scene);
    let names: Vec<_> = variants.iter().map(|(name, _)| *name).collect();
    let scenes = std::iter::once(subject.scene.clone()).chain(variants.into_iter().map(|(_, scene)| scene));
    let mut context = RenderContext {
        frame: subject.frame,
        shaders: Vec::new(),
        workers: subject.workers,
        frame_timeout: budget,
    };
    let mut renderers = vec!["tracer f32".to_owned(), "evaluator f32".to_owned()];
    renderers.extend(
        context
            .workers
            .iter()
            .map(|(device, _)| format!("{device} strict")),
    );
    let mut tasks = Vec::new();
    for (variant, scene) in scenes.enumerate() {
        let size = f64::from(scene.film.samples);
        let shader = export::shader(&scene).ok();
        let shader = shader.and_then(|text| Shader::new(None, &text, &subject.options));
        let mut push = |renderer: usize, backend| {
            tasks.push(Task {
                variant,
                renderer,
                cost: Cost { kind: renderer, size },
                backend,
            });
        };
        let scene = Box::new(scene);
        push(0, Backend::Tracer { scene, double: false });
        let Some(shader) = shader else { continue };
        let index = context.shaders.len();
        context.shaders.push(shader);
        let evaluator = Backend::Evaluator {
            shader: index,
            double: false,
        };
        push(1, evaluator);
        for worker in 0..context.workers.len() {
            let backend = Backend::Gpu {
                shader: index,
                worker,
                float: FloatMode::Strict,
            };
            push(2 + worker, backend);
        }
    }
    let costs: Vec<_> = tasks.iter().map(|task| task.cost).collect();
    let mut bench = FeatureBench {
        start: subject.start,
        budget,
        context,
        images: vec![None; names.len() + 1],
        tasks,
        interrupt,
        progress,
    };
    let seconds = schedule::measure(&mut bench, &costs, budget.as_secs_f64())?;
    let times = |variant: usize, renderer: usize| {
        let mut tasks = bench.tasks.iter().zip(&seconds);
        let found = tasks.find(|(task, _)| task.variant == variant && task.renderer == renderer);
        found
            .map(|(_, seconds)| &seconds[..])
            .filter(|seconds| !seconds.is_empty())
    };
    let features = names.iter().zip(1..).map(|(&name, variant)| {
        let prices = renderers
            .iter()
            .enumerate()
            .filter_map(|(at, renderer)| price(renderer, times(0, at)?, times(variant, at)?));
        Feature {
            name,
            changed_pixels: changed(bench.images[0].as_ref(), bench.images[variant].as_ref()),
            prices: prices.collect(),
        }
    });
    let features = features.collect();
    let renderers = renderers.iter().enumerate().filter_map(|(at, renderer)| {
        Some(RendererTime {
            renderer: renderer.clone(),
            seconds_per_frame: TimeStatistics::new(times(0, at)?),
        })
    });
    Ok(FeatureReport {
        subject: subject.name,
        size: subject.frame.size,
        renderers: renderers.collect(),
        features,
    })
}

/// The ratio of times of runs that followed each other, in the order of the schedule.
fn price(renderer: &str, with: &[f64], without: &[f64]) -> Option<Price> {
    let ratios: Vec<_> = with
        .iter()
        .zip(without)
        .map(|(with, without)| with / without)
        .collect();
    let ratio = (!ratios.is_empty()).then(|| median(&ratios))?;
    let deviations: Vec<_> = ratios.iter().map(|other| (other - ratio).abs()).collect();
    Some(Price {
        renderer: renderer.to_owned(),
        without: TimeStatistics::new(without),
        ratio,
        deviation: median(&deviations),
    })
}

fn changed(with: Option<&Image>, without: Option<&Image>) -> u64 {
    match (with, without) {
        (Some(with), Some(without)) => compare::compare(with, without).0.differing_8bit,
        _ => 0,
    }
}

/// Renders the scenes, and keeps the tracer's images.
struct FeatureBench<'a, P> {
    start: Instant,
    budget: Duration,
    context: RenderContext<'a>,
    tasks: Vec<Task>,
    /// The tracer's image of each scene.
    images: Vec<Option<Image>>,
    interrupt: &'a AtomicBool,
    progress: P,
}

impl<P: Fn(f64)> Runner for FeatureBench<'_, P> {
    type Error = TradeError;

    fn run(&mut self, task: usize, kind: RunKind) -> Result<Option<f64>, TradeError> {
        if self.interrupt.load(Ordering::Relaxed) {
            return Err(TradeError::Interrupted);
        }
        let left = self.budget.saturating_sub(self.start.elapsed());
        self.context.frame_timeout = left.max(Duration::from_millis(100));
        let Task {
            variant,
            renderer,
            ref backend,
            ..
        } = self.tasks[task];
        let rendered = self.context.render(backend);
        (self.progress)(self.now() / self.budget.as_secs_f64());
        let Some((image, took)) = rendered else {
            return Ok(None);
        };
        if kind == RunKind::WarmUp && renderer == 0 {
            self.images[variant] = Some(image);
        }
        Ok(Some(took.as_secs_f64()))
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

const COLUMNS: [&str; 9] = [
    "feature",
    "changed_pixels",
    "renderer",
    "seconds_without",
    "seconds_without_median_absolute_deviation",
    "runs",
    "outliers",
    "ratio",
    "ratio_median_absolute_deviation",
];

impl FeatureReport {
    /// A table (RFC 4180) with a row for each feature and renderer.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.features.iter().flat_map(|feature| {
            feature.prices.iter().map(|price| {
                vec![
                    feature.name.to_owned(),
                    feature.changed_pixels.to_string(),
                    spreadsheet_text(&price.renderer),
                    price.without.median.to_string(),
                    price.without.deviation.to_string(),
                    price.without.runs.to_string(),
                    price.without.outliers.to_string(),
                    price.ratio.to_string(),
                    price.deviation.to_string(),
                ]
            })
        });
        csv_table(COLUMNS, rows)
    }

    /// All results as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        json_file(self)
    }

    /// The prices as a table: for each renderer the ratio of the times with and without a feature.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let [width, height] = self.size;
        let mut lines = vec![format!(
            "Price of each feature: {}, {width}×{height} pixels",
            self.subject
        )];
        if self.features.is_empty() {
            lines.push("the scene has no feature that can be left out".to_owned());
            return lines;
        }
        let names = || self.renderers.iter().map(|time| &time.renderer);
        let header = ["feature".to_owned(), "pixels changed".to_owned()].into_iter();
        let mut rows = vec![header.chain(names().cloned()).collect::<Vec<_>>()];
        let frame = self
            .renderers
            .iter()
            .map(|time| milliseconds(time.seconds_per_frame.median));
        let all = ["all".to_owned(), String::new()].into_iter();
        rows.push(all.chain(frame).collect());
        let pixels = f64::from(width) * f64::from(height);
        for feature in &self.features {
            let share = 100.0 * feature.changed_pixels as f64 / pixels;
            let changed = format!("{} ({share:.1} %)", grouped(feature.changed_pixels));
            let prices = names().map(|name| {
                let found = feature.prices.iter().find(|price| price.renderer == *name);
                found.map_or_else(
                    || "–".to_owned(),
                    |price| format!("{:.2}× ± {:.2}", price.ratio, price.deviation),
                )
            });
            rows.push(
                [feature.name.to_owned(), changed]
                    .into_iter()
                    .chain(prices)
                    .collect(),
            );
        }
        let right: Vec<usize> = (1..rows[0].len()).collect();
        lines.extend(columns("  ", &rows, &right));
        lines.push(
            "A ratio is the time with the feature over that without it, the median of interleaved runs."
                .to_owned(),
        );
        lines
    }
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.2} ms", 1e3 * seconds)
}
