//! TOML files with a fixed set of keys, such as scenes and rubrics. Every error has a span, a message in
//! terms of the file, and advice.
//!
//! ```
//! use toyproof_diagnostic::{Code, File, Files};
//! use toyproof_toml::{Format, read};
//!
//! static FORMAT: Format = Format { form_code: Code::SceneSyntax, value_code: Code::SceneValue, aliases: &[] };
//! let mut files = Files::default();
//! let file = files.add(File::new("a.toml", "radius = \"1\""));
//! let errors = read(&FORMAT, &files, file, |table| table.required::<f64>("radius")).unwrap_err();
//! assert!(errors.to_string().starts_with("a.toml:1:10: error[E0501]: `radius` must be a number"));
//! ```
//!
//! # Parts
//!
//! - [`Table`]: the keys of a table, each read once, and what is wrong with them.
//! - `value`: the types of values; `moment`: dates with a time and an offset from UTC.
//! - `syntax`: errors in the syntax of TOML.

mod moment;
mod syntax;
mod value;

use std::cell::{Cell, RefCell};
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toyproof_diagnostic::{
    Code, Diagnostic, Diagnostics, FileId, Files, Span, grouped, nearest, one_of, plural,
};
use toyproof_image::{MAX_PIXELS, MAX_SIDE, check_size};

pub use self::moment::Moment;
pub use self::syntax::diagnostic as syntax_error;
use self::value::describe;
pub use self::value::{Literal, Value};

/// The properties of one kind of file.
#[derive(Debug)]
pub struct Format {
    /// The code of errors in the syntax, in keys and in types.
    pub form_code: Code,
    /// The code of errors in values.
    pub value_code: Code,
    /// Accepted spellings of keys: the alias, and the key.
    pub aliases: &'static [(&'static str, &'static str)],
}

/// A value and where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// The place.
    pub span: Span,
}

/// Reads one file, and collects its errors.
#[derive(Debug)]
pub struct Reader<'t> {
    format: &'static Format,
    file: FileId,
    text: &'t str,
    errors: RefCell<Vec<Diagnostic>>,
    /// The keys of the whole file that are not tables.
    top_level: RefCell<Vec<&'static str>>,
    error_count: Cell<usize>,
}

/// The maximum number of errors that are reported for one file.
const MAX_ERRORS: usize = 20;

/// Reads a file by passing its root table to `read`. All errors are reported at once, in the order of the
/// file, except that nothing else is read after a syntax error.
///
/// # Errors
/// Those of the file.
pub fn read<T>(
    format: &'static Format,
    files: &Files,
    file: FileId,
    read: impl FnOnce(&mut Table) -> T,
) -> Result<T, Diagnostics> {
    let text = files.get(file).text();
    let reader = Reader {
        format,
        file,
        text,
        errors: RefCell::default(),
        top_level: RefCell::default(),
        error_count: Cell::default(),
    };
    let document = match DeTable::parse(text) {
        Ok(document) => document,
        Err(error) => {
            let error = syntax::diagnostic(format.form_code, &error, text, file);
            return Err(Diagnostics::new(vec![error], files));
        }
    };
    let span = reader.span(0..0);
    let value = Table::new(&reader, Place::Root, span, document.into_inner()).read(read);
    let mut errors = reader.errors.into_inner();
    if errors.is_empty() {
        return Ok(value);
    }
    errors.sort_by_key(|error| error.span.map(|span| span.start));
    let omitted = errors.len().saturating_sub(MAX_ERRORS) as u64;
    if omitted > 0 {
        errors.truncate(MAX_ERRORS);
        let last = errors.pop().map(|last| {
            let noun = plural(omitted, "error is", "errors are");
            last.note(format!("{} more {noun} not shown", grouped(omitted)))
        });
        errors.extend(last);
    }
    Err(Diagnostics::new(errors, files))
}

impl Reader<'_> {
    fn span(&self, bytes: Range<usize>) -> Span {
        Span::new(self.file, bytes.start as u32, bytes.end as u32)
    }

    /// Returns a short excerpt of the file there.
    fn excerpt(&self, span: Span) -> &str {
        let text = &self.text[span.start as usize..span.end as usize];
        text.lines().next().unwrap_or_default()
    }

    fn report(&self, code: Code, span: Span, message: String, help: &str) {
        let mut error = Diagnostic::new(code, message).at(span);
        if !help.is_empty() {
            error = error.help(help);
        }
        self.errors.borrow_mut().push(error);
        self.error_count.set(self.error_count.get() + 1);
    }
}

/// The place of a table.
#[derive(Debug, Clone, Copy)]
enum Place {
    Root,
    /// `[name]`
    One(&'static str),
    /// `[[name]]`
    Many(&'static str),
    /// `name = { … }`
    Inline(&'static str),
}

impl Place {
    fn name(self) -> String {
        match self {
            Self::Root => "the file".to_owned(),
            Self::One(name) => format!("[{name}]"),
            Self::Many(name) => format!("[[{name}]]"),
            Self::Inline(name) => format!("`{name}`"),
        }
    }
}

/// A table whose entries are read one by one; those that are left are unknown.
#[derive(Debug)]
pub struct Table<'r, 't> {
    reader: &'r Reader<'t>,
    place: Place,
    span: Span,
    entries: DeTable<'t>,
    /// The keys that were looked for, each with how it is written.
    known: Vec<(&'static str, String)>,
    /// The required keys that were not found, each with advice.
    missing: Vec<(&'static str, String)>,
    errors_before: usize,
}

impl<'r, 't> Table<'r, 't> {
    fn new(reader: &'r Reader<'t>, place: Place, span: Span, entries: DeTable<'t>) -> Self {
        Self {
            reader,
            place,
            span,
            entries,
            known: Vec::new(),
            missing: Vec::new(),
            errors_before: reader.error_count.get(),
        }
    }

    fn read<T>(mut self, read: impl FnOnce(&mut Self) -> T) -> T {
        let value = read(&mut self);
        self.report_unknown_keys();
        value
    }

    /// The place of the table: its header, or all of an inline table.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Whether there has been no error in this table, or since it was opened.
    pub fn is_valid(&self) -> bool {
        self.reader.error_count.get() == self.errors_before
    }

    /// Reports a value that cannot be used; `help` may be empty.
    pub fn reject(&self, span: Span, message: impl Into<String>, help: &str) {
        self.reader
            .report(self.reader.format.value_code, span, message.into(), help);
    }

    /// Rejects the value of a key; `problem` follows the key in the message.
    pub fn reject_value<T>(&self, key: &str, located: &Located<T>, problem: &str) {
        let found = self.excerpt(located.span);
        self.reject(located.span, format!("`{key}` {problem}, found {found}"), "");
    }

    /// Reports a value that does not have the form that it must have; `help` may be empty.
    pub fn reject_form(&self, span: Span, message: String, help: &str) {
        self.reader
            .report(self.reader.format.form_code, span, message, help);
    }

    /// Returns the text of the file there.
    pub fn excerpt(&self, span: Span) -> &str {
        self.reader.excerpt(span)
    }

    /// Whether there is such a key.
    pub fn has(&self, key: &str) -> bool {
        self.value_span(key).is_some()
    }

    /// The place of the value of a key.
    pub fn value_span(&self, key: &str) -> Option<Span> {
        self.entries.get(key).map(|value| self.reader.span(value.span()))
    }

    fn take(&mut self, key: &'static str, form: Place) -> Option<Spanned<DeValue<'t>>> {
        let written = match form {
            Place::Root | Place::Inline(_) => format!("`{key}`"),
            header => header.name(),
        };
        self.known.push((key, written));
        let mut found = self.entries.remove(key);
        for (alias, meant) in self.reader.format.aliases {
            if *meant == key
                && let Some((name, value)) = self.entries.remove_entry(*alias)
                && found.replace(value).is_some()
            {
                let message = format!("`{alias}` and `{key}` are the same key");
                self.reject_form(self.reader.span(name.span()), message, "remove one of them");
            }
        }
        found
    }

    /// Returns the value of an optional key. A value of another type is reported and gives `None`.
    pub fn optional<T: Value>(&mut self, key: &'static str) -> Option<Located<T>> {
        if matches!(self.place, Place::Root) {
            self.reader.top_level.borrow_mut().push(key);
        }
        let value = self.take(key, Place::Root)?;
        let span = self.reader.span(value.span());
        match T::read(&value) {
            Ok(value) => Some(Located { value, span }),
            Err(mismatch) => {
                let help = if mismatch.is_number_in_quotes {
                    "remove the quotes around the number".to_owned()
                } else {
                    format!("for example `{key} = {}`", T::EXAMPLE)
                };
                let message = format!("`{key}` must be {}, found {}", T::EXPECTED, mismatch.found);
                self.reject_form(self.reader.span(mismatch.bytes), message, &help);
                None
            }
        }
    }

    /// Returns the strings of an optional list, each with its place; none if the key is missing or its value
    /// has another type, which is reported.
    pub fn strings(&mut self, key: &'static str) -> Vec<Located<String>> {
        let strings = self.optional::<Vec<(String, Range<usize>)>>(key);
        let strings = strings.map_or_else(Vec::new, |strings| strings.value);
        let located = strings.into_iter().map(|(value, bytes)| Located {
            value,
            span: self.reader.span(bytes),
        });
        located.collect()
    }

    /// Returns the value of a key; `None` if it is missing or has another type, which is reported.
    pub fn required<T: Value>(&mut self, key: &'static str) -> Option<Located<T>> {
        let count = self.reader.error_count.get();
        let value = self.optional(key);
        if value.is_none() && self.reader.error_count.get() == count {
            self.report_missing(key, format!("add `{key} = {}`", T::EXAMPLE));
        }
        value
    }

    /// Reports that a key is missing that this table must have, with an example of its value.
    pub fn require(&mut self, key: &'static str, example: &str) {
        self.report_missing(key, format!("add `{key} = {example}`"));
    }

    /// Reports a missing key, unless an unknown one looks like a misspelling of it.
    fn report_missing(&mut self, key: &'static str, help: String) {
        self.missing.push((key, help));
        self.reader.error_count.set(self.reader.error_count.get() + 1);
    }

    /// Returns a whole number in a range, or a default if it is missing or rejected, which is reported.
    pub fn count_or(&mut self, key: &'static str, [min, max]: [u32; 2], default: u32) -> u32 {
        let Some(located) = self.optional::<i64>(key) else {
            return default;
        };
        match u32::try_from(located.value) {
            Ok(count) if (min..=max).contains(&count) => count,
            _ => {
                let max = grouped(u64::from(max));
                self.reject_value(key, &located, &format!("must be from {min} to {max}"));
                default
            }
        }
    }

    /// Returns the size of an image in pixels, or a default if it is missing or rejected, which is reported.
    pub fn size_or(&mut self, key: &'static str, default: [u32; 2]) -> [u32; 2] {
        let Some(located) = self.optional::<[i64; 2]>(key) else {
            return default;
        };
        if located.value.iter().any(|side| *side < 1) {
            self.reject_value(key, &located, "must be at least 1 pixel in each direction");
            return default;
        }
        let [width, height] = located.value.map(|side| side as u64);
        check_size(width, height).unwrap_or_else(|_| {
            let problem = format!(
                "must be at most {} pixels in each direction and {} pixels in all",
                grouped(u64::from(MAX_SIDE)),
                grouped(MAX_PIXELS)
            );
            self.reject_value(key, &located, &problem);
            default
        })
    }

    /// Returns the choice that a string names; `what` is the noun for it. `None` if the key is missing or not
    /// one of the choices, which is reported.
    pub fn choice<T: Copy>(
        &mut self,
        key: &'static str,
        what: &str,
        choices: &[(&'static str, T)],
    ) -> Option<Located<T>> {
        let Located { value: name, span } = self.optional::<String>(key)?;
        if let Some((_, value)) = choices.iter().find(|(known, _)| *known == name) {
            return Some(Located { value: *value, span });
        }
        let names = choices.iter().map(|(name, _)| *name);
        let help = suggestion(&name, names.map(|name| (name, format!("`{name}`"))));
        self.reject_form(span, format!("unknown {what} `{name}`"), &help);
        None
    }

    /// Returns the choice that the string of a required key names; `None` if it is missing or not one of the
    /// choices, which is reported.
    pub fn required_choice<T: Copy>(
        &mut self,
        key: &'static str,
        what: &str,
        choices: &[(&'static str, T)],
    ) -> Option<Located<T>> {
        if !self.has(key) {
            let names: Vec<_> = choices.iter().map(|(name, _)| format!("`{name}`")).collect();
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            let example = choices.first().map_or("", |(name, _)| name);
            let help = format!("add `{key} = \"{example}\"`; the choices are {}", one_of(&names));
            self.report_missing(key, help);
        }
        self.choice(key, what, choices)
    }

    /// Removes and returns the entries that have not been read, of a table whose keys are names that its
    /// author chose. Those of another type are reported.
    pub fn take_entries<T: Value>(&mut self) -> Vec<(String, T)> {
        let mut entries = Vec::new();
        for (name, value) in std::mem::take(&mut self.entries) {
            match T::read(&value) {
                Ok(value) => entries.push((name.into_inner().into_owned(), value)),
                Err(mismatch) => {
                    let name = name.get_ref();
                    let message = format!("`{name}` must be {}, found {}", T::EXPECTED, mismatch.found);
                    let help = format!("for example `{name} = {}`", T::EXAMPLE);
                    self.reject_form(self.reader.span(mismatch.bytes), message, &help);
                }
            }
        }
        entries
    }

    /// Whether the value of a key is a table.
    pub fn has_table(&self, key: &str) -> bool {
        self.entries
            .get(key)
            .is_some_and(|value| value.get_ref().is_table())
    }

    /// Removes the entries that have not been read, because what may be there is unknown.
    pub fn ignore_rest(&mut self) {
        self.entries = DeTable::new();
    }

    /// Reads a table that must be there, as it is in the example: `key = { … }`.
    pub fn required_table<T>(
        &mut self,
        key: &'static str,
        example: &str,
        read: impl FnOnce(&mut Table) -> T,
    ) -> Option<T> {
        if !self.has(key) {
            self.report_missing(key, format!("add `{example}`"));
        }
        self.inline_table(key, example, read)
    }

    /// Reads a table that may be missing: `[key]`.
    pub fn table<T>(&mut self, key: &'static str, read: impl FnOnce(&mut Table) -> T) -> Option<T> {
        let help = format!("write `[{key}]` on a line of its own, and its keys below");
        self.table_at(Place::One(key), key, &help, read)
    }

    /// Reads a table that may be missing, and is written as in the example: `key = { … }`.
    pub fn inline_table<T>(
        &mut self,
        key: &'static str,
        example: &str,
        read: impl FnOnce(&mut Table) -> T,
    ) -> Option<T> {
        self.table_at(Place::Inline(key), key, &format!("for example `{example}`"), read)
    }

    fn table_at<T>(
        &mut self,
        place: Place,
        key: &'static str,
        help: &str,
        read: impl FnOnce(&mut Table) -> T,
    ) -> Option<T> {
        let value = self.take(key, place)?;
        let span = self.reader.span(value.span());
        match value.into_inner() {
            DeValue::Table(entries) => {
                return Some(Table::new(self.reader, place, span, entries).read(read));
            }
            DeValue::Array(_) if matches!(place, Place::One(_)) => {
                let help = format!("write `[{key}]`, with single brackets");
                self.reject_form(span, format!("[{key}] can be given only once"), &help);
            }
            other => {
                let message = format!("`{key}` must be a table, found {}", describe(&other));
                self.reject_form(span, message, help);
            }
        }
        None
    }

    /// Reads all tables `[[key]]`, in the order of the file.
    pub fn tables<T>(&mut self, key: &'static str, mut read: impl FnMut(&mut Table) -> T) -> Vec<T> {
        let place = Place::Many(key);
        let Some(value) = self.take(key, place) else {
            return Vec::new();
        };
        let span = self.reader.span(value.span());
        let help = format!("write `[[{key}]]`, with double brackets, before the keys of each");
        let values = match value.into_inner() {
            DeValue::Array(values) => values,
            DeValue::Table(_) => {
                self.reject_form(span, format!("[{key}] must be written [[{key}]]"), &help);
                return Vec::new();
            }
            other => {
                let message = format!("`{key}` must be a table, found {}", describe(&other));
                self.reject_form(span, message, &help);
                return Vec::new();
            }
        };
        let mut all = Vec::with_capacity(values.len());
        for value in values {
            let span = self.reader.span(value.span());
            match value.into_inner() {
                DeValue::Table(entries) => {
                    all.push(Table::new(self.reader, place, span, entries).read(&mut read));
                }
                other => {
                    let message = format!("`{key}` must be a table, found {}", describe(&other));
                    self.reject_form(span, message, &help);
                }
            }
        }
        all
    }

    /// Rejects keys that belong to the choice `owner` of `what`, such as a projection, where `actual` was
    /// chosen.
    pub fn reject_keys(&mut self, keys: &[&str], what: &str, owner: &str, actual: &str) {
        for key in keys {
            let message = format!("`{key}` is not a key of the {what} `{actual}`");
            self.reject_key(key, message, &format!("remove it; only `{owner}` has `{key}`"));
        }
    }

    /// Rejects a key that does not belong in this table, if it is there.
    fn reject_key(&mut self, key: &str, message: String, help: &str) {
        if let Some((name, _)) = self.entries.remove_entry(key) {
            self.reject(self.reader.span(name.span()), message, help);
        }
    }

    /// Reports the entries that have not been read, and the required ones that were not found.
    pub fn report_unknown_keys(&mut self) {
        let unknown = std::mem::take(&mut self.entries);
        for (name, value) in &unknown {
            self.report_unknown_key(name.get_ref(), self.reader.span(name.span()), value.get_ref());
        }
        for (key, help) in std::mem::take(&mut self.missing) {
            let mut unknown = unknown.keys();
            if !unknown.any(|name| nearest(name.get_ref(), [key]).is_some()) {
                let message = format!("missing key `{key}` in {}", self.place.name());
                self.reject_form(self.span, message, &help);
            }
        }
    }

    fn report_unknown_key(&self, key: &str, span: Span, value: &DeValue) {
        let is_root = matches!(self.place, Place::Root);
        let message = match value {
            _ if !is_root => format!("unknown key `{key}` in {}", self.place.name()),
            DeValue::Table(_) => format!("unknown table [{key}]"),
            DeValue::Array(all) if all.iter().any(|one| one.get_ref().is_table()) => {
                format!("unknown table [[{key}]]")
            }
            _ => format!("unknown key `{key}`"),
        };
        let help = if !is_root && self.reader.top_level.borrow().contains(&key) {
            format!("`{key}` belongs at the top of the file, above the first table")
        } else {
            let known = self.known.iter();
            suggestion(key, known.map(|(known, written)| (*known, written.clone())))
        };
        self.reject_form(span, message, &help);
    }
}

/// Returns the advice for an unknown name; each known name comes with how it is written.
fn suggestion(name: &str, known: impl Iterator<Item = (&'static str, String)>) -> String {
    let known: Vec<_> = known.collect();
    let near = nearest(name, known.iter().map(|(known, _)| *known));
    if let Some((_, written)) = known.iter().find(|(known, _)| Some(*known) == near) {
        return format!("did you mean {written}?");
    }
    let written: Vec<_> = known.iter().map(|(_, written)| written).collect();
    format!("expected {}", one_of(&written))
}
