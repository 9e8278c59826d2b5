//! `toyproof compare` of two shaders or projects.

use std::ops::{ControlFlow, RangeInclusive};
use std::path::Path;

use indicatif::ProgressBar;
use toyproof_diagnostic::Deadline;
use toyproof_explain::equality::{Pair, PairFailure};
use toyproof_glsl::{Checked, Filter};
use toyproof_image::{self as image, Frame, MovingTextures, Texture};
use toyproof_player::{Clock, Graph, Pass, Source, Target};
use toyproof_project::{CompiledProject, PassKind, Rendering};
use toyproof_report::{ComparedImages, ComparedShaders, ComparisonReport, FirstDifferenceRecord};
use toyproof_verify::Quantization;
use toyproof_verify::compare::{Criteria, compare_pair};
use toyproof_verify::project::bind::{default_frame, has_history};
use toyproof_verify::project::playback::PassShader;

use super::Args;
use crate::cli::project::{bind_channels, pass_shader, rendering};
use crate::cli::run::pass_error;
use crate::cli::shader::{Shader, find_one};
use crate::cli::{CliError, Exit, Terminal};

/// Compares two shaders to the bit, or their images by criteria, if any are given.
pub(super) fn compare(
    args: &Args,
    criteria: &Criteria,
    terminal: &Terminal,
) -> Result<ComparisonReport, CliError> {
    let by_images = *criteria != Criteria::default();
    if args.diff.is_some() && !by_images {
        let error = CliError::new("shaders that are compared to the bit have no image of differences");
        return Err(error.with_help("compare their images with --tolerance, --max-differing or --metric"));
    }
    let shaders = [load(args, &args.a, terminal)?, load(args, &args.b, terminal)?];
    let frame = args.frame.inputs().load()?;
    let passes = [
        Passes::new(&shaders[0], &frame)?,
        Passes::new(&shaders[1], &frame)?,
    ];
    let passes = passes.each_ref().map(Passes::shader);
    let frames = frames(args, &passes);
    let clock = Clock {
        rate: args.fps,
        start: args
            .frame
            .start(args.frames.map_or(*frames.start(), |_| 0), args.fps),
        inputs: frame,
    };
    let pair =
        Pair::new(passes.each_ref(), args.timeout).map_err(|failure| pair_error(&failure, &shaders))?;
    let bar = terminal.bar(u64::from(frames.end().abs_diff(*frames.start())) + 1, "frames");
    let session = Session {
        shaders: &shaders,
        pair: &pair,
        clock: &clock,
        frames,
        bar: &bar,
    };
    let report = if by_images {
        session.compare_images(args, criteria, terminal)
    } else {
        session.compare_bits(args)
    };
    bar.finish_and_clear();
    report
}

/// Two shaders that are compared in some frames.
struct Session<'a> {
    shaders: &'a [Shader; 2],
    pair: &'a Pair<'a>,
    clock: &'a Clock,
    frames: RangeInclusive<i32>,
    bar: &'a ProgressBar,
}

impl Session<'_> {
    /// Shows that a frame begins.
    fn step(&self, number: i32) {
        self.bar
            .set_position((number - self.frames.start()).max(0) as u64);
    }

    /// Compares the images of all frames; the image of differences is that of the first frame that does not
    /// agree.
    fn compare_images(
        &self,
        args: &Args,
        criteria: &Criteria,
        terminal: &Terminal,
    ) -> Result<ComparisonReport, CliError> {
        let mut compared = Vec::new();
        let mut failure = None;
        let mut difference_image = None;
        let step = |number| self.step(number);
        let played =
            self.pair.images(
                self.clock,
                self.frames.clone(),
                step,
                |number, images| match compare_pair(images, [Quantization::Float; 2], criteria) {
                    Ok(difference) => {
                        if !difference.agrees && difference_image.is_none() {
                            difference_image = Some(difference.image());
                        }
                        compared.push(ComparedImages::new(&difference, criteria).in_frame(number));
                        ControlFlow::Continue(())
                    }
                    Err(error) => {
                        failure = Some(error);
                        ControlFlow::Break(())
                    }
                },
            );
        played.map_err(|failure| pair_error(&failure, self.shaders))?;
        if let Some(error) = failure {
            return Err(error.into());
        }
        if let (Some(path), Some(difference)) = (&args.diff, difference_image) {
            terminal.write(path, &image::encode_shown(&difference, path)?)?;
        }
        Ok(ComparisonReport::of_images(args.names(), criteria, compared))
    }

    fn compare_bits(&self, args: &Args) -> Result<ComparisonReport, CliError> {
        let step = |number| self.step(number);
        let found = self.pair.first_difference(self.clock, self.frames.clone(), step);
        let found = found.map_err(|failure| pair_error(&failure, self.shaders))?;
        let files = self.shaders.each_ref().map(|shader| &shader.files);
        let names = |targets: Vec<Target>| targets.iter().map(ToString::to_string).collect();
        let compared = ComparedShaders {
            frames: [*self.frames.start(), *self.frames.end()],
            size: self.clock.inputs.size,
            passes: names(self.pair.common_passes()),
            only_in_a: names(self.pair.other_passes(0)),
            only_in_b: names(self.pair.other_passes(1)),
            first: found.map(|found| FirstDifferenceRecord::new(&found, files)),
        };
        Ok(ComparisonReport::of_shaders(args.names(), compared))
    }
}

/// The error of a shader that is not rendered; in a project, with its pass.
fn pair_error(failure: &PairFailure, shaders: &[Shader; 2]) -> CliError {
    let shader = &shaders[failure.shader];
    let pass = shader.project().map(|_| failure.target);
    pass_error(&failure.failure, pass, shader).with_exit(Exit::Error)
}

/// Reads a shader that compiles; its warnings are not the subject.
fn load(args: &Args, path: &Path, terminal: &Terminal) -> Result<Shader, CliError> {
    let input = find_one(path, "compare", terminal)?;
    let shader = Shader::load(&input, &args.language, Deadline::after(args.timeout));
    match shader.require_image() {
        Ok(_) => Ok(shader),
        // A shader that does not compile is not one that differs.
        Err(error) => Err(error.with_exit(Exit::Error)),
    }
}

/// The frames to compare.
fn frames(args: &Args, passes: &[PassShader; 2]) -> RangeInclusive<i32> {
    if let Some(frames) = args.frames {
        return frames.numbers();
    }
    let has_history = passes.iter().any(has_history);
    if has_history && !args.frame.is_moment_given() {
        return 0..=default_frame(None);
    }
    let number = args.frame.number(has_history, args.fps);
    number..=number
}

/// The passes of a project or of a single shader, with what they read.
enum Passes<'a> {
    Project(&'a CompiledProject, Rendering),
    Single {
        checked: &'a Checked,
        graph: Graph,
        media: Vec<Texture>,
    },
}

impl<'a> Passes<'a> {
    /// `frame` has the textures that the user binds to the channels of the image.
    fn new(shader: &'a Shader, frame: &Frame) -> Result<Self, CliError> {
        if let Some(project) = shader.project() {
            let failed = |failure| CliError::new(format_args!("{}: {failure}", shader.name));
            let mut rendering = rendering(project, PassKind::Image, frame.size).map_err(failed)?;
            bind_channels(project, &mut rendering, &frame.channels);
            return Ok(Self::Project(project, rendering));
        }
        let checked = shader.require_image()?;
        let mut media = Vec::new();
        let inputs = std::array::from_fn(|channel| {
            let texture = frame.channels[channel].clone()?;
            let has_mipmaps = checked.sampling[channel].filter == Filter::Mipmap;
            media.push(if has_mipmaps {
                texture.with_mipmaps()
            } else {
                texture
            });
            Some(Source::Medium(media.len() - 1))
        });
        let image = Pass {
            target: Target::Image,
            inputs,
        };
        Ok(Self::Single {
            checked,
            graph: Graph::new(vec![image], Default::default()),
            media,
        })
    }

    fn shader(&self) -> PassShader<'_> {
        match self {
            Self::Project(project, rendering) => pass_shader(project, rendering),
            Self::Single {
                checked,
                graph,
                media,
            } => PassShader {
                checked: vec![checked],
                graph,
                media,
                films: MovingTextures::default(),
            },
        }
    }
}
