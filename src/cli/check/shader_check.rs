//! Checks one shader in the planned frames: its record, its findings and the messages on it.

use std::sync::atomic::Ordering;

use toyproof_diagnostic::{self as diagnostic, Diagnostic, Files, Span, plural};
use toyproof_explain::project::{Project, ProjectCase};
use toyproof_explain::unused::Unused;
use toyproof_explain::whole_image::Alternatives;
use toyproof_explain::{self as explain, Findings, Options};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::SamplerShape;
use toyproof_image::{FRAME_RATE, Frame};
use toyproof_project::{CompiledProject, MissingMedium, PassKind};
use toyproof_report::{CheckedFrame, DialectRecord, FrameResult, GrowthRecord, Record};
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::project::bind::{BoundFrame, Renderers, bind, default_frame};
use toyproof_verify::{Case, Driver, Failure, FromStart, Verdict, unbound, unbound_channels};

use super::checker::{Checker, WorkerContext};
use super::outcome::Log;
use super::plan::PlannedFrame;
use super::reference::Reference;
use super::reference_cache::CachedReference;
use crate::cli::project::{pass_shader, rendering};
use crate::cli::reference::ill_conditioned;
use crate::cli::shader::{Shader, Unusable, denied};

/// The check of a shader, in one frame after the other.
pub(super) struct ShaderCheck<'a> {
    checker: &'a Checker<'a>,
    context: &'a mut WorkerContext,
    /// The shader from the frame with this index on: values of uniforms are part of it. The first is that of
    /// the first frame.
    shaders: &'a [(usize, Shader)],
    /// That of the frame in progress.
    shader: &'a Shader,
    reference: Option<&'a Reference<'a>>,
    log: Log,
    /// The diagnostics on the frame in progress.
    diagnostics: Vec<diagnostic::Json>,
    /// How far float32 is from double precision in the frame in progress.
    growth: Option<GrowthRecord>,
    /// Whether the driver, which names no line, exceeded the time limit.
    is_late_on_gpu: bool,
}

impl<'a> ShaderCheck<'a> {
    pub(super) fn new(
        checker: &'a Checker<'a>,
        context: &'a mut WorkerContext,
        shaders: &'a [(usize, Shader)],
        reference: Option<&'a Reference<'a>>,
    ) -> Self {
        Self {
            checker,
            context,
            shaders,
            shader: &shaders[0].1,
            reference,
            log: Log::default(),
            diagnostics: Vec::new(),
            growth: None,
            is_late_on_gpu: false,
        }
    }

    /// The messages, and whether the driver exceeded the time limit in the last frame.
    pub(super) fn finish(self) -> (Log, bool) {
        (self.log, self.is_late_on_gpu)
    }

    /// Checks the shader in all frames, up to the first without an image. Returns its record, and the
    /// findings in the first frame with the worst verdict, which is that of the record.
    pub(super) fn check_frames(&mut self) -> (Record, Option<Findings>) {
        let plan = self.checker.plan;
        let (scene_name, reference_name) = self.reference.map(Reference::names).unwrap_or_default();
        let solution = match self.reference {
            Some(Reference::Given(given)) => given.shader(),
            _ => None,
        };
        let mut checked: Vec<CheckedFrame> = Vec::new();
        let mut features = self.checker.features.count();
        let mut worst: Option<(Verdict, Option<Findings>)> = None;
        for (index, PlannedFrame { inputs, frame }) in plan.frames.iter().enumerate() {
            let mut frame = frame.clone();
            if let Some((_, shader)) = self.shaders.iter().rfind(|(from, _)| *from <= index) {
                self.shader = shader;
            }
            let shader = self.shader;
            // The explanation of the first wrong image is reported.
            let explains = !checked.iter().any(|frame| frame.record.verdict == Verdict::Wrong);
            self.report(shader.lints.warnings.clone(), &shader.files);
            let findings = self.verify(index, &mut frame, explains);
            let files = match (&findings, self.reference) {
                (Err(Failure::InvalidScene(_)), Some(Reference::Scene(scene))) => &scene.files,
                _ => &shader.files,
            };
            match &findings {
                Ok(findings) => self.report_device(findings),
                Err(failure) => self.report_failure(failure, files),
            }
            let solution = solution.filter(|_| findings.is_ok());
            let record = Record::new(FrameResult {
                shader: &shader.name,
                scene: scene_name,
                reference: reference_name,
                dialect: shader.image().ok().map(DialectRecord::new),
                findings: findings.as_ref(),
                files,
                diagnostics: std::mem::take(&mut self.diagnostics),
                growth: self.growth.take(),
                missing_media: missing_media(shader, &frame),
                unused: solution.map(|solution| {
                    let unused = Unused::new(&shader.trees(), &solution.trees());
                    (unused, &solution.files)
                }),
            });
            let has_image = findings.is_ok();
            if let Ok(findings) = &findings {
                features.add(index, findings.results.algorithm.as_ref());
            }
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
        let mut record = match (&plan.assignment, checked.pop()) {
            (None, Some(only)) => only.record,
            (_, last) => {
                checked.extend(last);
                Record::from_frames(checked, plan.frames.len())
            }
        };
        record.features = features.records();
        (record, worst.and_then(|(_, findings)| findings))
    }

    /// Verifies the shader in the planned frame with this index, which gets its size. Mistakes and repairs
    /// are searched for if it `explains` a wrong image.
    fn verify(&mut self, index: usize, frame: &mut Frame, explains: bool) -> Result<Findings, Failure> {
        let (checker, shader, reference) = (self.checker, self.shader, self.reference);
        let (options, plan) = (checker.options, checker.plan);
        let checked = image(shader)?;
        let has_history = shader.has_passes;
        let mut key = index;
        if has_history && plan.assignment.is_none() && !matches!(reference, Some(Reference::Given(_))) {
            // The reference has the time of the frame that the user does not name.
            if !options.is_moment_given {
                let scene = match reference {
                    Some(Reference::Scene(scene)) => scene.scene.as_ref().ok(),
                    _ => None,
                };
                let number = default_frame(scene);
                *frame = frame.at(number, number as f32 / FRAME_RATE);
            }
            key = plan.frames.len() + frame.frame as usize;
        }
        let cached = reference.map(|reference| checker.cached(reference, (index, key), has_history, frame));
        let cached = cached.transpose()?;
        let unbound = frame.clone();
        let from_start = match shader.project() {
            Some(passes) => self.bind(passes, frame)?,
            None => None,
        };
        self.growth = from_start.as_ref().map(|bound| GrowthRecord::new(&bound.growth));
        let frame = &*frame;
        if let (Some(Reference::Scene(scene)), Some(cached)) = (reference, &cached)
            && let Some(conditioning) = cached.conditioning()
        {
            self.log
                .warn(ill_conditioned(&scene.name, frame.size, &conditioning));
        }
        let hypotheses = contain(Part::Mistake, || {
            // A mistake of another pass is not one of the image.
            let cached = cached.as_ref().filter(|_| explains && !has_history);
            cached.and_then(|cached| cached.hypotheses(frame))
        });
        let hypotheses = hypotheses.unwrap_or_else(|panic| {
            self.log.fail(format!("{}: {panic}", shader.name));
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
            float: options.driver.float(),
            timeout: options.driver.timeout(),
            pool: self.context.pool.as_ref(),
        };
        let explain_options = Options {
            hypotheses,
            alternatives: (!has_history).then_some(Alternatives {
                permitted: &plan.permitted,
                scenes: Some(&checker.other_scenes),
            }),
            search: (explains && !has_history && options.search > 0.0)
                .then(|| checker.search_options(shader, checked)),
            value_images: options.out.is_some(),
        };
        if checker.fell_back.load(Ordering::Relaxed) {
            self.context.worker = None;
        }
        let worker = self.context.worker.as_mut().map(|worker| worker as &mut Driver);
        let mut findings = explain::check(worker, &case, &explain_options);
        if let Err(Failure::Gpu(failure)) = &findings
            && failure.is_without_driver()
            && options.driver.may_fall_back()
        {
            if !checker.fell_back.swap(true, Ordering::Relaxed) {
                self.log.warn(format!(
                    "{failure}; shaders are evaluated on the CPU, without the toolchain check (see `toyproof doctor`)"
                ));
            }
            self.context.worker = None;
            findings = explain::check(None, &case, &explain_options);
        }
        let mut findings = findings?;
        if explains && options.search > 0.0 && has_history {
            self.explain_passes(cached.as_deref(), &unbound, &mut findings);
        }
        if let (Some(Reference::Given(prepared)), Some(cached)) = (reference, &cached)
            && let Some(warning) = prepared.march_warning(&cached.expected)
        {
            self.log.warn(warning);
        }
        for panic in findings.panics.drain(..) {
            self.log.fail(format!("{}: {panic}", shader.name));
        }
        let denied = denied(&mut findings.notes, options.language.denied());
        self.report(std::mem::take(&mut findings.notes), &shader.files);
        if denied.is_empty() {
            Ok(findings)
        } else {
            Err(Failure::Invalid(denied))
        }
    }

    /// Finds the pass of a wrong project that departs from those of the reference, and searches it for
    /// repairs. The frame has no channels of the image.
    fn explain_passes(&self, cached: Option<&CachedReference>, frame: &Frame, findings: &mut Findings) {
        let (Some(Reference::Given(given)), Some(cached)) = (self.reference, cached) else {
            return;
        };
        let Some(solution) = given.shader().filter(|_| findings.verdict == Verdict::Wrong) else {
            return;
        };
        let (Some(passes), Some(reference)) = (self.shader.project(), solution.project()) else {
            return;
        };
        let renderings = [passes, reference].map(|passes| rendering(passes, PassKind::Image, frame.size));
        let [Ok(rendering), Ok(of_reference)] = &renderings else {
            return;
        };
        let [own, other] = [(passes, rendering), (reference, of_reference)]
            .map(|(passes, rendering)| pass_shader(passes, rendering));
        let [tabs, reference_tabs] =
            [(passes, rendering), (reference, of_reference)].map(|(passes, rendering)| {
                let tabs = rendering.passes.iter().map(|&at| passes.project.passes[at].file);
                tabs.collect::<Vec<_>>()
            });
        let options = self.checker.options;
        let case = ProjectCase {
            project: Project {
                shader: &own,
                files: &self.shader.files,
                tabs: &tabs,
            },
            reference: Project {
                shader: &other,
                files: &solution.files,
                tabs: &reference_tabs,
            },
            expected: &cached.expected,
            frame,
            budget: options.search,
            value_images: options.out.is_some(),
            pool: self.context.pool.as_ref(),
        };
        match contain(Part::Repair, || explain::project::explain(&case)) {
            Ok(explanation) => explanation
                .into_iter()
                .for_each(|found| findings.explain_with(found)),
            Err(panic) => findings.panics.push(panic),
        }
    }

    /// Binds the inputs of the image of a project in a frame, and reports the findings on its passes in the
    /// frames up to it.
    fn bind(&mut self, passes: &CompiledProject, frame: &mut Frame) -> Result<Option<BoundFrame>, Failure> {
        let rendering = rendering(passes, PassKind::Image, frame.size)?;
        let missing = rendering.missing.iter().map(MissingMedium::diagnostic);
        self.report(missing.collect(), &self.shader.files);
        let driver = &self.checker.options.driver;
        let renderers = Renderers {
            driver: self.context.worker.as_mut().map(|worker| worker as &mut Driver),
            float: driver.float(),
            timeout: driver.timeout(),
            pool: self.context.pool.as_ref(),
        };
        let pass_shader = pass_shader(passes, &rendering);
        let Some(mut bound) = bind(&pass_shader, frame, self.reference.is_some(), renderers)? else {
            return Ok(None);
        };
        let name = &self.shader.name;
        self.report(std::mem::take(&mut bound.notes), &self.shader.files);
        let errors = bound.growth.frames.iter().map(|error| error.max_abs);
        self.log.detail(format!(
            "{name}: over frames 0 to {}, float32 and double precision differ by at most {:.2e}",
            frame.frame,
            errors.fold(0.0, f64::max)
        ));
        if let Some(difference) = bound.difference {
            self.log.warn(format!(
                "{name}: the driver and the CPU render {} differently in frame {} ({} pixels); such pixels depend on \
                 undefined behavior, or the driver is wrong",
                difference.pass, difference.frame, difference.pixels
            ));
        }
        Ok(Some(bound))
    }

    fn report_device(&mut self, findings: &Findings) {
        if let Some(gpu_run) = &findings.results.gpu_run {
            self.log.detail(format!(
                "{}: translated in {:.4} s, compiled in {:.3} s, rendered in {:.3} s on {}",
                self.shader.name,
                gpu_run.translate.as_secs_f64(),
                gpu_run.compile.as_secs_f64(),
                gpu_run.draw.as_secs_f64(),
                gpu_run.device
            ));
            self.log.device = Some(gpu_run.device.clone());
        }
    }

    fn report_failure(&mut self, failure: &Failure, files: &Files) {
        self.report(failure.diagnostics(), files);
        self.is_late_on_gpu = match failure {
            Failure::LoopTruncated(_) => true,
            Failure::Gpu(failure) => failure.is_timeout(),
            _ => false,
        };
    }

    /// Adds diagnostics to the messages, and to the record of the frame in progress.
    fn report(&mut self, diagnostics: Vec<Diagnostic>, files: &Files) {
        let json = diagnostics.iter().map(|one| diagnostic::json(one, files));
        self.diagnostics.extend(json);
        self.log.diagnostics(diagnostics, files);
    }
}

/// The tree of the image, with whatever it reads.
pub(in crate::cli) fn image(shader: &Shader) -> Result<&Checked, Failure> {
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
