//! `#include` (as `GL_GOOGLE_include_directive` and glslViewer have it): the text of a file in place of the
//! directive. Conditions and macros decide which directives are executed, as in C.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::{Code, Deadline, Diagnostic, Diagnostics, FileId, Files, Span, grouped};

use super::lexer::Lexer;
use super::{Preprocessor, source_tokens};
use crate::dialect::Wrapping;
use crate::stage::Stage;
use crate::token::{Punctuator, TokenKind};
use crate::tree::Place;

/// Maximum nesting depth of included files.
const MAX_INCLUDE_DEPTH: usize = 64;

/// Maximum number of executed `#include` directives.
const MAX_INCLUDES: usize = 10_000;

/// Maximum number of files, whose texts the caller reads.
const MAX_INCLUDED_FILES: usize = 1000;

/// Maximum size in bytes of a text with those that it includes.
const MAX_TEXT_BYTES: usize = 4 << 20;

/// Maximum size in bytes of all texts that are read, a text once for each inclusion.
const MAX_READ_BYTES: usize = 64 << 20;

/// Reads an included file, adds it to the files, and returns its id, which is the same for the same file.
/// Takes the id of the including file and the path as it is written; an error is the reason.
pub type ReadInclude<'r> = dyn FnMut(&mut Files, FileId, &str) -> Result<FileId, String> + 'r;

/// Adds the text in which included files replace their directives, and returns its id; that of the file
/// itself if it includes none. Spans in the text are reported as those of the files.
///
/// # Errors
/// A file cannot be read, or a limit is exceeded. Other errors of the text are left to its check.
pub(crate) fn with_includes(
    files: &mut Files,
    file: FileId,
    stage: Stage,
    wrapping: Wrapping,
    deadline: &Deadline,
    read: &mut ReadInclude,
) -> Result<FileId, Diagnostics> {
    let found = Found::new(files, file, read);
    if found.0.is_empty() {
        return Ok(file);
    }
    let mut preprocessor = Preprocessor::new(files, file, stage, wrapping);
    preprocessor.inclusion = Some(Inclusion::new(files, file, &found));
    while preprocessor.next_of_text().kind != TokenKind::End && !deadline.is_over() {
        if let Some(inclusion) = &mut preprocessor.inclusion {
            inclusion.effects += 1;
        }
    }
    let end = preprocessor.text.len() as u32;
    let mut inclusion = preprocessor.inclusion.take().expect("it was set above");
    if !inclusion.errors.is_empty() {
        let errors = inclusion.errors;
        return Err(Diagnostics::new(errors, files));
    }
    inclusion.add_part(end);
    let name = files.get(file).name().to_owned();
    let parts = inclusion.parts;
    Ok(files.join_parts(name, &parts, ""))
}

/// The included files, by the file that includes them and the path as it is written. Those of directives that
/// conditions skip are among them.
struct Found(HashMap<(FileId, String), Result<FileId, String>>);

impl Found {
    fn new(files: &mut Files, file: FileId, read: &mut ReadInclude) -> Self {
        let mut found = HashMap::new();
        let mut pending = vec![file];
        let mut known = pending.clone();
        while let Some(file) = pending.pop() {
            for (from, path) in directives(files, file) {
                let key = (from, path);
                if found.contains_key(&key) {
                    continue;
                }
                let included = if known.len() > MAX_INCLUDED_FILES {
                    Err(format!(
                        "more than {} files are included",
                        grouped(MAX_INCLUDED_FILES as u64)
                    ))
                } else {
                    read(files, from, &key.1)
                };
                if let Ok(file) = included
                    && !known.contains(&file)
                {
                    known.push(file);
                    pending.push(file);
                }
                found.insert(key, included);
            }
        }
        Self(found)
    }
}

/// The directives of a text, each with the file in which it stands.
fn directives(files: &Files, file: FileId) -> Vec<(FileId, String)> {
    let text = files.get(file).text();
    if !text.contains("include") {
        return Vec::new();
    }
    let (tokens, interner) = source_tokens(files, file);
    let mut found = Vec::new();
    let lines = tokens.split(|token| token.kind == TokenKind::Newline);
    for line in lines {
        let word = |at: usize| match line.get(at)?.kind {
            TokenKind::Word(word) => Some(interner.text(word)),
            _ => None,
        };
        if !matches!(line.first(), Some(hash) if hash.kind == TokenKind::Punctuator(Punctuator::Hash)) {
            continue;
        }
        let last = match (word(1), word(2)) {
            (Some("include"), _) => line[1].at.span,
            (Some("pragma"), Some("include")) => line[2].at.span,
            _ => continue,
        };
        let rest = text[last.end as usize..].lines().next().unwrap_or_default();
        if let Some(path) = path(rest) {
            found.push((files.origin(last).file, path.to_owned()));
        }
    }
    found
}

/// The path in `"path"` or `<path>`, which comments may follow.
fn path(text: &str) -> Option<&str> {
    let text = text.trim();
    let close = match text.chars().next()? {
        '"' => '"',
        '<' => '>',
        _ => return None,
    };
    let (path, after) = text[1..].split_once(close)?;
    let after = after.trim_start();
    let is_end = after.is_empty() || after.starts_with("//") || after.starts_with("/*");
    (is_end && !path.is_empty()).then_some(path)
}

/// A text that waits for the end of one that it includes.
struct Outer<'a> {
    file: FileId,
    text: &'a str,
    lexer: Lexer<'a>,
    counted: (usize, i64),
    /// The numbers of parts and of effects in front of the included text.
    parts: usize,
    effects: usize,
    /// The size of the text in front of the included one.
    size: usize,
}

/// The state of inclusions.
pub(super) struct Inclusion<'a> {
    files: &'a Files,
    found: &'a Found,
    /// The texts around the current one, innermost last.
    outer: Vec<Outer<'a>>,
    /// The file that is read, and the byte up to which it is in the parts.
    file: FileId,
    from: u32,
    parts: Vec<Span>,
    /// The size of the parts, and of all texts that were read.
    size: usize,
    read: usize,
    /// The number of active tokens and of directives that change what follows. A text without any is left
    /// out: another inclusion of a file with a guard.
    effects: usize,
    /// The number of definitions of macros.
    definitions: usize,
    /// Files whose inclusion had no effect, after that number of definitions: it has none again.
    ineffective: HashMap<FileId, usize>,
    /// Files with `#pragma once`.
    once: HashSet<FileId>,
    executed: usize,
    errors: Vec<Diagnostic>,
}

impl<'a> Inclusion<'a> {
    fn new(files: &'a Files, file: FileId, found: &'a Found) -> Self {
        Self {
            files,
            found,
            outer: Vec::new(),
            file,
            from: 0,
            parts: Vec::new(),
            size: 0,
            read: 0,
            effects: 0,
            definitions: 0,
            ineffective: HashMap::new(),
            once: HashSet::new(),
            executed: 0,
            errors: Vec::new(),
        }
    }

    /// Adds the current file up to a byte.
    fn add_part(&mut self, end: u32) {
        let part = Span::new(self.file, self.from, end);
        self.size += (part.end - part.start) as usize;
        self.parts.push(part);
    }

    /// Notes an active directive other than conditions.
    pub(super) fn note_directive(&mut self, name: &str) {
        self.effects += 1;
        self.definitions += usize::from(matches!(name, "define" | "undef"));
    }

    /// The names of the files that include each other up to a file that includes itself.
    fn cycle(&self, file: FileId) -> Option<String> {
        let open: Vec<FileId> = self
            .outer
            .iter()
            .map(|outer| outer.file)
            .chain([self.file])
            .collect();
        let first = open.iter().position(|&one| one == file)?;
        let names = open[first..]
            .iter()
            .chain([&file])
            .map(|&file| self.files.get(file).name());
        Some(names.take(8).collect::<Vec<_>>().join(" → "))
    }

    /// The file of a directive; `None` if it has no effect.
    fn resolve(&mut self, rest: &str, at: Place) -> Result<Option<FileId>, Diagnostic> {
        let refuse = |message: String| Code::BadInclude.at(at, message);
        let Some(path) = path(rest) else {
            let refused = refuse("malformed `#include`".to_owned());
            return Err(refused.help("write `#include \"file.glsl\"`"));
        };
        let from = self.files.origin(at.span).file;
        let file = match self.found.0.get(&(from, path.to_owned())) {
            Some(Ok(file)) => *file,
            Some(Err(reason)) => return Err(refuse(reason.clone())),
            None => return Err(refuse(format!("`{path}` cannot be read here"))),
        };
        self.executed += 1;
        if self.once.contains(&file) || self.ineffective.get(&file) == Some(&self.definitions) {
            return Ok(None);
        }
        if self.outer.len() == MAX_INCLUDE_DEPTH {
            let message = format!("files include each other more than {MAX_INCLUDE_DEPTH} deep");
            let refused = refuse(message);
            return Err(match self.cycle(file) {
                Some(cycle) => refused
                    .note(cycle)
                    .help("put a guard around the text: `#ifndef`, `#define`, `#endif`"),
                None => refused,
            });
        }
        if self.executed > MAX_INCLUDES {
            return Err(refuse(format!(
                "more than {} files are included",
                grouped(MAX_INCLUDES as u64)
            )));
        }
        self.read += self.files.get(file).text().len();
        if self.size > MAX_TEXT_BYTES || self.read > MAX_READ_BYTES {
            let megabytes = MAX_TEXT_BYTES >> 20;
            return Err(refuse(format!(
                "the text with all included ones is larger than {megabytes} MB"
            )));
        }
        Ok(Some(file))
    }
}

impl Preprocessor<'_> {
    /// Executes `#include` or `#pragma`, whose name has been read.
    pub(super) fn on_include(&mut self, name: &str, at: Place) {
        if name == "include" {
            self.include(at);
            return;
        }
        let next = self.lex();
        match next.kind {
            TokenKind::Word(word) if self.interner.text(word) == "include" => self.include(at.to(next.at)),
            TokenKind::Newline | TokenKind::End => {}
            kind => {
                self.rest_of_line();
                if let (TokenKind::Word(word), Some(inclusion)) = (kind, &mut self.inclusion)
                    && self.interner.text(word) == "once"
                {
                    inclusion.once.insert(inclusion.file);
                }
            }
        }
    }

    /// Executes a directive that ends at `at` without its path. The end of its line remains.
    fn include(&mut self, at: Place) {
        let rest = self.lexer.rest_of_line();
        let Some(inclusion) = &mut self.inclusion else {
            return;
        };
        let after = self.lexer.place().span.start;
        let file = match inclusion.resolve(&rest, at) {
            Ok(file) => file,
            Err(error) => {
                // Further errors would be those of the texts that are missing.
                inclusion.errors.push(error);
                None
            }
        };
        let parts = inclusion.parts.len();
        inclusion.add_part(at.span.start);
        inclusion.from = after;
        let Some(file) = file.filter(|_| inclusion.errors.is_empty()) else {
            return;
        };
        let text = inclusion.files.get(file).text();
        let outer = Outer {
            file: std::mem::replace(&mut inclusion.file, file),
            text: std::mem::replace(&mut self.text, text),
            lexer: std::mem::replace(&mut self.lexer, Lexer::new(file, text)),
            counted: std::mem::replace(&mut self.counted, (0, 1)),
            parts: parts + 1,
            effects: inclusion.effects,
            size: inclusion.size,
        };
        inclusion.from = 0;
        inclusion.outer.push(outer);
    }

    /// Returns from the end of an included text to the one that includes it; whether there is one.
    pub(super) fn end_include(&mut self) -> bool {
        let end = self.text.len() as u32;
        let Some(inclusion) = &mut self.inclusion else {
            return false;
        };
        let Some(outer) = inclusion.outer.pop() else {
            return false;
        };
        inclusion.add_part(end);
        if inclusion.effects == outer.effects {
            inclusion.parts.truncate(outer.parts);
            inclusion.size = outer.size;
            inclusion
                .ineffective
                .insert(inclusion.file, inclusion.definitions);
        }
        inclusion.file = outer.file;
        inclusion.from = outer.lexer.place().span.start;
        self.text = outer.text;
        self.lexer = outer.lexer;
        self.counted = outer.counted;
        true
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;

    use super::*;
    use crate::{Options, with_includes};

    /// The text of the first file with the others included, which are found by their names.
    fn included(texts: &[(&str, &str)]) -> Result<(Files, FileId), String> {
        let mut files = Files::default();
        let ids: Vec<_> = texts
            .iter()
            .map(|&(name, text)| files.add(File::new(name, text)))
            .collect();
        let mut read = |_: &mut Files, _: FileId, path: &str| {
            let at = texts.iter().position(|(name, _)| *name == path);
            at.map(|at| ids[at]).ok_or_else(|| format!("no {path}"))
        };
        let joined = with_includes(&mut files, ids[0], &Options::default(), &mut read);
        joined
            .map(|joined| (files, joined))
            .map_err(|errors| errors.to_string())
    }

    fn text(texts: &[(&str, &str)]) -> String {
        let (files, joined) = included(texts).unwrap();
        files.get(joined).text().to_owned()
    }

    #[test]
    fn texts_replace_their_directives() {
        assert_eq!(
            text(&[("a", "x\n#include \"b\" // c\ny"), ("b", "1\n")]),
            "x\n1\n\ny"
        );
        assert_eq!(text(&[("a", "#pragma include <b>\ny"), ("b", "1")]), "1\ny");
        assert_eq!(text(&[("a", "x\n"), ("b", "1")]), "x\n");
        // Conditions decide; macros of an included text count.
        assert_eq!(
            text(&[("a", "#if 0\n#include \"b\"\n#endif\ny")]),
            "#if 0\n#include \"b\"\n#endif\ny"
        );
        let defines = [
            ("a", "#include \"b\"\n#ifdef B\n#include \"c\"\n#endif"),
            ("b", "#define B"),
            ("c", "3"),
        ];
        assert_eq!(text(&defines), "#define B\n#ifdef B\n3\n#endif");
        // In a comment it is none.
        assert_eq!(
            text(&[("a", "/*\n#include \"b\"\n*/"), ("b", "1")]),
            "/*\n#include \"b\"\n*/"
        );
    }

    #[test]
    fn a_guarded_text_is_included_once() {
        let guarded = "#ifndef B\n#define B\n1\n#endif\n";
        let twice = text(&[("a", "#include \"b\"\n#include \"b\"\n"), ("b", guarded)]);
        assert_eq!(twice, format!("{guarded}\n\n"));
        let once = [
            ("a", "#include \"b\"\n#include \"b\"\n"),
            ("b", "#pragma once\n1\n"),
        ];
        assert_eq!(text(&once), "#pragma once\n1\n\n\n");
        // Each of 40 files includes the next one twice.
        let names: Vec<String> = (0..41).map(|level| format!("f{level}")).collect();
        let level = |at: usize| {
            format!(
                "#include \"f{0}\"\n#include \"f{0}\"\n#ifndef F{at}\n#define F{at}\n#endif\n",
                at + 1
            )
        };
        let texts: Vec<String> = (0..40).map(level).chain(["last\n".to_owned()]).collect();
        let mut all: Vec<(&str, &str)> = names
            .iter()
            .zip(&texts)
            .map(|(name, text)| (&**name, &**text))
            .collect();
        all[40].1 = "#ifndef LAST\n#define LAST\n#endif";
        assert!(text(&all).len() < 10_000);
    }

    #[test]
    fn errors_are_in_the_file_of_the_directive() {
        let error = |texts: &[(&str, &str)]| included(texts).map(|_| ()).unwrap_err();
        assert_eq!(error(&[("a", "x\n#include \"c\"")]), "a:2:1: error[E0014]: no c");
        assert_eq!(
            error(&[("a", "#include \"b\""), ("b", "\n\n #include \"c\"")]),
            "b:3:2: error[E0014]: no c"
        );
        let itself = error(&[("a", "#include \"b\""), ("b", "#include \"a\"")]);
        assert!(itself.contains("more than 64 deep"), "{itself}");
        let exponential: Vec<(String, String)> = (0..60)
            .map(|at| {
                (
                    format!("f{at}"),
                    format!("x\n#include \"f{0}\"\n#include \"f{0}\"\n", (at + 1).min(59)),
                )
            })
            .collect();
        let texts: Vec<_> = exponential
            .iter()
            .map(|(name, text)| (&**name, &**text))
            .collect();
        let error = error(&texts);
        assert!(
            error.contains("64 deep") || error.contains("10,000 files"),
            "{error}"
        );
    }
}
