//! Deletes tokens that no other rewrite reaches, such as qualifiers, declarators and parentheses. Texts that
//! do not compile are reduced by this.

use std::ops::Range;

use super::Source;
use crate::outline::{HOST_FUNCTIONS, Outline};
use crate::rewrite::Rewrite;

/// The largest number of neighbors that are deleted together.
const MAX_WINDOW: usize = 4;

/// The largest number of tokens of a text whose tokens are deleted.
const MAX_TOKENS: usize = 4000;

/// Deletions of up to [`MAX_WINDOW`] neighbors, each a token or brackets with their content, and of brackets
/// around their content. Longer ones come first.
pub(super) fn deleted(source: &Source) -> Vec<Rewrite> {
    let outline = &source.outline;
    if outline.tokens.len() > MAX_TOKENS {
        return Vec::new();
    }
    let mut rewrites = Vec::new();
    for size in (1..=MAX_WINDOW).rev() {
        let mut lists = top_level(outline);
        while let Some(list) = lists.pop() {
            let elements = elements(outline, &list);
            for window in elements.windows(size) {
                let tokens = window[0].start..window[size - 1].end;
                rewrites.push(Rewrite::delete(outline.bytes(&tokens)));
            }
            for element in elements.into_iter().filter(|element| element.len() > 1) {
                if is_head_of_host(outline, element.start) {
                    continue;
                }
                let inside = element.start + 1..element.end - 1;
                if size == 1 && !inside.is_empty() {
                    let whole = outline.bytes(&element);
                    rewrites.push(Rewrite::keep(&outline.bytes(&inside), &whole));
                }
                lists.push(inside);
            }
        }
    }
    rewrites
}

/// The tokens of each declaration without the `;` that keeps it apart from the next one; all tokens if the
/// text has no declarations.
fn top_level(outline: &Outline) -> Vec<Range<usize>> {
    let whole = outline.items.is_empty().then_some(0..outline.tokens.len());
    let lists = outline.items.iter().rev().map(|item| {
        let is_function = item.function.is_some();
        item.tokens.start..item.tokens.end - usize::from(!is_function)
    });
    lists.chain(whole).collect()
}

/// Whether a token begins the parameters of the function that the host calls, which everybody knows in full.
fn is_head_of_host(outline: &Outline, open: usize) -> bool {
    let name = open.checked_sub(1).map_or("", |name| outline.token(name));
    HOST_FUNCTIONS.contains(&name)
}

/// The elements of some tokens: tokens, and brackets with their content.
fn elements(outline: &Outline, tokens: &Range<usize>) -> Vec<Range<usize>> {
    let mut elements = Vec::new();
    let mut at = tokens.start;
    while at < tokens.end {
        let is_open = matches!(outline.token(at), "(" | "[" | "{");
        let close = is_open.then(|| outline.partner(at)).flatten();
        let end = close
            .filter(|&close| close < tokens.end)
            .map_or(at + 1, |close| close + 1);
        elements.push(at..end);
        at = end;
    }
    elements
}
