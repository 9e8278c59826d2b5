//! One shader, from its text to its record and its pictures.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::ThreadPool;
use sha2::{Digest, Sha256};
use toyproof_diagnostic::{self as diagnostic, Deadline, Diagnostic, Files, path_name};
use toyproof_gpu::Worker;
use toyproof_image as image;
use toyproof_image::{Frame, output};
use toyproof_scene::Scene;
use toyproof_verify::compare::Verdict;
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::{self as verify, Case, Findings, verify};

use super::Args;
use super::pictures::PICTURES;
use super::reference::{Reference, References};
use super::scenes::Scenes;
use super::stopped::Stopped;
use crate::cli::files::{Found, ReadError};
use crate::cli::names::{Names, with_suffix};
use crate::cli::shader::{Shader, Unusable, denied};
use crate::cli::{Terminal, files, pool};
use crate::report::{Mistake, Record};

/// A shader that is to be judged.
pub(super) struct Submission {
    pub(super) input: Result<Found, ReadError>,
    pub(super) name: String,
    /// Where its pictures go, without their suffixes.
    pub(super) place: Option<PathBuf>,
    /// What its record depends on, as a hash; none if its files cannot be read.
    pub(super) key: Option<String>,
}

impl Submission {
    pub(super) fn new(
        input: Result<Found, ReadError>,
        args: &Args,
        references: &References,
        names: &mut Names,
    ) -> Self {
        let found = input.as_ref().ok();
        let place = match (&args.out, found) {
            (Some(out), Some(found)) => Some(out.join(names.place(found))),
            _ => None,
        };
        Self {
            name: found.map_or_else(String::new, Found::name),
            key: found
                .filter(|_| args.out.is_some())
                .and_then(|found| key(found, args, references)),
            place,
            input,
        }
    }
}

/// A hash of what a record depends on: this version, the shader, its scene, the flags, and the files that they name.
fn key(found: &Found, args: &Args, references: &References) -> Option<String> {
    let mut hash = Sha256::new();
    let mut add = |part: &[u8]| {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    };
    let settings = (&args.frame, &args.language, &args.driver);
    add(env!("CARGO_PKG_VERSION").as_bytes());
    add(format!("{settings:?} {:?} {}", args.scene, found.name()).as_bytes());
    add(files::read(found).ok()?.text().as_bytes());
    if let Some((_, scene)) = references.text(found) {
        add(scene.ok()?.text().as_bytes());
    }
    for path in args.frame.files() {
        add(&std::fs::read(path).ok()?);
    }
    let hash: [u8; 32] = hash.finalize().into();
    let half = hash.first_chunk().copied().map(u128::from_be_bytes);
    half.map(|half| format!("{half:032x}"))
}

/// What a thread needs for itself.
pub(super) struct Hand {
    /// None where the evaluator paints.
    worker: Option<Worker>,
    pool: Option<ThreadPool>,
}

impl Hand {
    /// One of so many.
    pub(super) fn new(args: &Args, threads: usize) -> Self {
        Self {
            worker: new_worker(args),
            pool: pool::own(threads),
        }
    }
}

/// That the arguments are right has been seen before.
fn new_worker(args: &Args) -> Option<Worker> {
    args.driver.worker().ok().flatten()
}

/// Something that is to be said, once it is the shader's turn.
pub(super) enum Said {
    Diagnostics(Vec<Diagnostic>, Files),
    Warning(String),
    Error(String),
    Detail(String),
}

impl Said {
    pub(super) fn say(&self, terminal: &Terminal) {
        match self {
            Self::Diagnostics(diagnostics, files) => terminal.diagnostics(diagnostics, files),
            Self::Warning(words) => terminal.warn(words),
            Self::Error(words) => terminal.error(words),
            Self::Detail(words) => terminal.detail(words),
        }
    }
}

/// What was found of a shader, and what is to be said of it.
pub(super) struct Judged {
    pub(super) record: Record,
    pub(super) said: Vec<Said>,
    pub(super) device: Option<String>,
    /// Something failed that the verdict does not tell.
    pub(super) trouble: bool,
}

impl Judged {
    /// An earlier run found it.
    pub(super) fn known(record: Record) -> Self {
        Self {
            record,
            said: Vec::new(),
            device: None,
            trouble: false,
        }
    }

    fn tell(&mut self, diagnostics: Vec<Diagnostic>, files: &Files) {
        let told = diagnostics.iter().map(|told| diagnostic::json(told, files));
        self.record.diagnostics.extend(told);
        if !diagnostics.is_empty() {
            self.said.push(Said::Diagnostics(diagnostics, files.clone()));
        }
    }

    fn failed(&mut self, words: String) {
        self.said.push(Said::Error(words));
        self.trouble = true;
    }
}

/// Judges shaders, on any thread.
pub(super) struct Judge<'a> {
    args: &'a Args,
    references: &'a References,
    frame: Frame,
    /// Whether somebody was told that there is no driver.
    fell_back: AtomicBool,
    scenes: Scenes,
}

impl<'a> Judge<'a> {
    pub(super) fn new(args: &'a Args, references: &'a References, frame: Frame) -> Self {
        Self {
            args,
            references,
            frame,
            fell_back: AtomicBool::new(false),
            scenes: Scenes::default(),
        }
    }

    /// Judges a shader and keeps its pictures. A panic costs this shader's verdict, which is then `error`, and nothing else.
    pub(super) fn judge(&self, hand: &mut Hand, submission: &Submission) -> Judged {
        contain(Part::Shader, || self.judge_one(hand, submission)).unwrap_or_else(|panic| {
            // What the worker was doing when it was left is not known.
            hand.worker = hand.worker.take().and_then(|_| new_worker(self.args));
            let mut judged = Judged::known(Record::new(submission.name.clone(), Verdict::Error));
            judged.record.reason = panic.to_string();
            judged
        })
    }

    fn judge_one(&self, hand: &mut Hand, submission: &Submission) -> Judged {
        let shader = Shader::load(
            &submission.input,
            &self.args.language,
            Deadline::after(self.args.driver.timeout()),
        );
        let found = submission.input.as_ref().ok();
        let reference = found.and_then(|found| self.references.find(found));
        let mut judged = Judged::known(Record::new(shader.name.clone(), Verdict::Ok));
        judged.record.scene = reference.as_ref().map(|reference| reference.name.clone());
        let findings = self.verify(hand, &mut judged, shader, reference);
        if let (Some(out), Some(place)) = (&self.args.out, &submission.place) {
            keep(out, place, findings.as_ref().ok(), &mut judged);
        }
        match findings {
            Ok(findings) => fill(&mut judged, findings),
            Err(stopped) => {
                judged.record.verdict = stopped.verdict;
                // Its name stands before the reason anyway.
                let named = format!("{}: ", judged.record.shader);
                judged.record.reason = match stopped.reason.strip_prefix(&named) {
                    Some(reason) => reason.to_owned(),
                    None => stopped.reason,
                };
                judged.tell(stopped.diagnostics, &stopped.files);
            }
        }
        judged
    }

    fn verify(
        &self,
        hand: &mut Hand,
        judged: &mut Judged,
        shader: Shader,
        reference: Option<Reference>,
    ) -> Result<Findings, Stopped> {
        let Shader {
            files,
            checked,
            lints,
            ..
        } = shader;
        judged.tell(lints.warnings.clone(), &files);
        let checked = match checked {
            Ok(checked) => checked,
            Err(unusable) => return Err(Stopped::unusable(unusable, files, Verdict::Invalid)),
        };
        let mut frame = self.frame.clone();
        let scene = match reference.map(|reference| (reference.scene, reference.files)) {
            None => None,
            Some((Err(unusable), files)) => return Err(Stopped::unusable(unusable, files, Verdict::Error)),
            Some((Ok(scene), _)) => Some(self.sized(scene, &mut frame)),
        };
        let known = scene.map(|scene| self.scenes.known(scene, &frame));
        let suspects = contain(Part::Mistake, || {
            known.as_ref().and_then(|known| known.suspects(&frame))
        });
        let suspects = suspects.unwrap_or_else(|panic| {
            judged.failed(format!("{}: {panic}", judged.record.shader));
            None
        });
        let case = Case {
            checked: &checked,
            lints: &lints,
            expected: known.as_ref().map(|known| &known.expected),
            suspects,
            frame: &frame,
            float: self.args.driver.float(),
            timeout: self.args.driver.timeout(),
            pool: hand.pool.as_ref(),
        };
        if self.fell_back.load(Ordering::Relaxed) {
            hand.worker = None;
        }
        let mut verified = verify(hand.worker.as_mut(), &case);
        if let Err(verify::Failure::Gpu(failure)) = &verified
            && failure.is_without_driver()
            && self.args.driver.may_fall_back()
        {
            if !self.fell_back.swap(true, Ordering::Relaxed) {
                judged.said.push(Said::Warning(format!(
                    "{failure}; shaders are evaluated on the CPU instead, without the toolchain check                      (`toyproof doctor` tests the drivers)"
                )));
            }
            hand.worker = None;
            verified = verify(None, &case);
        }
        let mut findings = verified.map_err(|failure| Stopped::failure(failure, files.clone()))?;
        if let (Verdict::Unstable, Some(cause)) = (findings.verdict, findings.cause) {
            let at = files.position(cause);
            let place = format!("; it is lost in line {}, column {}", at.line, at.column);
            findings.reason.push_str(&place);
        }
        for panic in findings.panics.drain(..) {
            judged.failed(format!("{}: {panic}", judged.record.shader));
        }
        let mut notes = std::mem::take(&mut findings.notes);
        let denied = denied(&mut notes, self.args.language.denied());
        judged.tell(notes, &files);
        if denied.is_empty() {
            Ok(findings)
        } else {
            let denied = Unusable::Invalid(denied);
            Err(Stopped::unusable(denied, files, Verdict::Invalid))
        }
    }

    /// The scene in the size of the frame, which is the scene's own unless the arguments tell another.
    fn sized(&self, mut scene: Scene, frame: &mut Frame) -> Scene {
        frame.size = self.args.frame.size.unwrap_or(scene.film.size);
        scene.film.size = frame.size;
        scene
    }
}

/// Puts what was found into the record.
fn fill(judged: &mut Judged, findings: Findings) {
    let record = &mut judged.record;
    let seconds = &mut record.seconds;
    seconds.eval = Some(findings.eval.as_secs_f64());
    seconds.trace = findings.trace.map(|trace| trace.as_secs_f64());
    if let Some(painter) = findings.painter {
        seconds.translate = Some(painter.translate.as_secs_f64());
        seconds.gpu = Some((painter.compile + painter.draw).as_secs_f64());
        judged.said.push(Said::Detail(format!(
            "{}: translated in {:.4} s, compiled in {:.3} s, painted in {:.3} s on {}",
            record.shader,
            painter.translate.as_secs_f64(),
            painter.compile.as_secs_f64(),
            painter.draw.as_secs_f64(),
            painter.device
        )));
        judged.device = Some(painter.device);
    }
    record.verdict = findings.verdict;
    record.reason = findings.reason;
    record.mistake = findings.mistake.as_deref().map(Mistake::new);
    if let Some(mistake) = &record.mistake {
        record.reason = format!("{}; {}", record.reason, mistake.says);
    }
    record.maths = findings.maths.map(|asked| asked.answer);
    record.rounding = findings.rounding.map(|asked| asked.answer);
    record.toolchain = findings.toolchain.map(|asked| asked.answer);
    record.picture = findings.picture.map(|(comparison, _)| comparison);
}

/// Writes the pictures, and removes those of an earlier run that there are no more.
fn keep(out: &Path, place: &Path, findings: Option<&Findings>, judged: &mut Judged) {
    for picture in PICTURES {
        let path = with_suffix(place, picture.suffix);
        let encoded = contain(Part::Image, || {
            let picture = findings.and_then(picture.of)?;
            Some(image::encode_shown(&picture, &path))
        });
        let kept = match encoded {
            Ok(Some(Ok(bytes))) => output::write_inside(out, &path, &bytes),
            Ok(None) => output::remove_inside(out, &path),
            Ok(Some(Err(error))) => Err(io::Error::other(error)),
            Err(panic) => Err(io::Error::other(format!("{}: {panic}", path_name(&path)))),
        };
        if let Err(error) = kept {
            judged.failed(format!("cannot write {error}"));
        }
    }
}
