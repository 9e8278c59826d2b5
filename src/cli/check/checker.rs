//! Checks one shader, from its text to its record and its images.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::ThreadPool;
use toyproof_classroom::assignment::Subject;
use toyproof_diagnostic::{Deadline, Files, Severity, Span, plural};
use toyproof_explain::repair::{Donors, SearchOptions};
use toyproof_explain::unused::Unused;
use toyproof_explain::whole_image::{Alternatives, OtherScenes};
use toyproof_explain::{self as explain, Findings, Options};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::SamplerShape;
use toyproof_gpu::Worker;
use toyproof_image::{FRAME_RATE, Frame};
use toyproof_project::{CompiledProject, PassKind};
use toyproof_report::{self as report, CheckedFrame, FrameResult, GrowthRecord, Record, Seconds};
use toyproof_scene::Scene;
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::project::bind::{BoundFrame, Renderers, accumulate, bind, default_frame};
use toyproof_verify::{Case, Driver, Failure, FromStart, Verdict, unbound, unbound_channels};

use super::images::{FIXED, IMAGES, keep};
use super::options::CheckOptions;
use super::outcome::{Log, Message, Outcome};
use super::plan::{Plan, PlannedFrame};
use super::reference::{CachedReference, Reference, References, SceneCache, other_scenes};
use super::submission::Submission;
use crate::cli::inputs::{DriverArgs, frame_flags, shell_word};
use crate::cli::pool;
use crate::cli::project::{pass_shader, rendering};
use crate::cli::reference::ill_conditioned;
use crate::cli::shader::{Shader, Unusable, denied};

/// The worker process and the thread pool that a thread owns.
pub(super) struct WorkerContext {
    /// `None` if the evaluator renders.
    worker: Option<Worker>,
    pool: Option<ThreadPool>,
}

impl WorkerContext {
    /// Creates the context for one of `threads` threads that need no GPU.
    pub(super) fn without_gpu(threads: usize) -> Self {
        Self {
            worker: None,
            pool: pool::thread_pool(threads),
        }
    }

    /// Creates the context for one of `threads` threads that render images of up to that many pixels.
    pub(super) fn new(driver: &DriverArgs, threads: usize, pixels: u64) -> Self {
        let mut worker = new_worker(driver);
        if let Some(worker) = &mut worker {
            // The driver starts while the first shader is read and its scene is traced.
            worker.warm_up(pixels);
        }
        Self {
            worker,
            pool: pool::thread_pool(threads),
        }
    }
}

/// Creates a worker; the arguments have been validated before.
fn new_worker(driver: &DriverArgs) -> Option<Worker> {
    let worker = driver.worker().ok().flatten();
    worker.map(Worker::with_plain_code_for_small_images)
}

/// Checks shaders, on any thread.
pub(super) struct Checker<'a> {
    options: &'a CheckOptions,
    plan: &'a Plan,
    references: &'a References,
    /// Whether the missing driver has been reported.
    fell_back: AtomicBool,
    scenes: SceneCache,
    /// The scenes that shaders may render instead of their own.
    other_scenes: OtherScenes,
}

impl<'a> Checker<'a> {
    pub(super) fn new(options: &'a CheckOptions, plan: &'a Plan, references: &'a References) -> Self {
        Self {
            options,
            plan,
            references,
            fell_back: AtomicBool::new(false),
            scenes: SceneCache::default(),
            other_scenes: other_scenes(plan.reference.scene.as_deref()),
        }
    }

    /// The number of pixels of the largest frame, unless its scene determines it.
    pub(super) fn pixels(&self) -> u64 {
        let frames = self.plan.frames.iter().map(|planned| planned.frame.size);
        let pixels = frames.map(|[width, height]| u64::from(width) * u64::from(height));
        pixels.max().unwrap_or(0)
    }

    /// Checks a shader and writes its images. A panic costs only this shader's verdict, which is then
    /// `error`.
    pub(super) fn check(&self, context: &mut WorkerContext, submission: &Submission) -> Outcome {
        let start = Instant::now();
        let checked = contain(Part::Shader, || self.check_shader(context, submission));
        let Outcome { record, log } = checked.unwrap_or_else(|panic| {
            // The worker was interrupted in an unknown state.
            context.worker = context
                .worker
                .take()
                .and_then(|_| new_worker(&self.options.driver));
            let record = Record::new(FrameResult {
                shader: &submission.name,
                scene: None,
                reference: None,
                findings: Err(&panic.into()),
                files: &Files::default(),
                diagnostics: Vec::new(),
                growth: None,
                missing_media: None,
                unused: None,
            });
            Outcome {
                record,
                log: Log::default(),
            }
        });
        // Unreadable inputs are not kept for `merge`, which reads them again; its report does not change.
        let all = submission.key.is_some().then(|| start.elapsed().as_secs_f64());
        let seconds = Seconds {
            all,
            ..record.seconds
        };
        Outcome {
            record: Record { seconds, ..record },
            log,
        }
    }

    fn check_shader(&self, context: &mut WorkerContext, submission: &Submission) -> Outcome {
        let shader = self.load(submission);
        let found = submission.input.as_ref().ok();
        let reference = found.and_then(|found| self.references.find(found));
        let mut log = Log::default();
        log.report(shader.lints.warnings.clone(), &shader.files);
        let (mut record, findings) = self.check_frames(context, &mut log, &shader, reference.as_ref());
        if record.verdict == Verdict::Wrong && self.options.search > 0.0 && shader.has_passes {
            record = record.with_unsearched();
        }
        if let Some((assignment, _)) = &self.plan.assignment {
            let subject = image(&shader).ok().map(|checked| Subject {
                checked,
                files: &shader.files,
                text: shader.text(checked),
                lenient: self.options.language.is_lenient(),
                timeout: self.options.driver.timeout(),
            });
            let subject = subject.filter(|_| record.verdict.is_compiled());
            let check_text = || assignment.check_text(subject.as_ref());
            let (rules, functions) = match &context.pool {
                Some(pool) => pool.install(check_text),
                None => check_text(),
            };
            record = Record {
                rules,
                functions,
                ..record
            };
        }
        if let (Some(out), Some(stem)) = (&self.options.out, &submission.output_stem) {
            keep(out, stem, &IMAGES, findings.as_ref(), &mut log);
        }
        let help = record
            .help
            .clone()
            .or_else(|| self.help(&record, log.is_late_on_gpu));
        Outcome {
            record: Record { help, ..record },
            log,
        }
    }

    /// Checks a shader in all frames, up to the first without an image. Returns its record, and the findings
    /// in the first frame with the worst verdict, which is that of the record.
    fn check_frames(
        &self,
        context: &mut WorkerContext,
        log: &mut Log,
        shader: &Shader,
        reference: Option<&Reference<'_>>,
    ) -> (Record, Option<Findings>) {
        let of_shader = log.diagnostics.clone();
        let (scene_name, reference_name) = reference.map(Reference::names).unwrap_or_default();
        let solution = match reference {
            Some(Reference::Given(given)) => given.shader(),
            _ => None,
        };
        let mut checked: Vec<CheckedFrame> = Vec::new();
        let mut worst: Option<(Verdict, Option<Findings>)> = None;
        for (index, PlannedFrame { inputs, frame }) in self.plan.frames.iter().enumerate() {
            let mut frame = frame.clone();
            let mut growth = None;
            // The explanation of the first wrong image is reported.
            let explains = !checked.iter().any(|frame| frame.record.verdict == Verdict::Wrong);
            let planned = (index, &mut frame);
            let findings = self.verify(context, (log, &mut growth), shader, reference, planned, explains);
            let files = match (&findings, reference) {
                (Err(Failure::InvalidScene(_)), Some(Reference::Scene(scene))) => &scene.files,
                _ => &shader.files,
            };
            match &findings {
                Ok(findings) => log.report_findings(&shader.name, findings),
                Err(failure) => log.report_failure(failure, files),
            }
            let solution = solution.filter(|_| findings.is_ok());
            let record = Record::new(FrameResult {
                shader: &shader.name,
                scene: scene_name,
                reference: reference_name,
                findings: findings.as_ref(),
                files,
                diagnostics: std::mem::replace(&mut log.diagnostics, of_shader.clone()),
                growth,
                missing_media: missing_media(shader, &frame),
                unused: solution.map(|solution| {
                    let unused = Unused::new(&shader.trees(), &solution.trees());
                    (unused, &solution.files)
                }),
            });
            let has_image = findings.is_ok();
            if worst.as_ref().is_none_or(|(worst, _)| record.verdict < *worst) {
                worst = Some((record.verdict, findings.ok()));
            }
            checked.push(CheckedFrame {
                inputs,
                size: frame.size,
                record,
            });
            if !has_image {
                break;
            }
        }
        let record = match (&self.plan.assignment, checked.pop()) {
            (None, Some(only)) => only.record,
            (_, last) => {
                checked.extend(last);
                Record::of_frames(checked, self.plan.frames.len())
            }
        };
        (record, worst.and_then(|(_, findings)| findings))
    }

    /// The command that shows more of a fault.
    fn help(&self, record: &Record, is_late_on_gpu: bool) -> Option<String> {
        let explain = |code: &str| Some(format!("toyproof explain {code}"));
        let check = match record.verdict {
            Verdict::Wrong => match &record.mistake {
                Some(mistake) => return explain(&mistake.id.replace('+', " ")),
                None => &record.algorithm,
            },
            Verdict::Unstable
                if record
                    .algorithm
                    .as_ref()
                    .is_some_and(|check| check.ill_conditioned > 0) =>
            {
                &record.algorithm
            }
            Verdict::Unstable => &record.precision,
            Verdict::Invalid | Verdict::Timeout | Verdict::Inconclusive => {
                let of = |severity| record.diagnostics.iter().find(|one| one.severity == severity);
                let diagnostic = of(Severity::Error).or_else(|| of(Severity::Warning));
                return match diagnostic.and_then(|one| report::explain(&one.code)) {
                    Some(explanation) => explain(explanation.code),
                    // The evaluator names the line of the loop.
                    None if is_late_on_gpu => Some(self.command("check", record, "--device cpu".to_owned())),
                    None => None,
                };
            }
            Verdict::Missing | Verdict::Error | Verdict::Chaotic | Verdict::Correct | Verdict::Ok => {
                return None;
            }
        };
        let check = check.as_ref()?;
        let pixel = check.worst.as_ref().or(check.first.as_ref())?;
        Some(self.command("debug", record, format!("--pixel {},{}", pixel.x, pixel.y)))
    }

    /// A command on a shader, with the flags of this run that it takes, and those of the frame that gives the
    /// verdict.
    fn command(&self, name: &str, record: &Record, flag: String) -> String {
        let mut command = vec![format!("toyproof {name}"), shell_word(&record.shader), flag];
        command.extend(self.plan.reference.flags());
        command.extend(frame_flags(&self.plan.frames[record.shown_frame()].inputs));
        command.extend(self.options.language.flags());
        command.join(" ")
    }

    /// Verifies a shader in the planned frame with this index, which gets its size. Mistakes and repairs are
    /// searched for if it `explains` a wrong image.
    fn verify(
        &self,
        context: &mut WorkerContext,
        (log, growth): (&mut Log, &mut Option<GrowthRecord>),
        shader: &Shader,
        reference: Option<&Reference<'_>>,
        (index, frame): (usize, &mut Frame),
        explains: bool,
    ) -> Result<Findings, Failure> {
        let checked = image(shader)?;
        let has_history = shader.has_passes;
        let mut key = index;
        if has_history && self.plan.assignment.is_none() && !matches!(reference, Some(Reference::Given(_))) {
            // The reference has the time of the frame that the user does not name.
            if !self.options.is_moment_given {
                let scene = match reference {
                    Some(Reference::Scene(scene)) => scene.scene.as_ref().ok(),
                    _ => None,
                };
                let number = default_frame(scene);
                *frame = frame.at(number, number as f32 / FRAME_RATE);
            }
            key = self.plan.frames.len() + frame.frame as usize;
        }
        let cached = reference.map(|reference| self.cached(reference, (index, key), has_history, frame));
        let cached = cached.transpose()?;
        let from_start = match shader.project() {
            Some(passes) => self.bind(context, log, shader, passes, (frame, reference.is_some()))?,
            None => None,
        };
        *growth = from_start.as_ref().map(|bound| GrowthRecord::new(&bound.growth));
        let frame = &*frame;
        if let (Some(Reference::Scene(scene)), Some(cached)) = (reference, &cached)
            && let Some(conditioning) = cached.conditioning()
        {
            let warning = ill_conditioned(&scene.name, frame.size, &conditioning);
            log.messages.push(Message::Warning(warning));
        }
        let hypotheses = contain(Part::Mistake, || {
            // A mistake of another pass is not one of the image.
            let cached = cached.as_ref().filter(|_| explains && !has_history);
            cached.and_then(|cached| cached.hypotheses(frame))
        });
        let hypotheses = hypotheses.unwrap_or_else(|panic| {
            log.fail(format!("{}: {panic}", shader.name));
            None
        });
        let case = Case {
            checked,
            lints: &shader.lints,
            expected: cached.as_ref().map(|cached| &cached.expected),
            frame,
            from_start: from_start.as_ref().map(|bound| FromStart {
                double: &bound.double,
                growth: bound.growth.visible,
            }),
            float: self.options.driver.float(),
            timeout: self.options.driver.timeout(),
            pool: context.pool.as_ref(),
        };
        let options = Options {
            hypotheses,
            alternatives: (!has_history).then_some(Alternatives {
                permitted: &self.plan.permitted,
                scenes: Some(&self.other_scenes),
            }),
            search: (explains && !has_history && self.options.search > 0.0)
                .then(|| self.search_options(shader, checked)),
        };
        if self.fell_back.load(Ordering::Relaxed) {
            context.worker = None;
        }
        let worker = context.worker.as_mut().map(|worker| worker as &mut Driver);
        let mut findings = explain::check(worker, &case, &options);
        if let Err(Failure::Gpu(failure)) = &findings
            && failure.is_without_driver()
            && self.options.driver.may_fall_back()
        {
            if !self.fell_back.swap(true, Ordering::Relaxed) {
                log.messages.push(Message::Warning(format!(
                    "{failure}; shaders are evaluated on the CPU, without the toolchain check (see `toyproof doctor`)"
                )));
            }
            context.worker = None;
            findings = explain::check(None, &case, &options);
        }
        let mut findings = findings?;
        if let (Some(Reference::Given(prepared)), Some(cached)) = (reference, &cached)
            && let Some(warning) = prepared.march_warning(&cached.expected)
        {
            log.messages.push(Message::Warning(warning));
        }
        for panic in findings.panics.drain(..) {
            log.fail(format!("{}: {panic}", shader.name));
        }
        let denied = denied(&mut findings.notes, self.options.language.denied());
        log.report(std::mem::take(&mut findings.notes), &shader.files);
        if denied.is_empty() {
            Ok(findings)
        } else {
            Err(Failure::Invalid(denied))
        }
    }

    /// Binds the inputs of the image of a project in a frame, with or without a reference, and reports the
    /// findings on its passes in the frames up to it.
    fn bind(
        &self,
        context: &mut WorkerContext,
        log: &mut Log,
        shader: &Shader,
        passes: &CompiledProject,
        (frame, has_reference): (&mut Frame, bool),
    ) -> Result<Option<BoundFrame>, Failure> {
        let renderers = Renderers {
            driver: context.worker.as_mut().map(|worker| worker as &mut Driver),
            float: self.options.driver.float(),
            timeout: self.options.driver.timeout(),
            pool: context.pool.as_ref(),
        };
        let rendering = rendering(passes, PassKind::Image)?;
        let pass_shader = pass_shader(passes, &rendering);
        let Some(mut bound) = bind(&pass_shader, frame, has_reference, renderers)? else {
            return Ok(None);
        };
        log.report(std::mem::take(&mut bound.notes), &shader.files);
        let errors = bound.growth.frames.iter().map(|error| error.max_abs);
        log.messages.push(Message::Detail(format!(
            "{}: over frames 0 to {}, float32 and double precision differ by at most {:.2e}",
            shader.name,
            frame.frame,
            errors.fold(0.0, f64::max)
        )));
        if let Some(difference) = bound.difference {
            log.messages.push(Message::Warning(format!(
                "{}: the driver and the CPU render {} differently in frame {} ({} pixels); such pixels depend on \
                 undefined behavior, or the driver is wrong",
                shader.name, difference.pass, difference.frame, difference.pixels
            )));
        }
        Ok(Some(bound))
    }

    /// Searches a wrong shader for places where an expression of a correct one repairs it. Returns its record
    /// with the fix, if there is one, and writes the image after the fix.
    pub(super) fn search_again(
        &self,
        context: &WorkerContext,
        submission: &Submission,
        record: &Record,
        donors: &Donors,
    ) -> Option<Outcome> {
        let shader = self.load(submission);
        let checked = shader.single_pass()?;
        let reference = self.references.find(submission.input.as_ref().ok()?)?;
        let index = record.shown_frame();
        let mut frame = self.plan.frames[index].frame.clone();
        let cached = self.cached(&reference, (index, index), false, &mut frame).ok()?;
        let case = Case {
            checked,
            lints: &shader.lints,
            expected: Some(&cached.expected),
            frame: &frame,
            from_start: None,
            float: self.options.driver.float(),
            timeout: self.options.driver.timeout(),
            pool: context.pool.as_ref(),
        };
        let options = Options {
            search: Some(SearchOptions {
                donors: Some(donors),
                ..self.search_options(&shader, checked)
            }),
            ..Options::default()
        };
        let findings = contain(Part::Repair, || explain::check(None, &case, &options));
        let findings = findings.ok()?.ok()?;
        let search = findings
            .search
            .as_ref()
            .filter(|search| !search.repairs.is_empty())?;
        let record = record.clone().with_search(search, &shader.files);
        let help = self.help(&record, false);
        let mut log = Log::default();
        if let (Some(out), Some(stem)) = (&self.options.out, &submission.output_stem) {
            keep(out, stem, &[FIXED], Some(&findings), &mut log);
        }
        Some(Outcome {
            record: Record { help, ..record },
            log,
        })
    }

    fn load(&self, submission: &Submission) -> Shader {
        Shader::load(
            &submission.input,
            &self.options.language,
            Deadline::after(self.options.driver.timeout()),
        )
    }

    /// Collects the expressions of correct shaders.
    pub(super) fn donors<'s>(&self, correct: impl Iterator<Item = &'s Submission>) -> Donors {
        let shaders: Vec<Shader> = correct.map(|submission| self.load(submission)).collect();
        Donors::new(shaders.iter().filter_map(Shader::single_pass))
    }

    fn search_options<'s>(&self, shader: &'s Shader, checked: &Checked) -> SearchOptions<'s> {
        SearchOptions {
            source: shader.text(checked),
            lenient: self.options.language.is_lenient(),
            budget: self.options.search,
            donors: None,
        }
    }

    /// The reference of a shader in the planned frame with this index; sets the size of the frame. If the
    /// image `has_history`, because it depends on earlier frames, it has accumulated a sample in each of
    /// them.
    fn cached(
        &self,
        reference: &Reference,
        (index, key): (usize, usize),
        has_history: bool,
        frame: &mut Frame,
    ) -> Result<Arc<CachedReference>, Failure> {
        match reference {
            Reference::Scene(scene) => {
                let mut scene: Scene = scene.scene.clone()?;
                frame.size = self.plan.frames[index].inputs.size.unwrap_or(scene.film.size);
                scene.film.size = frame.size;
                if has_history {
                    accumulate(&mut scene, frame.frame);
                }
                Ok(self.scenes.get(scene, key, frame))
            }
            Reference::Given(given) => Ok(Arc::clone(&given.cached[index])),
        }
    }
}

/// The tree of the image, with whatever it reads.
fn image(shader: &Shader) -> Result<&Checked, Failure> {
    shader.image().map_err(|unusable| match unusable {
        Unusable::Unreadable(error) if shader.is_missing => Failure::Missing(error.reason.clone()),
        Unusable::Unreadable(error) => Failure::Unreadable(error.reason.clone()),
        Unusable::Invalid(diagnostics) => Failure::Invalid(diagnostics.clone()),
    })
}

/// A sentence about the media that a shader reads and that toyproof does not have; `None` if it has all. An
/// image that the user can bind does not count, and neither does one that the author allows to be missing.
fn missing_media(shader: &Shader, frame: &Frame) -> Option<String> {
    let checked = shader.single_pass()?;
    let warned = unbound(checked, &shader.lints, frame);
    let is_warned = |span: Span| warned.iter().any(|warning| warning.span == Some(span));
    let missing = unbound_channels(checked, frame)
        .into_iter()
        .filter_map(|(channel, span)| {
            let kind = match checked.channels[channel] {
                SamplerShape::D2 if shader.project().is_none() => return None,
                SamplerShape::D2 => "texture",
                SamplerShape::Cube => "cube map",
                SamplerShape::D3 => "volume",
                SamplerShape::D2Array => "array of textures",
            };
            is_warned(span).then(|| format!("the {kind} of `iChannel{channel}`"))
        });
    let missing: Vec<_> = missing.collect();
    let verb = plural(missing.len() as u64, "is", "are");
    (!missing.is_empty()).then(|| format!("{} {verb} not available, and black instead", missing.join(", ")))
}
