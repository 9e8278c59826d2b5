//! Confirms hypotheses on whole images: the edited text is checked as if its author had written it, in the
//! frame of the check and in a second one; and an image that a hypothesis predicts is compared by the rules
//! of the algorithm check.

use std::sync::OnceLock;
use std::time::Instant;

use toyproof_diagnostic::{Deadline, Edit, File, Files, Fix, Span};
use toyproof_eval::{Fault, Places};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::{Frame, Image, Rgb8Image};
use toyproof_lint::Lints;
use toyproof_verify::bounds::MIN_IMAGE_ITERATIONS;
use toyproof_verify::compare::{self, CheckSummary, EpsilonSearch, PixelStatus, Undefined};
use toyproof_verify::{
    BandReference, Case, CheckEvidence, CheckResult, CheckResults, Checks, Expected, NumberType, Ruling,
    Subject, Verdict, decide, verify_within,
};

/// The second frame: another size and shape of the image, and another time if the scene moves.
const OTHER_SIZE: [u32; 2] = [132, 100];
const OTHER_TIME: f32 = 1.3;

/// The largest number of samples of its image, all pixels together.
const MAX_SAMPLES: u32 = 1 << 19;

/// The largest share of the wrong pixels that may differ under a hypothesis. An explanation that leaves more
/// is an accident where few pixels are wrong at all.
const MAX_UNEXPLAINED_SHARE: f64 = 0.05;

/// Confirms what may explain the image of one shader.
pub(crate) struct Confirmer<'a> {
    pub(crate) case: &'a Case<'a>,
    pub(crate) expected: &'a Expected,
    /// The algorithm check of the shader itself.
    pub(crate) before: &'a CheckResult,
    /// The faults that were observed, each at one place.
    faults: &'a [Fault],
    checks: &'a Checks,
    pub(crate) deadline: Instant,
    /// The number of variables that the shader reads without a value.
    unset: OnceLock<usize>,
    /// The second frame and its reference; `None` if it cannot be rendered there.
    other: OnceLock<Option<(Frame, Expected)>>,
}

/// The image of an edited shader that is right.
#[derive(Debug)]
pub struct Confirmation {
    /// The number of pixels that agree with the reference.
    pub agreeing: u64,
    /// The number of pixels that were compared.
    pub pixels: u64,
    /// Whether their means agree, because the shader has its own random numbers.
    pub by_means: bool,
    /// The image, as displayed.
    pub image: Rgb8Image,
}

impl<'a> Confirmer<'a> {
    /// `None` without a reference.
    pub(crate) fn new(subject: Subject<'a>, checks: &'a Checks, deadline: Instant) -> Option<Self> {
        Some(Self {
            case: subject.case,
            expected: subject.case.expected?,
            before: subject.results.algorithm.as_ref()?,
            faults: &subject.results.faults,
            checks,
            deadline,
            unset: OnceLock::new(),
            other: OnceLock::new(),
        })
    }

    // Edited texts.

    /// The shader with another text, if it is valid.
    pub(crate) fn checked(&self, text: &str, options: &glsl::Options) -> Option<Checked> {
        let mut files = Files::default();
        let file = files.add(File::new("<repair>", text));
        let options = glsl::Options {
            channels: self.case.checked.channels.map(Some),
            deadline: Deadline::after(self.deadline.saturating_duration_since(Instant::now())),
            ..options.clone()
        };
        glsl::check(&files, file, &options).ok()
    }

    /// Confirms an edited shader if it is right in both frames, and no pixel depends on undefined behavior
    /// that did not before. `iterations` bounds the loop iterations of most of its pixels.
    pub(crate) fn edited(&self, checked: &Checked, iterations: u32) -> Option<Confirmation> {
        let confirmation = self.edited_in_frame(checked, iterations)?;
        // Means are compared over many sets of random numbers; a second frame would add little evidence.
        if !confirmation.by_means {
            let iterations = iterations.max(MIN_IMAGE_ITERATIONS);
            let (frame, expected) = self.other.get_or_init(|| self.other_frame()).as_ref()?;
            let (results, _) = self.right(checked, frame, expected, iterations)?;
            if self.adds_fault(&results.faults, false) {
                return None;
            }
        }
        Some(confirmation)
    }

    /// Confirms an edited shader in the frame of the check alone.
    pub(crate) fn edited_in_frame(&self, checked: &Checked, iterations: u32) -> Option<Confirmation> {
        let iterations = iterations.max(MIN_IMAGE_ITERATIONS);
        let unset = self.unset.get_or_init(|| unset_variables(self.case.checked));
        if unset_variables(checked) > *unset {
            return None;
        }
        let (results, ruling) = self.right(checked, self.case.frame, self.expected, iterations)?;
        let summary = &results.algorithm.as_ref()?.summary;
        if self.adds_fault(&results.faults, summary.undefined > self.before.summary.undefined) {
            return None;
        }
        let by_means = ruling.reason.compares_means();
        let differing = if by_means { 0 } else { summary.differing };
        Some(Confirmation {
            agreeing: summary.pixels - differing,
            pixels: summary.pixels,
            by_means,
            image: results.actual,
        })
    }

    /// The results of the checks in a frame, if nothing speaks against the algorithm there.
    fn right(
        &self,
        checked: &Checked,
        frame: &Frame,
        expected: &Expected,
        max_iterations: u32,
    ) -> Option<(CheckResults, Ruling)> {
        let lints = &Lints::default();
        let case = Case {
            checked,
            lints,
            expected: Some(expected),
            frame,
            ..*self.case
        };
        let verified = verify_within(&case, max_iterations, self.deadline).ok()?;
        let ruling = verified.ruling();
        // There is no precision check where double precision could not be evaluated.
        (is_right(ruling.verdict) && verified.results.precision.is_some())
            .then_some((verified.results, ruling))
    }

    /// Whether the edited shader has more faults of a kind than the shader: reads of elements that do not
    /// exist or of variables without a value, which are no repair, or other undefined operations on which
    /// colors depend.
    fn adds_fault(&self, faults: &[Fault], excludes_more: bool) -> bool {
        let count = |faults: &[Fault], fault: Fault| faults.iter().filter(|&&other| other == fault).count();
        faults.iter().any(|&fault| {
            let is_serious = match fault {
                Fault::IndexOutOfBounds | Fault::NeverWritten => true,
                // At an edge of any shader that takes derivatives.
                Fault::NonUniformDerivative => false,
                _ => excludes_more && fault.is_undefined(),
            };
            is_serious && count(faults, fault) > count(self.faults, fault)
        })
    }

    fn other_frame(&self) -> Option<(Frame, Expected)> {
        let mut frame = self.case.frame.clone();
        frame.size = OTHER_SIZE;
        while frame.size[0] * frame.size[1] * self.expected.samples() > MAX_SAMPLES && frame.size[1] > 16 {
            frame.size = frame.size.map(|side| side * 3 / 4);
        }
        if self.expected.is_animated() {
            frame.time += OTHER_TIME;
        }
        let expected = self.expected.in_frame(&frame)?;
        Some((frame, expected))
    }

    // Predicted images.

    /// Compares all pixels of an image, rendered at their places, with the expected image of a frame. Returns
    /// the algorithm check, if the shader is right with it.
    pub(crate) fn rendered(
        &self,
        expected: &Expected,
        frame: &Frame,
        render: impl Fn(&Places) -> Option<Image>,
    ) -> Option<CheckSummary> {
        let [width, height] = frame.size;
        let mut mixed = EpsilonSearch::new(u64::from(width) * u64::from(height));
        let mut check = CheckResult::default();
        for rows in frame.bands() {
            let band = expected.rows(&rows).ok()?;
            let mut places = Places::spread(frame.size, frame.size);
            places.rows = places.rows[rows.start as usize..rows.end as usize].to_vec();
            let actual = render(&places)?;
            let undefined = Undefined {
                pixels: &vec![false; actual.pixels().len()],
                substituted: Some(&[]),
                in_reference: &band.undefined,
            };
            let derives = self.case.checked.takes_derivatives();
            let reference = BandReference {
                expected,
                rows: &rows,
                number_type: NumberType::Double,
                derives,
            };
            let statuses = compare::algorithm(
                &band.image,
                &actual,
                &undefined,
                &reference,
                &mut mixed,
                |_, _| None,
            );
            check.extend(&band.image, &actual, &statuses, rows.start);
        }
        self.accepted(check.with_regions(width))
    }

    /// Compares the shader's image with another one, which a hypothesis expects; `agrees` decides for each
    /// pixel that is defined. Returns the algorithm check, if the shader is right with it.
    pub(crate) fn predicted(
        &self,
        other: &Image,
        actual: &Image,
        agrees: impl Fn(usize) -> bool,
    ) -> Option<CheckSummary> {
        let statuses = self
            .before
            .statuses
            .iter()
            .enumerate()
            .map(|(at, &status)| match status {
                PixelStatus::Undefined => PixelStatus::Undefined,
                _ if agrees(at) => PixelStatus::Agrees,
                PixelStatus::Agrees => PixelStatus::Differs,
                status => status,
            });
        let statuses: Vec<_> = statuses.collect();
        let mut check = CheckResult::default();
        check.extend(other, actual, &statuses, 0);
        self.accepted(check.with_regions(self.case.frame.size[0]))
    }

    /// Accepts a check with which the shader is not wrong, and almost no wrong pixel is left.
    fn accepted(&self, check: CheckResult) -> Option<CheckSummary> {
        let algorithm = check.summary;
        let checks = Checks {
            algorithm: Some(algorithm.clone()),
            ..self.checks.clone()
        };
        let evidence = CheckEvidence {
            checks,
            ..CheckEvidence::default()
        };
        let most = MAX_UNEXPLAINED_SHARE * self.before.summary.differing as f64;
        (is_right(decide(evidence).verdict) && algorithm.differing as f64 <= most).then_some(algorithm)
    }
}

/// The number of variables that a shader may read without a value; an edit that adds one is no repair.
pub(crate) fn unset_variables(checked: &Checked) -> usize {
    toyproof_lint::uninitialized_reads(checked, &Deadline::default())
}

/// Whether nothing speaks against the algorithm.
fn is_right(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Correct | Verdict::Unstable)
}

/// The text after all edits, which are sorted and do not overlap; `None` if they do.
pub(crate) fn apply(source: &str, fix: &Fix) -> Option<String> {
    let mut text = String::with_capacity(source.len() + 64);
    let mut end = 0;
    for edit in &fix.edits {
        text.push_str(source.get(end..edit.span.start as usize)?);
        text.push_str(&edit.replacement);
        end = edit.span.end as usize;
    }
    text.push_str(source.get(end..)?);
    Some(text)
}

/// The edits of a text, and those of the text that they result in, as edits of the first; `None` if they
/// overlap.
pub(crate) fn compose(first: &Fix, second: &Fix) -> Option<Fix> {
    let mut edits = first.edits.clone();
    for edit in &second.edits {
        // How much longer the first edits in front of this one, and inside of it, make the text.
        let (mut shift, mut inside) = (0_i64, 0_i64);
        let [mut start, mut end] = [edit.span.start, edit.span.end].map(i64::from);
        for before in &first.edits {
            let from = i64::from(before.span.start) + shift + inside;
            let to = from + before.replacement.len() as i64;
            let growth = before.replacement.len() as i64 - i64::from(before.span.end - before.span.start);
            if start >= to {
                shift += growth;
            } else if start <= from && to <= end {
                // The second edit's text contains the text of the first one.
                inside += growth;
                edits.retain(|own| own.span != before.span);
            } else if end > from {
                return None;
            }
        }
        start -= shift;
        end -= shift + inside;
        let [start, end] = [start, end].map(u32::try_from);
        edits.push(Edit {
            span: Span::new(first.edits.first()?.span.file, start.ok()?, end.ok()?),
            replacement: edit.replacement.clone(),
        });
    }
    edits.sort_by_key(|edit| edit.span.start);
    let overlap = edits.windows(2).any(|pair| pair[0].span.end > pair[1].span.start);
    (!overlap).then(|| Fix {
        message: format!("{}, and {}", first.message, second.message),
        edits,
    })
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use toyproof_verify::{DEFAULT_TOLERANCE, ShaderReference, verify};

    use super::*;

    fn fix(edits: &[(u32, u32, &str)]) -> Fix {
        let file = Files::default().add(File::new("a", ""));
        let edits = edits.iter().map(|&(start, end, replacement)| Edit {
            span: Span::new(file, start, end),
            replacement: replacement.to_owned(),
        });
        Fix {
            message: "edit".to_owned(),
            edits: edits.collect(),
        }
    }

    /// Whether replacing `old` by `new` in a shader repairs it, compared with a reference shader.
    fn is_confirmed(shader: &str, reference: &str, old: &str, new: &str) -> bool {
        let checked = |text: &str| {
            let mut files = Files::default();
            let file = files.add(File::new("s", text));
            glsl::check(&files, file, &glsl::Options::default()).unwrap()
        };
        let frame = Frame {
            size: [24, 16],
            ..Frame::default()
        };
        let lints = Lints::default();
        let timeout = Duration::from_secs(60);
        let reference = ShaderReference::new(&checked(reference), &lints, &frame, DEFAULT_TOLERANCE, timeout);
        let expected = Expected::Shader(Box::new(reference.unwrap().0));
        let checked = checked(shader);
        let case = Case::new(&checked, &lints, &frame)
            .with_expected(&expected)
            .with_timeout(timeout);
        let before = verify(None, &case).unwrap();
        assert_eq!(before.ruling().verdict, Verdict::Wrong);
        let checks = before.results.checks();
        let deadline = Instant::now() + timeout;
        let confirmer = Confirmer::new(before.subject().unwrap(), &checks, deadline).unwrap();
        let start = shader.find(old).unwrap() as u32;
        let file = checked.tree[checked.main_image].at.span.file;
        let fix = Fix::new("edit", Span::new(file, start, start + old.len() as u32), new);
        let edited = confirmer
            .checked(&apply(shader, &fix).unwrap(), &glsl::Options::default())
            .unwrap();
        confirmer.edited(&edited, 0).is_some()
    }

    #[test]
    fn an_edit_that_reads_nothing_defined_is_no_repair() {
        let with = |index: &str| {
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{
                    float unset;
                    float all[3] = float[](0.2, 0.5, 0.8);
                    int at = p.x < 12.0 ? {index} : 0;
                    float zero = 0.6;
                    c = vec4(all[at], zero - 0.6, 0.0, 1.0);
                }}"
            )
        };
        let (wrong, right) = (with("1"), with("2"));
        let repairs = |new| is_confirmed(&wrong, &right, "? 1", new);
        assert!(repairs("? 2"));
        // The last element is used, as on the GPU.
        assert!(!repairs("? 7"));
        let wrong = right.replace("zero - 0.6", "zero");
        let repairs = |new| is_confirmed(&wrong, &right, "zero, 0.0", new);
        assert!(repairs("zero - 0.6, 0.0"));
        assert!(!repairs("unset, 0.0"));
    }

    #[test]
    fn a_fault_of_the_shader_itself_prevents_no_repair() {
        let with = |color: &str| {
            format!(
                "void mainImage(out vec4 c, in vec2 p) {{
                    float all[3] = float[](0.2, 0.5, 0.8);
                    float seen = all[int(p.x / 4.0)];
                    c = p.x < 12.0 ? vec4({color}, seen, 0.0, 1.0) : vec4(0.3);
                }}"
            )
        };
        assert!(is_confirmed(&with("0.5"), &with("0.7"), "0.5, seen", "0.7, seen"));
    }

    #[test]
    fn composed_edits_give_the_text_of_both() {
        let source = "a = b + c; d = e;";
        let first = fix(&[(4, 5, "long"), (8, 9, "")]);
        let text = apply(source, &first).unwrap();
        assert_eq!(text, "a = long + ; d = e;");
        for (start, end, replacement) in [(0, 1, "x"), (17, 18, "f"), (9, 10, "-"), (13, 14, "")] {
            let second = fix(&[(start, end, replacement)]);
            let both = compose(&first, &second).unwrap();
            assert_eq!(apply(source, &both), apply(&text, &second), "{second:?}");
        }
        // The second edit encloses the first.
        let whole = fix(&[(4, 10, "f(long)")]);
        let both = compose(&first, &whole).unwrap();
        assert_eq!(both.edits.len(), 2);
        assert_eq!(apply(source, &both), apply(&text, &whole));
        assert_eq!(compose(&first, &fix(&[(5, 6, "i")])), None);
    }
}
