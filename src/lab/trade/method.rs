//! The rendering methods that are compared.

use std::time::{Duration, Instant};

use toyproof_diagnostic::{File, Files};
use toyproof_eval::{self as eval, Number, Program, Settings, UndefinedPolicy};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Film, FrameTime, Requirements, Sampler, Scene};
use toyproof_tracer::{Real, Tracer};
use toyproof_translate::FloatMode;

use crate::trade::schedule::Cost;

/// A method of rendering an image.
#[derive(Debug)]
pub(super) struct Method {
    /// A short description.
    pub(super) name: String,
    /// The device and precision that it shares with other methods.
    pub(super) group: Group,
    /// The estimated cost of a frame, in samples; comparable within a group.
    pub(super) cost: f64,
    pub(super) backend: Backend,
}

impl Method {
    pub(super) fn cost(&self) -> Cost {
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
        (Self::Strict, "GPU, strict"),
        (Self::Fast, "GPU, fast"),
        (Self::OtherDevice, "another GPU"),
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
    /// The formula that replaces its ray–sphere intersection; empty for its own.
    pub(super) formula: &'static str,
    checked: Checked,
    program: Program,
}

impl Shader {
    /// Prepares a shader; `None` if the text is invalid or the program too large.
    pub(super) fn new(formula: &'static str, text: &str, options: &glsl::Options) -> Option<Self> {
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
            let formula = shader.formula;
            let named = |name: &str| {
                if formula.is_empty() {
                    name.to_owned()
                } else {
                    format!("{name}, {formula}")
                }
            };
            for (double, group, name) in [
                (false, Group::Evaluator32, "evaluator f32"),
                (true, Group::Evaluator64, "evaluator f64"),
            ] {
                methods.push(Method {
                    name: named(name),
                    group,
                    cost: samples * if double { 1.5 } else { 1.0 },
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
                        name: named(&format!("{device} {name}")),
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

fn render_traced<T: Real>(scene: &Scene, frame: &Frame) -> (Image, Duration) {
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
    (Sampler::Sobol, "sobol"),
];

/// All methods that use the tracer: varies only the settings that the scene requires.
pub(super) fn scene_methods(scene: &Scene) -> Vec<Method> {
    let requirements = Requirements::of(scene);
    let film = scene.film;
    let mut films = Vec::new();
    if requirements.samples {
        for (sampler, name) in SAMPLERS {
            for samples in SAMPLE_COUNTS {
                let film_label = format!("{name} {samples}");
                films.push((
                    film_label,
                    Film {
                        samples,
                        sampler,
                        ..film
                    },
                ));
            }
        }
        if film.sampler == Sampler::SineHash {
            films.push((format!("sine-hash {}", film.samples), film));
        }
    } else {
        films.push((String::new(), film));
    }
    if requirements.secondary_rays {
        // The depths 1, 2, 3, 5, 8, … below the scene's maximum depth.
        let (mut depth, mut next) = (1, 2);
        while depth < film.max_depth {
            let film_label = format!("depth {depth}");
            films.push((
                film_label,
                Film {
                    max_depth: depth,
                    ..film
                },
            ));
            (depth, next) = (next, depth + next);
        }
    }
    let methods = films.into_iter().flat_map(|(film_label, film)| {
        [
            (false, Group::Tracer32, "tracer f32"),
            (true, Group::Tracer64, "tracer f64"),
        ]
        .map(|(double, group, name)| Method {
            name: if film_label.is_empty() {
                name.to_owned()
            } else {
                format!("{name}, {film_label}")
            },
            group,
            cost: f64::from(film.samples) * if double { 1.5 } else { 1.0 },
            backend: Backend::Tracer {
                scene: Box::new(Scene {
                    film,
                    ..scene.clone()
                }),
                double,
            },
        })
    });
    methods.collect()
}
