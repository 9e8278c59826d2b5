//! A malicious shader and its expected verdict.

use std::iter::repeat_n;

/// One shader.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) text: Vec<u8>,
    /// The verdict; several where it depends on the speed of the machine.
    pub(crate) verdicts: &'static [&'static str],
}

pub(crate) const INVALID: &[&str] = &["invalid"];
pub(crate) const OK: &[&str] = &["ok"];
pub(crate) const TIMEOUT: &[&str] = &["timeout"];
/// A legal but slow shader.
pub(crate) const SLOW: &[&str] = &["ok", "timeout"];

const MAIN: &str = "void mainImage(out vec4 c, in vec2 p)";

/// A case with this text.
pub(crate) fn text(name: &'static str, verdicts: &'static [&'static str], text: impl Into<Vec<u8>>) -> Case {
    Case {
        name,
        text: text.into(),
        verdicts,
    }
}

/// A case with statements in `mainImage`, where `c` is the color and `p` the pixel.
pub(crate) fn body(name: &'static str, verdicts: &'static [&'static str], body: &str) -> Case {
    within(name, verdicts, "", body)
}

/// A case with declarations, and statements in `mainImage`.
pub(crate) fn within(
    name: &'static str,
    verdicts: &'static [&'static str],
    before: &str,
    body: &str,
) -> Case {
    text(name, verdicts, format!("{before}\n{MAIN} {{\n{body}\n}}\n"))
}

/// Generates `count` lines from their numbers.
pub(crate) fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(|at| line(at) + "\n").collect()
}

/// Wraps `middle` in `count` pairs of `open` and `close`.
pub(crate) fn nested(count: usize, open: &str, middle: &str, close: &str) -> String {
    let parts = repeat_n(open, count)
        .chain([middle])
        .chain(repeat_n(close, count));
    parts.collect()
}
