//! Misspelled names, names of other languages, and missing declarations near the errors.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, Edit, Span, similar};

use super::candidates::Candidates;
use crate::foreign::Foreign;
use crate::keywords::{Keyword, Word};
use crate::preprocess::DIRECTIVES;
use crate::source::Source;
use crate::token::{Punctuator, Symbol};
use crate::tree::BuiltIn;

/// Cost of one letter by which names differ.
const COST_PER_LETTER: usize = 3;

/// Maximum number of similar names that are tried for one name.
const MAX_SIMILAR: usize = 6;

/// Maximum number of names for which similar ones are searched.
const MAX_NAMES: usize = 24;

/// Maximum length in bytes of a word that may consist of two.
const MAX_GLUED_BYTES: usize = 64;

/// Maximum number of occurrences of a name that one edit changes.
const MAX_OCCURRENCES: usize = 100;

pub(super) fn collect(candidates: &mut Candidates, errors: &Diagnostics) {
    let names = Names::new(candidates.source);
    let undeclared = undeclared(candidates.source, errors);
    for &index in &undeclared {
        rename_declaration(candidates, &names, index);
        rename_everywhere(candidates, errors, index);
    }
    let mut words = candidates.near();
    words.retain(|&(index, _)| candidates.source.symbol(index).is_some());
    words.sort_by_key(|&(_, distance)| distance);
    let mut tried = 0;
    for (index, distance) in words {
        foreign(candidates, index, distance);
        glued(candidates, &names, index, distance);
        let is_unknown = undeclared.contains(&index);
        if (is_unknown || names.is_suspicious(candidates.source, index)) && tried < MAX_NAMES {
            tried += 1;
            let cost = distance + if is_unknown { 1 } else { 3 };
            misspelling(candidates, &names, index, cost);
        }
    }
    if errors.iter().any(|error| error.code == Code::NoMainImage) {
        main_image(candidates);
    }
}

/// The names of a source text.
struct Names<'a> {
    /// The number of occurrences of each word, by its text.
    counts: BTreeMap<&'a str, usize>,
    /// The words that may be meant: those of the text and those of the language.
    all: BTreeSet<&'a str>,
}

impl<'a> Names<'a> {
    fn new(source: &'a Source) -> Self {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for index in (0..source.len()).filter(|&index| source.symbol(index).is_some()) {
            *counts.entry(source.token_text(index)).or_default() += 1;
        }
        let mut all: BTreeSet<_> = counts.keys().copied().collect();
        all.extend(BuiltIn::ALL.iter().map(|function| function.name()));
        all.extend(Keyword::ALL.iter().map(|keyword| keyword.text()));
        all.extend(source.interner.types());
        all.insert("mainImage");
        Self { counts, all }
    }

    /// Whether a word may be misspelled: a name that occurs once and is not a built-in function, or a keyword
    /// that shaders hardly need.
    fn is_suspicious(&self, source: &Source, index: usize) -> bool {
        let text = source.token_text(index);
        if let Some(keyword) = source.keyword(index) {
            return matches!(
                keyword,
                Keyword::Flat | Keyword::Smooth | Keyword::Do | Keyword::In
            );
        }
        source.is_name(index) && self.counts.get(text) == Some(&1) && BuiltIn::named(text).is_none()
    }

    /// The most similar words, nearest first.
    fn similar(&self, name: &str) -> Vec<(usize, &'a str)> {
        let mut similar: Vec<_> = similar(name, self.all.iter().copied()).collect();
        similar.sort_by_key(|&(distance, _)| distance);
        similar.truncate(MAX_SIMILAR);
        similar
    }
}

/// Separates a known name from the rest of a word: by the `(` or `[` that is missing, or by a blank.
fn glued(candidates: &mut Candidates, names: &Names, index: usize, distance: usize) {
    let source = candidates.source;
    let text = source.token_text(index);
    if !source.is_name(index) || names.counts.get(text) != Some(&1) || text.len() > MAX_GLUED_BYTES {
        return;
    }
    for length in (1..text.len()).rev() {
        let (first, rest) = text.split_at(length);
        let is_known = |name: &str| names.all.contains(name);
        let rest_is_type = source.interner.types().any(|ty| ty == rest);
        let is_plausible = is_known(rest) || rest.starts_with(|c: char| c.is_ascii_digit());
        let cost = match (is_known(first), is_plausible) {
            // Two known names are not a coincidence, even at some distance from the error.
            (true, true) => distance / 4,
            (true, false) => distance + 8,
            // The name of a declared function, and the type of its first parameter.
            (false, _) if rest_is_type => distance + 2,
            (false, _) => continue,
        };
        let at = source.span(index).start + length as u32;
        let at = Span::new(source.file, at, at);
        for (rank, separator) in ["(", " ", "[", ".", ";", ","].into_iter().enumerate() {
            candidates.add(cost + rank, at, separator);
        }
    }
}

/// The tokens that errors report as names without the required declaration.
fn undeclared(source: &Source, errors: &Diagnostics) -> Vec<usize> {
    let codes = [
        Code::Undeclared,
        Code::ReservedWord,
        Code::UnknownMember,
        Code::NotAVariable,
        Code::NoOverload,
        Code::Undefined,
    ];
    let reported = errors.iter().filter(|error| codes.contains(&error.code));
    let indices = reported.flat_map(|error| {
        // In a macro, the related span has the name.
        let related = error.related.iter().map(|(span, _)| *span);
        let indices = error
            .span
            .into_iter()
            .chain(related)
            .map(|span| source.index_at(span.start));
        indices.filter(|&index| {
            let quoted = format!("`{}`", source.token_text(index));
            source.symbol(index).is_some() && error.message.contains(&quoted)
        })
    });
    indices.take(MAX_NAMES).collect()
}

/// Replaces a word by a similar one.
fn misspelling(candidates: &mut Candidates, names: &Names, index: usize, cost: usize) {
    let text = candidates.source.token_text(index);
    for (rank, (letters, near)) in names.similar(text).into_iter().enumerate() {
        candidates.replace(cost + letters * COST_PER_LETTER + rank, index, near);
    }
    if candidates.source.is_in_directive(index) {
        for (letters, near) in similar(text, DIRECTIVES) {
            candidates.replace(cost + letters * COST_PER_LETTER, index, near);
        }
    }
}

/// Gives a declared name the similar, undeclared name that its uses have.
fn rename_declaration(candidates: &mut Candidates, names: &Names, index: usize) {
    let source = candidates.source;
    let wanted = source.token_text(index);
    let near: BTreeMap<_, _> = names
        .similar(wanted)
        .into_iter()
        // All names of one letter are similar.
        .filter(|&(letters, _)| letters < wanted.len())
        .map(|(letters, near)| (near, letters))
        .collect();
    for declared in 1..source.len() {
        let is_declared = source.is_name(declared)
            && (source.is_type(declared - 1)
                || source.is_name(declared - 1)
                || source.is(declared - 1, Punctuator::Comma));
        if is_declared && let Some(letters) = near.get(source.token_text(declared)) {
            let count = |name: &str| names.counts.get(name).copied().unwrap_or_default();
            // The name of several uses is rather the right one than the name of no use.
            let is_unused = count(source.token_text(declared)) == 1 && count(wanted) > 1;
            let cost = if is_unused {
                0
            } else {
                3 + letters * COST_PER_LETTER
            };
            candidates.replace(cost, declared, wanted);
        }
    }
}

/// Applies the fix of an undeclared name to all of its occurrences.
fn rename_everywhere(candidates: &mut Candidates, errors: &Diagnostics, index: usize) {
    let source = candidates.source;
    let span = source.span(index);
    let fixes = errors.iter().flat_map(|error| &error.fixes);
    let of_name = fixes
        .filter(|fix| fix.edits.len() == 1)
        .find(|fix| fix.edits[0].span == span);
    let (Some(fix), Some(name)) = (of_name, source.symbol(index)) else {
        return;
    };
    let edits = occurrences(source, name)
        .map(|index| Edit {
            span: source.span(index),
            replacement: fix.edits[0].replacement.clone(),
        })
        .collect();
    let message = format!(
        "write `{}` instead of `{}`",
        fix.edits[0].replacement,
        source.token_text(index)
    );
    candidates.add_edits(2, edits, Some(message));
}

fn occurrences(source: &Source, name: Symbol) -> impl Iterator<Item = usize> {
    let all = (0..source.len()).filter(move |&index| source.symbol(index) == Some(name));
    all.take(MAX_OCCURRENCES)
}

/// Replaces a name of another language, at this place and everywhere.
fn foreign(candidates: &mut Candidates, index: usize, distance: usize) {
    let source = candidates.source;
    let Some(foreign) = Foreign::named(source.token_text(index)) else {
        return;
    };
    let edits = |index: usize| -> Vec<Edit> {
        let call = source.is(index + 1, Punctuator::LeftParen);
        let close = call.then(|| source.partner(index + 1)).flatten();
        let end = close.map(|close| {
            let start = source.span(close).start;
            Span::new(source.file, start, start)
        });
        let at = crate::tree::Place::plain(source.span(index));
        let advised = foreign.advise(Diagnostic::new(Code::Undeclared, ""), at, end);
        advised.fixes.into_iter().flat_map(|fix| fix.edits).collect()
    };
    let message = format!("use {}", foreign.replacement());
    candidates.add_edits(distance + 1, edits(index), Some(message.clone()));
    if let Some(name) = source.symbol(index) {
        let all = occurrences(source, name).flat_map(edits).collect();
        candidates.add_edits(distance + 2, all, Some(message));
    }
}

/// Gives a function the name `mainImage`.
fn main_image(candidates: &mut Candidates) {
    let source = candidates.source;
    for index in 1..source.len() {
        let is_function = source.is_type(index - 1) && source.is(index + 1, Punctuator::LeftParen);
        if is_function && matches!(source.word(index), Some(Word::Name)) {
            let is_similar = similar(source.token_text(index), ["mainImage", "main"])
                .next()
                .is_some();
            candidates.replace(if is_similar { 1 } else { 12 }, index, "mainImage");
        }
    }
}
