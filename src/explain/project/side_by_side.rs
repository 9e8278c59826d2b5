//! Two projects side by side: the first pass that renders another texture than the reference's, although it
//! reads the same.

use std::cell::LazyCell;
use std::time::Instant;

use toyproof_eval::{Number, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{Checked, Filter};
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Graph, Source, Target};
use toyproof_verify::MAX_DIFFERING;
use toyproof_verify::project::bind::{clock, programs};
use toyproof_verify::project::playback::{CpuPlayback, PassShader};

use super::difference::Difference;
use super::wrapper::{self, with_suffix};
use super::{PassDeparture, ProjectCase, frame_timeout};

/// The number of frames after the first wrong one among which the one with the most wrong pixels is chosen.
const FRAMES_AFTER: i32 = 16;

/// The least number of replays that can be afforded for finding out which channels are read.
const REPLAYS_OF_CHANNELS: usize = 8;

/// Two projects with the passes that both have.
pub(super) struct Players<'a> {
    case: &'a ProjectCase<'a>,
    programs: Vec<Program>,
    reference: Vec<Program>,
    pairs: Vec<Pair>,
    deadline: Instant,
}

/// A pass of both projects.
#[derive(Debug, Clone, Copy)]
struct Pair {
    target: Target,
    /// The number of the pass in the project.
    own: usize,
    /// The number of the pass in the reference.
    reference: usize,
}

/// The first wrong pass.
pub(super) struct Wrong {
    /// The number of the pass in the project.
    pub(super) pass: usize,
    /// The number of the pass in the reference.
    pub(super) reference: usize,
    pub(super) departure: PassDeparture,
    /// The frame in which most of the pass's pixels are wrong.
    pub(super) step: Step,
    /// Whether the pass's texture holds what the reference's holds.
    pub(super) corresponds: bool,
}

/// A pass in one frame.
pub(super) struct Step {
    /// The frame with what the pass reads in the reference.
    pub(super) frame: Frame,
    /// The frame with what the reference's pass reads.
    pub(super) reference: Frame,
    pub(super) difference: Difference,
}

/// The comparison of a pass in all frames.
#[derive(Default)]
struct History {
    /// The first frame in which any pixel is wrong.
    first: Option<i32>,
    /// The first frame in which many pixels are wrong.
    first_of_many: Option<i32>,
    /// The frame with the most wrong pixels.
    worst: Option<Step>,
    /// Whether a texture that is not uniform agreed before the first difference.
    agreed: bool,
}

impl<'a> Players<'a> {
    /// Compiles the passes; `None` if they are too large, or no pass is in both.
    pub(super) fn new(case: &'a ProjectCase<'a>, deadline: Instant) -> Option<Self> {
        let [own, reference] = [case.project.shader, case.reference.shader];
        let size = |graph: &Graph, target| graph.size(target, case.frame.size);
        let position = |target| {
            // Textures of different sizes hold different things.
            let has_size = size(own.graph, target) == size(reference.graph, target);
            let mut passes = reference.graph.passes().iter();
            passes.position(|pass| pass.target == target && has_size)
        };
        let passes = own.graph.passes().iter().enumerate();
        let pairs = passes.filter_map(|(own, pass)| {
            Some(Pair {
                target: pass.target,
                own,
                reference: position(pass.target)?,
            })
        });
        let timeout = frame_timeout(deadline);
        Some(Self {
            programs: programs(own, timeout, case.pool).ok()?,
            reference: programs(reference, timeout, case.pool).ok()?,
            pairs: pairs.collect(),
            case,
            deadline,
        })
    }

    /// The first pass that is wrong. Channels that nothing reads are not compared; to find these channels
    /// takes some `replays`.
    pub(super) fn first_wrong(&self, replays: usize) -> Option<Wrong> {
        // The alpha of the image is not shown.
        let mut ignored: Vec<[bool; 4]> = self
            .pairs
            .iter()
            .map(|pair| [false, false, false, pair.target == Target::Image])
            .collect();
        let image = LazyCell::new(|| self.last_image(self.case.project.shader, &self.programs));
        loop {
            let mut histories = self.compare(&ignored)?;
            let at = first(&histories)?;
            let pair = self.pairs[at];
            let channels = histories[at].worst.as_ref()?.difference.channels;
            let differing = (0..4).filter(|&channel| channels[channel] > 0);
            let unread: Vec<usize> = match pair.target {
                Target::Buffer(_) if replays >= REPLAYS_OF_CHANNELS => {
                    let is_unread = |&channel: &usize| match &*image {
                        Some(image) => !self.is_read(pair, channel, image),
                        None => false,
                    };
                    differing.filter(is_unread).collect()
                }
                _ => Vec::new(),
            };
            if !unread.is_empty() {
                for channel in unread {
                    ignored[at][channel] = true;
                }
                continue;
            }
            let corresponds = self.corresponds(at, &histories);
            let history = &mut histories[at];
            return Some(Wrong {
                pass: pair.own,
                reference: pair.reference,
                departure: PassDeparture {
                    pass: pair.target,
                    frame: history.first?,
                },
                step: history.worst.take()?,
                corresponds,
            });
        }
    }

    /// Compares the passes of all frames; `None` if a pass cannot be rendered.
    fn compare(&self, ignored: &[[bool; 4]]) -> Option<Vec<History>> {
        let clock = clock(self.case.frame);
        let mut own = self.playback(self.case.project.shader, &self.programs);
        let mut reference = self.playback(self.case.reference.shader, &self.reference);
        let mut histories: Vec<History> = self.pairs.iter().map(|_| History::default()).collect();
        // Until a texture differs, all passes read what those of the reference read.
        let mut is_apart = false;
        for number in 0..=self.case.frame.frame {
            let since = histories.iter().filter_map(|history| history.first_of_many).min();
            if since.is_some_and(|since| number > since + FRAMES_AFTER) || Instant::now() >= self.deadline {
                break;
            }
            let inputs = clock.frame(number);
            own.render(&inputs).ok()?;
            reference.render(&inputs).ok()?;
            for ((pair, history), &ignored) in self.pairs.iter().zip(&mut histories).zip(ignored) {
                let [rendered, expected] = [&own, &reference].map(|playback| playback.texture(pair.target));
                let [rendered, expected] = [rendered?, expected?].map(toyproof_image::Texture::to_single);
                let frame = || self.inputs(*pair, &own, &reference, &inputs);
                let mut difference = self.difference(*pair, &rendered[0], &expected[0], ignored);
                if is_apart {
                    let rendered = self.render(*pair, &frame())?;
                    difference = self.difference(*pair, &rendered, &expected[0], ignored);
                }
                if difference.pixels == 0 {
                    history.agreed |= history.first.is_none() && difference.is_varied;
                    continue;
                }
                is_apart = true;
                history.first.get_or_insert(number);
                if difference.ratio() > MAX_DIFFERING {
                    history.first_of_many.get_or_insert(number);
                }
                let worst = history.worst.as_ref().map_or(0, |worst| worst.difference.pixels);
                if difference.pixels > worst {
                    history.worst = Some(Step {
                        frame: frame(),
                        reference: reference.bound(pair.reference, &inputs),
                        difference,
                    });
                }
            }
        }
        Some(histories)
    }

    fn difference(&self, pair: Pair, own: &Image, reference: &Image, ignored: [bool; 4]) -> Difference {
        let displayed = (pair.target == Target::Image).then(|| self.case.expected.tolerance());
        Difference::new(own, reference, ignored, displayed)
    }

    fn playback<'p>(&self, shader: &PassShader<'p>, programs: &'p [Program]) -> CpuPlayback<'p, f64> {
        CpuPlayback::new(shader, programs, None, frame_timeout(self.deadline), plain())
    }

    /// The frame with what a pass reads, where its buffers hold what the reference's hold.
    fn inputs<N: Number>(
        &self,
        pair: Pair,
        own: &CpuPlayback<N>,
        reference: &CpuPlayback<N>,
        inputs: &Frame,
    ) -> Frame {
        let mut frame = own.bound(pair.own, inputs);
        let other = reference.bound(pair.reference, inputs);
        let [project, solution] = [self.case.project.shader, self.case.reference.shader];
        let read = &solution.graph.passes()[pair.reference].inputs;
        for (channel, source) in project.graph.passes()[pair.own].inputs.iter().enumerate() {
            let position = read.iter().position(|other| other == source);
            let Some(Source::Buffer(_)) = source else { continue };
            let Some(texture) = position.and_then(|at| other.channels[at].clone()) else {
                continue;
            };
            let has_mipmaps = project.checked[pair.own].sampling[channel].filter == Filter::Mipmap;
            frame.channels[channel] = Some(if has_mipmaps && texture.levels() == 1 {
                Texture::with_mipmaps(texture)
            } else {
                texture
            });
        }
        frame
    }

    fn render(&self, pair: Pair, frame: &Frame) -> Option<Image> {
        let settings = Settings {
            deadline: Some(self.deadline),
            ..plain()
        };
        let rendered = self.programs[pair.own].render_rows(frame, frame.rows(), &settings);
        rendered.ok().map(|rendered| rendered.image)
    }

    /// Whether a pass holds in its texture what the reference holds there. Otherwise the pass differs without
    /// being wrong, and so do the passes that read its texture.
    fn corresponds(&self, at: usize, histories: &[History]) -> bool {
        let pair = self.pairs[at];
        let passes = self.case.project.shader.graph.passes();
        let reads = |reader: Target, read: Target| {
            let mut passes = passes.iter().filter(|pass| pass.target == reader);
            let read = match read {
                Target::Buffer(number) => Some(Source::Buffer(number)),
                Target::Image => None,
            };
            read.is_some() && passes.any(|pass| pass.inputs.contains(&read))
        };
        let agrees = |other: usize| histories[other].first_of_many.is_none() && histories[other].agreed;
        let others = || (0..self.pairs.len()).filter(move |&other| other != at);
        let mut related = others().filter(|&other| {
            let other = self.pairs[other].target;
            reads(other, pair.target) || pair.target == Target::Image && reads(Target::Image, other)
        });
        histories[at].agreed || related.any(agrees)
    }

    /// Whether the `image` that was checked depends on a channel of a buffer.
    fn is_read(&self, pair: Pair, channel: usize, image: &Texture) -> bool {
        let component = ["x", "y", "z", "w"][channel];
        let depends = |value: &str| {
            let value = value.replace('$', &format!("{}.{component}", wrapper::COLOR));
            let body = format!("{}.{component} = {value};", wrapper::COLOR);
            let project = self.case.project;
            let suffix = wrapper::suffix(&body, None);
            let own = project.shader.checked[pair.own];
            let changed = with_suffix(own, project.text(pair.own), &suffix)?;
            let mut checked: Vec<&Checked> = project.shader.checked.clone();
            checked[pair.own] = &changed;
            let shader = PassShader {
                checked,
                ..project.shader.clone()
            };
            let programs = programs(&shader, frame_timeout(self.deadline), None).ok()?;
            Some(self.last_image(&shader, &programs).as_ref() != Some(image))
        };
        ["1.0 - $", "3.0 * $ + 7.0"]
            .into_iter()
            .any(|value| depends(value).unwrap_or(true))
    }

    /// The image in the frame that was checked.
    fn last_image(&self, shader: &PassShader, programs: &[Program]) -> Option<Texture> {
        let clock = clock(self.case.frame);
        let mut playback = self.playback(shader, programs);
        for number in 0..=self.case.frame.frame {
            playback.render(&clock.frame(number)).ok()?;
        }
        playback.texture(Target::Image).cloned()
    }
}

/// The settings of an evaluation in double precision.
pub(super) fn plain<'a>() -> Settings<'a, f64> {
    Settings {
        undefined: UndefinedPolicy::Plain,
        ..Settings::default()
    }
}

/// The pass that is wrong first, in the order of frames and of passes: in many pixels, since rounding may
/// decide a few, or else in any.
fn first(histories: &[History]) -> Option<usize> {
    let earliest = |frame: fn(&History) -> Option<i32>| {
        let passes = histories.iter().enumerate();
        let frames = passes.filter_map(|(at, history)| Some((frame(history)?, at)));
        frames.min().map(|(_, at)| at)
    };
    earliest(|history| history.first_of_many).or_else(|| earliest(|history| history.first))
}
