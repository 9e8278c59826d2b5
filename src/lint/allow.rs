//! Comments `// toyproof: allow(W0005)`, which suppress warnings that the author accepts.
//!
//! At the end of a line, an `allow` covers that line; on a line of its own, the next statement, declaration
//! or directive; before all code, the whole file. Text after the `)` is the author's reason.

use toyproof_diagnostic::{Code, Diagnostic, Files, IN_MACRO, Span};
use toyproof_glsl::ControlComment;
use toyproof_glsl::tree::{Block, Item, Tree, walk};

/// The `allow`s of a shader.
#[derive(Debug, Default)]
pub(super) struct Allows {
    /// Sorted by the start of their scopes.
    all: Vec<Allow>,
}

/// One code that is allowed within one scope.
#[derive(Debug, Clone, Copy)]
struct Allow {
    code: Code,
    /// The span of the code's text.
    name: Span,
    /// The range of text that it covers.
    scope: Span,
}

impl Allows {
    /// Reads the `allow` comments of a file; appends warnings about malformed ones to `diagnostics`.
    pub(super) fn read(
        files: &Files,
        control_comments: &[ControlComment],
        tree: &Tree,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        if control_comments.is_empty() {
            return Self::default();
        }
        let extents = StatementExtents::new(tree);
        let mut all = Vec::new();
        for comment in control_comments {
            if is_for_formatter(files, *comment) {
                continue;
            }
            let scope = extents.scope_of(files, *comment);
            for name in code_spans(files, *comment, diagnostics) {
                match Code::ALL.iter().find(|code| code.as_str() == files.text(name)) {
                    Some(&code) if code.can_be_allowed() => all.push(Allow { code, name, scope }),
                    Some(_) => diagnostics.push(invalid_comment(name, "only warnings can be allowed")),
                    None => {
                        let message = format!("unknown warning `{}`", files.text(name));
                        diagnostics.push(invalid_comment(name, message));
                    }
                }
            }
        }
        all.sort_by_key(|allow| allow.scope.start);
        Self { all }
    }

    /// The allowed codes of warnings that arise while the shader runs, with their scopes.
    pub(super) fn runtime_allows(&self) -> Vec<(Code, Span)> {
        let runtime_allows = self.all.iter().filter(|allow| allow.code.is_of_runs());
        runtime_allows.map(|allow| (allow.code, allow.scope)).collect()
    }

    /// Removes the allowed warnings from `found`, and appends a warning for each `allow` that removed none.
    /// Codes of warnings that only arise at run time are exempt: their use is not known here.
    pub(super) fn filter(&self, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let mut used = vec![false; self.all.len()];
        let allowed = self.allowed(&found, &mut used);
        let unused = self.all.iter().zip(&used);
        let unused = unused.filter(|(allow, used)| !**used && !allow.code.is_of_runs());
        let unused = unused.map(|(allow, _)| {
            let message = format!("unused `allow({})`", allow.code);
            let diagnostic = Diagnostic::new(Code::UnusedAllow, message).at(allow.name);
            diagnostic.help("remove it")
        });
        let left = found.into_iter().zip(allowed).filter(|(_, allowed)| !allowed);
        left.map(|(diagnostic, _)| diagnostic).chain(unused).collect()
    }

    /// For each diagnostic, whether an `allow` covers it; sets `used` for each `allow` that does.
    fn allowed(&self, found: &[Diagnostic], used: &mut [bool]) -> Vec<bool> {
        let mut allowed = vec![false; found.len()];
        let mut places: Vec<(u32, usize)> = Vec::new();
        for (index, diagnostic) in found.iter().enumerate() {
            places.extend(diagnostic.span.map(|span| (span.start, index)));
            let in_macro = diagnostic.related.iter().filter(|(_, text)| text == IN_MACRO);
            places.extend(in_macro.map(|(span, _)| (span.start, index)));
        }
        places.sort_unstable();
        let mut waiting = self.all.iter().enumerate().peekable();
        // Scopes nest as statements do, so few are open at once.
        let mut open: Vec<usize> = Vec::new();
        for (place, index) in places {
            while let Some((allow, _)) = waiting.next_if(|(_, allow)| allow.scope.start <= place) {
                open.push(allow);
            }
            open.retain(|&allow| place < self.all[allow].scope.end);
            for &allow in &open {
                if self.all[allow].code == found[index].code {
                    used[allow] = true;
                    allowed[index] = true;
                }
            }
        }
        allowed
    }
}

fn invalid_comment(at: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::BadAllow, message)
        .at(at)
        .help("write `// toyproof: allow(W0005)`, with commas between several codes")
}

/// Whether a comment is `// toyproof: no-format`.
fn is_for_formatter(files: &Files, comment: ControlComment) -> bool {
    let text = files.text(comment.at).split_once(':');
    text.is_some_and(|(_, control)| control.split_whitespace().next() == Some("no-format"))
}

/// The spans of the codes between the parentheses.
fn code_spans(files: &Files, comment: ControlComment, diagnostics: &mut Vec<Diagnostic>) -> Vec<Span> {
    let text = files.text(comment.at);
    let inside = text
        .split_once(':')
        .map(|(_, rest)| rest.trim_start())
        .and_then(|rest| rest.strip_prefix("allow"))
        .and_then(|rest| rest.trim_start().strip_prefix('('))
        .and_then(|rest| rest.split_once(')'))
        .map(|(inside, _)| inside);
    let Some(inside) = inside else {
        diagnostics.push(invalid_comment(comment.at, "malformed `toyproof:` comment"));
        return Vec::new();
    };
    // `part` and `inside` are slices of `text`.
    let offset = |part: &str| (part.as_ptr() as usize - text.as_ptr() as usize) as u32 + comment.at.start;
    inside
        .split(',')
        .map(str::trim)
        .map(|name| Span::new(comment.at.file, offset(name), offset(name) + name.len() as u32))
        .collect()
}

/// The byte ranges of statements and declarations, sorted by start, and the longest first among equal starts.
struct StatementExtents(Vec<(u32, u32)>);

impl StatementExtents {
    fn new(tree: &Tree) -> Self {
        let mut all = Vec::new();
        for item in &tree.items {
            let (start, end) = match item {
                Item::Struct(id) => {
                    let last = tree[*id].members.last().map_or(tree[*id].at, |member| member.at);
                    (tree[*id].at.span, last.span.end)
                }
                Item::Variable(id) => {
                    let Some(at) = tree[*id].at else { continue };
                    let value = tree[*id].initializer.map_or(at, |value| tree[value].at);
                    (at.span, value.span.end.max(at.span.end))
                }
                Item::Prototype(id) => (tree[*id].at.span, tree[*id].at.span.end),
                Item::Function(id) => {
                    let at = tree[*id].at.span;
                    let body = tree[*id]
                        .body
                        .as_ref()
                        .map(|body| collect_statements(tree, body, &mut all));
                    (at, body.unwrap_or_default().max(at.end))
                }
            };
            all.push((start.start, end));
        }
        all.sort_unstable_by_key(|&(start, end)| (start, u32::MAX - end));
        Self(all)
    }

    /// The range of text that a comment covers.
    fn scope_of(&self, files: &Files, comment: ControlComment) -> Span {
        let text = files.get(comment.at.file).text();
        let line_end = |byte: u32| {
            let rest = &text[byte as usize..];
            byte + rest.find(['\n', '\r']).unwrap_or(rest.len()) as u32
        };
        let (start, end) = if comment.first {
            (0, text.len() as u32 + 1)
        } else if comment.alone {
            let after = comment.at.end;
            let end = directive_after(text, after).or_else(|| {
                let next = self.0.partition_point(|&(start, _)| start < after);
                self.0.get(next).map(|&(_, end)| end)
            });
            (after, line_end(end.unwrap_or(after)))
        } else {
            let line = text[..comment.at.start as usize].rfind(['\n', '\r']);
            (line.map_or(0, |newline| newline as u32 + 1), comment.at.start)
        };
        Span::new(comment.at.file, start, end)
    }
}

/// The start of the next directive after `after`, if nothing but line comments and white space precedes it.
fn directive_after(text: &str, after: u32) -> Option<u32> {
    let mut start = after as usize;
    loop {
        start += text[start..].find(|c: char| !c.is_whitespace())?;
        if !text[start..].starts_with("//") {
            break;
        }
        start += text[start..].find(['\n', '\r'])?;
    }
    text[start..].starts_with('#').then_some(start as u32)
}

/// Appends the range of each statement of a block, and returns the end of the last one.
fn collect_statements(tree: &Tree, block: &Block, all: &mut Vec<(u32, u32)>) -> u32 {
    let mut last = 0;
    for statement in block {
        let own = walk::own_expressions(tree, statement);
        let own = own.into_iter().map(|expr| tree[expr].at.span.end);
        let mut end = own.fold(statement.at.span.end, u32::max);
        for body in walk::child_blocks(statement) {
            end = end.max(collect_statements(tree, body, all));
        }
        all.push((statement.at.span.start, end));
        last = last.max(end);
    }
    last
}
