//! The tokens of an author's file, and the comments between them.

use toyproof_diagnostic::{FileId, Files};
use toyproof_glsl::tree::Place;
use toyproof_glsl::{Lexeme, lexemes};

use super::comment_text::comment_lines;

/// What becomes of a comment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fate {
    /// It is written before what follows it.
    Pending,
    /// It is written with the constant that its macro becomes.
    OfMacro,
    /// It is written, or belongs to code that is not.
    Done,
}

/// A comment of the author.
#[derive(Debug)]
pub(super) struct Comment {
    pub(super) start: usize,
    pub(super) end: usize,
    /// The index of the token after it.
    pub(super) next: usize,
    /// Whether it is the last on the line of a token.
    pub(super) is_trailing: bool,
    pub(super) after_blank_line: bool,
    pub(super) before_blank_line: bool,
    pub(super) fate: Fate,
}

/// A file as tokens and comments. Brackets in directives and in code that is not compiled do not count.
pub(super) struct SourceLayout<'a> {
    pub(super) text: &'a str,
    pub(super) tokens: Vec<Lexeme>,
    pub(super) comments: Vec<Comment>,
    /// The first and last tokens of the declarations at global scope.
    pub(super) declarations: Vec<[usize; 2]>,
    /// The first of the comments that may be written before each of them, and after the last.
    pub(super) regions: Vec<usize>,
    /// The partner of each bracket; other tokens are their own.
    pub(super) partners: Vec<usize>,
    /// The first `,` or `;` after each token that is not in brackets.
    declarator_ends: Vec<usize>,
    /// The brace that closes the block around each token; past the last token, if there is none.
    pub(super) closing: Vec<usize>,
}

impl<'a> SourceLayout<'a> {
    /// Reads a file; `compiled` has the sorted positions in it that the tree refers to.
    pub(super) fn new(files: &'a Files, file: FileId, compiled: &[usize]) -> Self {
        let tokens = lexemes(files, file);
        let text = files.get(file).text();
        let count = tokens.len();
        let mut layout = Self {
            text,
            comments: comments(text, &tokens),
            tokens,
            declarations: Vec::new(),
            regions: Vec::new(),
            partners: (0..count).collect(),
            declarator_ends: vec![count; count],
            closing: vec![count; count],
        };
        let is_skipped = layout.skipped_tokens(compiled);
        for comment in &mut layout.comments {
            // A comment before the directive that ends the skipped lines is among them.
            let before = comment.next.checked_sub(1);
            let is_dropped = before.is_some_and(|before| {
                is_skipped[before] || layout.tokens[before].is_in_directive && comment.is_trailing
            });
            if is_dropped || is_skipped.get(comment.next).is_some_and(|&skipped| skipped) {
                comment.fate = Fate::Done;
            }
        }
        layout.match_brackets(&is_skipped);
        layout
    }

    pub(super) fn token(&self, index: usize) -> &'a str {
        self.tokens.get(index).map_or("", |token| {
            &self.text[token.span.start as usize..token.span.end as usize]
        })
    }

    /// Where a token begins; past the last one, the end of the text.
    pub(super) fn start(&self, index: usize) -> usize {
        let token = self.tokens.get(index);
        token.map_or(self.text.len(), |token| token.span.start as usize)
    }

    /// The index of the first token that ends after a byte.
    pub(super) fn index_at(&self, byte: usize) -> usize {
        self.tokens
            .partition_point(|token| token.span.end as usize <= byte)
    }

    /// The index of the first comment before a token or after it.
    pub(super) fn first_comment(&self, token: usize) -> usize {
        self.comments.partition_point(|comment| comment.next < token)
    }

    /// The indices of the comments directly before a token.
    pub(super) fn comments_before(&self, token: usize) -> std::ops::Range<usize> {
        self.first_comment(token)..self.first_comment(token + 1)
    }

    /// The index of the first of the comments that no blank line separates from a token on a later line.
    pub(super) fn adjacent_comments(&self, token: usize) -> std::ops::Range<usize> {
        let all = self.comments_before(token);
        let mut first = all.end;
        for index in all.clone().rev() {
            if self.comments[index].before_blank_line || self.comments[index].is_trailing {
                break;
            }
            first = index;
        }
        first..all.end
    }

    /// Whether the line above a token, or above the comments directly before it, is blank.
    pub(super) fn follows_blank_line(&self, token: usize) -> bool {
        let from = match (self.comments_before(token).last(), token.checked_sub(1)) {
            (Some(comment), _) => self.comments[comment].end,
            (None, Some(before)) => self.tokens[before].span.end as usize,
            (None, None) => return false,
        };
        has_blank_line(&self.text[from..self.start(token)])
    }

    /// The index of the `,` or `;` that ends the declarator to which a token belongs.
    pub(super) fn declarator_end(&self, token: usize) -> usize {
        self.declarator_ends
            .get(token)
            .copied()
            .unwrap_or(self.tokens.len())
    }

    /// The last token of a statement, of its head, or of the declarator with a name.
    pub(super) fn last_token(&self, at: Place, name: Option<Place>) -> usize {
        if let Some(name) = name.filter(|name| name.span.file == at.span.file) {
            return self.declarator_end(self.index_at(name.span.start as usize));
        }
        let last = self.index_at((at.span.end as usize).saturating_sub(1));
        match self.token(last + 1) {
            "(" if self.token(last) != ";" => self.partners[last + 1],
            ";" => last + 1,
            _ => last,
        }
    }

    /// The indices of the comments directly above the `#define` of the text at a byte, and of those that end
    /// its line.
    pub(super) fn of_macro(&self, byte: usize) -> Vec<usize> {
        let Some(line) = self.tokens.get(self.index_at(byte)).map(|token| token.line) else {
            return Vec::new();
        };
        let hash = self.tokens.partition_point(|token| token.line < line);
        let next = self.tokens.partition_point(|token| token.line <= line);
        let behind = self.comments_before(next);
        let behind = behind.filter(|&index| self.comments[index].is_trailing);
        self.adjacent_comments(hash).chain(behind).collect()
    }

    /// Marks the comments of the macro that is defined at a byte, which are written where the macro is.
    pub(super) fn mark_macro(&mut self, byte: usize) {
        for index in self.of_macro(byte) {
            self.comments[index].fate = Fate::OfMacro;
        }
    }

    pub(super) fn is_in_directive(&self, byte: usize) -> bool {
        let token = self.tokens.get(self.index_at(byte));
        token.is_some_and(|token| token.is_in_directive)
    }

    /// Makes the directives at these bytes, of macros that become functions, declarations; returns those inside
    /// of other declarations, which stay parts of them, and the others.
    pub(super) fn declare_macros(&mut self, bytes: Vec<usize>) -> (Vec<usize>, Vec<usize>) {
        let is_inside = |&byte: &usize| {
            let name = self.index_at(byte);
            let at = self.declarations.partition_point(|&[_, last]| last < name);
            self.declarations.get(at).is_some_and(|&[first, _]| first < name)
        };
        let (inside, outside): (Vec<_>, Vec<_>) = bytes.into_iter().partition(is_inside);
        for &byte in &outside {
            let line = self.tokens[self.index_at(byte)].line;
            let first = self.tokens.partition_point(|token| token.line < line);
            let next = self.tokens.partition_point(|token| token.line <= line);
            self.declarations.push([first, next - 1]);
            for index in self.comments_before(next) {
                if self.comments[index].is_trailing {
                    self.comments[index].fate = Fate::Pending;
                }
            }
        }
        // A macro may be several functions.
        self.declarations.sort_unstable();
        self.declarations.dedup();
        (inside, outside)
    }

    /// Leaves out the comments of the declarations that contain none of the `written` places.
    pub(super) fn leave_out_others(&mut self, written: &[usize]) {
        let mut is_written = vec![false; self.declarations.len()];
        for &place in written {
            let token = self.index_at(place);
            let declaration = self.declarations.partition_point(|&[_, last]| last < token);
            if let Some(is_written) = is_written.get_mut(declaration) {
                *is_written = true;
            }
        }
        let mut region = 0;
        for (&[first, last], is_written) in self.declarations.iter().zip(is_written) {
            self.regions.push(region);
            let behind = self.comments_before(last + 1);
            let behind = behind.start + behind.filter(|&index| self.comments[index].is_trailing).count();
            if is_written {
                region = behind;
                continue;
            }
            let from = self.adjacent_comments(first).start;
            for comment in &mut self.comments[from..behind] {
                comment.fate = Fate::Done;
            }
        }
        self.regions.push(region);
    }

    /// Appends a comment, with the blank lines around it, and marks it as written.
    pub(super) fn write(&mut self, index: usize, lines: &mut Vec<String>) {
        let text = self.text;
        let comment = &mut self.comments[index];
        comment.fate = Fate::Done;
        if comment.after_blank_line && lines.last().is_none_or(|line| !line.is_empty()) {
            lines.push(String::new());
        }
        lines.extend(comment_lines(&text[comment.start..comment.end]));
        if comment.before_blank_line {
            lines.push(String::new());
        }
    }

    /// Writes the comments that end the line of a token, as one.
    pub(super) fn write_behind(&mut self, token: usize) -> Option<String> {
        let mut lines = Vec::new();
        for index in self.comments_before(token + 1) {
            if self.comments[index].is_trailing && self.comments[index].fate == Fate::Pending {
                self.write(index, &mut lines);
            }
        }
        lines.retain(|line| !line.is_empty());
        (!lines.is_empty()).then(|| lines.join(" "))
    }

    /// Which tokens are in the lines of a conditional directive that are not compiled.
    fn skipped_tokens(&self, compiled: &[usize]) -> Vec<bool> {
        // How many groups begin at a token, less those that end there.
        let mut changes = vec![0_i32; self.tokens.len()];
        let mut groups: Vec<usize> = Vec::new();
        for hash in 0..self.tokens.len() {
            let line = self.tokens[hash].line;
            let begins_line = hash == 0 || self.tokens[hash - 1].line != line;
            if !(begins_line && self.tokens[hash].is_in_directive) {
                continue;
            }
            let directive = self.token(hash + 1);
            if matches!(directive, "elif" | "else" | "endif")
                && let Some(begin) = groups.pop()
            {
                let first = compiled.partition_point(|&at| at < self.start(begin));
                if compiled.get(first).is_none_or(|&at| at > self.start(hash)) {
                    changes[begin] += 1;
                    changes[hash] -= 1;
                }
            }
            if matches!(directive, "if" | "ifdef" | "ifndef" | "elif" | "else") {
                let of_line = self.tokens[hash..].iter().take_while(|token| token.line == line);
                groups.push(hash + of_line.count());
            }
        }
        let mut depth = 0;
        let depths = changes.into_iter().map(|change| {
            depth += change;
            depth
        });
        depths.map(|depth| depth > 0).collect()
    }

    fn match_brackets(&mut self, is_skipped: &[bool]) {
        let mut open: Vec<usize> = Vec::new();
        let mut braces: Vec<usize> = Vec::new();
        // The brace that opens the block around each token.
        let mut opening = vec![None; self.tokens.len()];
        let mut begin = None;
        for (index, token) in self.tokens.iter().enumerate() {
            opening[index] = braces.last().copied();
            if token.is_in_directive || is_skipped[index] {
                continue;
            }
            let first = *begin.get_or_insert(index);
            let text = &self.text[token.span.start as usize..token.span.end as usize];
            match text {
                "(" | "[" => open.push(index),
                "{" => {
                    open.push(index);
                    braces.push(index);
                }
                ")" | "]" => {
                    if let Some(partner) = open.pop_if(|&mut partner| Some(&partner) != braces.last()) {
                        self.partners[partner] = index;
                        self.partners[index] = partner;
                    }
                }
                "}" => {
                    if let Some(partner) = braces.pop() {
                        open.truncate(open.partition_point(|&other| other < partner));
                        opening[index] = braces.last().copied();
                        self.partners[partner] = index;
                        self.partners[index] = partner;
                    }
                }
                _ => {}
            }
            let partner = self.partners[index];
            let ends_body = text == "}" && partner > 0 && self.token(partner - 1) == ")";
            if open.is_empty() && (text == ";" || ends_body) {
                match self.declarations.last_mut() {
                    // A `;` alone.
                    Some(last) if first == index => last[1] = index,
                    _ => self.declarations.push([first, index]),
                }
                begin = None;
            }
        }
        for index in (0..self.tokens.len()).rev() {
            let after_brackets = self.partners[index].max(index) + 1;
            self.declarator_ends[index] = match self.token(index) {
                "," | ";" => index,
                _ => self.declarator_end(after_brackets),
            };
        }
        for (closing, opening) in self.closing.iter_mut().zip(opening) {
            if let Some(brace) = opening {
                let partner = self.partners[brace];
                *closing = if partner > brace { partner } else { *closing };
            }
        }
    }
}

/// Whether there is a blank line in the blanks between two tokens or comments.
fn has_blank_line(blanks: &str) -> bool {
    blanks.matches('\n').count() > 1
}

/// The comments of a text.
fn comments(text: &str, tokens: &[Lexeme]) -> Vec<Comment> {
    let mut comments = Vec::new();
    let mut from = 0;
    for next in 0..=tokens.len() {
        let to = tokens
            .get(next)
            .map_or(text.len(), |token| token.span.start as usize);
        let first = comments.len();
        let mut at = from;
        while let Some(begin) = text[at..to].find('/').map(|begin| at + begin) {
            let end = comment_end(&text[begin..to]).map_or(to, |length| begin + length);
            comments.push(Comment {
                start: begin,
                end,
                next,
                is_trailing: next > 0 && !text[from..begin].contains('\n'),
                after_blank_line: has_blank_line(&text[at..begin]),
                before_blank_line: false,
                fate: Fate::Pending,
            });
            at = end;
        }
        let mut follower = to;
        let mut ends_line = next == tokens.len();
        for comment in comments[first..].iter_mut().rev() {
            let after = &text[comment.end..follower];
            comment.before_blank_line = has_blank_line(after);
            ends_line |= after.contains('\n');
            let is_one_line = !text[comment.start..comment.end].contains('\n');
            comment.is_trailing &= ends_line && is_one_line;
            ends_line |= !is_one_line;
            follower = comment.start;
        }
        from = tokens.get(next).map_or(to, |token| token.span.end as usize);
    }
    comments
}

/// The length of the comment that a text begins with, without the end of its line.
fn comment_end(text: &str) -> Option<usize> {
    if let Some(block) = text.strip_prefix("/*") {
        return block.find("*/").map(|end| end + 4);
    }
    let mut length = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end_matches(['\n', '\r']);
        length += line.len();
        // A line that ends in `\` is continued.
        if !content.ends_with('\\') {
            return Some(length - (line.len() - content.len()));
        }
    }
    None
}
