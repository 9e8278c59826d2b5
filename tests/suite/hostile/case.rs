//! A shader that means harm, and what is to be said of it.

use std::iter::repeat_n;

/// One shader.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) text: Vec<u8>,
    /// The verdict; several where the machine decides: what one does not finish in time, a faster one may.
    pub(crate) verdicts: &'static [&'static str],
}

pub(crate) const INVALID: &[&str] = &["invalid"];
pub(crate) const OK: &[&str] = &["ok"];
pub(crate) const TIMEOUT: &[&str] = &["timeout"];
/// A legal shader that takes long.
pub(crate) const SLOW: &[&str] = &["ok", "timeout"];

const MAIN: &str = "void mainImage(out vec4 c, in vec2 p)";

/// A text as it is.
pub(crate) fn text(name: &'static str, verdicts: &'static [&'static str], text: impl Into<Vec<u8>>) -> Case {
    Case {
        name,
        text: text.into(),
        verdicts,
    }
}

/// Statements in `mainImage`, where `c` is the colour and `p` the pixel.
pub(crate) fn body(name: &'static str, verdicts: &'static [&'static str], body: &str) -> Case {
    within(name, verdicts, "", body)
}

/// Declarations, and statements in `mainImage`.
pub(crate) fn within(
    name: &'static str,
    verdicts: &'static [&'static str],
    before: &str,
    body: &str,
) -> Case {
    text(name, verdicts, format!("{before}\n{MAIN} {{\n{body}\n}}\n"))
}

/// So many lines, each made of its number.
pub(crate) fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(|at| line(at) + "\n").collect()
}

/// What stands in the middle, between so many of these.
pub(crate) fn nested(count: usize, open: &str, middle: &str, close: &str) -> String {
    let parts = repeat_n(open, count)
        .chain([middle])
        .chain(repeat_n(close, count));
    parts.collect()
}
