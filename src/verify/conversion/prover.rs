//! Proofs of conversions: the written file is read by independent readers, and what they read is run.

use toyproof_diagnostic::{File, Files, grouped, plural, short};
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::browser::{self, Text};
use toyproof_gpu::{Failure, ShaderArtifact};
use toyproof_image::Image;
use toyproof_translate::backend::{Target, roundtrip, spirv};
use toyproof_translate::naga_ir::Shape;
use toyproof_translate::wgsl::Style;
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify as verify;
use toyproof_verify::conversion::{Against, Proof, Rgb8Comparison, frames, prove};

use super::super::shader::Shader;
use super::conversion::{Converter, WorkerContext};
use super::tool;

/// The name of the reader of WGSL and of the GLSL that naga is fed.
pub(super) const NAGA: &str = "naga";

/// The status of a conversion's proof.
pub(super) enum ProofStatus {
    /// No proof was requested.
    NotRequested,
    /// The file was read again, and renders the same image.
    Proved(Proof, Readers),
    /// The shader that naga wrote the file from renders the same image; no reader reads the file itself.
    SourceProved(Proof),
    /// The proof failed, for this reason.
    Unproved(String),
    /// No proof was possible, for a reason that applies to any conversion of the shader.
    NotProvable(String),
}

/// The readers of a conversion.
pub(super) struct Readers {
    /// The readers whose results were run, each separately.
    pub(super) names: Vec<String>,
    /// The validator that accepts it, as text.
    pub(super) validator: Option<String>,
    /// The browser that renders it like the original, if `--browser` was given.
    pub(super) browser: Option<(String, Rgb8Comparison)>,
}

impl Converter<'_> {
    /// Reads the conversion with every available reader, and runs the results.
    pub(super) fn prove(
        &self,
        context: &mut WorkerContext,
        (checked, files): (&Checked, &Files),
        lowered: Lowered,
        target: Target,
        bytes: &[u8],
    ) -> Result<ProofStatus, String> {
        let validator = tool::validate(target, bytes)?;
        let channels = checked.channels.map(|shape| match shape {
            SamplerShape::D2 | SamplerShape::D2Array => Shape::D2,
            SamplerShape::D3 => Shape::D3,
            SamplerShape::Cube => Shape::Cube,
        });
        let mut readings = match target {
            Target::Wgsl => {
                let text = String::from_utf8_lossy(bytes);
                vec![(NAGA.to_owned(), ShaderArtifact::Wgsl(Style::Plain.hosted(&text)))]
            }
            Target::Spirv => {
                let words = spirv::of_bytes(bytes).ok_or("half a word was written")?;
                vec![("the driver".to_owned(), ShaderArtifact::Words(words, channels))]
            }
            Target::Glsl => vec![("toyproof's GLSL front end".to_owned(), read_glsl(bytes)?)],
            Target::Hlsl | Target::Msl => Vec::new(),
        };
        if let Some((words, who)) = tool::compile(target, bytes)? {
            readings.push((who, ShaderArtifact::Words(words, channels)));
        }
        if !readings.is_empty() {
            return Ok(self.run(context, (checked, files), readings, validator));
        }
        let meaning = vec![(String::new(), ShaderArtifact::Lowered(lowered))];
        Ok(match self.run(context, (checked, files), meaning, None) {
            ProofStatus::Proved(proof, _) => ProofStatus::SourceProved(proof),
            other => other,
        })
    }

    /// Runs the result of each reader; the status is proved only if all results agree with the shader.
    pub(super) fn run(
        &self,
        context: &mut WorkerContext,
        (checked, files): (&Checked, &Files),
        readings: Vec<(String, ShaderArtifact)>,
        validator: Option<String>,
    ) -> ProofStatus {
        let (names, written): (Vec<_>, Vec<_>) = readings.into_iter().unzip();
        let proofs = self.proofs(context, checked, written);
        let proofs = match proofs {
            Ok(proofs) => proofs,
            Err(status) => return status,
        };
        if let Some(why) = proofs.first().and_then(|proof| fully_undefined(proof, files)) {
            return ProofStatus::NotProvable(why);
        }
        let held = || {
            let several = proofs.len() > 1;
            let mut first = None;
            for (proof, who) in proofs.into_iter().zip(&names) {
                let held = require_proof(proof).map_err(|why| {
                    if several {
                        format!("as {who} reads it, {why}")
                    } else {
                        why
                    }
                })?;
                first.get_or_insert(held);
            }
            first.ok_or_else(|| "nothing read it".to_owned())
        };
        held().map_or_else(ProofStatus::Unproved, |proof| {
            let browser = None;
            ProofStatus::Proved(
                proof,
                Readers {
                    names,
                    validator,
                    browser,
                },
            )
        })
    }

    fn proofs(
        &self,
        context: &mut WorkerContext,
        checked: &Checked,
        readings: Vec<ShaderArtifact>,
    ) -> Result<Vec<Proof>, ProofStatus> {
        let runner = match &mut context.runner {
            Ok(Some(runner)) => runner,
            Ok(None) => {
                let why = "to prove a conversion takes a Vulkan driver, and --on cpu asks for none";
                return Err(ProofStatus::NotProvable(why.to_owned()));
            }
            Err(error) => return Err(ProofStatus::NotProvable(error.clone())),
        };
        let frames = frames(checked);
        let pool = context.pool.as_ref();
        prove(runner, checked, readings, &frames, self.driver.timeout(), pool).map_err(failure_status)
    }
}

/// The status of a conversion that could not be rendered. A different conversion would help only if this one
/// is at fault, not if the shader itself takes too long or cannot be run.
fn failure_status(failure: verify::Failure) -> ProofStatus {
    use Failure::{Device, Timeout};
    match failure {
        verify::Failure::Gpu(failure) if failure.is_without_driver() => {
            ProofStatus::NotProvable(format!("to prove a conversion takes a Vulkan driver: {failure}"))
        }
        verify::Failure::Cpu(_)
        | verify::Failure::LoopTruncated(_)
        | verify::Failure::Overdue(_)
        | verify::Failure::Gpu(Timeout { .. } | Device(_)) => ProofStatus::NotProvable(failure.to_string()),
        failure => ProofStatus::Unproved(failure.to_string()),
    }
}

/// Renders a proved conversion and the original in a browser, if there is one: their 8-bit colors may differ
/// by at most 1/255.
pub(super) fn prove_in_browser(
    context: &mut WorkerContext,
    checked: &Checked,
    shader: &Shader,
    status: ProofStatus,
    text: Text,
    upside_down: bool,
) -> ProofStatus {
    let Some(browser) = &mut context.browser else {
        return status;
    };
    let (proof, mut readers) = match status {
        ProofStatus::Proved(proof, readers) => (proof, readers),
        other => return other,
    };
    let is_flat = |shape: &SamplerShape| *shape == SamplerShape::D2;
    if checked.reads_textures() && !checked.channels.iter().all(is_flat) {
        return ProofStatus::Unproved("a channel that is not flat cannot be fed to Chromium yet".to_owned());
    }
    let frames = frames(checked);
    let original = browser::as_shadertoy(shader.text(checked));
    let images = browser
        .render(Text::Glsl(&original), &frames)
        .map_err(|failure| format!("the original: {failure}"))
        .and_then(|original| {
            let converted = browser
                .render(text, &frames)
                .map_err(|failure| failure.to_string())?;
            Ok((original, converted))
        });
    let (original, mut converted) = match images {
        Ok(images) => images,
        Err(why) => return ProofStatus::Unproved(why),
    };
    if upside_down {
        converted = converted.iter().map(Image::upside_down).collect();
    }
    let shown = Rgb8Comparison::of(&original, &converted, &proof.undefined_at);
    if shown.differing > 0 {
        return ProofStatus::Unproved(format!(
            "in Chromium {} of {} pixels {} not as with WebGL 2 of the original, by up to {:.1}/255",
            grouped(shown.differing),
            grouped(shown.pixels),
            plural(shown.differing, "is", "are"),
            shown.max * 255.0
        ));
    }
    let name = browser.name().unwrap_or("Chromium").to_owned();
    readers.browser = Some((name, shown));
    ProofStatus::Proved(proof, readers)
}

/// The reason why no conversion of a shader can be proved, if every pixel depends on undefined behavior.
fn fully_undefined(proof: &Proof, files: &Files) -> Option<String> {
    let by = proof
        .undefined_by
        .filter(|_| proof.undefined() == proof.pixels())?;
    let span = by.site.at.span;
    let place = files.position(span);
    Some(format!(
        "every pixel hangs on what GLSL leaves undefined: {} at {}:{}:{}",
        by.site.fault.words(),
        files.get(span.file).name(),
        place.line,
        place.column
    ))
}

/// Returns the proof if it holds, or the reason why it does not.
fn require_proof(proof: Proof) -> Result<Proof, String> {
    if proof.holds() {
        return Ok(proof);
    }
    let differing = proof.differing();
    let worst = proof
        .answers
        .iter()
        .map(|answer| answer.max_abs)
        .fold(0.0, f64::max);
    let against = match proof.against {
        Against::Evaluator => "the evaluator's",
        Against::StrictRun => "the shader's own",
    };
    Err(format!(
        "{} of {} pixels {} not to the bit {against}, by up to {worst:.1e}",
        grouped(differing),
        grouped(proof.pixels()),
        plural(differing, "is", "are")
    ))
}

/// Reads the written GLSL with our own front end.
fn read_glsl(bytes: &[u8]) -> Result<ShaderArtifact, String> {
    let mut files = Files::default();
    let text = roundtrip::as_shadertoy(&String::from_utf8_lossy(bytes));
    let file = files.add(File::new("written", &text));
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(|errors| {
        let first = errors.first().map(|error| short(error, &files));
        format!("our own front end refuses it: {}", first.unwrap_or_default())
    })?;
    Ok(ShaderArtifact::Lowered(FloatMode::Fast.lower(&checked)))
}
