//! Edits of the user's files.

use std::collections::BTreeMap;
use std::ops::Range;

use toyproof_diagnostic::Fix;

use crate::symbol::FilePlace;
use crate::unit::Unit;

/// Replacements of bytes, by the URIs of the files; those of a file are sorted and do not overlap.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct FileEdits {
    files: BTreeMap<String, Vec<(Range<u32>, String)>>,
}

impl FileEdits {
    /// Adds a replacement. Returns whether it could be added: it may not overlap another one, nor insert text
    /// where another one inserts other text. The same replacement is made once.
    pub(crate) fn add(&mut self, place: FilePlace, replacement: &str) -> bool {
        let FilePlace { uri, start, end } = place;
        let edits = self.files.entry(uri).or_default();
        let at = edits.partition_point(|(other, _)| (other.start, other.end) < (start, end));
        if edits
            .get(at)
            .is_some_and(|(other, text)| *other == (start..end) && text == replacement)
        {
            return true;
        }
        // Text may be inserted at the ends of a replacement, but the order of two insertions is not given.
        let is_before = |other: Option<&(Range<u32>, String)>| {
            other.is_none_or(|(other, _)| end <= other.start && (start..end) != *other)
        };
        let is_after =
            |other: Option<&(Range<u32>, String)>| other.is_none_or(|(other, _)| other.end <= start);
        let fits = is_before(edits.get(at)) && is_after(at.checked_sub(1).and_then(|at| edits.get(at)));
        if fits {
            edits.insert(at, (start..end, replacement.to_owned()));
        }
        fits
    }

    /// Adds all edits of a fix, or none. Returns whether they could be added.
    pub(crate) fn add_fix(&mut self, unit: &Unit, fix: &Fix) -> bool {
        let mut with = self.clone();
        let added = fix.edits.iter().all(|edit| {
            let place = FilePlace::of(unit, edit.span);
            place.is_some_and(|place| with.add(place, &edit.replacement))
        });
        if added {
            *self = with;
        }
        added
    }

    pub(crate) fn files(&self) -> &BTreeMap<String, Vec<(Range<u32>, String)>> {
        &self.files
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.files.values().all(Vec::is_empty)
    }
}

/// A text after edits, which are sorted and do not overlap.
pub(crate) fn apply(text: &str, edits: &[(Range<u32>, String)]) -> String {
    let mut edited = text.to_owned();
    for (bytes, replacement) in edits.iter().rev() {
        edited.replace_range(bytes.start as usize..bytes.end as usize, replacement);
    }
    edited
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_do_not_overlap() {
        let mut edits = FileEdits::default();
        let mut add = |start, end, text: &str| {
            let uri = "a".to_owned();
            edits.add(FilePlace { uri, start, end }, text)
        };
        assert!(add(4, 6, "X") && add(0, 2, "Y") && add(2, 3, "") && add(8, 8, "Z"));
        assert!(add(0, 2, "Y"), "the same again");
        assert!(!add(0, 2, "W") && !add(1, 3, "") && !add(5, 5, "") && !add(3, 9, "") && !add(8, 8, "W"));
        assert!(add(6, 8, "V"), "before an insertion");
        assert_eq!(apply("0123456789", &edits.files()["a"]), "Y3XVZ89");
    }
}
