//! Candidates for the single edit, their costs, and the tokens near the errors.

use std::collections::{BTreeMap, HashSet};

use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, Edit, Fix, Severity, Span};

use crate::source::Source;

/// Number of errors, from the first one, around which edits are tried.
const MAX_ERRORS: usize = 4;

/// Cost of an edit at the next error instead of this one, in tokens.
const COST_PER_ERROR: usize = 6;

/// Cost of a fix that an error carries: little, but more than the removal of an obvious duplicate.
const COST_CARRIED: usize = 1;

/// Additional cost of each further fix of the same kind of error.
const COST_PER_FIX: usize = 3;

/// Number of tokens before an error that are tried.
const TOKENS_BEFORE: usize = 40;

/// Number of tokens before an error that are tried where a bracket is reported, whose partner may be far.
const TOKENS_BEFORE_BRACKET: usize = 120;

/// Number of tokens after an error that are tried.
const TOKENS_AFTER: usize = 40;

/// A possible edit.
struct Candidate {
    cost: usize,
    edits: Vec<Edit>,
    /// The advice, if not evident from the edit.
    message: Option<String>,
}

/// The candidates for the errors of a source text.
pub(super) struct Candidates<'a> {
    pub(super) source: &'a Source<'a>,
    /// The tokens near errors, and their distances from the nearest of them in tokens.
    near: BTreeMap<usize, usize>,
    /// The codes of the errors.
    codes: HashSet<Code>,
    found: Vec<Candidate>,
}

impl<'a> Candidates<'a> {
    pub(super) fn new(source: &'a Source<'a>, errors: &'a Diagnostics) -> Self {
        let errors = || errors.iter().filter(|error| error.severity == Severity::Error);
        let mut candidates = Self {
            source,
            near: BTreeMap::new(),
            codes: errors().map(|error| error.code).collect(),
            found: Vec::new(),
        };
        for (rank, error) in errors().take(MAX_ERRORS).enumerate() {
            let places = error.related.iter().map(|(span, _)| *span);
            for span in error.span.into_iter().chain(places) {
                candidates.add_place(span, rank * COST_PER_ERROR);
            }
        }
        candidates
    }

    /// Whether one of the codes is reported.
    pub(super) fn has(&self, codes: &[Code]) -> bool {
        codes.iter().any(|code| self.codes.contains(code))
    }

    /// Whether a violation of the grammar is reported, not only of the rules for names and types.
    fn is_syntax(&self) -> bool {
        self.is_unbalanced() || self.has(&[Code::Syntax, Code::BadNumber, Code::ReservedWord])
    }

    /// Whether a bracket without its partner is reported.
    pub(super) fn is_unbalanced(&self) -> bool {
        self.has(&[Code::Unclosed, Code::BadMacroCall])
    }

    /// Whether the arguments of a call are reported.
    pub(super) fn is_call(&self) -> bool {
        self.has(&[Code::NoOverload, Code::BadConstructor])
    }

    /// Adds the tokens near a span of an error.
    fn add_place(&mut self, span: Span, cost: usize) {
        if span.file != self.source.file {
            return;
        }
        let first = self.source.index_at(span.start);
        let last = self.source.index_at(span.end.saturating_sub(1)).max(first);
        let tokens_before = if self.is_unbalanced() {
            TOKENS_BEFORE_BRACKET
        } else {
            TOKENS_BEFORE
        };
        // The grammar is violated before the token that it does not allow; a call is reported by its name.
        let cost_after = if self.is_syntax() { 2 } else { 1 };
        let near = &mut self.near;
        let mut add = |index: usize, distance: usize| {
            let nearest = near.entry(index).or_insert(usize::MAX);
            *nearest = (*nearest).min(cost + distance);
        };
        for distance in 0..=tokens_before.min(first) {
            add(first - distance, distance);
        }
        for index in (first..last).take(TOKENS_BEFORE) {
            add(index, 0);
        }
        for index in (first..=last).rev().take(TOKENS_BEFORE) {
            add(index, 0);
        }
        for distance in (1..=TOKENS_AFTER).take_while(|distance| last + distance <= self.source.len()) {
            add(last + distance, cost_after * distance);
        }
    }

    /// The tokens near errors with their distances, in their order in the text.
    pub(super) fn near(&self) -> Vec<(usize, usize)> {
        let near = self.near.iter();
        near.map(|(&index, &distance)| (index, distance)).collect()
    }

    /// The distance of a token from an error; `None` if it is far.
    pub(super) fn distance(&self, index: usize) -> Option<usize> {
        self.near.get(&index).copied()
    }

    /// The cost of an edit: `of_syntax` where the errors report the grammar, otherwise `of_others`.
    pub(super) fn cost(&self, of_syntax: usize, of_others: usize) -> usize {
        if self.is_syntax() { of_syntax } else { of_others }
    }

    /// Adds the insertion of a text after the token before `index`.
    pub(super) fn insert(&mut self, cost: usize, index: usize, text: &str) {
        let at = match index.checked_sub(1) {
            Some(before) => self.source.span(before).end,
            None => 0,
        };
        self.add(cost, Span::new(self.source.file, at, at), text);
    }

    /// Adds the insertion of a text right before a token.
    pub(super) fn insert_before(&mut self, cost: usize, index: usize, text: &str) {
        let at = self.source.span(index).start;
        self.add(cost, Span::new(self.source.file, at, at), text);
    }

    /// Adds the removal of a token.
    pub(super) fn remove(&mut self, cost: usize, index: usize) {
        self.replace(cost, index, "");
    }

    /// Adds the replacement of a token.
    pub(super) fn replace(&mut self, cost: usize, index: usize, text: &str) {
        self.add(cost, self.source.span(index), text);
    }

    /// Adds the replacement of a span.
    pub(super) fn add(&mut self, cost: usize, span: Span, text: &str) {
        let replacement = text.to_owned();
        self.add_edits(cost, vec![Edit { span, replacement }], None);
    }

    /// Adds several edits that count as one.
    pub(super) fn add_edits(&mut self, cost: usize, edits: Vec<Edit>, message: Option<String>) {
        self.found.push(Candidate { cost, edits, message });
    }

    /// Adds the fixes of the errors: each alone, and all fixes of one kind of error.
    pub(super) fn add_carried_fixes(&mut self, errors: &Diagnostics) {
        let is_of_file = |fix: &&Fix| fix.edits.iter().all(|edit| edit.span.file == self.source.file);
        let of =
            |error: &Diagnostic| -> Vec<Fix> { error.fixes.iter().filter(is_of_file).cloned().collect() };
        let errors: Vec<_> = errors
            .iter()
            .filter(|error| error.severity == Severity::Error)
            .map(|error| (error.code, of(error)))
            .collect();
        let mut kinds: Vec<_> = errors.iter().map(|(code, _)| *code).collect();
        kinds.sort_unstable();
        kinds.dedup();
        for fix in errors.iter().flat_map(|(_, fixes)| fixes) {
            self.add_edits(COST_CARRIED, fix.edits.clone(), Some(fix.message.clone()));
        }
        for kind in kinds {
            let alike = errors.iter().filter(|(code, _)| *code == kind);
            let fixes: Vec<_> = alike.flat_map(|(_, fixes)| fixes).collect();
            if fixes.len() > 1 {
                let edits = fixes.iter().flat_map(|fix| &fix.edits).cloned().collect();
                let mut messages: Vec<_> = fixes.iter().map(|fix| fix.message.as_str()).collect();
                messages.dedup();
                let cost = COST_CARRIED + COST_PER_FIX * (fixes.len() - 1);
                self.add_edits(cost, edits, Some(messages.join("; ")));
            }
        }
    }

    /// The fixes in the order of their costs, each once.
    pub(super) fn by_cost(mut self) -> impl Iterator<Item = Fix> {
        self.found.sort_by_key(|candidate| candidate.cost);
        let (source, is_unbalanced) = (self.source, self.is_unbalanced());
        // The report of a macro's arguments may concern a bracket or not.
        let is_macro_call = self.has(&[Code::BadMacroCall]);
        let mut seen = HashSet::new();
        self.found.into_iter().filter_map(move |candidate| {
            let mut edits = candidate.edits;
            edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
            edits.dedup();
            let overlaps = |pair: &[Edit]| pair[1].span.start < pair[0].span.end;
            if edits.is_empty() || edits.windows(2).any(overlaps) {
                return None;
            }
            let key: Vec<_> = edits
                .iter()
                .map(|edit| (edit.span.start, edit.span.end, edit.replacement.clone()))
                .collect();
            let is_new = seen.insert(key);
            (is_new && (is_macro_call || may_balance(source, &edits, is_unbalanced))).then(|| {
                let message = candidate.message.unwrap_or_else(|| describe(source, &edits[0]));
                let first = edits.remove(0);
                let fix = Fix::new(message, first.span, first.replacement);
                edits
                    .into_iter()
                    .fold(fix, |fix, edit| fix.and(edit.span, edit.replacement))
            })
        })
    }
}

/// Whether brackets may have partners after the edits. Where a bracket is reported, some must change, and
/// otherwise both or none of a pair; only in macros, edits may change one bracket of a pair.
fn may_balance(source: &Source, edits: &[Edit], is_unbalanced: bool) -> bool {
    let is_directive =
        |edit: &Edit| source.is_in_directive(source.index_at(edit.span.start).saturating_sub(1));
    if edits.iter().any(is_directive) {
        return true;
    }
    let change = |open: char, close: char| {
        let count = |text: &str| {
            let signs = text.chars().map(|c| i64::from(c == open) - i64::from(c == close));
            signs.sum::<i64>()
        };
        let changes = edits
            .iter()
            .map(|edit| count(&edit.replacement) - count(source.slice(edit.span)));
        changes.sum::<i64>() != 0
    };
    let is_changed = [('(', ')'), ('[', ']'), ('{', '}')]
        .iter()
        .any(|&(open, close)| change(open, close));
    // A `;` ends brackets, except in the head of a `for`, and a `{` only if it begins no structure.
    let ends_brackets = |text: &str| text.contains(';') || ["for", "struct"].contains(&text);
    let touches = |edit: &Edit| ends_brackets(&edit.replacement) || ends_brackets(source.slice(edit.span));
    is_changed == is_unbalanced || (is_unbalanced && edits.iter().any(touches))
}

/// The advice to make an edit.
fn describe(source: &Source, edit: &Edit) -> String {
    let old = source.slice(edit.span);
    let new = edit.replacement.trim();
    if old.is_empty() {
        match source.quoted_end(edit.span.start) {
            "" => format!("insert `{new}` at the beginning"),
            end => format!("insert `{new}` after `{end}`"),
        }
    } else if new.is_empty() {
        format!("remove `{old}`")
    } else {
        format!("write `{new}` instead of `{old}`")
    }
}

/// The text after edits that do not overlap, in the order of their positions.
pub(super) fn edited(text: &str, edits: &[Edit]) -> String {
    let mut result = String::with_capacity(text.len() + 64);
    let mut done = 0;
    for edit in edits {
        let (start, end) = (edit.span.start as usize, edit.span.end as usize);
        result += text.get(done..start).unwrap_or_default();
        result += &edit.replacement;
        done = end;
    }
    result + text.get(done..).unwrap_or_default()
}
