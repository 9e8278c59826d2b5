//! Formats GLSL: indents by 4 columns, spaces operators alike, puts each statement on a line of its own, and
//! breaks lines of code at 100 columns. Comments, directives, blank lines and the author's line breaks inside
//! of statements are kept; so is the meaning, because only blanks between tokens change.
//!
//! ```
//! let text = "void mainImage(out vec4 c,in vec2 p){c=vec4(p/iResolution.xy,0,1);} // a gradient";
//! let formatted = toyproof_format::format(text)?;
//! assert_eq!(
//!     formatted,
//!     "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); } // a gradient\n"
//! );
//! assert_eq!(toyproof_format::format(&formatted)?, formatted);
//! # Ok::<(), toyproof_format::Error>(())
//! ```
//!
//! A comment `// toyproof: no-format` keeps the statement or declaration after it as it is, and the whole text
//! if only comments precede it.
//!
//! # Parts
//!
//! - `piece`: tokens, comments and directives, with the line breaks before them.
//! - `macros`: what uses of macros are in statements.
//! - `statement`: where statements, labels, heads and blocks begin and end.
//! - `spacing`: where spaces are.
//! - `line`: a statement as lines of text.
//! - `define`: long definitions of macros.
//! - `verbatim`: what is kept as it is.

mod define;
mod line;
mod macros;
mod piece;
mod spacing;
mod statement;
mod verbatim;

use line::Written;
use piece::{Kind, Piece, pieces};
use toyproof_diagnostic::{File, Position};

/// Why a text is not formatted.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Blocks, brackets or `#if` are nested deeper than the front end accepts.
    #[error("{}:{}: blocks, brackets or conditions are nested too deeply", .0.line, .0.column)]
    TooDeep(Position),
    /// The formatted text has other tokens: a defect of the formatter.
    #[error("toyproof would change the code `{0}`; please report this as a defect of toyproof")]
    Changed(String),
}

/// Formats a text, valid or not. Lines of the result end as the first line of the text does.
///
/// # Errors
/// If the text is nested too deeply, or if the formatter has a defect that would change the text's meaning.
pub fn format(text: &str) -> Result<String, Error> {
    let line_end = match text.find(['\r', '\n']) {
        Some(end) if text[end..].starts_with("\r\n") => "\r\n",
        _ => "\n",
    };
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let before = pieces(&text);
    if verbatim::is_whole(&before) {
        return Ok(text.replace('\n', line_end));
    }
    let kept = verbatim::with_kept(&text, before.clone());
    let lines = statement::lines(&kept)
        .map_err(|statement::TooDeep(byte)| Error::TooDeep(File::new("", &*text).position(byte)))?;
    let mut written = Vec::new();
    for line in lines {
        if line.after_blank && !written.is_empty() {
            written.push(Written::code(String::new()));
        }
        line.write(&mut written);
    }
    let formatted = join(&written);
    if let Some(changed) = first_change(&before, &pieces(&formatted)) {
        return Err(Error::Changed(changed));
    }
    Ok(formatted.replace('\n', line_end))
}

/// Joins lines, with comments at their ends aligned where the author aligned them.
fn join(lines: &[Written<'_>]) -> String {
    let mut text = String::new();
    let mut rest = lines;
    while let Some(first) = rest.first() {
        let Some(comment) = first.comment else {
            text.push_str(&first.code);
            text.push('\n');
            rest = &rest[1..];
            continue;
        };
        let aligned = rest
            .iter()
            .take_while(|line| line.comment.is_some_and(|other| other.column == comment.column));
        let (aligned, others) = rest.split_at(aligned.count());
        let column = aligned.iter().map(Written::width).max().unwrap_or(0) + 1;
        for line in aligned {
            text.push_str(&line.code);
            text.extend(std::iter::repeat_n(' ', column - line.width()));
            text.push_str(line.comment.map_or("", |comment| comment.text));
            text.push('\n');
        }
        rest = others;
    }
    text
}

/// The first piece that differs between two texts, other than by blanks.
fn first_change(before: &[Piece<'_>], after: &[Piece<'_>]) -> Option<String> {
    let is_same = |a: &Piece<'_>, b: &Piece<'_>| {
        let lines = |text: &str| -> Vec<String> { text.lines().map(|line| line.trim().to_owned()).collect() };
        a.kind == b.kind
            && match a.kind {
                Kind::Directive => define::tokens(a.text) == define::tokens(b.text),
                Kind::BlockComment => lines(a.text) == lines(b.text),
                _ => a.text == b.text,
            }
    };
    let differs = |index: &usize| match (before.get(*index), after.get(*index)) {
        (Some(a), Some(b)) => !is_same(a, b),
        _ => true,
    };
    let first = (0..before.len().max(after.len())).find(differs)?;
    let piece = before.get(first).or(after.get(first))?;
    Some(piece.text.to_owned())
}

#[cfg(test)]
mod tests;
