//! The ways to a picture.

use std::time::{Duration, Instant};

use toyproof_diagnostic::{File, Files};
use toyproof_eval::{self as eval, Number, Program, Settings, Variant};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Film, Moment, Requirements, Sampler, Scene};
use toyproof_tracer::{Real, Tracer};
use toyproof_translate::FloatMode;

use super::schedule::Cost;

/// A way to a picture.
#[derive(Debug)]
pub(super) struct Way {
    /// What it is, in a few words.
    pub(super) name: String,
    /// What it has in common with others.
    pub(super) group: Group,
    /// What its frame is thought to cost, in samples of its kind.
    pub(super) cost: f64,
    pub(super) how: How,
}

impl Way {
    pub(super) fn cost(&self) -> Cost {
        Cost {
            kind: self.group as usize,
            size: self.cost,
        }
    }
}

/// What runs a way.
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

/// How a way's picture is made.
#[derive(Debug)]
pub(super) enum How {
    /// By the tracer, in f64 or f32.
    Traced { scene: Box<Scene>, double: bool },
    /// By the evaluator, of one of the shaders.
    Evaluated { shader: usize, double: bool },
    /// By a GPU, likewise: one of the workers.
    Drawn {
        shader: usize,
        worker: usize,
        float: FloatMode,
    },
}

/// A shader, ready for all that may run it.
#[derive(Debug)]
pub(super) struct Shader {
    /// Which formula it meets spheres with; empty for its own.
    pub(super) formula: &'static str,
    checked: Checked,
    program: Program,
}

impl Shader {
    /// From its text; none if that is not valid, or too large.
    pub(super) fn new(formula: &'static str, text: &str, options: &glsl::Options) -> Option<Self> {
        let mut files = Files::default();
        let file = files.add(File::new("<trade>", text));
        let checked = glsl::check(&files, file, options).ok()?;
        let limit = options.deadline.left();
        let program = Program::prepared_within(&checked, Variant::Plain, limit).ok()?;
        Some(Self {
            formula,
            checked,
            program,
        })
    }

    pub(super) fn paint<N: Number>(
        &self,
        frame: &Frame,
        noise: N::Noise,
        deadline: Instant,
    ) -> Result<Image, eval::Failure> {
        let settings = Settings::<N> {
            variant: Variant::Plain,
            deadline: Some(deadline),
            noise,
            ..Settings::default()
        };
        Ok(self.program.paint(frame, &settings)?.painting.image())
    }
}

/// What ways are made of.
pub(super) struct Workshop<'a> {
    pub(super) frame: &'a Frame,
    pub(super) shaders: Vec<Shader>,
    pub(super) workers: Vec<(String, Worker)>,
    /// How long a frame may take.
    pub(super) patience: Duration,
}

impl Workshop<'_> {
    pub(super) fn moment(frame: &Frame) -> Moment {
        Moment {
            frame: frame.frame,
            time: f64::from(frame.time),
        }
    }

    /// A frame, and the time that it took without what comes before it; none if there is none to be had.
    pub(super) fn make(&mut self, how: &How) -> Option<(Image, Duration)> {
        let deadline = Instant::now() + self.patience;
        match how {
            How::Traced { scene, double } => Some(if *double {
                traced::<f64>(scene, self.frame)
            } else {
                traced::<f32>(scene, self.frame)
            }),
            How::Evaluated { shader, double } => {
                let shader = &self.shaders[*shader];
                let start = Instant::now();
                let image = if *double {
                    shader.paint::<f64>(self.frame, (), deadline)
                } else {
                    shader.paint::<f32>(self.frame, (), deadline)
                };
                Some((image.ok()?, start.elapsed()))
            }
            How::Drawn {
                shader,
                worker,
                float,
            } => {
                let lowered = float.lower(&self.shaders[*shader].checked);
                let worker = &mut self.workers[*worker].1;
                let drawn = worker.draw_unwatched(lowered, self.frame.clone(), *float);
                let drawn = drawn.ok()?;
                let painting = drawn.draw;
                Some((drawn.image(), painting))
            }
        }
    }

    /// All ways that the shaders have.
    pub(super) fn of_shaders(&self, samples: f64) -> Vec<Way> {
        let mut ways = Vec::new();
        for (index, shader) in self.shaders.iter().enumerate() {
            let formula = shader.formula;
            let named = |what: &str| {
                if formula.is_empty() {
                    what.to_owned()
                } else {
                    format!("{what}, {formula}")
                }
            };
            for (double, group, what) in [
                (false, Group::Evaluator32, "evaluator f32"),
                (true, Group::Evaluator64, "evaluator f64"),
            ] {
                ways.push(Way {
                    name: named(what),
                    group,
                    cost: samples * if double { 1.5 } else { 1.0 },
                    how: How::Evaluated {
                        shader: index,
                        double,
                    },
                });
            }
            for (at, (device, _)) in self.workers.iter().enumerate() {
                for (float, group, what) in [
                    (FloatMode::Strict, Group::Strict, "strict"),
                    (FloatMode::Fast, Group::Fast, "fast"),
                ] {
                    ways.push(Way {
                        name: named(&format!("{device} {what}")),
                        group: if at == 0 { group } else { Group::OtherDevice },
                        cost: samples,
                        how: How::Drawn {
                            shader: index,
                            worker: at,
                            float,
                        },
                    });
                }
            }
        }
        ways
    }
}

fn traced<T: Real>(scene: &Scene, frame: &Frame) -> (Image, Duration) {
    let start = Instant::now();
    let picture = Tracer::<T>::at(scene, Workshop::moment(frame)).picture(|| ());
    (picture, start.elapsed())
}

/// Numbers of samples that are tried.
const SAMPLES: [u32; 4] = [1, 4, 16, 64];
/// Samplers that are tried where a scene's draws, and their names.
const SAMPLERS: [(Sampler, &str); 3] = [
    (Sampler::Independent, "independent"),
    (Sampler::Stratified, "stratified"),
    (Sampler::Sobol, "sobol"),
];

/// All ways that the tracer has: only what the scene asks for is varied.
pub(super) fn of_scene(scene: &Scene) -> Vec<Way> {
    let requirements = Requirements::of(scene);
    let film = scene.film;
    let mut films = Vec::new();
    if requirements.samples {
        for (sampler, name) in SAMPLERS {
            for samples in SAMPLES {
                let words = format!("{name} {samples}");
                films.push((
                    words,
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
        // 1, 2, 3, 5, 8 …: fewer rays are followed.
        let (mut depth, mut next) = (1, 2);
        while depth < film.max_depth {
            let words = format!("depth {depth}");
            films.push((
                words,
                Film {
                    max_depth: depth,
                    ..film
                },
            ));
            (depth, next) = (next, depth + next);
        }
    }
    let ways = films.into_iter().flat_map(|(words, film)| {
        [
            (false, Group::Tracer32, "tracer f32"),
            (true, Group::Tracer64, "tracer f64"),
        ]
        .map(|(double, group, what)| Way {
            name: if words.is_empty() {
                what.to_owned()
            } else {
                format!("{what}, {words}")
            },
            group,
            cost: f64::from(film.samples) * if double { 1.5 } else { 1.0 },
            how: How::Traced {
                scene: Box::new(Scene {
                    film,
                    ..scene.clone()
                }),
                double,
            },
        })
    });
    ways.collect()
}
