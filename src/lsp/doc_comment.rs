//! The comment at a declaration, which documents it: directly in front of it, or at the end of its line.

use std::collections::BTreeMap;

use toyproof_diagnostic::{File, FileId, Span};

use crate::snapshot::Snapshot;
use crate::tokens::{Token, Tokens};

/// Maximum number of tokens in a declaration in front of the declared name.
const MAX_TOKENS_BEFORE_NAME: usize = 64;

/// Maximum number of lines that are shown.
const MAX_LINES: usize = 40;

/// The comments of the files of a snapshot.
pub(crate) struct DocComments<'s> {
    snapshot: &'s Snapshot,
    /// The tokens of each file that was read.
    tokens: BTreeMap<FileId, Tokens<'s>>,
}

impl<'s> DocComments<'s> {
    pub(crate) fn new(snapshot: &'s Snapshot) -> Self {
        Self {
            snapshot,
            tokens: BTreeMap::new(),
        }
    }

    /// The comment at the declaration of a name of the analyzed text, in Markdown.
    pub(crate) fn at(&mut self, name: Span) -> Option<String> {
        let files = self.snapshot.files();
        let name = files.origin(name);
        let tokens = self.tokens.entry(name.file);
        let tokens = tokens.or_insert_with(|| Tokens::new(files, name.file));
        let file = files.get(name.file);
        let lines = in_front(file, tokens, name).or_else(|| behind(file, tokens, name))?;
        Some(lines.join("  \n"))
    }
}

/// The comments in front of the declaration, without a blank line in between.
fn in_front(file: &File, tokens: &Tokens<'_>, name: Span) -> Option<Vec<String>> {
    let text = file.text();
    let mut start = declaration_start(tokens, name)?;
    let mut comments = Vec::new();
    let before = tokens.comments().partition_point(|comment| comment.start < start);
    for comment in tokens.comments()[..before].iter().rev().take(MAX_LINES) {
        let gap = text.get(comment.end() as usize..start as usize)?;
        let is_adjacent = gap.trim().is_empty() && gap.matches('\n').count() <= 1;
        let line_start = text[..comment.start as usize].rfind('\n').map_or(0, |at| at + 1);
        let is_alone = text[line_start..comment.start as usize].trim().is_empty();
        if !(is_adjacent && is_alone) {
            break;
        }
        comments.push(*comment);
        start = comment.start;
    }
    comments.reverse();
    lines_of(&comments)
}

/// The comment on the line of the name, if the declaration ends there.
fn behind(file: &File, tokens: &Tokens<'_>, name: Span) -> Option<Vec<String>> {
    let text = file.text();
    let after = tokens
        .comments()
        .partition_point(|comment| comment.start < name.end);
    let comment = tokens.comments().get(after)?;
    let between = text.get(name.end as usize..comment.start as usize)?;
    let is_declaration = !between.contains(['\n', '{', '(']) || is_macro(tokens, name);
    (is_declaration && !between.contains('\n')).then(|| lines_of(&[*comment]))?
}

fn is_macro(tokens: &Tokens<'_>, name: Span) -> bool {
    let token = tokens.word_at(name.start).map(|index| tokens.code()[index]);
    token.is_some_and(|token| token.is_in_directive)
}

/// The first byte of the declaration of a name.
fn declaration_start(tokens: &Tokens<'_>, name: Span) -> Option<u32> {
    let named = tokens.word_at(name.start)?;
    let is_in_directive = tokens.code()[named].is_in_directive;
    let mut first = named;
    for index in (0..named).rev().take(MAX_TOKENS_BEFORE_NAME) {
        let token = tokens.code()[index];
        let ends = token.is_in_directive != is_in_directive
            || (is_in_directive && token.line != tokens.code()[named].line)
            || (!is_in_directive && matches!(token.text, ";" | "{" | "}"));
        if ends {
            break;
        }
        first = index;
    }
    Some(tokens.code()[first].start)
}

/// The lines of comments without their markers; `None` if nothing remains.
fn lines_of(comments: &[Token<'_>]) -> Option<Vec<String>> {
    let mut lines = Vec::new();
    for comment in comments {
        if let Some(block) = comment.text.strip_prefix("/*") {
            let inner = block.strip_suffix("*/").unwrap_or(block);
            let unmarked = inner
                .lines()
                .map(|line| line.trim().trim_start_matches(['*', '!']));
            lines.extend(unmarked.map(|line| line.trim_end_matches('*').trim()));
        } else {
            let unmarked = comment
                .text
                .lines()
                .map(|line| line.trim_start_matches(['/', '!', '<']));
            lines.extend(unmarked.map(str::trim).filter(|line| !is_control(line)));
        }
    }
    lines.retain(|line| line.is_empty() || line.contains(|c: char| c.is_alphanumeric()));
    let is_text = |line: &str| !line.is_empty();
    let first = lines.iter().position(|line| is_text(line))?;
    let last = lines.iter().rposition(|line| is_text(line))?;
    let shown = lines[first..=last].iter().take(MAX_LINES);
    Some(shown.map(|line| escaped(line)).collect())
}

/// Whether a comment is for toyproof.
fn is_control(line: &str) -> bool {
    line.starts_with("toyproof:")
}

/// A text in which Markdown has no effect.
fn escaped(line: &str) -> String {
    let mut text = String::with_capacity(line.len());
    for character in line.chars() {
        if "\\`*_<>[]#|~&".contains(character) {
            text.push('\\');
        }
        text.push(character);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::marked;

    fn comment(text: &str) -> Option<String> {
        let (snapshot, at) = marked(text);
        DocComments::new(&snapshot).at(Span::new(snapshot.analyzed(), at, at))
    }

    #[test]
    fn comments_in_front_of_a_declaration_are_its_documentation() {
        let text = "// other\n\n// The distance.\r\n// p: *point*\r\nfloat |sphere(vec3 p) { return 0.; }";
        assert_eq!(comment(text).as_deref(), Some("The distance.  \np: \\*point\\*"));
        let block = "/**\n * A ray.\n *\n * Normalized 😀.\n */\nstruct\n|Ray { vec3 o; };";
        assert_eq!(comment(block).as_deref(), Some("A ray.  \n  \nNormalized 😀."));
        assert_eq!(comment("// -----\n// toyproof: allow(W0101)\nfloat |x;"), None);
        assert_eq!(comment("float a; // of a\nfloat |b;"), None);
    }

    #[test]
    fn comments_at_the_end_of_the_line_are_documentation() {
        assert_eq!(comment("float |r = 1.; // radius\n").as_deref(), Some("radius"));
        assert_eq!(
            comment("struct A { float |r; /* radius */ };").as_deref(),
            Some("radius")
        );
        assert_eq!(comment("#define |N(x) (x) // steps\n").as_deref(), Some("steps"));
        assert_eq!(comment("void |f() { // begins\n}"), None);
        assert_eq!(comment("float |r;\n// next\n"), None);
    }
}
