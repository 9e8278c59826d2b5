//! Changes of a text, and how several of them apply together.

use std::cmp::Reverse;
use std::ops::Range;

/// A change of a text: ranges of bytes with their replacements, which are made together.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Rewrite {
    pieces: Vec<(Range<usize>, String)>,
}

impl Rewrite {
    /// Deletes a range.
    pub(crate) fn delete(range: Range<usize>) -> Self {
        Self::replace(range, "")
    }

    /// Replaces a range.
    pub(crate) fn replace(range: Range<usize>, text: impl Into<String>) -> Self {
        Self::default().and(range, text)
    }

    /// Keeps a part of a range, so that rewrites inside of that part still apply.
    pub(crate) fn keep(part: &Range<usize>, whole: &Range<usize>) -> Self {
        Self::delete(whole.start..part.start).and(part.end..whole.end, "")
    }

    /// Adds a replacement.
    pub(crate) fn and(mut self, range: Range<usize>, text: impl Into<String>) -> Self {
        let text = text.into();
        if !(range.is_empty() && text.is_empty()) {
            self.pieces.push((range, text));
        }
        self
    }

    /// Whether it changes nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }
}

/// The text after some rewrites. Of a range inside of another one that is replaced, nothing is left; `None`
/// if ranges overlap in part.
///
/// Tokens that get neighbors are separated by a blank where they would otherwise become one.
pub(crate) fn apply<'r>(text: &str, rewrites: impl IntoIterator<Item = &'r Rewrite>) -> Option<String> {
    let mut pieces: Vec<_> = rewrites.into_iter().flat_map(|rewrite| &rewrite.pieces).collect();
    pieces.sort_by_key(|(range, _)| (range.start, Reverse(range.end)));
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for (range, replacement) in pieces {
        if range.start < at {
            if range.end > at {
                return None;
            }
            continue;
        }
        push(&mut out, &text[at..range.start]);
        push(&mut out, replacement);
        at = range.end;
    }
    push(&mut out, &text[at..]);
    Some(out)
}

/// Appends a text; tokens stay apart.
fn push(out: &mut String, text: &str) {
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    let is_operator = |c: char| "+-*/<>=!&|^%".contains(c);
    if let (Some(last), Some(first)) = (out.chars().next_back(), text.chars().next())
        && (is_word(last) && is_word(first) || is_operator(last) && is_operator(first))
    {
        out.push(' ');
    }
    out.push_str(text);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rewrites_apply_together() {
        let text = "f(a + b) * c";
        let sum = Rewrite::keep(&(2..7), &(0..8));
        let left = Rewrite::keep(&(2..3), &(2..7));
        assert_eq!(apply(text, [&sum]).as_deref(), Some("a + b * c"));
        assert_eq!(apply(text, [&sum, &left]).as_deref(), Some("a * c"));
        let all = Rewrite::replace(0..12, "0.");
        assert_eq!(apply(text, [&left, &all]).as_deref(), Some("0."));
    }

    #[test]
    fn ranges_that_overlap_in_part_do_not_apply() {
        let (left, right) = (Rewrite::delete(0..3), Rewrite::delete(2..4));
        assert_eq!(apply("a + b", [&left, &right]), None);
    }

    #[test]
    fn tokens_stay_apart() {
        let keep = Rewrite::keep(&(7..8), &(6..9));
        assert_eq!(apply("return(a)", [&keep]).as_deref(), Some("return a"));
        let negative = Rewrite::delete(2..4);
        assert_eq!(
            apply("a-(-b)", [&Rewrite::delete(2..3)]).as_deref(),
            Some("a- -b)")
        );
        assert_eq!(apply("a-b -c", [&negative]).as_deref(), Some("a- -c"));
    }
}
