//! The pictures that `--out` keeps of a shader.

use std::borrow::Cow;

use toyproof_image::Shown;
use toyproof_verify::compare::{IN_BITS, Legend, Mark, SEEN_BY_EYE};
use toyproof_verify::{Asked, Findings};

/// A picture that there may be.
pub(super) struct Picture {
    /// The end of its file's name.
    pub(super) suffix: &'static str,
    /// It itself, if there is one. Pictures are large: they are made one at a time, when they are written.
    pub(super) of: fn(&Findings) -> Option<Cow<'_, Shown>>,
}

/// What was expected, what came, how they differ, and one for each question whose answer is not “the same”.
pub(super) const PICTURES: [Picture; 6] = [
    Picture {
        suffix: "-actual.png",
        of: |findings| Some(Cow::Borrowed(&findings.actual)),
    },
    Picture {
        suffix: "-reference.png",
        of: |findings| findings.reference.as_ref().map(Cow::Borrowed),
    },
    Picture {
        suffix: "-difference.png",
        of: |findings| {
            let (_, marks) = findings.picture.as_ref()?;
            Some(difference(findings, marks, SEEN_BY_EYE))
        },
    },
    Picture {
        suffix: "-maths.png",
        of: |findings| asked(findings, findings.maths.as_ref(), SEEN_BY_EYE),
    },
    Picture {
        suffix: "-rounding.png",
        of: |findings| asked(findings, findings.rounding.as_ref(), SEEN_BY_EYE),
    },
    Picture {
        suffix: "-toolchain.png",
        of: |findings| asked(findings, findings.toolchain.as_ref(), IN_BITS),
    },
];

fn asked<'a>(findings: &Findings, asked: Option<&Asked>, legend: Legend) -> Option<Cow<'a, Shown>> {
    let asked = asked.filter(|asked| !asked.answer.is_same())?;
    Some(difference(findings, &asked.marks, legend))
}

fn difference<'a>(findings: &Findings, marks: &[Mark], legend: Legend) -> Cow<'a, Shown> {
    Cow::Owned(toyproof_verify::compare::difference(
        findings.actual.size(),
        marks,
        legend,
    ))
}
