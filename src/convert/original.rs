//! The frames of a shader with several passes, with which those of its conversion are compared.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rayon::ThreadPool;
use toyproof_diagnostic::Deadline;
use toyproof_eval::{Observed, bound};
use toyproof_eval_native::Program;
use toyproof_glsl::Sampling;
use toyproof_gpu::browser::Chromium;
use toyproof_gpu::{PassCode, ShaderArtifact, Worker};
use toyproof_image::{FRAME_RATE, Frame, IDLE_MOUSE, Image, Texture, cube};
use toyproof_player::{Channel, Clock, Graph, Player, Renderer, State, Storage, Target};
use toyproof_translate::FloatMode;
use toyproof_verify::evaluator::{Evaluation, Evaluator};
use toyproof_verify::project::playback::DevicePlayback;
use toyproof_verify::{EVALUATOR_TIME_FACTOR, Failure, within};

use super::passes::{GraphContent, PASS_FRAMES, PASS_SIZES, PassComparison, PassSources};
use super::proof::Rgb8Comparison;
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
    /// Renders the original strictly in frames that `adapt` changes, with the driver's filters, and finds its
    /// undefined pixels.
    pub(super) fn play(
        passes: &PassSources,
        worker: &mut Worker,
        adapt: fn(Frame) -> Frame,
        timeout: Duration,
        pool: Option<&ThreadPool>,
    ) -> Result<Self, ProofError> {
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
        let mut frames = Vec::new();
        for size in PASS_SIZES {
            playback
                .restore(&start(passes.graph, size))
                .map_err(Failure::Gpu)?;
            for inputs in inputs(size).map(adapt) {
                playback.render(&inputs, &[]).map_err(Failure::Gpu)?;
                let state = playback.state(&inputs).map_err(Failure::Gpu)?;
                frames.push(PlayedFrame {
                    inputs,
                    state,
                    undefined: Vec::new(),
                });
            }
        }
        let observe = || observe(passes, &mut frames, timeout);
        let Observations { drawn, undefined_by } = within(pool, observe)?;
        Ok(Self {
            frames,
            device,
            drawn,
            undefined_by,
        })
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

    /// Renders the passes that were read from a conversion, and compares each.
    pub(super) fn compare(
        &self,
        passes: &PassSources,
        worker: &mut Worker,
        artifacts: Vec<ShaderArtifact>,
        graph: &GraphContent,
    ) -> Result<Vec<PassComparison>, Failure> {
        let upside_down = artifacts.iter().any(ShaderArtifact::is_upside_down);
        let code = PassCode::Converted(artifacts);
        let sampling = graph.sampling.iter().copied();
        let mut playback = open(worker, code, sampling, &graph.graph, passes.media)?;
        let targets: Vec<Target> = passes.graph.passes().iter().map(|pass| pass.target).collect();
        let mut comparisons: Vec<_> = targets.iter().copied().map(PassComparison::new).collect();
        // No frame has been rendered.
        let mut size = [0; 2];
        for frame in &self.frames {
            if frame.inputs.size != size {
                size = frame.inputs.size;
                playback
                    .restore(&start(passes.graph, size))
                    .map_err(Failure::Gpu)?;
            }
            let images = playback.render(&frame.inputs, &targets).map_err(Failure::Gpu)?;
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
                playback.restore(&frame.state).map_err(Failure::Gpu)?;
            }
        }
        Ok(comparisons)
    }
}

impl PlayedFrame {
    /// The texture that a pass rendered.
    pub(super) fn texture(&self, target: Target) -> Arc<Image> {
        let texture = match target {
            Target::Image => self.state.image.as_ref(),
            Target::Buffer(number) => self.state.buffers[number].as_ref().map(|[last, _]| last),
        };
        let texture = texture.expect("the state has every texture of the graph");
        texture.stack()
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
    /// The images of the driver in this frame, for each pass.
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
