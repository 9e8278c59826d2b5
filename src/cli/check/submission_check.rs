//! Checks one submission, from its text to its record and its images.

use std::time::Instant;

use toyproof_classroom::function_test::Subject;
use toyproof_diagnostic::{Files, Severity};
use toyproof_explain::repair::{Donors, SearchOptions};
use toyproof_explain::{self as explain, Options};
use toyproof_report::{self as report, Departure, FrameResult, Record};
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::{Case, Verdict};

use super::checker::{Checker, WorkerContext};
use super::images::{FIXED, IMAGES, keep};
use super::outcome::{Log, Outcome};
use super::shader_check::{ShaderCheck, image};
use super::submission::Submission;
use crate::cli::inputs::{frame_flags, shell_word};
use crate::cli::shader::Shader;

impl Checker<'_> {
    /// Checks a shader and writes its images. A panic costs only this shader's verdict, which is then
    /// `error`.
    pub(super) fn check(&self, context: &mut WorkerContext, submission: &Submission) -> Outcome {
        let start = Instant::now();
        let checked = contain(Part::Shader, || self.check_shader(context, submission));
        let mut outcome = checked.unwrap_or_else(|panic| {
            context.restart(&self.options.driver);
            let record = Record::new(FrameResult {
                shader: &submission.name,
                scene: None,
                reference: None,
                dialect: None,
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
        outcome.record.seconds.all = submission.key.is_some().then(|| start.elapsed().as_secs_f64());
        outcome
    }

    fn check_shader(&self, context: &mut WorkerContext, submission: &Submission) -> Outcome {
        // The shader in each frame, read anew for each set of values of uniforms.
        let mut shaders: Vec<(usize, Shader)> = Vec::new();
        for (index, planned) in self.plan.frames.iter().enumerate() {
            let uniforms = &planned.inputs.uniforms;
            let is_last = |&(last, _): &(usize, _)| self.plan.frames[last].inputs.uniforms == *uniforms;
            if !shaders.last().is_some_and(is_last) {
                shaders.push((index, self.load(submission, index)));
            }
        }
        let shader = &shaders[0].1;
        let found = submission.input.as_ref().ok();
        let reference = found.and_then(|found| self.references.find(found));
        let mut check = ShaderCheck::new(self, context, &shaders, reference.as_ref());
        let (mut record, findings) = check.check_frames();
        let (mut log, is_late_on_gpu) = check.finish();
        let is_explained = findings
            .as_ref()
            .is_some_and(|findings| findings.pass_departure.is_some());
        if record.verdict == Verdict::Wrong && self.options.search > 0.0 && shader.has_passes && !is_explained
        {
            record = record.with_unsearched();
        }
        if let Some((assignment, _)) = &self.plan.assignment {
            let subject = image(shader).ok().map(|checked| Subject {
                checked,
                files: &shader.files,
                text: shader.text(checked),
                timeout: self.options.driver.timeout(),
            });
            let subject = subject.filter(|_| record.verdict.is_compiled());
            let check_text = || assignment.check_text(subject.as_ref());
            (record.rules, record.functions) = match &context.pool {
                Some(pool) => pool.install(check_text),
                None => check_text(),
            };
        }
        if let (Some(out), Some(stem)) = (&self.options.out, &submission.output_stem) {
            keep(out, stem, &IMAGES, findings.as_ref(), &mut log);
        }
        if record.help.is_none() {
            record.help = self.help(&record, is_late_on_gpu);
        }
        Outcome { record, log }
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
        let worst = check.worst.as_ref().or(check.first.as_ref())?;
        // The pixel whose values are stated, so that they can be followed.
        let stated = record.departure.as_ref().and_then(Departure::pixel);
        let [x, y] = stated.unwrap_or([worst.x, worst.y]);
        Some(self.command("debug", record, format!("--pixel {x},{y}")))
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

    /// Searches a wrong shader for places where an expression of a correct one repairs it. Returns its record
    /// with the fix, if there is one, and writes the image after the fix.
    pub(super) fn search_again(
        &self,
        context: &WorkerContext,
        submission: &Submission,
        record: &Record,
        donors: &Donors,
    ) -> Option<Outcome> {
        let index = record.shown_frame();
        let shader = self.load(submission, index);
        let checked = shader.single_pass()?;
        let reference = self.references.find(submission.input.as_ref().ok()?)?;
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
}
