//! The rendering methods that are compared.

use std::fmt;
use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_diagnostic::{File, Files, plural};
use toyproof_eval::{self as eval, Number, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Film, FrameTime, Requirements, Sampler, Scene};
use toyproof_tracer::{self as tracer, Tracer};
use toyproof_translate::FloatMode;

use crate::trade::schedule::Cost;

/// The settings of a rendering method, shown to users.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
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
            write!(f, ", {formula}")?;
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
            kind: self.group as usize,
            size: self.cost,
        }
    }
}

/// The renderer and precision of a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Group {
    Tracer32,
    Tracer64,
    Evaluator32,
    Evaluator64,
    Strict,
    Fast,
    OtherDevice,
}

impl Group {
    pub(super) const ALL: [(Self, &str); 7] = [
        (Self::Tracer32, "tracer, f32"),
        (Self::Tracer64, "tracer, f64"),
        (Self::Evaluator32, "evaluator, f32"),
        (Self::Evaluator64, "evaluator, f64"),
        (Self::Strict, "GPU, strict f32"),
        (Self::Fast, "GPU, fast f32"),
        (Self::OtherDevice, "other GPUs, f32"),
    ];
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

/// A shader prepared for the evaluator and for GPUs.
#[derive(Debug)]
pub(super) struct Shader {
    /// The formula that replaces the shader's ray–sphere intersection; `None` for the shader's own.
    pub(super) formula: Option<&'static str>,
    checked: Checked,
    program: Program,
}

impl Shader {
    /// Prepares a shader; `None` if the text is invalid or the program too large.
    pub(super) fn new(formula: Option<&'static str>, text: &str, options: &glsl::Options) -> Option<Self> {
        let mut files = Files::default();
        let file = files.add(File::new("<trade>", text));
        let checked = glsl::check(&files, file, options).ok()?;
        let limit = options.deadline.left();
        let program = Program::prepared_within(&checked, UndefinedPolicy::Plain, limit).ok()?;
        Some(Self {
            formula,
            checked,
            program,
        })
    }

    pub(super) fn render<N: Number>(
        &self,
        frame: &Frame,
        noise: N::Noise,
        deadline: Instant,
    ) -> Result<Image, eval::Failure> {
        let settings = Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(deadline),
            noise,
            ..Settings::default()
        };
        Ok(self.program.render(frame, &settings)?.framebuffer.image())
    }
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
                let start = Instant::now();
                let image = if *double {
                    shader.render::<f64>(self.frame, (), deadline)
                } else {
                    shader.render::<f32>(self.frame, (), deadline)
                };
                Some((image.ok()?, start.elapsed()))
            }
            Backend::Gpu {
                shader,
                worker,
                float,
            } => {
                let lowered = float.lower(&self.shaders[*shader].checked);
                let worker = &mut self.workers[*worker].1;
                let rendered = worker.draw_unwatched(lowered, self.frame.clone(), *float);
                let rendered = rendered.ok()?;
                let render_time = rendered.draw;
                Some((rendered.image(), render_time))
            }
        }
    }

    /// All methods that run the shaders.
    pub(super) fn shader_methods(&self, samples: f64) -> Vec<Method> {
        let mut methods = Vec::new();
        for (index, shader) in self.shaders.iter().enumerate() {
            let configuration = |renderer: &str, precision| Configuration {
                renderer: renderer.to_owned(),
                precision,
                sphere_formula: shader.formula,
                ..Configuration::default()
            };
            for (double, group, precision) in [
                (false, Group::Evaluator32, "f32"),
                (true, Group::Evaluator64, "f64"),
            ] {
                methods.push(Method {
                    configuration: configuration("evaluator", precision),
                    group,
                    cost: samples * if double { DOUBLE_COST } else { 1.0 },
                    backend: Backend::Evaluator {
                        shader: index,
                        double,
                    },
                });
            }
            for (at, (device, _)) in self.workers.iter().enumerate() {
                for (float, group, name) in [
                    (FloatMode::Strict, Group::Strict, "strict"),
                    (FloatMode::Fast, Group::Fast, "fast"),
                ] {
                    methods.push(Method {
                        configuration: configuration(&format!("{device} {name}"), "f32"),
                        group: if at == 0 { group } else { Group::OtherDevice },
                        cost: samples,
                        backend: Backend::Gpu {
                            shader: index,
                            worker: at,
                            float,
                        },
                    });
                }
            }
        }
        methods
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
