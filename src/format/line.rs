//! A statement, label, head or comment as lines of text.

use crate::define::wrapped;
use crate::piece::{Kind, Piece, width};
use crate::spacing::{Role, operator, precedence, precedes_operand, space};

/// Maximum number of columns of code.
pub(crate) const MAX_COLUMNS: usize = 100;

/// Columns of a level of indentation.
const LEVEL: usize = 4;

/// Minimum number of columns behind the indentation inside of brackets.
const MIN_ALIGNED: usize = 40;

/// A line break inside of a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NewLine {
    /// The author's, or one that is necessary.
    Kept,
    /// The author's blank line.
    Blank,
}

/// A piece of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    pub(crate) piece: Piece<'a>,
    pub(crate) role: Role,
    space: bool,
    break_before: Option<NewLine>,
    /// How early the line may be broken before it: by the number of brackets around it, then by operator.
    cost: Option<(usize, usize)>,
    /// Its opening bracket, if that is in the line: for a closing bracket and for what is inside.
    bracket: Option<usize>,
}

/// A statement, or what else begins a line, with the author's line breaks.
#[derive(Debug, Clone)]
pub(crate) struct Line<'a> {
    /// The level of its indentation.
    pub(crate) level: usize,
    /// Whether a blank line is before it.
    pub(crate) after_blank: bool,
    pub(crate) parts: Vec<Part<'a>>,
    /// Whether it has several statements, a body behind its head or a block.
    pub(crate) is_joined: bool,
    /// Whether `-` would be an operator between operands.
    pub(crate) follows_operand: bool,
    /// The open brackets.
    open: Vec<usize>,
    /// A line break of the author that belongs to the next part.
    moved_break: Option<NewLine>,
    /// Its columns without line breaks and comments.
    columns: usize,
    /// Maximum number of columns of its lines.
    pub(crate) max_columns: usize,
}

impl<'a> Line<'a> {
    pub(crate) fn new(after_blank: bool) -> Self {
        Self {
            level: 0,
            after_blank,
            parts: Vec::new(),
            is_joined: false,
            follows_operand: false,
            open: Vec::new(),
            moved_break: None,
            columns: 0,
            max_columns: MAX_COLUMNS,
        }
    }

    /// The role of a piece that does not shape the statement.
    pub(crate) fn role(&self, piece: &Piece<'_>) -> Role {
        match piece.text {
            "(" | "[" | "{" => Role::Open,
            ")" | "]" | "}" => Role::Close,
            _ if piece.kind != Kind::Punctuator => Role::Other,
            text => operator(text, self.follows_operand).unwrap_or(Role::Other),
        }
    }

    /// Appends a piece.
    pub(crate) fn push(&mut self, piece: Piece<'a>, role: Role) {
        let bracket = match role {
            Role::Close | Role::CloseHead => self.open.pop(),
            _ => self.open.last().copied(),
        };
        let mut part = Part {
            piece,
            role,
            space: false,
            break_before: None,
            cost: None,
            bracket,
        };
        if let Some(&before) = self.parts.last() {
            let follows_head = before.piece.kind == Kind::Verbatim;
            part.space = follows_head || space((&before.piece, before.role), (&piece, role));
            part.cost = self.cost(&before, &part);
            part.break_before = self.author_break(&before, &part);
        }
        if role == Role::Open {
            self.open.push(self.parts.len());
        }
        if !piece.is_comment() {
            self.follows_operand = match role {
                Role::Close | Role::Postfix => true,
                Role::Other => piece.kind != Kind::Punctuator && !precedes_operand(piece.text),
                _ => false,
            };
            self.columns += usize::from(part.space) + piece.text.chars().count();
        }
        self.parts.push(part);
    }

    /// Whether it begins with a label, whose statements may be on the line.
    pub(crate) fn is_case(&self) -> bool {
        let first = self.parts.first();
        first.is_some_and(|part| matches!(part.piece.text, "case" | "default"))
    }

    /// Whether the next line is the first of a block.
    pub(crate) fn opens_block(&self) -> bool {
        let mut code = self.parts.iter().rev().filter(|part| !part.piece.is_comment());
        code.next().is_some_and(|part| part.role == Role::OpenBlock)
    }

    /// Whether it begins with the `}` of a block.
    pub(crate) fn closes_block(&self) -> bool {
        self.parts
            .first()
            .is_some_and(|part| part.role == Role::CloseBlock)
    }

    /// Whether it has a whole block.
    pub(crate) fn has_block(&self) -> bool {
        self.parts
            .iter()
            .skip(1)
            .any(|part| part.role == Role::CloseBlock)
    }

    /// Whether more may be joined to the line.
    pub(crate) fn has_room(&self) -> bool {
        LEVEL * self.level + self.columns <= MAX_COLUMNS
    }

    fn cost(&self, before: &Part<'_>, part: &Part<'_>) -> Option<(usize, usize)> {
        /// Breaks behind brackets and assignments leave much of a line unused.
        const LATE: usize = 100;
        let depth = self.open.len();
        match (before.role, part.role) {
            (_, Role::Close | Role::CloseHead | Role::Postfix | Role::Label | Role::Assignment) => None,
            (Role::Open, _) => Some((depth + LATE, 1)),
            (Role::Assignment, _) => Some((depth + LATE, 0)),
            (_, Role::Binary) => Some((depth, precedence(part.piece.text)?)),
            _ if matches!(before.piece.text, "," | ";") => Some((depth, 0)),
            _ => None,
        }
    }

    /// The author's line break before a part, where it is kept. Those behind an operator or before a comma are
    /// moved to its other side.
    fn author_break(&mut self, before: &Part<'_>, part: &Part<'_>) -> Option<NewLine> {
        let moved = self.moved_break.take();
        let of_author = NewLine::of(&part.piece).or(moved);
        if before.piece.kind == Kind::LineComment {
            return of_author.or(Some(NewLine::Kept));
        }
        if part.piece.is_comment() || before.piece.is_comment() {
            return of_author;
        }
        let of_author = of_author?;
        if before.role == Role::Binary {
            let last = self.parts.len() - 1;
            if last > 0 && !self.parts[last - 1].piece.is_comment() {
                self.parts[last].break_before.get_or_insert(of_author);
            }
            return None;
        }
        if part.piece.text == "," {
            self.moved_break = Some(of_author);
            return None;
        }
        let closes_broken = part.role == Role::Close
            && part.bracket.is_some_and(|open| {
                let first = self.parts.get(open + 1);
                first.is_some_and(|first| first.break_before.is_some())
            });
        let is_behind_macro =
            matches!(before.role, Role::Close | Role::CloseHead) && part.piece.kind == Kind::Word;
        (part.cost.is_some() || closes_broken || is_behind_macro).then_some(of_author)
    }

    /// Whether code is longer than a line, without further line breaks; comments at the end do not count.
    pub(crate) fn is_too_long(&self) -> bool {
        let mut layout = Layout::default();
        (0..self.parts.len()).any(|index| {
            layout.place(self, index);
            layout.column > self.max_columns && !self.parts[index].piece.is_comment()
        })
    }

    /// Breaks the line where it is too long, and appends its lines to `out`.
    pub(crate) fn write(mut self, out: &mut Vec<Written<'a>>) {
        let layout = self.wrap();
        let mut text = String::new();
        // Whether the line before the next part is written.
        let mut is_written = true;
        for (index, part) in self.parts.iter().enumerate() {
            if let Some(broken) = part.break_before {
                if !is_written {
                    out.push(Written::code(std::mem::take(&mut text)));
                }
                if broken == NewLine::Blank {
                    out.push(Written::code(String::new()));
                }
                is_written = true;
            }
            if is_written {
                text.extend(std::iter::repeat_n(' ', layout.indents[layout.lines[index]]));
            } else if part.space {
                text.push(' ');
            }
            let ends_line = self
                .parts
                .get(index + 1)
                .is_none_or(|next| next.break_before.is_some());
            if part.piece.kind == Kind::LineComment && !is_written && ends_line {
                text.truncate(text.trim_end().len());
                let code = std::mem::take(&mut text);
                out.push(Written {
                    code,
                    comment: Some(part.piece),
                });
                is_written = true;
                continue;
            }
            if is_written && part.piece.kind == Kind::BlockComment {
                push_block_comment(&mut text, &part.piece);
            } else if part.piece.kind == Kind::Directive {
                text.push_str(&wrapped(part.piece.text));
            } else {
                text.push_str(part.piece.text);
            }
            is_written = false;
        }
        if !is_written {
            out.push(Written::code(text));
        }
    }

    /// Adds line breaks until each line fits, if it can.
    fn wrap(&mut self) -> Layout {
        let mut layout = Layout::default();
        // The best place to break the current line: the least cost, and among equals the last.
        let mut best: Option<((usize, usize), usize)> = None;
        let mut index = 0;
        while let Some(part) = self.parts.get(index) {
            let before = layout.column;
            layout.place(self, index);
            let begins_line = index == 0 || part.break_before.is_some();
            if begins_line {
                best = None;
            } else if let Some((depth, precedence)) = part.cost {
                /// A short first part is only made if there is no other.
                const EARLY: usize = 10_000;
                let indent = layout.indents[layout.lines[index]];
                let is_early = before < indent + MAX_COLUMNS.saturating_sub(indent) / 3;
                let cost = (depth + if is_early { EARLY } else { 0 }, precedence);
                if best.is_none_or(|(least, _)| cost <= least) {
                    best = Some((cost, index));
                }
            }
            let is_too_long = layout.column > self.max_columns && !part.piece.is_comment();
            match best.take_if(|_| is_too_long) {
                Some((_, chosen)) => {
                    self.parts[chosen].break_before = Some(NewLine::Kept);
                    layout.go_back(chosen);
                    index = chosen;
                }
                None => index += 1,
            }
        }
        layout
    }
}

/// A line of the result.
#[derive(Debug)]
pub(crate) struct Written<'a> {
    pub(crate) code: String,
    /// The comment at its end.
    pub(crate) comment: Option<Piece<'a>>,
}

impl Written<'_> {
    pub(crate) fn code(code: String) -> Self {
        Self { code, comment: None }
    }

    /// The columns of its code.
    pub(crate) fn width(&self) -> usize {
        let last = self.code.rsplit('\n').next().unwrap_or_default();
        last.chars().count()
    }
}

/// Where the parts of a line are.
#[derive(Debug, Default)]
struct Layout {
    /// The column behind the last part that was placed.
    column: usize,
    /// The indentation of each line.
    indents: Vec<usize>,
    /// The line of each part that was placed, and the column behind it.
    lines: Vec<usize>,
    ends: Vec<usize>,
}

impl Layout {
    /// Places the next part.
    fn place(&mut self, line: &Line<'_>, index: usize) {
        let part = &line.parts[index];
        if index == 0 || part.break_before.is_some() {
            self.column = if index == 0 {
                LEVEL * line.level
            } else {
                self.indent(line, index)
            };
            self.indents.push(self.column);
        } else {
            self.column += usize::from(part.space);
        }
        // A token with a line continuation has several lines.
        let text = part.piece.text;
        self.column = match text.rfind('\n') {
            Some(newline) => text.len() - newline - 1,
            None => self.column + text.chars().count(),
        };
        self.lines.push(self.indents.len() - 1);
        self.ends.push(self.column);
    }

    /// Takes back the parts from an index on, which is not the first.
    fn go_back(&mut self, index: usize) {
        self.lines.truncate(index);
        self.ends.truncate(index);
        self.indents.truncate(self.lines[index - 1] + 1);
        self.column = self.ends[index - 1];
    }

    /// The indentation of a line that begins with a part: behind the bracket around it, unless that is at the
    /// end of its line or too far to the right.
    fn indent(&self, line: &Line<'_>, index: usize) -> usize {
        let parts = &line.parts;
        let part = &parts[index];
        let Some(open) = part.bracket else {
            return LEVEL * (line.level + 1);
        };
        let base = self.indents[self.lines[open]];
        if part.role == Role::Close {
            return base;
        }
        let ends_line = parts[open + 1].break_before.is_some();
        let is_head = open > 0 && matches!(parts[open - 1].piece.text, "if" | "for" | "while" | "switch");
        let aligned = self.ends[open];
        let indent = if is_head {
            // The body is indented by one level.
            base + 2 * LEVEL
        } else if ends_line || aligned + MIN_ALIGNED > MAX_COLUMNS {
            base + LEVEL
        } else {
            aligned
        };
        indent.min(MAX_COLUMNS - MIN_ALIGNED)
    }
}

/// Appends a comment whose further lines move with its first one.
fn push_block_comment(text: &mut String, comment: &Piece<'_>) {
    let column = text.chars().count();
    for (number, line) in comment.text.lines().enumerate() {
        if number == 0 {
            text.push_str(line.trim_end());
            continue;
        }
        text.push('\n');
        let content = line.trim();
        if !content.is_empty() {
            let indent = width(&line[..line.len() - line.trim_start().len()]);
            let indent = (indent + column).saturating_sub(comment.column);
            text.extend(std::iter::repeat_n(' ', indent));
            text.push_str(content);
        }
    }
}
