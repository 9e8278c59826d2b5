//! Formatting as edits of the blanks that change, so that cursors and folds of the editor stay where they
//! are.

use std::ops::Range;

use lsp_types::TextEdit;

use crate::snapshot::Snapshot;

/// The edits that format a document, or the bytes of it that are given.
///
/// # Errors
/// Why the text cannot be formatted.
pub(crate) fn format(snapshot: &Snapshot, part: Option<&Range<u32>>) -> Result<Vec<TextEdit>, String> {
    let old = snapshot.file().text();
    let new = toyproof_format::format(old).map_err(|error| error.to_string())?;
    let edits = changes(old, &new).into_iter();
    let edits = edits.filter(|(bytes, _)| {
        let is_in = |part: &Range<u32>| part.start <= bytes.start && bytes.end <= part.end;
        part.is_none_or(is_in)
    });
    let in_protocol = edits.map(|(bytes, text)| {
        let range = snapshot.document_range(bytes.start, bytes.end);
        TextEdit::new(range, text.to_owned())
    });
    Ok(in_protocol.collect())
}

/// The runs of blanks that differ between two texts with the same other characters, each with what replaces
/// it; if other characters differ, the whole text.
fn changes<'n>(old: &str, new: &'n str) -> Vec<(Range<u32>, &'n str)> {
    let mut changed = Vec::new();
    let (mut at, mut by) = (0, 0);
    loop {
        let (before, after) = (blanks(&old[at..]), blanks(&new[by..]));
        if old[at..at + before] != new[by..by + after] {
            changed.push((at as u32..(at + before) as u32, &new[by..by + after]));
        }
        (at, by) = (at + before, by + after);
        match (old[at..].chars().next(), new[by..].chars().next()) {
            (None, None) => return changed,
            (Some(one), Some(other)) if one == other => {
                at += one.len_utf8();
                by += one.len_utf8();
            }
            _ => return vec![(0..old.len() as u32, new)],
        }
    }
}

/// The number of bytes of blanks at the start of a text.
fn blanks(text: &str) -> usize {
    text.len() - text.trim_start().len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edits::apply;
    use crate::snapshot::testing::of;

    #[test]
    fn only_blanks_are_replaced() {
        let old = "void f(){\n\tint a=1 ; // 😀\n}\n";
        let new = "void f() {\n    int a = 1; // 😀\n}\n";
        let changed = changes(old, new);
        assert!(changed.iter().all(|(bytes, text)| {
            let replaced = &old[bytes.start as usize..bytes.end as usize];
            replaced.trim().is_empty() && text.trim().is_empty()
        }));
        let edits: Vec<_> = changed
            .into_iter()
            .map(|(bytes, text)| (bytes, text.to_owned()))
            .collect();
        assert_eq!(edits.len(), 5);
        assert_eq!(apply(old, &edits), new);
        assert_eq!(changes("a b", "ab c"), [(0..3, "ab c")]);
        assert!(changes(new, new).is_empty());
    }

    #[test]
    fn a_part_of_a_document_is_formatted() {
        let text = "float a=1.;\nfloat b=2.;\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(a, b, p); }\n";
        let snapshot = of(text);
        let all = format(&snapshot, None).unwrap();
        let second = format(&snapshot, Some(&(12..23))).unwrap();
        assert_eq!((all.len(), second.len()), (4, 2));
        assert!(second.iter().all(|edit| edit.range.start.line == 1));
    }
}
