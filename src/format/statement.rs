//! Splits a text into statements, labels, heads and comments, each of which begins a line.
//!
//! There is no grammar: a text may be invalid, the branches of `#if` need not be balanced, and macros are not
//! expanded. One pass over the pieces keeps the open blocks and brackets; each branch of an `#if` begins with
//! those at the `#if`.

use std::collections::HashMap;

use toyproof_glsl::MAX_NESTING;

use crate::line::{Line, NewLine};
use crate::macros::{Form, Macro, directive, macros};
use crate::piece::{Kind, Piece};
use crate::spacing::Role;

/// Maximum number of open blocks, heads, brackets and `#if`: what compiles has fewer.
const MAX_OPEN: usize = MAX_NESTING;

/// Maximum number of statements in a block that may stay on one line.
const MAX_STATEMENTS_OF_LINE: usize = 2;

/// Blocks, brackets or conditions are nested too deeply; the byte where the limit is exceeded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TooDeep(pub(crate) usize);

/// The head of a statement whose body is the next statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HeadKind {
    If,
    Do,
    /// `for`, `while`, `switch`, `else`, or a macro that is one.
    Other,
}

#[derive(Debug, Clone, Copy)]
struct Head {
    kind: HeadKind,
    /// Whether the body is on lines of its own, indented further.
    is_broken: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Bracket {
    Plain,
    /// That of the head of a statement.
    Head(HeadKind),
    /// That of a macro that is a statement.
    Statement,
}

/// An open block, or the whole text.
#[derive(Debug, Clone)]
struct Block {
    /// Whether it has members of a structure, and declarators may follow it.
    is_struct: bool,
    /// The level of its statements or labels, and that of its `}`.
    level: usize,
    closing_level: usize,
    /// Whether statements are indented further, below a label.
    has_label: bool,
    /// The heads before the next statement.
    heads: Vec<Head>,
}

/// The place in a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Position {
    /// A statement begins.
    Start,
    /// The `while` of a `do` follows.
    AfterDo,
    /// In the label of a `case`.
    Label,
    /// In a structure or a block of inputs, whose braces have members.
    Members,
    /// In another statement.
    Inside,
}

/// What is open at a piece.
#[derive(Debug, Clone)]
struct State {
    blocks: Vec<Block>,
    brackets: Vec<Bracket>,
    position: Position,
    /// The level of the line where the statement began.
    level: usize,
    /// The head or macro whose `(` is next.
    expected: Option<Bracket>,
    /// Whether `-` would be an operator between operands.
    follows_operand: bool,
}

impl State {
    fn is_start(&self) -> bool {
        matches!(self.position, Position::Start | Position::AfterDo)
    }

    /// Goes on in the statement that begins or goes on here.
    fn go_on(&mut self) {
        if self.is_start() {
            self.position = Position::Inside;
        }
    }

    fn block(&mut self) -> &mut Block {
        self.blocks.last_mut().expect("the whole text is a block")
    }

    /// The level of the next statement of the block.
    fn statement_level(&self) -> usize {
        let block = self.blocks.last().expect("the whole text is a block");
        let broken = block.heads.iter().filter(|head| head.is_broken).count();
        block.level + usize::from(block.has_label) + broken
    }
}

/// What follows a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Flow {
    /// The line goes on.
    Line,
    /// The next line begins.
    NextLine,
}

/// Splits a text into lines that may be too long.
pub(crate) fn lines<'a>(pieces: &[Piece<'a>]) -> Result<Vec<Line<'a>>, TooDeep> {
    let mut splitter = Splitter {
        pieces,
        macros: macros(pieces),
        partners: partners(pieces),
        at: 0,
        stays: true,
        conditions: Vec::new(),
        state: State {
            blocks: vec![Block {
                is_struct: false,
                level: 0,
                closing_level: 0,
                has_label: false,
                heads: Vec::new(),
            }],
            brackets: Vec::new(),
            position: Position::Start,
            level: 0,
            expected: None,
            follows_operand: false,
        },
    };
    let mut lines: Vec<Line<'a>> = Vec::new();
    while splitter.at < pieces.len() {
        let (state, at) = (splitter.state.clone(), splitter.at);
        let mut line = splitter.line();
        let is_uneven = line.opens_block() && line.has_block();
        if line.is_joined && (is_uneven || line.is_too_long()) {
            // What the author wrote on one line does not fit, or a branch of an `if` does not.
            splitter.state = state;
            splitter.at = at;
            splitter.stays = false;
            line = splitter.line();
            splitter.stays = true;
        }
        if splitter.open() > MAX_OPEN {
            return Err(TooDeep(pieces[at].start));
        }
        let after_open = lines.last().is_none_or(Line::opens_block);
        line.after_blank &= !after_open && !line.closes_block();
        lines.push(line);
    }
    Ok(lines)
}

/// The closing brace of each opening one, where the text between is balanced; 0 for others.
fn partners(pieces: &[Piece<'_>]) -> Vec<usize> {
    let mut partners = vec![0; pieces.len()];
    let mut open = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        if piece.kind == Kind::Directive {
            // A block with directives has several lines.
            open.clear();
        } else if piece.is("{") {
            open.push(index);
        } else if piece.is("}")
            && let Some(partner) = open.pop()
        {
            partners[partner] = index;
        }
    }
    partners
}

struct Splitter<'s, 'a> {
    pieces: &'s [Piece<'a>],
    macros: HashMap<&'a str, Macro>,
    partners: Vec<usize>,
    at: usize,
    /// Whether what the author wrote on one line may stay on it.
    stays: bool,
    /// The state at each open `#if`, and whether its `#else` was read.
    conditions: Vec<(State, bool)>,
    state: State,
}

impl<'a> Splitter<'_, 'a> {
    /// The number of open blocks, heads, brackets and `#if`.
    fn open(&self) -> usize {
        let heads = self.state.blocks.iter().map(|block| block.heads.len());
        self.state.blocks.len() + heads.sum::<usize>() + self.state.brackets.len() + self.conditions.len()
    }

    fn peek(&self) -> Option<&Piece<'a>> {
        self.pieces.get(self.at)
    }

    /// The next token, after comments and directives.
    fn next_token(&self) -> &'a str {
        let mut rest = self.pieces[self.at..].iter();
        rest.find(|piece| piece.is_token()).map_or("", |piece| piece.text)
    }

    /// Whether the next piece is on the author's line, and may stay there.
    fn stays(&self, line: &Line<'_>) -> bool {
        let next = self.peek();
        self.stays && line.has_room() && next.is_some_and(|next| next.is_token() && !next.begins_line())
    }

    /// Whether the comment at an index ends its line.
    fn ends_line(&self, index: usize) -> bool {
        self.pieces[index].kind == Kind::LineComment
            || self.pieces.get(index + 1).is_none_or(Piece::begins_line)
    }

    fn line(&mut self) -> Line<'a> {
        let first = self.pieces[self.at];
        let mut line = Line::new(first.breaks > 1);
        match first.kind {
            Kind::Directive => {
                self.at += 1;
                self.directive(first.text);
                line.push(first, Role::Other);
                return line;
            }
            Kind::Verbatim => {
                self.at += 1;
                line.push(first, Role::Other);
                self.end_statement();
                return line;
            }
            Kind::LineComment | Kind::BlockComment if self.ends_line(self.at) => {
                line.level = self.comment_level();
                self.at += 1;
                line.push(first, Role::Other);
                return line;
            }
            _ => {}
        }
        if self.state.is_start() {
            self.state.level = self.state.statement_level();
            line.level = self.state.level;
        } else {
            line.level = self.state.level + 1;
            line.follows_operand = self.state.follows_operand;
        }
        while let Some(&piece) = self.peek() {
            if piece.kind == Kind::Directive || piece.kind == Kind::Verbatim {
                self.state.follows_operand = line.follows_operand;
                return line;
            }
            if piece.is_comment() {
                self.at += 1;
                line.push(piece, Role::Other);
            } else if self.token(piece, &mut line) == Flow::NextLine {
                self.trailing_comments(&mut line);
                return line;
            }
        }
        line
    }

    /// Appends the comments that end the line.
    fn trailing_comments(&mut self, line: &mut Line<'a>) {
        let mut end = self.at;
        while let Some(piece) = self.pieces.get(end)
            && piece.is_comment()
            && !piece.begins_line()
        {
            end += 1;
        }
        if end > self.at && self.ends_line(end - 1) {
            for &comment in &self.pieces[self.at..end] {
                line.push(comment, Role::Other);
            }
            self.at = end;
        }
    }

    fn comment_level(&self) -> usize {
        let state = &self.state;
        if !state.is_start() {
            return state.level + 1;
        }
        match self.next_token() {
            "case" | "default" => state.blocks.last().map_or(0, |block| block.level),
            _ => state.statement_level(),
        }
    }

    /// Follows the conditions: each branch begins like the first, and what follows an `#if` without `#else`
    /// goes on as before it.
    fn directive(&mut self, text: &str) {
        match directive(text).0 {
            "if" | "ifdef" | "ifndef" => self.conditions.push((self.state.clone(), false)),
            name @ ("elif" | "else") => {
                if let Some((state, has_else)) = self.conditions.last_mut() {
                    *has_else |= name == "else";
                    self.state = state.clone();
                }
            }
            "endif" => {
                if let Some((state, has_else)) = self.conditions.pop()
                    && !has_else
                {
                    self.state = state;
                }
            }
            _ => {}
        }
    }

    fn token(&mut self, piece: Piece<'a>, line: &mut Line<'a>) -> Flow {
        self.at += 1;
        match piece.text {
            "{" if self.begins_block(line) => return self.open_block(piece, line),
            "}" if self.state.brackets.is_empty() => return self.close_block(piece, line),
            "(" | "[" | "{" => {
                let bracket = self.state.expected.take().unwrap_or(Bracket::Plain);
                self.state.brackets.push(bracket);
                self.state.go_on();
                line.push(piece, Role::Open);
                return Flow::Line;
            }
            ")" | "]" | "}" => return self.close_bracket(piece, line),
            ";" if self.state.brackets.is_empty() => {
                line.push(piece, Role::Other);
                self.end_statement();
                return self.after_statement(line);
            }
            ":" if self.state.position == Position::Label && self.state.brackets.is_empty() => {
                line.push(piece, Role::Label);
                self.state.position = Position::Start;
                return self.after_label(line);
            }
            _ => {}
        }
        if self.state.is_start() {
            let begin = self.state.position;
            self.state.position = match piece.text {
                "uniform" | "layout" | "buffer" => Position::Members,
                _ => Position::Inside,
            };
            if let Some(flow) = self.first_token(piece, begin, line) {
                return flow;
            }
        }
        if piece.text == "struct" {
            self.state.position = Position::Members;
        }
        let role = line.role(&piece);
        line.push(piece, role);
        Flow::Line
    }

    /// The first token of a statement, if it is a keyword or a macro that shapes it.
    fn first_token(&mut self, piece: Piece<'a>, begin: Position, line: &mut Line<'a>) -> Option<Flow> {
        if piece.kind != Kind::Word {
            return None;
        }
        let expected = match piece.text {
            "if" => Bracket::Head(HeadKind::If),
            "while" if begin == Position::AfterDo => Bracket::Plain,
            "for" | "while" | "switch" => Bracket::Head(HeadKind::Other),
            "else" | "do" => {
                line.push(piece, Role::Other);
                let kind = if piece.text == "do" {
                    HeadKind::Do
                } else {
                    HeadKind::Other
                };
                return Some(self.begin_body(kind, line));
            }
            "case" | "default" => {
                self.state.position = Position::Label;
                let block = self.state.block();
                block.has_label = true;
                let level = block.level;
                self.state.level = level;
                if line.parts.is_empty() {
                    line.level = level;
                }
                return None;
            }
            name => {
                let found = *self.macros.get(name)?;
                if found.has_parameters && self.peek()?.text != "(" {
                    return None;
                }
                let bracket = match found.form {
                    Form::Head => Bracket::Head(HeadKind::Other),
                    Form::Statement => Bracket::Statement,
                };
                if !found.has_parameters {
                    line.push(piece, Role::Other);
                    return Some(self.after_bracket(bracket, line));
                }
                bracket
            }
        };
        self.state.expected = Some(expected);
        None
    }

    fn close_bracket(&mut self, piece: Piece<'a>, line: &mut Line<'a>) -> Flow {
        let bracket = self.state.brackets.pop().unwrap_or(Bracket::Plain);
        self.state.go_on();
        if bracket == Bracket::Plain || !self.state.brackets.is_empty() {
            line.push(piece, Role::Close);
            return Flow::Line;
        }
        line.push(piece, Role::CloseHead);
        self.after_bracket(bracket, line)
    }

    /// Goes on behind a head, or a macro that is a statement.
    fn after_bracket(&mut self, bracket: Bracket, line: &mut Line<'a>) -> Flow {
        match bracket {
            Bracket::Plain => Flow::Line,
            Bracket::Head(kind) => self.begin_body(kind, line),
            Bracket::Statement => {
                self.end_statement();
                self.after_statement(line)
            }
        }
    }

    /// Begins the body of a head, on the line of the head or on one of its own.
    fn begin_body(&mut self, kind: HeadKind, line: &mut Line<'a>) -> Flow {
        let is_else = line.parts.last().is_some_and(|part| part.piece.text == "else");
        self.state.position = Position::Start;
        let joined = self
            .peek()
            .is_some_and(|next| next.is("{") || next.is(";") || is_else && next.is("if"));
        let stays = joined || self.stays(line);
        line.is_joined |= stays && !joined;
        self.state.block().heads.push(Head {
            kind,
            is_broken: !stays,
        });
        if stays { Flow::Line } else { Flow::NextLine }
    }

    /// Closes the heads whose body ends here.
    fn end_statement(&mut self) {
        let next = self.next_token();
        self.state.expected = None;
        let heads = &mut self.state.block().heads;
        let wanted = match next {
            "else" => HeadKind::If,
            "while" => HeadKind::Do,
            _ => HeadKind::Other,
        };
        let open = heads.iter().rposition(|head| head.kind == wanted);
        let open = open.filter(|_| wanted != HeadKind::Other);
        heads.truncate(open.unwrap_or(0));
        self.state.position = if open.is_some() && wanted == HeadKind::Do {
            Position::AfterDo
        } else {
            Position::Start
        };
    }

    /// Whether the line goes on behind a statement, or a block on one line.
    fn after_statement(&mut self, line: &mut Line<'a>) -> Flow {
        let Some(next) = self.peek() else {
            return Flow::NextLine;
        };
        if next.is(";") {
            return Flow::Line;
        }
        let ends_case = next.is("}") || next.is("case") || next.is("default");
        let continues =
            next.is("else") || self.state.position == Position::AfterDo || line.is_case() && !ends_case;
        if continues && self.stays(line) {
            line.is_joined = true;
            return Flow::Line;
        }
        Flow::NextLine
    }

    fn after_label(&mut self, line: &mut Line<'a>) -> Flow {
        if self.peek().is_some_and(|next| next.is("{")) {
            return Flow::Line;
        }
        if self.stays(line) && !self.peek().is_some_and(|next| next.is("}")) {
            line.is_joined = true;
            return Flow::Line;
        }
        Flow::NextLine
    }

    /// Whether the `{` just read begins a block or the members of a structure, rather than a list of values.
    fn begins_block(&self, line: &Line<'_>) -> bool {
        let is_value = line
            .parts
            .last()
            .is_some_and(|part| part.role == Role::Assignment);
        self.state.brackets.is_empty() && (self.state.is_start() || !is_value)
    }

    fn open_block(&mut self, brace: Piece<'a>, line: &mut Line<'a>) -> Flow {
        let open = self.at - 1;
        let is_struct = self.state.position == Position::Members;
        let partner = self.partners[open];
        let is_empty = partner == open + 1;
        if is_empty || self.stays && self.is_short(open, partner) {
            line.push(brace, if is_empty { Role::Open } else { Role::OpenBlock });
            self.short_block(partner, line);
            line.is_joined |= !is_empty;
            if is_struct {
                self.state.position = Position::Inside;
                return Flow::Line;
            }
            self.end_statement();
            return self.after_statement(line);
        }
        line.push(brace, Role::OpenBlock);
        self.state.blocks.push(Block {
            is_struct,
            level: self.state.level + 1,
            closing_level: self.state.level,
            has_label: false,
            heads: Vec::new(),
        });
        self.state.position = Position::Start;
        Flow::NextLine
    }

    /// Whether the author wrote a block on one line, and it has few statements.
    fn is_short(&self, open: usize, partner: usize) -> bool {
        if partner == 0 {
            return false;
        }
        let mut statements = 0;
        let mut depth = 0_usize;
        for piece in &self.pieces[open + 1..=partner] {
            match piece.text {
                "(" => depth += 1,
                ")" => depth = depth.saturating_sub(1),
                ";" => statements += usize::from(depth == 0),
                _ => {}
            }
            let is_several = piece.begins_line() || piece.is("{") || piece.kind == Kind::LineComment;
            if is_several || statements > MAX_STATEMENTS_OF_LINE {
                return false;
            }
        }
        true
    }

    /// Writes the pieces of a block up to its `}` on the line.
    fn short_block(&mut self, partner: usize, line: &mut Line<'a>) {
        // Whether each open bracket is that of a head.
        let mut heads = Vec::new();
        let mut is_head = false;
        for &piece in &self.pieces[self.at..partner] {
            let mut role = line.role(&piece);
            match role {
                Role::Open => heads.push(is_head),
                Role::Close if heads.pop() == Some(true) => role = Role::CloseHead,
                _ => {}
            }
            is_head = matches!(piece.text, "if" | "for" | "while" | "switch");
            line.push(piece, role);
        }
        let is_empty = line.parts.last().is_some_and(|part| part.role == Role::Open);
        line.push(
            self.pieces[partner],
            if is_empty { Role::Close } else { Role::CloseBlock },
        );
        self.at = partner + 1;
    }

    fn close_block(&mut self, brace: Piece<'a>, line: &mut Line<'a>) -> Flow {
        let is_struct = if self.state.blocks.len() > 1 {
            let block = self.state.blocks.pop().expect("there are several");
            self.state.level = block.closing_level;
            block.is_struct
        } else {
            false
        };
        if line.parts.is_empty() {
            line.level = self.state.level;
        }
        line.push(brace, Role::CloseBlock);
        if is_struct {
            self.state.position = Position::Inside;
            return Flow::Line;
        }
        self.end_statement();
        let next = self.peek();
        let joins = next.is_some_and(|next| next.is("else") || next.is(";"));
        if joins || self.state.position == Position::AfterDo && next.is_some_and(|next| next.is("while")) {
            return Flow::Line;
        }
        Flow::NextLine
    }
}

impl NewLine {
    /// The line break that an author made before a piece.
    pub(crate) fn of(piece: &Piece<'_>) -> Option<Self> {
        match piece.breaks {
            0 => None,
            1 => Some(Self::Kept),
            _ => Some(Self::Blank),
        }
    }
}
