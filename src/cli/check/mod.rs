//! `toyproof check`

mod reference;
mod stopped;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) use self::reference::Reference;
use self::stopped::Stopped;
use super::inputs::{DriverArgs, Format, FrameArgs, LanguageArgs};
use super::shader::{Names, Shader, find, with_suffix};
use super::{Exit, Terminal, codes};
use crate::compare::{TOLERANCE, Verdict};
use crate::diagnostic::{self, Diagnostic};
use crate::frame::Frame;
use crate::gpu::{self, INSTALL_HINT, Worker};
use crate::image::{self, Image, Legend};
use crate::report::{self, Record, Report, Seconds};
use crate::source::{Files, Found, ReadError};
use crate::verify::{self, Case, Findings, verify};

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
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    if let Some(code) = &args.explain {
        return codes::run(code, terminal);
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

struct Checker<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    /// None where the evaluator paints.
    worker: Option<Worker>,
    frame: Frame,
    names: Names,
    device: Option<String>,
    /// Something failed that no verdict tells.
    trouble: bool,
}

impl Checker<'_> {
    fn check(&mut self, input: &Result<Found, ReadError>) -> Record {
        let shader = Shader::load(input, &self.args.language);
        let spinner = self.terminal.spinner(&shader.name);
        let scene = self.args.scene.as_deref();
        let reference = input
            .as_ref()
            .ok()
            .and_then(|found| Reference::find(scene, found));
        let mut record = Record {
            shader: shader.name.clone(),
            scene: reference.as_ref().map(|reference| reference.name.clone()),
            verdict: Verdict::Ok,
            reason: String::new(),
            maths: None,
            rounding: None,
            toolchain: None,
            picture: None,
            mistake: (),
            diagnostics: Vec::new(),
            seconds: Seconds::default(),
        };
        let verified = self.verify(&mut record, shader, reference);
        spinner.finish_and_clear();
        match verified {
            Ok(findings) => {
                if let (Some(out), Ok(found)) = (&self.args.out, input) {
                    let place = out.join(self.names.place(&found.relative));
                    for (suffix, picture) in pictures(&findings) {
                        self.keep(&with_suffix(&place, suffix), &picture);
                    }
                }
                self.fill(&mut record, findings);
            }
            Err(stopped) => {
                record.verdict = stopped.verdict;
                record.reason = stopped.reason;
                self.tell(&mut record, &stopped.diagnostics, &stopped.files);
            }
        }
        record
    }

    fn verify(
        &mut self,
        record: &mut Record,
        shader: Shader,
        reference: Option<Reference>,
    ) -> Result<Findings, Stopped> {
        let Shader {
            files,
            checked,
            warnings,
            ..
        } = shader;
        self.tell(record, &warnings, &files);
        let checked = match checked {
            Ok(checked) => checked,
            Err(unusable) => return Err(Stopped::unusable(unusable, files, Verdict::Invalid)),
        };
        let mut frame = self.frame.clone();
        let scene = match reference.map(|reference| (reference.scene, reference.files)) {
            None => None,
            Some((Err(unusable), files)) => return Err(Stopped::unusable(unusable, files, Verdict::Error)),
            Some((Ok(mut scene), _)) => {
                frame.size = self.args.frame.size.unwrap_or(scene.film.size);
                scene.film.size = frame.size;
                Some(scene)
            }
        };
        let case = Case {
            checked: &checked,
            scene: scene.as_ref(),
            frame: &frame,
            float: self.args.driver.float(),
            timeout: self.args.driver.timeout(),
        };
        let mut verified = verify(self.worker.as_mut(), &case);
        if let Err(verify::Failure::Gpu(gpu::Failure::NoDriver(why))) = &verified
            && self.args.driver.may_fall_back()
        {
            self.terminal.warn(format_args!(
                "{why}; shaders run on the CPU, and whether a GPU would paint the same is not asked"
            ));
            self.worker = None;
            verified = verify(None, &case);
        }
        let mut findings = verified.map_err(|failure| Stopped::failure(failure, files.clone()))?;
        if let (Verdict::Unstable, Some(cause)) = (findings.verdict, findings.cause) {
            let at = files.position(cause);
            let place = format!("; it is lost in line {}, column {}", at.line, at.column);
            findings.reason.push_str(&place);
        }
        self.tell(record, &findings.notes, &files);
        Ok(findings)
    }

    /// Keeps what was found.
    fn fill(&mut self, record: &mut Record, findings: Findings) {
        let seconds = &mut record.seconds;
        seconds.eval = Some(findings.eval.as_secs_f64());
        seconds.trace = findings.trace.map(|trace| trace.as_secs_f64());
        if let Some(painter) = findings.painter {
            seconds.translate = Some(painter.translate.as_secs_f64());
            seconds.gpu = Some((painter.compile + painter.draw).as_secs_f64());
            self.terminal.detail(&format!(
                "{}: translated in {:.4} s, compiled in {:.3} s, painted in {:.3} s on {}",
                record.shader,
                painter.translate.as_secs_f64(),
                painter.compile.as_secs_f64(),
                painter.draw.as_secs_f64(),
                painter.device
            ));
            self.device = Some(painter.device);
        }
        record.verdict = findings.verdict;
        record.reason = findings.reason;
        record.maths = findings.maths.map(|asked| asked.answer);
        record.rounding = findings.rounding.map(|asked| asked.answer);
        record.toolchain = findings.toolchain.map(|asked| asked.answer);
        record.picture = findings.picture.map(|(comparison, _)| comparison);
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

/// The pictures of a shader, each with the end of its file's name: what was expected, what came, how they differ, and one for each
/// question whose answer is not “the same”.
fn pictures(findings: &Findings) -> Vec<(&'static str, Image)> {
    let size = findings.actual.size();
    let mut pictures = vec![("-actual.png", findings.actual.clone())];
    if let Some(reference) = &findings.reference {
        pictures.push(("-reference.png", reference.clone()));
    }
    if let Some((_, marks)) = &findings.picture {
        pictures.push(("-difference.png", image::difference(size, marks, SEEN_BY_EYE)));
    }
    let questions = [
        ("-maths.png", &findings.maths, SEEN_BY_EYE),
        ("-rounding.png", &findings.rounding, SEEN_BY_EYE),
        ("-toolchain.png", &findings.toolchain, IN_BITS),
    ];
    for (suffix, asked, legend) in questions {
        if let Some(asked) = asked.as_ref().filter(|asked| !asked.answer.is_same()) {
            pictures.push((suffix, image::difference(size, &asked.marks, legend)));
        }
    }
    pictures
}

/// What is more than rounding stands out.
const SEEN_BY_EYE: Legend = Legend {
    tolerance: TOLERANCE as f32,
};
/// Where every bit counts, all but the last bits stand out.
const IN_BITS: Legend = Legend { tolerance: 1e-6 };
