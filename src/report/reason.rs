//! The reason of a verdict in words: one short sentence, and the details below it.

use toyproof_diagnostic::{Diagnostic, Files, Severity, grouped, plural, printable};
use toyproof_eval as eval;
use toyproof_explain::Findings;
use toyproof_explain::project::PassDeparture;
use toyproof_player::{DriverFailure, Target};
use toyproof_scene::Sampler;
use toyproof_verify::Difference;
use toyproof_verify::compare::Region;
use toyproof_verify::{Failure, MAX_DIFFERING, MAX_UNSTABLE, Means, Reason, ReferenceKind, Share, Verdict};

use super::Mistake;
use super::share::{count_with_verb, imprecision, percentage, pixels};

/// The reason of a verdict.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Statement {
    /// One short sentence.
    pub reason: String,
    /// Further sentences, the most important first.
    pub details: Vec<String>,
}

impl Statement {
    fn new(reason: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
            details: Vec::new(),
        }
    }

    fn detail(self, detail: impl Into<String>) -> Self {
        self.details([detail.into()])
    }

    fn details(mut self, details: impl IntoIterator<Item = String>) -> Self {
        self.details.extend(details);
        self
    }
}

/// States why a verdict was reached, and what the images show in addition. `files` are those of the shader.
#[must_use]
pub fn state(findings: &Findings, files: &Files) -> Statement {
    let mut statement = state_reason(&findings.reason, files);
    if let (Reason::NoReference, Some(imprecise)) = (&findings.reason, imprecise(findings)) {
        statement.reason = format!(
            "the shader renders, but {}; there is no reference",
            imprecision(imprecise)
        );
    }
    if let Some(PassDeparture { pass, frame }) = findings.pass_departure {
        let pass = match pass {
            Target::Buffer(_) => pass.to_string(),
            Target::Image => "the image".to_owned(),
        };
        let departs = format!("{pass} departs from the reference in frame {frame}");
        statement.details.insert(0, departs);
    }
    if let Some(mistake) = &findings.tolerated_mistake {
        statement.details.push(format!(
            "a known mistake explains these pixels: {}",
            Mistake::new(mistake, files).text
        ));
    }
    let is_repaired = findings
        .search
        .as_ref()
        .is_some_and(|search| !search.repairs.is_empty());
    let is_explained = findings.mistake.is_some() || is_repaired;
    if let (Verdict::Wrong, false, Some(color)) = (
        findings.verdict,
        is_explained,
        findings.results.actual.only_color(),
    ) {
        statement.details.push(match color {
            [0, 0, 0] => "every pixel is black".to_owned(),
            [r, g, b] => format!("every pixel has the same color, ({r}, {g}, {b}) of 255"),
        });
    }
    if let (Reason::AlgorithmDiffers { differing, .. }, false) = (&findings.reason, is_explained)
        && differing.count == differing.of
        && findings.results.actual.only_color().is_none()
    {
        statement
            .details
            .push("no pixel agrees: is this the right reference?".to_owned());
    }
    if findings.results.reference_kind == Some(ReferenceKind::Image) {
        statement.details.push(
            "only the image was compared: it does not show where rounding decides the reference's colors"
                .to_owned(),
        );
    }
    if let (Verdict::Unstable, Some(cause)) = (findings.verdict, findings.cause) {
        let at = files.position(cause);
        statement.details.push(format!(
            "most precision is lost at line {}, column {}: {}",
            at.line,
            at.column,
            excerpt(files.text(cause))
        ));
    }
    statement
}

/// The visible difference of float32 from double precision, if it is large enough for a warning.
fn imprecise(findings: &Findings) -> Option<Share> {
    let share = Share::differing(&findings.results.precision.as_ref()?.summary);
    (share.ratio() > MAX_UNSTABLE).then_some(share)
}

/// The longest quoted piece of source text, in characters.
const MAX_EXCERPT: usize = 60;

/// A piece of source text on one line, shortened, in backticks.
pub(super) fn excerpt(text: &str) -> String {
    let words: Vec<_> = text.split_whitespace().collect();
    let text = words.join(" ");
    let shown: String = text.chars().take(MAX_EXCERPT).collect();
    let rest = if shown.len() < text.len() { " …" } else { "" };
    format!("`{}`{rest}", printable(&shown))
}

/// States the reason alone.
pub(super) fn state_reason(reason: &Reason, files: &Files) -> Statement {
    match reason {
        Reason::NoImage(failure) => {
            Statement::new(without_image(failure, files)).details(loop_text(failure, files))
        }
        Reason::NotEvaluated { failure, .. } => Statement::new(format!(
            "the shader renders, but cannot be evaluated on the CPU: {failure}"
        ))
        .detail("the algorithm and precision checks need the CPU evaluator"),
        Reason::ToolchainDiffers(differing) => Statement::new(format!(
            "{} {} between the GPU and the same float32 arithmetic on the CPU {}",
            pixels(*differing),
            plural(differing.count, "differs", "differ"),
            percentage(*differing)
        ))
        .detail("naga, the driver or toyproof is at fault, not the shader"),
        Reason::NoReference => Statement::new("the shader renders; there is no reference to compare it with"),
        Reason::AlgorithmDiffers {
            differing: share,
            regions,
        } => {
            let region = regions.largest_compact.filter(|_| share.ratio() <= MAX_DIFFERING);
            Statement::new(differing(*share)).details(region.map(compact_region))
        }
        Reason::SelfIntersection(cause) => {
            let share = cause.pixels;
            let sentence = format!(
                "{} {} on rounding errors {}",
                pixels(share),
                plural(share.count, "depends", "depend"),
                percentage(share)
            );
            Statement::new(if cause.in_double {
                sentence
            } else {
                format!("the shader is correct in double precision, but in float32 {sentence}")
            })
        }
        Reason::Undefined(share) => Statement::new(format!(
            "{} {} on undefined behavior {}",
            pixels(*share),
            plural(share.count, "depends", "depend"),
            percentage(*share)
        ))
        .detail("these pixels cannot be compared, and the others are too few for a verdict"),
        Reason::ReferenceIllConditioned(share) => Statement::new(format!(
            "{} {} ill-conditioned in the reference {}",
            pixels(*share),
            plural(share.count, "is", "are"),
            percentage(*share)
        ))
        .detail("a change of 1 ULP changes the reference's own color there, so nothing can be compared"),
        Reason::IllConditioned(share) => Statement::new(format!(
            "{} {} ill-conditioned {}",
            pixels(*share),
            plural(share.count, "is", "are"),
            percentage(*share)
        ))
        .detail("a change of 1 ULP changes their color, even in double precision"),
        Reason::Imprecise(share) => Statement::new(format!(
            "the shader is correct in double precision, but {} {} in float32 {}",
            pixels(*share),
            plural(share.count, "differs", "differ"),
            percentage(*share)
        )),
        Reason::Growth(growth) => Statement::new(growth.sentence()).details(growth.consequences()),
        &Reason::Agrees {
            differing,
            ill_conditioned,
            undefined,
            undefined_region,
            tied,
            imprecise,
        } => agrees(
            differing,
            [ill_conditioned, undefined],
            undefined_region,
            tied,
            imprecise,
        ),
        Reason::Permitted {
            difference,
            text,
            differing,
        } => permitted(*difference, text, *differing),
        &Reason::OtherRandomNumbers {
            differing,
            sampler,
            means,
        } => by_means(differing, sampler, means),
    }
}

fn agrees(
    differing: Share,
    [ill_conditioned, undefined]: [u64; 2],
    undefined_region: Option<Region>,
    tied: u64,
    imprecise: Option<Share>,
) -> Statement {
    let Share { count, of } = differing;
    let reason = match (count, ill_conditioned + undefined) {
        (0, 0) => format!("all {} pixels agree with the reference", grouped(of)),
        (0, excluded) => {
            let others = match (ill_conditioned, undefined) {
                (_, 0) => "are ill-conditioned",
                (0, _) => "depend on undefined behavior",
                _ => "are ill-conditioned or depend on undefined behavior",
            };
            format!(
                "{} of {} pixels agree with the reference; the others {others}",
                grouped(of.saturating_sub(excluded)),
                grouped(of)
            )
        }
        _ => format!(
            "{} from the reference, within the tolerance of {} %",
            count_with_verb(differing, ["differs", "differ"]),
            100.0 * MAX_DIFFERING
        ),
    };
    let left_out = undefined_region.map_or_else(String::new, |region| {
        let [x, y] = region.middle();
        format!(
            "; an area of {} pixels around ({x}, {y}) was left out, since it depends on undefined behavior",
            grouped(region.pixels)
        )
    });
    let precision = imprecise.map_or_else(String::new, |imprecise| {
        format!("; {}, and so does the reference", imprecision(imprecise))
    });
    let mut statement = Statement::new(reason + &left_out + &precision);
    let pixels = |count| format!("in {} {}", grouped(count), plural(count, "pixel", "pixels"));
    if tied > 0 {
        statement = statement.detail(format!(
            "{}, rounding decides the color of the reference itself, as where an edge passes exactly through the \
             sample point",
            pixels(tied)
        ));
    }
    statement
}

fn permitted(difference: Difference, text: &str, differing: Share) -> Statement {
    let others = match differing.count {
        0 => String::new(),
        _ => format!("; besides, {}", count_with_verb(differing, ["differs", "differ"])),
    };
    Statement::new(format!(
        "agrees with the reference but for `{difference}`, which is permitted{others}"
    ))
    .detail(text)
}

/// The largest number of standard deviations that is stated: a larger number has no additional meaning.
const MAX_DEVIATIONS: f64 = 100.0;

fn by_means(pixels: Share, sampler: Option<Sampler>, means: Means) -> Statement {
    let whose = sampler.map_or("reference", |_| "scene's sampler");
    let own_name = sampler.map_or_else(String::new, |sampler| format!(", `{}`", sampler.name()));
    let own_numbers = format!(
        "{}: the shader's random numbers, or what it computes from them, are not those of the {whose}{own_name}",
        count_with_verb(pixels, ["differs", "differ"]),
    );
    let other_numbers = format!("{own_numbers}; means were compared instead");
    let noise = |variance: f64| format!("its noise has {variance:.1} times the variance of the {whose}");
    let source = sampler.map_or("the reference's random numbers", |_| "the scene's sampler");
    match means {
        Means::Different {
            at: [x, y],
            deviations,
        } => {
            let much = match deviations {
                None => String::new(),
                Some(deviations) if deviations > MAX_DEVIATIONS && deviations.is_finite() => {
                    format!(", by more than {MAX_DEVIATIONS} standard deviations")
                }
                Some(deviations) if deviations.is_finite() => {
                    format!(", by {deviations:.0} standard deviations")
                }
                Some(_) => ", and the shader is not random there".to_owned(),
            };
            Statement::new(format!(
                "the mean color differs from the reference, most strongly around pixel ({x}, {y}){much}"
            ))
            .detail(other_numbers)
        }
        Means::FewerSamples { own, scene, variance } => Statement::new(format!(
            "the mean is right, but the shader takes {own} {} per pixel instead of {scene}",
            plural(u64::from(own), "sample", "samples")
        ))
        .detail(noise(variance))
        .detail(other_numbers),
        Means::Correlated => Statement::new(
            "the random numbers of neighboring pixels are correlated, so means cannot be compared",
        )
        .detail(format!(
            "seed the random numbers of each pixel from its coordinates, or use {source}"
        ))
        .detail(other_numbers),
        Means::TooNoisy { variance } => {
            Statement::new("the image is too noisy to compare means with the reference")
                .detail(noise(variance))
                .detail("sample the lights directly, or take more samples per pixel")
                .detail(other_numbers)
        }
        Means::UnknownNoise => Statement::new(
            "the shader is stochastic, and means cannot be compared with the reference",
        )
        .detail(
            "the noise of one of the two is not known: its random numbers cannot be changed, or neighboring \
                     pixels share them",
        )
        .detail(own_numbers),
        Means::Underpowered => {
            Statement::new("there are too few samples or pixels to compare means with the reference")
                .detail(format!("check a larger image, or use {source}"))
                .detail(other_numbers)
        }
        Means::Same {
            within,
            pixels,
            replicates,
            variance,
        } => {
            let sets = replicates.map_or_else(String::new, |sets| {
                format!(", with {sets} sets of random numbers")
            });
            let mut statement = Statement::new(format!(
                "the mean of {} pixels agrees with the reference to within {within:.4}",
                grouped(pixels)
            ))
            .detail(other_numbers + &sets);
            statement.details.extend(variance.map(noise));
            statement
        }
    }
}

fn without_image(failure: &Failure, files: &Files) -> String {
    match failure {
        Failure::Invalid(_)
        | Failure::InvalidScene(_)
        | Failure::Overdue(_)
        | Failure::Gpu(DriverFailure::Invalid(_) | DriverFailure::Refused(_)) => {
            first_error(&failure.diagnostics(), files)
        }
        Failure::LoopTruncated(pixels) => loop_truncated(*pixels),
        Failure::Cpu(failure) => format!("{failure}{}", failure_position(failure, files)),
        Failure::Missing(_)
        | Failure::Unreadable(_)
        | Failure::Unrendered(_)
        | Failure::Reference(_)
        | Failure::Spool(_)
        | Failure::Gpu(_)
        | Failure::Panic(_) => failure.to_string(),
    }
}

/// The loop in which the evaluator stopped: the rest of the line on which it begins.
fn loop_text(failure: &Failure, files: &Files) -> Option<String> {
    let Failure::Cpu(eval::Failure::TooOften { at, .. } | eval::Failure::Timeout { at }) = failure else {
        return None;
    };
    let span = files.origin(at.span);
    let text = files.get(span.file).text().get(span.start as usize..)?;
    let line = text.lines().next()?;
    Some(format!(
        "the loop does not end, or takes too long: {}",
        excerpt(line)
    ))
}

/// The only error with its position, or the number of errors.
fn first_error(diagnostics: &[Diagnostic], files: &Files) -> String {
    let errors = diagnostics.iter().filter(|one| one.severity == Severity::Error);
    let errors: Vec<_> = errors.collect();
    match errors[..] {
        [] => "the shader does not compile".to_owned(),
        [only] => match only.span {
            Some(span) => {
                let at = files.position(span);
                // The file of a project is a tab.
                let tab = if files.is_several() {
                    format!("{}, ", files.name(span).rsplit('/').next().unwrap_or_default())
                } else {
                    String::new()
                };
                format!("{} ({tab}line {}, column {})", only.message, at.line, at.column)
            }
            None => only.message.clone(),
        },
        _ => format!("{} errors", grouped(errors.len() as u64)),
    }
}

/// The message on a shader whose loops the driver truncated in `pixels` pixels.
#[must_use]
pub fn loop_truncated(pixels: u64) -> String {
    format!(
        "the driver stopped a loop in {} {}: the loop does not end, or exceeds the limit of Mesa before 23, \
         65,535 iterations",
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

/// Why few differing pixels are a mistake.
fn compact_region(region: Region) -> String {
    let [x, y] = region.middle();
    format!(
        "{} of them form a region around ({x}, {y}), as a small object does: that many single pixels would be \
         tolerated",
        grouped(region.pixels)
    )
}

/// States how many pixels differ from the reference.
fn differing(share: Share) -> String {
    if share.count == share.of {
        format!("all {} pixels differ from the reference", grouped(share.of))
    } else {
        format!(
            "{} from the reference {}",
            count_with_verb(share, ["differs", "differ"]),
            percentage(share)
        )
    }
}
