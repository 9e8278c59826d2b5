//! `toyproof check`

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Instant;

use clap::ValueEnum;

use super::inputs::{DriverArgs, FrameArgs};
use super::shader::{Names, Shader, Unusable, find, is_invalid, with_suffix};
use super::{Exit, Terminal, explain};
use crate::compare::{TOLERANCE, Verdict, compare, judge};
use crate::diagnostic::{self, Diagnostic, Severity};
use crate::frame::Frame;
use crate::gpu::{Drawn, Failure, FloatMode, INSTALL_HINT, Worker};
use crate::image::{self, Image, Legend};
use crate::report::{self, Record, Report, Seconds};
use crate::scene::{self, Moment, Scene};
use crate::source::{self, Files, Found, FoundIn, ReadError};
use crate::trace::Tracer;

/// Compare what shaders paint with the reference tracer, and give a verdict on each
///
/// The scene of a shader is the one that --scene names, else the .toml beside it. A shader without a scene is
/// `ok` if it paints.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  toyproof check glsl --out out\n  \
                        toyproof check homework.glsl --scene glsl/02-sphere.toml --format json\n\n\
                        Exit code: 0 if every shader is correct or ok, 1 if one is not, 2 if there was other trouble.")]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required_unless_present = "explain")]
    shaders: Vec<PathBuf>,
    /// Say what a code such as E0301 means, with examples, and do nothing else
    #[arg(long, value_name = "CODE", exclusive = true)]
    explain: Option<String>,
    /// The scene of all these shaders
    #[arg(long, value_name = "SCENE.toml")]
    scene: Option<PathBuf>,
    /// Write the pictures (reference, actual, difference) and verdict.json into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What goes to standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    format: Format,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Human,
    Json,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    if let Some(code) = &args.explain {
        return explain::run(code, terminal);
    }
    let (worker, frame) = match (args.driver.worker(), args.frame.frame()) {
        (Ok(worker), Ok(frame)) => (worker, frame),
        (Err(error), _) | (_, Err(error)) => {
            terminal.error(error);
            return Exit::Trouble;
        }
    };
    let interrupted = stop_on_interrupt();
    let mut checker = Checker {
        args,
        terminal,
        worker,
        frame,
        names: Names::default(),
        device: None,
        trouble: false,
    };
    let mut records = Vec::new();
    for input in find(&args.shaders) {
        if interrupted.load(Ordering::Relaxed) {
            terminal.error("interrupted; what was done is kept");
            checker.trouble = true;
            break;
        }
        let record = checker.check(&input);
        if args.format == Format::Human {
            terminal.result(&report::line(&record));
        }
        records.push(record);
    }
    checker.finish(records)
}

/// The first interrupt asks to stop after the shader that is being checked, the second stops at once.
fn stop_on_interrupt() -> Arc<AtomicBool> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // Where no handler can be set, an interrupt ends the program as it always did.
    let _ = ctrlc::set_handler(move || {
        Terminal::interrupted();
        if flag.swap(true, Ordering::Relaxed) {
            #[expect(clippy::exit, reason = "the user asked twice")]
            std::process::exit(130);
        }
    });
    interrupted
}

/// What a driver that ended loops by force means for a shader.
pub(super) fn cut_short(pixels: u64) -> String {
    format!(
        "a loop never ends, or runs longer than this driver allows: it was ended by force in {pixels} pixels \
         (Mesa before 23 stops at 65,535 iterations)"
    )
}

/// Why a picture that is not the reference's cannot be held against its shader.
const UNTOLD: &str = "it could not be told in time whether this driver ended a loop by force, as Mesa before 23 does \
                      after 65,535 iterations; give more time with --timeout";

struct Checker<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    worker: Worker,
    frame: Frame,
    names: Names,
    device: Option<String>,
    /// Something failed that no verdict tells.
    trouble: bool,
}

/// The scene of a shader.
struct Reference {
    name: String,
    scene: Result<Scene, Unusable>,
    files: Files,
}

impl Checker<'_> {
    fn check(&mut self, input: &Result<Found, ReadError>) -> Record {
        let shader = Shader::load(input, &self.args.driver, self.args.driver.float());
        let spinner = self.terminal.spinner(&shader.name);
        let reference = input.as_ref().ok().and_then(|found| self.reference(found));
        let mut record = Record {
            shader: shader.name.clone(),
            scene: reference.as_ref().map(|reference| reference.name.clone()),
            verdict: Verdict::Ok,
            reason: "the shader paints; there is no scene to compare it with".to_owned(),
            maths: (),
            rounding: (),
            toolchain: (),
            picture: None,
            mistake: (),
            diagnostics: Vec::new(),
            seconds: Seconds::default(),
        };
        let stopped = self.compare(&mut record, shader, reference, input.as_ref().ok());
        spinner.finish_and_clear();
        if let Err(stopped) = stopped {
            record.verdict = stopped.verdict;
            record.reason = stopped.reason;
            self.tell(&mut record, &stopped.diagnostics, &stopped.files);
        }
        record
    }

    /// Fills in the record, up to where something stops it.
    fn compare(
        &mut self,
        record: &mut Record,
        shader: Shader,
        reference: Option<Reference>,
        found: Option<&Found>,
    ) -> Result<(), Stopped> {
        let Shader {
            files,
            lowered,
            warnings,
            ..
        } = shader;
        self.tell(record, &warnings, &files);
        let lowered = match lowered {
            Ok(lowered) => lowered,
            Err(unusable) => return Err(Stopped::unusable(unusable, files, Verdict::Invalid)),
        };
        let mut frame = self.frame.clone();
        let tracer = match reference {
            None => None,
            Some(Reference {
                scene: Err(unusable),
                files,
                ..
            }) => {
                return Err(Stopped::unusable(unusable, files, Verdict::Error));
            }
            Some(Reference {
                scene: Ok(mut scene), ..
            }) => {
                frame.size = self.args.frame.size.unwrap_or(scene.film.size);
                scene.film.size = frame.size;
                let moment = Moment {
                    frame: frame.frame,
                    time: f64::from(frame.time),
                };
                Some(Tracer::<f64>::at(&scene, moment))
            }
        };
        let float = self.args.driver.float();
        let (drawn, traced) = at_once(&mut self.worker, (lowered, frame, float), tracer.as_ref());
        let drawn = drawn.map_err(|failure| Stopped::failure(failure, files))?;
        record.seconds.translate = Some(drawn.translate.as_secs_f64());
        record.seconds.gpu = Some((drawn.compile + drawn.draw).as_secs_f64());
        if let Some(pixels @ 1..) = drawn.cut_short {
            return Err(Stopped::because(Verdict::Timeout, cut_short(pixels)));
        }
        self.terminal.detail(&format!(
            "{}: translated in {:.4} s, compiled in {:.3} s, painted in {:.3} s on {}",
            record.shader,
            drawn.translate.as_secs_f64(),
            drawn.compile.as_secs_f64(),
            drawn.draw.as_secs_f64(),
            drawn.device
        ));
        let actual = drawn.image;
        self.device = Some(drawn.device);
        let mut pictures = vec![];
        if let (Some(tracer), Some((expected, seconds))) = (&tracer, traced) {
            record.seconds.trace = Some(seconds);
            let hull = |x, y| tracer.hull(x, y);
            let (comparison, marks) = compare(&expected, &actual, Some(&hull));
            (record.verdict, record.reason) = judge(&comparison);
            let legend = Legend {
                tolerance: TOLERANCE as f32,
            };
            pictures.push(("-reference.png", expected));
            pictures.push((
                "-difference.png",
                image::difference(actual.size(), &marks, legend),
            ));
            record.picture = Some(comparison);
        }
        if drawn.cut_short.is_none() && record.verdict != Verdict::Correct {
            record.verdict = Verdict::Inconclusive;
            UNTOLD.clone_into(&mut record.reason);
        }
        pictures.push(("-actual.png", actual));
        if let (Some(out), Some(found)) = (&self.args.out, found) {
            let place = out.join(self.names.place(&found.relative));
            for (suffix, picture) in pictures {
                self.keep(&with_suffix(&place, suffix), &picture);
            }
        }
        Ok(())
    }

    fn tell(&self, record: &mut Record, diagnostics: &[Diagnostic], files: &Files) {
        self.terminal.diagnostics(diagnostics, files);
        record
            .diagnostics
            .extend(diagnostics.iter().map(|told| diagnostic::json(told, files)));
    }

    fn keep(&mut self, path: &Path, picture: &Image) {
        let written = match image::encode(picture, path) {
            Ok(bytes) => self.terminal.write(path, &bytes),
            Err(error) => {
                self.terminal.error(error);
                false
            }
        };
        self.trouble |= !written;
    }

    /// The scene that `--scene` names, else the one beside the shader.
    fn reference(&self, found: &Found) -> Option<Reference> {
        let path = match (&self.args.scene, &found.place) {
            (Some(path), _) => path.clone(),
            (None, FoundIn::File(shader)) => {
                let beside = shader.with_extension("toml");
                beside.is_file().then_some(beside)?
            }
            (None, FoundIn::StandardInput) => return None,
        };
        let mut files = Files::default();
        let scene = match source::read_text(&path) {
            Ok(text) => {
                let file = files.add(text);
                scene::parse(&files, file).map_err(Unusable::Invalid)
            }
            Err(error) => Err(Unusable::Trouble(error.to_string())),
        };
        Some(Reference {
            name: path.display().to_string(),
            scene,
            files,
        })
    }

    fn finish(self, records: Vec<Record>) -> Exit {
        let Self {
            args,
            terminal,
            device,
            mut trouble,
            ..
        } = self;
        let no_driver = records.iter().any(|record| record.reason.contains(INSTALL_HINT));
        let report = Report::new(device, records);
        if args.format == Format::Human {
            terminal.say(&report::summary(report.shaders()));
        } else {
            trouble |= terminal.bytes(report.json().as_bytes()).is_err();
        }
        if let Some(out) = &args.out {
            let path = out.join("verdict.json");
            if terminal.write(&path, report.json().as_bytes()) {
                terminal.say(&format!("pictures and verdict.json are in {}", out.display()));
            } else {
                trouble = true;
            }
        }
        if no_driver {
            terminal.detail("`toyproof doctor` tells more of the drivers");
        }
        let verdicts = || report.shaders().iter().map(|record| record.verdict);
        if trouble || verdicts().any(|verdict| verdict == Verdict::Error) {
            Exit::Trouble
        } else if verdicts().all(Verdict::is_good) {
            Exit::Good
        } else {
            Exit::Bad
        }
    }
}

/// The worker paints while we trace: they share the cores, but neither waits for the other's latencies.
fn at_once(
    worker: &mut Worker,
    (lowered, frame, float): (crate::glsl::Lowered, Frame, FloatMode),
    tracer: Option<&Tracer<f64>>,
) -> (Result<Drawn, Failure>, Option<(Image, f64)>) {
    thread::scope(|scope| {
        let traced = tracer.map(|tracer| {
            scope.spawn(|| {
                let start = Instant::now();
                let picture = tracer.picture(|| ());
                (picture, start.elapsed().as_secs_f64())
            })
        });
        let drawn = worker.draw(lowered, frame, float);
        let traced = traced.map(|thread| {
            thread
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        (drawn, traced)
    })
}

/// Why a shader got no further.
struct Stopped {
    verdict: Verdict,
    reason: String,
    diagnostics: Vec<Diagnostic>,
    files: Files,
}

impl Stopped {
    fn because(verdict: Verdict, reason: String) -> Self {
        Self {
            verdict,
            reason,
            diagnostics: Vec::new(),
            files: Files::default(),
        }
    }

    /// `verdict` is for what the text itself is guilty of.
    fn unusable(unusable: Unusable, files: Files, verdict: Verdict) -> Self {
        match unusable {
            Unusable::Trouble(error) => Self::because(Verdict::Error, error),
            Unusable::Invalid(diagnostics) => Self::invalid(verdict, diagnostics, files),
        }
    }

    fn invalid(verdict: Verdict, diagnostics: Vec<Diagnostic>, files: Files) -> Self {
        let error = diagnostics.iter().find(|told| told.severity == Severity::Error);
        let reason = error.map_or_else(
            || "it does not compile".to_owned(),
            |first| match first.span.map(|span| files.position(span)) {
                Some(at) => format!("{} (line {}, column {})", first.message, at.line, at.column),
                None => first.message.clone(),
            },
        );
        Self {
            verdict,
            reason,
            diagnostics,
            files,
        }
    }

    fn failure(failure: Failure, files: Files) -> Self {
        let verdict = match &failure {
            failure if is_invalid(failure) => Verdict::Invalid,
            Failure::Timeout { .. } => Verdict::Timeout,
            _ => Verdict::Error,
        };
        match failure {
            Failure::Invalid(diagnostics) | Failure::Refused(diagnostics) => {
                Self::invalid(verdict, diagnostics, files)
            }
            failure => Self::because(verdict, failure.to_string()),
        }
    }
}
