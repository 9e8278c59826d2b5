//! What is proved of a conversion: who reads again what was written, and what comes of running what they read.

use toyproof_diagnostic::{File, Files, short};
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::browser::{self, Text};
use toyproof_gpu::{Failure, Written};
use toyproof_image::Image;
use toyproof_translate::backend::{Target, reread, spirv};
use toyproof_translate::naga_ir::Shape;
use toyproof_translate::wgsl::Style;
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify as verify;
use toyproof_verify::compare::{grouped, plural};
use toyproof_verify::conversion::{Against, Proof, Shown, frames, prove};

use super::super::shader::Shader;
use super::conversion::{Converter, Hand};
use super::tool;

/// Who reads WGSL, and what is fed to naga.
pub(super) const NAGA: &str = "naga";

/// How far a conversion is proved.
pub(super) enum Standing {
    /// Nobody asked.
    Unasked,
    /// What was written was read again, and paints the same.
    Proved(Proof, Readers),
    /// What naga wrote it from paints the same; the text itself was read by nobody.
    Meant(Proof),
    /// It is not proved, for that reason.
    Unproved(String),
    /// It could not be put to the proof, for a reason that no other text would change.
    Untried(String),
}

/// Who read what was written.
pub(super) struct Readers {
    /// Who read it so that it could be run, each by itself.
    pub(super) ran: Vec<String>,
    /// Who accepts it beside, in words.
    pub(super) judge: Option<String>,
    /// The browser that paints it as it paints the original, if it was asked.
    pub(super) browser: Option<(String, Shown)>,
}

impl Converter<'_> {
    /// Lets all that can read it read what was written, and runs what they read.
    pub(super) fn judge(
        &self,
        hand: &mut Hand,
        (checked, files): (&Checked, &Files),
        lowered: Lowered,
        target: Target,
        bytes: &[u8],
    ) -> Result<Standing, String> {
        let judge = tool::judge(target, bytes)?;
        let channels = checked.channels.map(|shape| match shape {
            SamplerShape::D2 | SamplerShape::D2Array => Shape::D2,
            SamplerShape::D3 => Shape::D3,
            SamplerShape::Cube => Shape::Cube,
        });
        let mut readings = match target {
            Target::Wgsl => {
                let text = String::from_utf8_lossy(bytes);
                vec![(NAGA.to_owned(), Written::Wgsl(Style::Plain.hosted(&text)))]
            }
            Target::Spirv => {
                let words = spirv::of_bytes(bytes).ok_or("half a word was written")?;
                vec![("the driver".to_owned(), Written::Words(words, channels))]
            }
            Target::Glsl => vec![("toyproof's GLSL front end".to_owned(), reread_glsl(bytes)?)],
            Target::Hlsl | Target::Msl => Vec::new(),
        };
        if let Some((words, who)) = tool::compile(target, bytes)? {
            readings.push((who, Written::Words(words, channels)));
        }
        if !readings.is_empty() {
            return Ok(self.run(hand, (checked, files), readings, judge));
        }
        let meaning = vec![(String::new(), Written::Lowered(lowered))];
        Ok(match self.run(hand, (checked, files), meaning, None) {
            Standing::Proved(proof, _) => Standing::Meant(proof),
            other => other,
        })
    }

    /// Runs what was read again, by each who read it; all proofs hold, or there is a reason why not.
    pub(super) fn run(
        &self,
        hand: &mut Hand,
        (checked, files): (&Checked, &Files),
        readings: Vec<(String, Written)>,
        judge: Option<String>,
    ) -> Standing {
        let (ran, written): (Vec<_>, Vec<_>) = readings.into_iter().unzip();
        let proofs = self.proofs(hand, checked, written);
        let proofs = match proofs {
            Ok(proofs) => proofs,
            Err(untold) => return untold,
        };
        if let Some(why) = proofs.first().and_then(|proof| incomparable(proof, files)) {
            return Standing::Untried(why);
        }
        let held = || {
            let several = proofs.len() > 1;
            let mut first = None;
            for (proof, who) in proofs.into_iter().zip(&ran) {
                let held = held(proof).map_err(|why| {
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
        held().map_or_else(Standing::Unproved, |proof| {
            let browser = None;
            Standing::Proved(proof, Readers { ran, judge, browser })
        })
    }

    fn proofs(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        readings: Vec<Written>,
    ) -> Result<Vec<Proof>, Standing> {
        let runner = match &mut hand.runner {
            Ok(Some(runner)) => runner,
            Ok(None) => {
                let why = "to prove a conversion takes a Vulkan driver, and --on cpu asks for none";
                return Err(Standing::Untried(why.to_owned()));
            }
            Err(error) => return Err(Standing::Untried(error.clone())),
        };
        let frames = frames(checked);
        let pool = hand.pool.as_ref();
        prove(runner, checked, readings, &frames, self.driver.timeout(), pool).map_err(unproved)
    }
}

/// What stands of a conversion that has no pictures. Another text has them only if this one is at fault, not where the shader itself
/// takes too long or cannot be run.
fn unproved(failure: verify::Failure) -> Standing {
    use Failure::{Device, Timeout};
    match failure {
        verify::Failure::Gpu(failure) if failure.is_without_driver() => {
            Standing::Untried(format!("to prove a conversion takes a Vulkan driver: {failure}"))
        }
        verify::Failure::Cpu(_)
        | verify::Failure::CutShort(_)
        | verify::Failure::Overdue(_)
        | verify::Failure::Gpu(Timeout { .. } | Device(_)) => Standing::Untried(failure.to_string()),
        verify::Failure::Gpu(_) => Standing::Unproved(failure.to_string()),
    }
}

/// Lets a browser, if there is one, paint what is proved beside the original: as shown, they must be the same.
pub(super) fn in_browser(
    hand: &mut Hand,
    checked: &Checked,
    shader: &Shader,
    standing: Standing,
    text: Text,
    upside_down: bool,
) -> Standing {
    let Some(browser) = &mut hand.browser else {
        return standing;
    };
    let (proof, mut readers) = match standing {
        Standing::Proved(proof, readers) => (proof, readers),
        other => return other,
    };
    let is_flat = |shape: &SamplerShape| *shape == SamplerShape::D2;
    if checked.reads_textures() && !checked.channels.iter().all(is_flat) {
        return Standing::Unproved("a channel that is not flat cannot be fed to Chromium yet".to_owned());
    }
    let frames = frames(checked);
    let original = browser::as_shadertoy(shader.text(checked));
    let painted = browser
        .paint(Text::Glsl(&original), &frames)
        .map_err(|failure| format!("the original: {failure}"))
        .and_then(|original| {
            let converted = browser
                .paint(text, &frames)
                .map_err(|failure| failure.to_string())?;
            Ok((original, converted))
        });
    let (original, mut converted) = match painted {
        Ok(painted) => painted,
        Err(why) => return Standing::Unproved(why),
    };
    if upside_down {
        converted = converted.iter().map(Image::upside_down).collect();
    }
    let shown = Shown::of(&original, &converted, &proof.undefined_at);
    if shown.differing > 0 {
        return Standing::Unproved(format!(
            "in Chromium {} of {} pixels {} not as with WebGL 2 of the original, by up to {:.1}/255",
            grouped(shown.differing),
            grouped(shown.pixels),
            plural(shown.differing, "is", "are"),
            shown.max * 255.0
        ));
    }
    let name = browser.name().unwrap_or("Chromium").to_owned();
    readers.browser = Some((name, shown));
    Standing::Proved(proof, readers)
}

/// Why nothing that is written of a shader can be proved, if that is so.
fn incomparable(proof: &Proof, files: &Files) -> Option<String> {
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

/// The proof if it holds, or why it does not.
fn held(proof: Proof) -> Result<Proof, String> {
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

/// GLSL that was written, read again by our own front end.
fn reread_glsl(bytes: &[u8]) -> Result<Written, String> {
    let mut files = Files::default();
    let text = reread::as_shadertoy(&String::from_utf8_lossy(bytes));
    let file = files.add(File::new("written", &text));
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(|errors| {
        let first = errors.first().map(|error| short(error, &files));
        format!("our own front end refuses it: {}", first.unwrap_or_default())
    })?;
    Ok(Written::Lowered(FloatMode::Fast.lower(&checked)))
}
