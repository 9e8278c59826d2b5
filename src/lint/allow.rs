//! `// toyproof: allow(W0005)`: what the author knows, and does not want to be told.
//!
//! At the end of a line it holds for that line, on a line of its own for the next statement, declaration or directive, and before
//! all else for the whole file. Words behind the `)` are the author's reason.

use toyproof_diagnostic::{Diagnostic, Files, Span};
use toyproof_glsl::tree::{Block, Item, Tree, walk};
use toyproof_glsl::{Code, IN_MACRO, Remark};

/// The `allow`s of a shader.
#[derive(Debug, Default)]
pub(super) struct Allows {
    /// In the order of where they begin.
    all: Vec<Allow>,
}

/// One code that is allowed somewhere.
#[derive(Debug, Clone, Copy)]
struct Allow {
    code: Code,
    /// The code's own characters.
    name: Span,
    /// Where it holds.
    over: Span,
}

impl Allows {
    /// Reads the remarks of a file; what is wrong with them goes to `told`.
    pub(super) fn read(files: &Files, remarks: &[Remark], tree: &Tree, told: &mut Vec<Diagnostic>) -> Self {
        if remarks.is_empty() {
            return Self::default();
        }
        let extents = Extents::of(tree);
        let mut all = Vec::new();
        for remark in remarks {
            let over = extents.reach(files, *remark);
            for name in names(files, *remark, told) {
                match Code::ALL.iter().find(|code| code.as_str() == files.text(name)) {
                    Some(&code) if code.can_be_allowed() => all.push(Allow { code, name, over }),
                    Some(_) => told.push(bad(name, "only warnings about the shader can be allowed")),
                    None => {
                        let message = format!("there is no warning `{}`", files.text(name));
                        told.push(bad(name, message));
                    }
                }
            }
        }
        all.sort_by_key(|allow| allow.over.start);
        Self { all }
    }

    /// What they allow of what is seen while the shader runs, and where.
    pub(super) fn of_runs(&self) -> Vec<(Code, Span)> {
        let of_runs = self.all.iter().filter(|allow| allow.code.is_of_runs());
        of_runs.map(|allow| (allow.code, allow.over)).collect()
    }

    /// What is left of these warnings, each `allow` that none of them needed told beside them; whether a run needs one, a run tells.
    pub(super) fn sift(&self, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let mut used = vec![false; self.all.len()];
        let allowed = self.allowed(&found, &mut used);
        let unused = self.all.iter().zip(&used);
        let unused = unused.filter(|(allow, used)| !**used && !allow.code.is_of_runs());
        let unused = unused.map(|(allow, _)| {
            let message = format!("nothing here needs `allow({})`", allow.code.as_str());
            Diagnostic::warning(Code::UnusedAllow.as_str(), message).at(allow.name)
        });
        let left = found.into_iter().zip(allowed).filter(|(_, allowed)| !allowed);
        left.map(|(diagnostic, _)| diagnostic).chain(unused).collect()
    }

    /// Which are allowed; marks what allowed them.
    fn allowed(&self, found: &[Diagnostic], used: &mut [bool]) -> Vec<bool> {
        let mut allowed = vec![false; found.len()];
        let mut places: Vec<(u32, usize)> = Vec::new();
        for (index, diagnostic) in found.iter().enumerate() {
            places.extend(diagnostic.span.map(|span| (span.start, index)));
            let in_macro = diagnostic.related.iter().filter(|(_, words)| words == IN_MACRO);
            places.extend(in_macro.map(|(span, _)| (span.start, index)));
        }
        places.sort_unstable();
        let mut waiting = self.all.iter().enumerate().peekable();
        // They nest as statements do, so that few are open at once.
        let mut open: Vec<usize> = Vec::new();
        for (place, index) in places {
            while let Some((allow, _)) = waiting.next_if(|(_, allow)| allow.over.start <= place) {
                open.push(allow);
            }
            open.retain(|&allow| place < self.all[allow].over.end);
            for &allow in &open {
                if self.all[allow].code.as_str() == found[index].code {
                    used[allow] = true;
                    allowed[index] = true;
                }
            }
        }
        allowed
    }
}

fn bad(at: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::warning(Code::BadAllow.as_str(), message)
        .at(at)
        .note("it is written `// toyproof: allow(W0005)`; several codes are parted by commas")
}

/// The places of the codes between the parentheses.
fn names(files: &Files, remark: Remark, told: &mut Vec<Diagnostic>) -> Vec<Span> {
    let text = files.text(remark.at);
    let inside = text
        .split_once(':')
        .map(|(_, rest)| rest.trim_start())
        .and_then(|rest| rest.strip_prefix("allow"))
        .and_then(|rest| rest.trim_start().strip_prefix('('))
        .and_then(|rest| rest.split_once(')'))
        .map(|(inside, _)| inside);
    let Some(inside) = inside else {
        told.push(bad(remark.at, "this remark to toyproof is not understood"));
        return Vec::new();
    };
    // Both are slices of one text.
    let offset = |part: &str| (part.as_ptr() as usize - text.as_ptr() as usize) as u32 + remark.at.start;
    inside
        .split(',')
        .map(str::trim)
        .map(|name| Span::new(remark.at.file, offset(name), offset(name) + name.len() as u32))
        .collect()
}

/// Where statements and declarations begin and end, in bytes; in order, and of those that begin together the longest first.
struct Extents(Vec<(u32, u32)>);

impl Extents {
    fn of(tree: &Tree) -> Self {
        let mut all = Vec::new();
        for item in &tree.items {
            let (start, end) = match item {
                Item::Struct(id) => {
                    let last = tree[*id].members.last().map_or(tree[*id].at, |member| member.at);
                    (tree[*id].at.span, last.span.end)
                }
                Item::Variable(id) => {
                    let Some(at) = tree[*id].at else { continue };
                    let value = tree[*id].initialiser.map_or(at, |value| tree[value].at);
                    (at.span, value.span.end.max(at.span.end))
                }
                Item::Prototype(id) => (tree[*id].at.span, tree[*id].at.span.end),
                Item::Function(id) => {
                    let at = tree[*id].at.span;
                    let body = tree[*id]
                        .body
                        .as_ref()
                        .map(|body| statements(tree, body, &mut all));
                    (at, body.unwrap_or_default().max(at.end))
                }
            };
            all.push((start.start, end));
        }
        all.sort_unstable_by_key(|&(start, end)| (start, u32::MAX - end));
        Self(all)
    }

    /// Where a remark holds.
    fn reach(&self, files: &Files, remark: Remark) -> Span {
        let text = files.get(remark.at.file).text();
        let line_end = |byte: u32| {
            let rest = &text[byte as usize..];
            byte + rest.find(['\n', '\r']).unwrap_or(rest.len()) as u32
        };
        let (start, end) = if remark.first {
            (0, text.len() as u32 + 1)
        } else if remark.alone {
            let after = remark.at.end;
            let end = directive_after(text, after).or_else(|| {
                let next = self.0.partition_point(|&(start, _)| start < after);
                self.0.get(next).map(|&(_, end)| end)
            });
            (after, line_end(end.unwrap_or(after)))
        } else {
            let line = text[..remark.at.start as usize].rfind(['\n', '\r']);
            (line.map_or(0, |newline| newline as u32 + 1), remark.at.start)
        };
        Span::new(remark.at.file, start, end)
    }
}

/// The first byte of the directive that the next line with anything on it is, if it is one.
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

/// Notes each statement of a block; gives where the last one ends.
fn statements(tree: &Tree, block: &Block, all: &mut Vec<(u32, u32)>) -> u32 {
    let mut last = 0;
    for statement in block {
        let own = walk::own_expressions(tree, statement);
        let own = own.into_iter().map(|expr| tree[expr].at.span.end);
        let mut end = own.fold(statement.at.span.end, u32::max);
        for body in walk::inner(statement) {
            end = end.max(statements(tree, body, all));
        }
        all.push((statement.at.span.start, end));
        last = last.max(end);
    }
    last
}
