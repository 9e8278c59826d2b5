//! The sentence that states the reason of a verdict.

use toyproof_diagnostic::{Diagnostic, Files, Severity, grouped, plural};
use toyproof_eval as eval;
use toyproof_gpu as gpu;
use toyproof_scene::Sampler;
use toyproof_verify::{Failure, Findings, MAX_DIFFERING, Means, Reason, Share, Verdict};

use super::Mistake;

/// Formats why a verdict was reached, in one sentence, with what explains it: the mistake, the line that loses
/// precision. `files` are those of the shader.
#[must_use]
pub fn reason(findings: &Findings, files: &Files) -> String {
    let mut sentence = phrase(&findings.reason, files);
    let mut add = |part: String| {
        sentence.push_str("; ");
        sentence.push_str(&part);
    };
    if let Some(mistake) = &findings.tolerated_mistake {
        add(Mistake::new(mistake).says);
    }
    if let (Verdict::Wrong, None, Some(color)) =
        (findings.verdict, &findings.mistake, findings.actual.only_color())
    {
        add(match color {
            [0, 0, 0] => "every pixel is black".to_owned(),
            [r, g, b] => format!("every pixel has one colour, ({r}, {g}, {b}) of 255"),
        });
    }
    if let (Verdict::Unstable, Some(cause)) = (findings.verdict, findings.cause) {
        let at = files.position(cause);
        add(format!("it is lost in line {}, column {}", at.line, at.column));
    }
    if let Some(mistake) = findings.mistake.as_ref().map(Mistake::new) {
        add(mistake.says);
    }
    sentence
}

/// Formats the reason alone.
pub(super) fn phrase(reason: &Reason, files: &Files) -> String {
    match reason {
        Reason::NoImage(failure) => without_image(failure, files),
        Reason::NotEvaluated {
            failure,
            has_reference: true,
        } => format!("the shader could not be evaluated on the CPU: {failure}"),
        Reason::NotEvaluated { failure, .. } => {
            format!("the shader paints; it could not be evaluated on the CPU: {failure}")
        }
        Reason::ToolchainDiffers(differing) => format!(
            "{} {} not what the shader says: naga, the driver or toyproof broke it, and it is not the shader's fault",
            pixels(*differing),
            plural(differing.count, "is", "are")
        ),
        Reason::NoReference => "the shader paints; there is no scene to compare it with".to_owned(),
        Reason::AlgorithmDiffers(pixels) => format!("{}: it is the mathematics", differing(*pixels)),
        Reason::SelfIntersection(Share { count, of }) => format!(
            "in {} of {} pixels rounding decides whether a ray meets the surface that it starts from",
            grouped(*count),
            grouped(*of)
        ),
        Reason::Undefined(undefined) => format!(
            "in {} the shader does what GLSL leaves undefined, so that cannot be compared",
            pixels(*undefined)
        ),
        Reason::IllConditioned(ill_conditioned) => format!(
            "the mathematics may be right, but {} {} by a hair even in double precision: a rounding error decides",
            pixels(*ill_conditioned),
            plural(ill_conditioned.count, "hangs", "hang")
        ),
        Reason::Imprecise(imprecise) => format!(
            "the mathematics is right, but float32 is not enough for it here: {} {} visibly another colour than in \
             double precision",
            pixels(*imprecise),
            plural(imprecise.count, "is", "are")
        ),
        &Reason::Agrees {
            differing,
            excluded,
            tied,
        } => agrees(differing, excluded) + &at_edges(tied),
        &Reason::OtherRandomNumbers {
            differing,
            sampler,
            means,
        } => by_means(differing, sampler, means),
    }
}

fn agrees(differing: Share, excluded: u64) -> String {
    let Share { count, of } = differing;
    match (count, excluded) {
        (0, 0) => format!("all {} pixels agree with the scene", grouped(of)),
        (0, excluded) => format!(
            "all pixels agree with the scene but {} that cannot be decided",
            grouped(excluded)
        ),
        _ => format!(
            "{} of {} pixels {} from the scene, fewer than the {} that are allowed",
            grouped(count),
            grouped(of),
            plural(count, "differs", "differ"),
            grouped((of as f64 * MAX_DIFFERING) as u64 + 1)
        ),
    }
}

fn at_edges(tied: u64) -> String {
    match tied {
        0 => String::new(),
        tied => format!(
            "; in {} an edge of the scene itself passes through the pixel's sample",
            grouped(tied)
        ),
    }
}

fn by_means(pixels: Share, sampler: Sampler, means: Means) -> String {
    let differs = format!(
        "{}, only where the samples' random numbers decide: it draws others than the scene, whose sampler is `{}`",
        differing(pixels),
        sampler.name()
    );
    match means {
        Means::Different {
            at: [x, y],
            deviations,
        } => {
            let much = match deviations {
                None => String::new(),
                Some(deviations) if deviations.is_finite() => {
                    format!(", by {deviations:.0} standard deviations")
                }
                Some(_) => ", and nothing random is left to explain it".to_owned(),
            };
            format!("{differs}; but there its mean is another too, most of all around ({x}, {y}){much}")
        }
        Means::FewerSamples { own, scene, variance } => format!(
            "{differs}; the mean is the same, but it takes fewer samples, {own} where the scene has {scene}: its noise \
             has {variance:.1} times the variance"
        ),
        Means::Correlated => format!(
            "random: {differs}, and what they do in neighbouring pixels has much in common, so that means cannot be \
             compared. Draw as docs/scenes.md tells, or start each pixel's numbers from its place"
        ),
        Means::TooNoisy { variance } => format!(
            "random: {differs}, and its noise has {variance:.0} times the variance of the scene's own sampler: too much \
             to compare means, as where directions seldom meet a light. Sample the lights as well, or take more samples"
        ),
        Means::Underpowered => format!(
            "random: {differs}, and samples or pixels are too few to compare means. Draw as docs/scenes.md tells, give \
             the scene the sampler that draws as the shader does, or ask for a larger picture"
        ),
        Means::Same {
            within,
            pixels,
            replicates,
            variance,
        } => {
            let sets = replicates.map_or_else(String::new, |sets| {
                format!(", with {sets} sets of random numbers")
            });
            let noise = variance.map_or_else(String::new, |variance| {
                format!("; its noise has {variance:.1} times the variance of the scene's own sampler")
            });
            format!(
                "the same in the mean, to within {within:.4} over {} pixels{sets}; {differs}{noise}",
                grouped(pixels)
            )
        }
    }
}

fn without_image(failure: &Failure, files: &Files) -> String {
    match failure {
        Failure::Invalid(_)
        | Failure::InvalidScene(_)
        | Failure::Overdue(_)
        | Failure::Gpu(gpu::Failure::Invalid(_) | gpu::Failure::Refused(_)) => {
            first_error(&failure.diagnostics(), files)
        }
        Failure::LoopTruncated(pixels) => loop_truncated(*pixels),
        Failure::Cpu(failure) => format!("{failure}{}", failure_position(failure, files)),
        Failure::Unreadable(_) | Failure::Gpu(_) | Failure::Panic(_) => failure.to_string(),
    }
}

/// The first error, and its position.
fn first_error(diagnostics: &[Diagnostic], files: &Files) -> String {
    let error = diagnostics.iter().find(|one| one.severity == Severity::Error);
    error.map_or_else(
        || "it does not compile".to_owned(),
        |first| match first.span.map(|span| files.position(span)) {
            Some(at) => format!("{} (line {}, column {})", first.message, at.line, at.column),
            None => first.message.clone(),
        },
    )
}

/// The message on a shader of which the driver truncated the loops of `pixels` pixels.
#[must_use]
pub fn loop_truncated(pixels: u64) -> String {
    format!(
        "a loop never ends, or runs longer than this driver allows: it was ended by force in {} {} \
         (Mesa before 23 stops at 65,535 iterations)",
        grouped(pixels),
        plural(pixels, "pixel", "pixels")
    )
}

/// The position where the evaluator stopped, as a suffix of its message.
#[must_use]
pub fn failure_position(failure: &eval::Failure, files: &Files) -> String {
    match failure {
        eval::Failure::TooOften { at, .. } | eval::Failure::Timeout { at } => {
            let at = files.position(at.span);
            format!(" (line {}, column {})", at.line, at.column)
        }
        _ => String::new(),
    }
}

/// Formats how many pixels differ from the scene.
fn differing(share: Share) -> String {
    format!(
        "{} {} from the scene even in exact arithmetic",
        pixels(share),
        plural(share.count, "differs", "differ")
    )
}

fn pixels(share: Share) -> String {
    format!(
        "{} of {} pixels ({:.2} %)",
        grouped(share.count),
        grouped(share.of),
        100.0 * share.ratio()
    )
}
