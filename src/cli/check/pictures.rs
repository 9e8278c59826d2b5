//! The pictures that `--out` keeps of a shader.

use crate::compare::TOLERANCE;
use crate::image::{self, Image, Legend};
use crate::verify::Findings;

/// What is more than rounding stands out.
const SEEN_BY_EYE: Legend = Legend {
    tolerance: TOLERANCE as f32,
};
/// Where every bit counts, all but the last bits stand out.
const IN_BITS: Legend = Legend { tolerance: 1e-6 };

/// The ends of the names of all pictures that there may be.
pub(super) const SUFFIXES: [&str; 6] = [
    "-actual.png",
    "-reference.png",
    "-difference.png",
    "-maths.png",
    "-rounding.png",
    "-toolchain.png",
];

/// The pictures of a shader, each with the end of its file's name: what was expected, what came, how they differ, and one for each
/// question whose answer is not “the same”.
pub(super) fn pictures(findings: &Findings) -> Vec<(&'static str, Image)> {
    let [actual, reference, difference, maths, rounding, toolchain] = SUFFIXES;
    let size = findings.actual.size();
    let mut pictures = vec![(actual, findings.actual.clone())];
    if let Some(picture) = &findings.reference {
        pictures.push((reference, picture.clone()));
    }
    if let Some((_, marks)) = &findings.picture {
        pictures.push((difference, image::difference(size, marks, SEEN_BY_EYE)));
    }
    let questions = [
        (maths, &findings.maths, SEEN_BY_EYE),
        (rounding, &findings.rounding, SEEN_BY_EYE),
        (toolchain, &findings.toolchain, IN_BITS),
    ];
    for (suffix, asked, legend) in questions {
        if let Some(asked) = asked.as_ref().filter(|asked| !asked.answer.is_same()) {
            pictures.push((suffix, image::difference(size, &asked.marks, legend)));
        }
    }
    pictures
}
