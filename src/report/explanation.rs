//! The explanations of diagnostic codes, of mistakes, and of terms.

use std::borrow::Cow;

use toyproof_diagnostic::Code;
use toyproof_explain::known::documentation;

/// The explanation of a diagnostic code, of a mistake or of a term.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// `E` or `W` and four digits, or the name of a mistake or of a term, such as `unstable`.
    pub code: &'static str,
    /// A title of one line.
    pub title: &'static str,
    /// Markdown: the explanation, and how to fix it. Examples are in fences, each after a line `Wrong:` or
    /// `Right:`.
    pub text: Cow<'static, str>,
}

/// The terms, each with its id and its definition.
pub(super) const TERMS: [(&str, &str, &str); 22] = [
    (
        "correct",
        "correct",
        "The image of the shader agrees with the reference.",
    ),
    (
        "ok",
        "ok",
        "The shader renders. There is no reference to compare its image with.",
    ),
    (
        "wrong",
        "wrong",
        "The algorithm of the shader differs from the reference: it renders another image even in double precision.",
    ),
    (
        "unstable",
        "unstable",
        "The algorithm is correct, but some pixels differ visibly because float32 is not precise enough for it, or \
         because these pixels are ill-conditioned.",
    ),
    (
        "chaotic",
        "chaotic",
        "Each frame of the shader is right and precise, but feedback through its buffers amplifies rounding errors \
         until images differ visibly, in any precision.",
    ),
    (
        "inconclusive",
        "inconclusive",
        "There is no verdict, because too many pixels cannot be compared: they depend on undefined behavior or on \
         random numbers, or the shader cannot be evaluated in time.",
    ),
    ("invalid", "invalid", "The shader does not compile."),
    ("missing", "missing", "No shader was submitted."),
    (
        "timeout",
        "timeout",
        "The shader does not end, or takes too long.",
    ),
    (
        "error",
        "error",
        "The driver or toyproof failed. The shader is not at fault.",
    ),
    (
        "reference",
        "reference",
        "The expected image: the scene, rendered by toyproof's ray tracer; the reference shader, evaluated in double \
         precision; or the reference image.",
    ),
    (
        "algorithm",
        "algorithm check",
        "Compares the shader, evaluated in double precision, with the reference. A difference is a mistake in the \
         algorithm, not a rounding error.",
    ),
    (
        "precision",
        "precision check",
        "Compares the shader in float32 with the same shader in double precision. A difference is caused by \
         rounding errors.",
    ),
    (
        "toolchain",
        "toolchain check",
        "Compares the image of the GPU with the same float32 arithmetic on the CPU, bit for bit. A difference is \
         caused by the shader translator or the driver, not by the shader.",
    ),
    (
        "pixels-off",
        "pixels off",
        "The number of pixels that differ in a check by more than its tolerance.",
    ),
    (
        "ill-conditioned",
        "ill-conditioned",
        "A pixel whose color changes visibly if one operation is rounded differently by 1 ULP, even in double \
         precision. It is not counted as off.",
    ),
    (
        "undefined",
        "undefined behavior",
        "An operation whose result GLSL leaves undefined, such as a read of an uninitialized variable or `pow` of \
         a negative number. Pixels whose color depends on one are not compared.",
    ),
    (
        "ulp",
        "ULP",
        "Unit in the last place: the distance between two neighboring floating-point numbers.",
    ),
    (
        "largest",
        "largest difference",
        "The largest difference of a color component, from 0 to 1, over all pixels that are compared. 1/255 = 0.0039 \
         is one level of an 8-bit image.",
    ),
    (
        "fix",
        "fix",
        "An edit of the shader after which its image agrees with the reference. It was found by trying edits; the \
         author may have meant another one.",
    ),
    (
        "suspect-lines",
        "suspect lines",
        "The lines on which the wrong pixels depend more than the others, the most suspicious first. In about two of \
         five shaders, the mistake is in one of them.",
    ),
    (
        "symptom",
        "symptom",
        "A description of a wrong image that many mistakes can cause. It does not name the mistake.",
    ),
];

/// Returns all explanations: of codes in numerical order, of mistakes by topic, then of terms.
pub fn explanations() -> impl Iterator<Item = Explanation> {
    let codes = Code::ALL.iter().map(|&code| explain_code(code));
    codes.chain(mistakes()).chain(terms())
}

/// Returns the explanation of a code or of a mistake, in any case.
#[must_use]
pub fn explain(code: &str) -> Option<Explanation> {
    if let Some(code) = Code::parse(code) {
        return Some(explain_code(code));
    }
    let mut others = mistakes().chain(terms());
    others.find(|explanation| explanation.code.eq_ignore_ascii_case(code))
}

fn explain_code(code: Code) -> Explanation {
    Explanation {
        code: code.as_str(),
        title: code.title(),
        text: code.explanation().into(),
    }
}

fn terms() -> impl Iterator<Item = Explanation> {
    TERMS.iter().map(|&(code, _, title)| Explanation {
        code,
        title,
        text: "".into(),
    })
}

fn mistakes() -> impl Iterator<Item = Explanation> {
    documentation::all().map(|mistake| Explanation {
        code: mistake.id,
        title: mistake.form,
        text: format!(
            "How to fix it: {}\n\n{}",
            mistake.fix,
            mistake.topic.introduction()
        )
        .into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_in_any_case() {
        let explanation = explain("e0402").unwrap();
        assert_eq!(explanation.code, "E0402");
        assert_eq!(explanation.title, "A `const` without a value");
        assert!(
            explanation.text.ends_with("3.14159265;\n```"),
            "{}",
            explanation.text
        );
        assert_eq!(explain("E0"), None);
    }

    #[test]
    fn every_explanation_has_its_own_code() {
        let mut codes: Vec<_> = explanations().map(|explanation| explanation.code).collect();
        assert!(mistakes().count() > 100);
        codes.sort_unstable();
        assert!(codes.windows(2).all(|pair| pair[0] != pair[1]), "{codes:?}");
        assert!(explain("far-root").unwrap().text.starts_with("How to fix it: "));
    }
}
