//! The frames of a shader with several passes, with which those of its conversion are compared.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rayon::ThreadPool;
use toyproof_diagnostic::Deadline;
use toyproof_eval::{Observed, Settings, bound};
use toyproof_eval_native::Program;
use toyproof_glsl::Sampling;
use toyproof_gpu::browser::Chromium;
use toyproof_gpu::{PassCode, ShaderArtifact, Worker};
use toyproof_image::{FRAME_RATE, Frame, IDLE_MOUSE, Image, MovingTextures, Texture, cube};
use toyproof_player::{Channel, Clock, Graph, Player, Renderer, State, Storage, Target};
use toyproof_translate::FloatMode;
use toyproof_verify::evaluator::{Evaluation, Evaluator};
use toyproof_verify::project::playback::{CpuPlayback, DevicePlayback, PassShader};
use toyproof_verify::{EVALUATOR_TIME_FACTOR, Failure, within};

use super::passes::{GraphContent, PASS_FRAMES, PASS_SIZES, PassComparison, PassSources};
use super::proof::{EVALUATOR, Rgb8Comparison, Runner};
use super::prover::{ProofError, in_browser};
use super::{Source, TargetCode};

/// The frames of the original shader.
pub(super) struct Original {
    frames: Vec<PlayedFrame>,
    pub(super) device: String,
    /// Each pass in every frame, with the textures that it reads.
    drawn: Vec<Vec<Frame>>,
    /// The undefined operation that occurs in most pixels of a pass in a frame, and that pass.
    pub(super) undefined_by: Option<(usize, Observed)>,
}

/// A frame of the original shader.
pub(super) struct PlayedFrame {
    pub(super) inputs: Frame,
    /// All textures after the frame, in f32.
    state: State,
    /// The pixels of each pass that depend on undefined behavior.
    undefined: Vec<Vec<bool>>,
}

impl Original {
    /// Renders the original in frames that `adapt` changes, and finds its undefined pixels. A driver renders it
    /// strictly, with its own filters.
    pub(super) fn play(
        passes: &PassSources,
        runner: &mut Runner,
        adapt: fn(Frame) -> Frame,
        timeout: Duration,
        pool: Option<&ThreadPool>,
    ) -> Result<Self, ProofError> {
        let (device, mut frames) = match runner {
            Runner::Driver(worker) => Self::play_strictly(passes, worker, adapt, timeout)?,
            Runner::Evaluator(_) => {
                let shader = PassShader {
                    checked: passes.sources.iter().map(|source| source.checked).collect(),
                    graph: passes.graph,
                    media: passes.media,
                    films: MovingTextures::default(),
                };
                let frames = within(pool, || {
                    Evaluated::with(&shader, timeout, |playback| played(passes, playback, adapt))
                })?;
                (EVALUATOR.to_owned(), frames)
            }
        };
        let Observations { drawn, undefined_by } = within(pool, || observe(passes, &mut frames, timeout))?;
        Ok(Self {
            frames,
            device,
            drawn,
            undefined_by,
        })
    }

    /// Renders the original strictly by a driver, whose name is returned with the frames.
    fn play_strictly(
        passes: &PassSources,
        worker: &mut Worker,
        adapt: fn(Frame) -> Frame,
        timeout: Duration,
    ) -> Result<(String, Vec<PlayedFrame>), ProofError> {
        let deadline = Deadline::after(timeout);
        let lowered = passes.sources.iter();
        let lowered = lowered.map(|source| FloatMode::Strict.lower_for_host(source.checked, &deadline));
        let lowered = lowered
            .map(|lowered| Ok((lowered?, FloatMode::Strict)))
            .collect::<Result<Vec<_>, _>>()
            .map_err(ProofError::Overdue)?;
        let code = PassCode::Lowered(lowered);
        let sampling = passes.sources.iter().map(|source| source.checked.sampling);
        let mut playback = open(worker, code, sampling, passes.graph, passes.media)?;
        let device = playback.device().to_owned();
        Ok((device, played(passes, &mut playback, adapt)?))
    }

    /// The frames, and the pixels of the image that depend on undefined behavior in each.
    pub(super) fn images(&self) -> impl Iterator<Item = (&Frame, &[bool])> {
        self.frames.iter().map(|frame| {
            let undefined = frame.undefined.last();
            (&frame.inputs, undefined.map_or(&[][..], Vec::as_slice))
        })
    }

    /// Renders each pass and its conversion in a browser, in every frame from the textures that the original
    /// read. Returns the browser's name and the comparison; `None` for languages that browsers do not run.
    pub(super) fn compare_in_browser(
        &self,
        browser: &mut Chromium,
        sources: &[Source],
        written: &[TargetCode],
    ) -> Result<Option<(String, Rgb8Comparison)>, ProofError> {
        let mut all: Option<(String, Rgb8Comparison)> = None;
        for (pass, (source, written)) in sources.iter().zip(written).enumerate() {
            let undefined = self.frames.iter().map(|frame| frame.undefined[pass].clone());
            let undefined: Vec<_> = undefined.collect();
            let Some((name, shown)) = in_browser(browser, *source, written, &self.drawn[pass], &undefined)?
            else {
                return Ok(None);
            };
            match &mut all {
                Some((_, all)) => all.add(shown),
                None => all = Some((name, shown)),
            }
        }
        Ok(all)
    }

    /// Plays the passes that were read from a conversion, and compares each.
    pub(super) fn compare(
        &self,
        passes: &PassSources,
        runner: &mut Runner,
        artifacts: Vec<ShaderArtifact>,
        graph: &GraphContent,
        (timeout, pool): (Duration, Option<&ThreadPool>),
    ) -> Result<Vec<PassComparison>, ProofError> {
        let upside_down = artifacts.iter().any(ShaderArtifact::is_upside_down);
        let written = match runner {
            Runner::Driver(worker) => {
                let sampling = graph.sampling.iter().copied();
                let code = PassCode::Converted(artifacts);
                let mut playback = open(worker, code, sampling, &graph.graph, passes.media)?;
                return Ok(self.compare_played(passes, &mut playback, upside_down)?);
            }
            Runner::Evaluator(_) => passes.sources.iter().zip(artifacts).zip(&graph.sampling),
        };
        let written = written.map(|((source, artifact), sampling)| {
            let mut written = runner.read(artifact, source.checked, timeout)?;
            written.sampling = *sampling;
            Ok(written)
        });
        let written = written.collect::<Result<Vec<_>, ProofError>>()?;
        let shader = PassShader {
            checked: written.iter().collect(),
            graph: &graph.graph,
            media: passes.media,
            films: MovingTextures::default(),
        };
        Ok(within(pool, || {
            Evaluated::with(&shader, timeout, |playback| {
                self.compare_played(passes, playback, upside_down)
            })
        })?)
    }

    fn compare_played(
        &self,
        passes: &PassSources,
        playback: &mut impl Playback,
        upside_down: bool,
    ) -> Result<Vec<PassComparison>, Failure> {
        let targets: Vec<Target> = passes.graph.passes().iter().map(|pass| pass.target).collect();
        let mut comparisons: Vec<_> = targets.iter().copied().map(PassComparison::new).collect();
        // No frame has been rendered.
        let mut size = [0; 2];
        for frame in &self.frames {
            if frame.inputs.size != size {
                size = frame.inputs.size;
                playback.restart(&start(passes.graph, size))?;
            }
            let images = playback.images(&frame.inputs, &targets)?;
            let mut has_same_bits = true;
            for ((comparison, image), undefined) in comparisons.iter_mut().zip(images).zip(&frame.undefined) {
                let image = if upside_down && comparison.target == Target::Image {
                    image.upside_down()
                } else {
                    image
                };
                has_same_bits &= comparison.add(frame, &image, undefined);
            }
            if !has_same_bits {
                playback.restart(&frame.state)?;
            }
        }
        Ok(comparisons)
    }
}

/// Plays passes frame by frame.
trait Playback {
    /// Continues from a state.
    fn restart(&mut self, state: &State) -> Result<(), Failure>;

    /// Renders the next frame; returns the images of passes.
    fn images(&mut self, frame: &Frame, targets: &[Target]) -> Result<Vec<Image>, Failure>;

    /// The state after a frame, which was rendered last.
    fn state_after(&mut self, frame: &Frame) -> Result<State, Failure>;
}

impl Playback for DevicePlayback<'_> {
    fn restart(&mut self, state: &State) -> Result<(), Failure> {
        Ok(self.restore(state)?)
    }

    fn images(&mut self, frame: &Frame, targets: &[Target]) -> Result<Vec<Image>, Failure> {
        Ok(self.render(frame, targets)?)
    }

    fn state_after(&mut self, frame: &Frame) -> Result<State, Failure> {
        Ok(self.state(frame)?)
    }
}

/// Plays passes on the evaluator.
struct Evaluated<'a> {
    shader: &'a PassShader<'a>,
    programs: &'a [Program],
    /// The time limit of a frame.
    timeout: Duration,
    playback: CpuPlayback<'a, f32>,
}

impl<'a> Evaluated<'a> {
    /// Compiles a shader, and plays it from before the first frame.
    fn with<T>(
        shader: &PassShader,
        timeout: Duration,
        play: impl FnOnce(&mut Evaluated) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let timeout = timeout * EVALUATOR_TIME_FACTOR;
        let programs = shader.programs(timeout);
        let programs = programs.map_err(|(_, refusal)| super::proof::refused(refusal))?;
        play(&mut Evaluated {
            shader,
            programs: &programs,
            timeout,
            playback: Evaluated::from(shader, &programs, timeout, None),
        })
    }

    fn from(
        shader: &'a PassShader<'a>,
        programs: &'a [Program],
        timeout: Duration,
        state: Option<&State>,
    ) -> CpuPlayback<'a, f32> {
        CpuPlayback::new(shader, programs, state, timeout, Settings::plain())
    }
}

impl Playback for Evaluated<'_> {
    fn restart(&mut self, state: &State) -> Result<(), Failure> {
        self.playback = Self::from(self.shader, self.programs, self.timeout, Some(state));
        Ok(())
    }

    fn images(&mut self, frame: &Frame, targets: &[Target]) -> Result<Vec<Image>, Failure> {
        self.playback.render(frame).map_err(|error| error.failure)?;
        let image = |&target: &Target| Image::clone(&stack_of(self.playback.texture(target)));
        Ok(targets.iter().map(image).collect())
    }

    fn state_after(&mut self, frame: &Frame) -> Result<State, Failure> {
        Ok(self.playback.state(frame.frame))
    }
}

/// The frames of the original in all sizes, without their undefined pixels.
fn played(
    passes: &PassSources,
    playback: &mut impl Playback,
    adapt: fn(Frame) -> Frame,
) -> Result<Vec<PlayedFrame>, Failure> {
    let mut frames = Vec::new();
    for size in PASS_SIZES {
        playback.restart(&start(passes.graph, size))?;
        for inputs in inputs(size).map(adapt) {
            playback.images(&inputs, &[])?;
            let state = playback.state_after(&inputs)?;
            frames.push(PlayedFrame {
                inputs,
                state,
                undefined: Vec::new(),
            });
        }
    }
    Ok(frames)
}

/// The image of a texture, which the graph has.
fn stack_of(texture: Option<&Texture>) -> Arc<Image> {
    texture.expect("the state has every texture of the graph").stack()
}

impl PlayedFrame {
    /// The texture that a pass rendered.
    pub(super) fn texture(&self, target: Target) -> Arc<Image> {
        let texture = match target {
            Target::Image => self.state.image.as_ref(),
            Target::Buffer(number) => self.state.buffers[number].as_ref().map(|[last, _]| last),
        };
        stack_of(texture)
    }
}

/// The state before the first frame.
fn start(graph: &Graph, size: [u32; 2]) -> State {
    State {
        frame: -1,
        size,
        buffers: std::array::from_fn(|buffer| graph.uses(buffer).then(|| [zeros(size), zeros(size)])),
        image: None,
    }
}

fn zeros([width, height]: [u32; 2]) -> Texture {
    Image::new(width, height, vec![[0.0; 4]; (width * height) as usize]).into()
}

/// The frames that are played in a size. In the second, the mouse is dragged from the third frame on.
fn inputs(size: [u32; 2]) -> impl Iterator<Item = Frame> {
    let is_second = size == PASS_SIZES[1];
    let clock = Clock {
        inputs: Frame {
            size,
            date: [2026.0, 10.0, 2.0, if is_second { 3_661.5 } else { 0.0 }],
            ..Frame::default()
        },
        rate: f64::from(FRAME_RATE),
        start: 0.0,
    };
    (0..PASS_FRAMES).map(move |number| Frame {
        mouse: if is_second && number > 1 {
            let pressed = if number == 2 { 30.0 } else { -30.0 };
            [40.0 + number as f32, 30.0 + number as f32, 42.0, pressed]
        } else {
            IDLE_MOUSE
        },
        ..clock.frame(number)
    })
}

/// The observations of the evaluator in all passes and frames.
struct Observations {
    /// Each pass in every frame, with the textures that it reads.
    drawn: Vec<Vec<Frame>>,
    /// The undefined operation that occurs in most pixels of a pass in a frame, and that pass.
    undefined_by: Option<(usize, Observed)>,
}

/// Opens the passes of a graph, which start before the first frame.
fn open<'a>(
    worker: &'a mut Worker,
    code: PassCode,
    sampling: impl Iterator<Item = [Sampling; 4]>,
    graph: &Graph,
    media: &[Texture],
) -> Result<DevicePlayback<'a>, Failure> {
    let device = worker
        .open_player(code, sampling.collect(), graph.clone(), media.to_vec(), None)
        .map_err(Failure::Gpu)?;
    Ok(DevicePlayback::opened(worker, device, graph))
}

/// Finds the undefined pixels of all passes and frames.
fn observe(
    passes: &PassSources,
    frames: &mut [PlayedFrame],
    timeout: Duration,
) -> Result<Observations, Failure> {
    let limit = timeout * EVALUATOR_TIME_FACTOR;
    let programs = passes
        .sources
        .iter()
        .map(|source| Program::within(source.checked, limit));
    let programs: Vec<Program> = programs
        .collect::<Result<_, _>>()
        .map_err(super::proof::refused)?;
    let observer = Observer {
        programs: &programs,
        media: passes.media,
        limit,
        rendered: Vec::new(),
        undefined: Vec::new(),
        observations: Observations {
            drawn: vec![Vec::new(); programs.len()],
            undefined_by: None,
        },
    };
    let mut player = Player::new(passes.graph.clone(), observer);
    for frame in frames {
        // The textures of another size are zeros.
        let rendered = passes
            .graph
            .passes()
            .iter()
            .map(|pass| frame.texture(pass.target));
        player.renderer_mut().rendered = rendered.collect();
        player.render(&frame.inputs)?;
        frame.undefined = std::mem::take(&mut player.renderer_mut().undefined);
    }
    Ok(player.into_renderer().observations)
}

/// Finds the undefined pixels of passes; their textures are those that the driver rendered, so that it and
/// the evaluator never diverge.
struct Observer<'a> {
    programs: &'a [Program],
    media: &'a [Texture],
    /// The time limit of an image.
    limit: Duration,
    /// The images of this frame, for each pass.
    rendered: Vec<Arc<Image>>,
    /// The undefined pixels of each pass of this frame.
    undefined: Vec<Vec<bool>>,
    observations: Observations,
}

impl Renderer for Observer<'_> {
    type Texture = Texture;
    type Error = Failure;

    fn zeros(&mut self, storage: Storage, mipmaps: bool) -> Result<Texture, Failure> {
        let zeros = match storage {
            Storage::Image(size) => zeros(size),
            Storage::Cube(side) => zeros([side, side * cube::FACES]).into_cube(),
        };
        Ok(if mipmaps { zeros.with_mipmaps() } else { zeros })
    }

    fn draw(
        &mut self,
        pass: usize,
        over: Texture,
        frame: &Frame,
        channels: [Channel<'_, Texture>; 4],
    ) -> Result<Texture, Failure> {
        let frame = bound(frame, channels, self.media);
        let stop = AtomicBool::new(false);
        let evaluator = Evaluator::new(&self.programs[pass], &frame, self.limit, &stop);
        let Evaluation {
            undefined, observed, ..
        } = evaluator.single(&frame.rows())?;
        if observed.beyond_cap > 0 {
            return Err(Failure::LoopTruncated(observed.beyond_cap));
        }
        self.undefined.push(undefined);
        self.observations.drawn[pass].push(frame);
        let faults = observed
            .faults
            .iter()
            .filter(|observed| observed.site.fault.is_undefined());
        let most = faults
            .map(|&observed| (pass, observed))
            .chain(self.observations.undefined_by);
        self.observations.undefined_by = most.max_by_key(|(_, observed)| observed.pixels);
        let texture = Texture::from(Image::clone(&self.rendered[pass])).shaped_as(&over);
        Ok(if over.levels() > 1 {
            texture.with_mipmaps()
        } else {
            texture
        })
    }

    /// Starts again: the frames of another size are another run.
    fn resized(&mut self, texture: Texture, size: [u32; 2]) -> Result<Texture, Failure> {
        self.zeros(Storage::Image(size), texture.levels() > 1)
    }
}
