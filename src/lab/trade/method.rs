//! The rendering methods that are compared.

use std::fmt;
use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_diagnostic::plural;
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Film, FrameTime, Requirements, Sampler, Scene};
use toyproof_tracer::{self as tracer, Tracer};
use toyproof_translate::FloatMode;

use super::parameter::Setting;
use super::schedule::Cost;
use super::source::Shader;

/// The settings of a rendering method, shown to users.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Configuration {
    /// The tracer, the evaluator, or a GPU with its float mode.
    pub renderer: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// The sampler, if the scene requires samples.
    pub sampler: Option<&'static str>,
    /// The samples per pixel, if the scene requires samples.
    pub samples_per_pixel: Option<u32>,
    /// The maximum depth, if it is not the scene's.
    pub max_depth: Option<u32>,
    /// The formula that replaces the shader's own ray–sphere intersection.
    pub sphere_formula: Option<&'static str>,
    /// The parameters of the shader that have another value.
    pub settings: Vec<Setting>,
}

impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.renderer, self.precision)?;
        if let Some(sampler) = self.sampler {
            write!(f, ", {sampler}")?;
        }
        if let Some(samples) = self.samples_per_pixel {
            let noun = plural(u64::from(samples), "sample", "samples");
            write!(f, ", {samples} {noun}")?;
        }
        if let Some(depth) = self.max_depth {
            write!(f, ", depth {depth}")?;
        }
        if let Some(formula) = self.sphere_formula {
            write!(f, ", {formula} formula")?;
        }
        for setting in &self.settings {
            write!(f, ", {setting}")?;
        }
        Ok(())
    }
}

/// The cost of a frame in f64, relative to f32.
const DOUBLE_COST: f64 = 1.5;

/// A method of rendering an image.
#[derive(Debug)]
pub(super) struct Method {
    pub(super) configuration: Configuration,
    /// The device and precision, which other methods may share.
    pub(super) group: Group,
    /// The estimated cost of a frame, in samples. It predicts times within a group, and orders the first runs
    /// of all methods.
    pub(super) cost: f64,
    pub(super) backend: Backend,
}

impl Method {
    pub(super) fn scheduled_cost(&self) -> Cost {
        Cost {
            kind: self.group.index(),
            size: self.cost,
        }
    }
}

/// The renderer and precision of a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    Tracer32,
    Tracer64,
    Evaluator32,
    Evaluator64,
    /// A GPU, by its index.
    Device(usize, FloatMode),
}

impl Group {
    fn index(self) -> usize {
        match self {
            Self::Tracer32 => 0,
            Self::Tracer64 => 1,
            Self::Evaluator32 => 2,
            Self::Evaluator64 => 3,
            Self::Device(at, float) => 4 + 2 * at + usize::from(float == FloatMode::Fast),
        }
    }
}

/// The renderer of a method, with its settings.
#[derive(Debug)]
pub(super) enum Backend {
    /// The tracer, in f64 or f32.
    Tracer { scene: Box<Scene>, double: bool },
    /// The evaluator, with the index of a shader.
    Evaluator { shader: usize, double: bool },
    /// A GPU, with the indices of a shader and a worker.
    Gpu {
        shader: usize,
        worker: usize,
        float: FloatMode,
    },
}

/// The inputs and devices that methods share.
pub(super) struct RenderContext<'a> {
    pub(super) frame: &'a Frame,
    pub(super) shaders: Vec<Shader>,
    pub(super) workers: Vec<(String, Worker)>,
    /// The time limit of a frame.
    pub(super) frame_timeout: Duration,
}

impl RenderContext<'_> {
    pub(super) fn frame_time(frame: &Frame) -> FrameTime {
        FrameTime {
            frame: frame.frame,
            time: f64::from(frame.time),
        }
    }

    /// Renders a frame, and measures its time without preparation; `None` if the renderer fails.
    pub(super) fn render(&mut self, backend: &Backend) -> Option<(Image, Duration)> {
        let deadline = Instant::now() + self.frame_timeout;
        match backend {
            Backend::Tracer { scene, double } => Some(if *double {
                render_traced::<f64>(scene, self.frame)
            } else {
                render_traced::<f32>(scene, self.frame)
            }),
            Backend::Evaluator { shader, double } => {
                let shader = &self.shaders[*shader];
                let rendered = if *double {
                    shader.evaluate::<f64>(self.frame, (), deadline)
                } else {
                    shader.evaluate::<f32>(self.frame, (), deadline)
                };
                rendered.ok()
            }
            Backend::Gpu {
                shader,
                worker,
                float,
            } => {
                let worker = &mut self.workers[*worker].1;
                self.shaders[*shader].draw(worker, self.frame, *float, self.frame_timeout)
            }
        }
    }

    /// All methods that run the shaders. Other settings than the user's are measured in f32, and by drivers
    /// with their fast arithmetic, which hosts have.
    pub(super) fn shader_methods(&self, samples: f64) -> Vec<Method> {
        let mut methods = Vec::new();
        for (index, shader) in self.shaders.iter().enumerate() {
            let is_own = shader.settings.is_empty();
            let mut add = |renderer: &str, precision, group, cost, backend| {
                methods.push(Method {
                    configuration: Configuration {
                        renderer: renderer.to_owned(),
                        precision,
                        sphere_formula: shader.formula,
                        settings: shader.settings.clone(),
                        ..Configuration::default()
                    },
                    group,
                    cost,
                    backend,
                });
            };
            for (double, group, precision) in [
                (false, Group::Evaluator32, "f32"),
                (true, Group::Evaluator64, "f64"),
            ] {
                let cost = samples * if double { DOUBLE_COST } else { 1.0 };
                let backend = Backend::Evaluator {
                    shader: index,
                    double,
                };
                if is_own || !double {
                    add("evaluator", precision, group, cost, backend);
                }
            }
            for (at, (device, _)) in self.workers.iter().enumerate() {
                for (float, name) in [(FloatMode::Strict, "strict"), (FloatMode::Fast, "fast")] {
                    let backend = Backend::Gpu {
                        shader: index,
                        worker: at,
                        float,
                    };
                    if is_own || float == FloatMode::Fast {
                        let group = Group::Device(at, float);
                        add(&format!("{device} {name}"), "f32", group, samples, backend);
                    }
                }
            }
        }
        methods
    }

    /// The name of a group in charts.
    pub(super) fn group_name(&self, group: Group) -> String {
        match group {
            Group::Tracer32 => "tracer, f32".to_owned(),
            Group::Tracer64 => "tracer, f64".to_owned(),
            Group::Evaluator32 => "evaluator, f32".to_owned(),
            Group::Evaluator64 => "evaluator, f64".to_owned(),
            Group::Device(at, FloatMode::Strict) => format!("{}, strict f32", self.workers[at].0),
            Group::Device(at, FloatMode::Fast) => format!("{}, fast f32", self.workers[at].0),
        }
    }
}

fn render_traced<T: tracer::Backend>(scene: &Scene, frame: &Frame) -> (Image, Duration) {
    let start = Instant::now();
    let image = Tracer::<T>::at(scene, RenderContext::frame_time(frame)).render(|| ());
    (image, start.elapsed())
}

/// Samples per pixel that are compared.
const SAMPLE_COUNTS: [u32; 4] = [1, 4, 16, 64];

/// Samplers compared for scenes that require samples, with their names.
const SAMPLERS: [(Sampler, &str); 3] = [
    (Sampler::Independent, "independent"),
    (Sampler::Stratified, "stratified"),
    (Sampler::Sobol, "Sobol"),
];

/// All methods that use the tracer: varies only the settings that the scene requires.
pub(super) fn scene_methods(scene: &Scene) -> Vec<Method> {
    let requirements = Requirements::new(scene);
    let film = scene.film;
    let mut films = Vec::new();
    if requirements.samples {
        for (sampler, name) in SAMPLERS {
            for samples in SAMPLE_COUNTS {
                films.push((
                    Configuration {
                        sampler: Some(name),
                        samples_per_pixel: Some(samples),
                        ..Configuration::default()
                    },
                    Film {
                        samples,
                        sampler,
                        ..film
                    },
                ));
            }
        }
        if film.sampler == Sampler::SineHash {
            let configuration = Configuration {
                sampler: Some("sine hash"),
                samples_per_pixel: Some(film.samples),
                ..Configuration::default()
            };
            films.push((configuration, film));
        }
    } else {
        films.push((Configuration::default(), film));
    }
    if requirements.secondary_rays {
        // The depths 1, 2, 3, 5, 8, … below the scene's maximum depth.
        let (mut depth, mut next) = (1, 2);
        while depth < film.max_depth {
            films.push((
                Configuration {
                    max_depth: Some(depth),
                    ..Configuration::default()
                },
                Film {
                    max_depth: depth,
                    ..film
                },
            ));
            (depth, next) = (next, depth + next);
        }
    }
    let methods = films.into_iter().flat_map(|(configuration, film)| {
        [(false, Group::Tracer32, "f32"), (true, Group::Tracer64, "f64")].map(|(double, group, precision)| {
            Method {
                configuration: Configuration {
                    renderer: "tracer".to_owned(),
                    precision,
                    ..configuration.clone()
                },
                group,
                cost: f64::from(film.samples) * if double { DOUBLE_COST } else { 1.0 },
                backend: Backend::Tracer {
                    scene: Box::new(Scene {
                        film,
                        ..scene.clone()
                    }),
                    double,
                },
            }
        })
    });
    methods.collect()
}
