//! What can be written at a byte: names in scope, members and swizzles, built-in functions, keywords.

mod member;
mod name;
mod snippet;

use lsp_types::{CompletionItem, CompletionItemKind, CompletionList, Documentation, InsertTextFormat};
use toyproof_diagnostic::Span;
use toyproof_glsl::documentation;
use toyproof_glsl::tree::Type;

use crate::describe::markdown;
use crate::doc_comment::DocComments;
use crate::scope;
use crate::snapshot::Snapshot;
use crate::tokens::{Token, TokenKind, Tokens};

/// The completions at a byte of the analyzed text.
pub(crate) fn completion(snapshot: &Snapshot, at: u32) -> CompletionList {
    let Some(mut completer) = Completer::new(snapshot, at) else {
        return CompletionList::default();
    };
    completer.complete();
    CompletionList {
        // The swizzles on offer depend on what is written of one.
        is_incomplete: completer.is_incomplete,
        items: completer.items,
        ..CompletionList::default()
    }
}

/// How likely a completion is what the author wants, the likeliest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Local,
    Parameter,
    Global,
    Function,
    Input,
    BuiltIn,
    Type,
    Keyword,
    Snippet,
}

/// A completion.
struct Item {
    label: String,
    kind: CompletionItemKind,
    detail: Option<String>,
    documentation: Option<String>,
    rank: Rank,
    /// Whether its type is the one that is expected here.
    fits: bool,
    /// What is inserted in place of the label, with places to fill in.
    snippet: Option<String>,
}

impl Item {
    fn new(label: impl Into<String>, kind: CompletionItemKind, rank: Rank) -> Self {
        Self {
            label: label.into(),
            kind,
            detail: None,
            documentation: None,
            rank,
            fits: false,
            snippet: None,
        }
    }
}

impl From<Item> for CompletionItem {
    fn from(item: Item) -> Self {
        let fit = u8::from(!item.fits);
        Self {
            sort_text: Some(format!("{fit}{}{}", item.rank as u8, item.label)),
            label: item.label,
            kind: Some(item.kind),
            detail: item.detail,
            documentation: item
                .documentation
                .map(|text| Documentation::MarkupContent(markdown(text))),
            insert_text_format: item.snippet.is_some().then_some(InsertTextFormat::Snippet),
            insert_text: item.snippet,
            ..Self::default()
        }
    }
}

/// Where in a text something is completed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Where a declaration at global scope may begin.
    Global,
    /// In the parentheses behind the name of a function that is declared.
    Parameters,
    /// Where a statement may begin.
    Statement,
    /// Where only an expression may be.
    Expression,
}

struct Completer<'s> {
    snapshot: &'s Snapshot,
    tokens: Tokens<'s>,
    comments: DocComments<'s>,
    /// The byte in the analyzed text.
    at: u32,
    /// The byte in the document.
    in_document: u32,
    /// What is written of the word.
    prefix: &'s str,
    /// The number of tokens in front of the word.
    before: usize,
    items: Vec<CompletionItem>,
    is_incomplete: bool,
}

impl<'s> Completer<'s> {
    /// `None` in comments, in numbers, and in other files.
    fn new(snapshot: &'s Snapshot, at: u32) -> Option<Self> {
        let in_document = snapshot
            .in_document(Span::new(snapshot.analyzed(), at, at))?
            .start;
        let tokens = snapshot.tokens();
        if tokens.is_in_comment(in_document) {
            return None;
        }
        let count = tokens.count_before(in_document);
        let last = count.checked_sub(1).map(|last| tokens.code()[last]);
        let (prefix, before) = match last {
            Some(last) if last.end() < in_document => ("", count),
            Some(last) if last.kind == TokenKind::Number => return None,
            Some(last) if last.kind == TokenKind::Word => {
                let length = (in_document - last.start) as usize;
                (last.text.get(..length)?, count - 1)
            }
            _ => ("", count),
        };
        Some(Self {
            snapshot,
            comments: DocComments::new(snapshot),
            tokens,
            at,
            in_document,
            prefix,
            before,
            items: Vec::new(),
            is_incomplete: false,
        })
    }

    fn complete(&mut self) {
        if let Some(hash) = self.directive_start() {
            self.complete_directive(hash);
            return;
        }
        if self.is_before(".") {
            self.complete_member();
            return;
        }
        // Behind a type is a new name.
        let type_before = self.token_before().and_then(|token| self.type_named(token.text));
        if type_before.is_some() {
            return;
        }
        self.complete_word(self.place());
    }

    /// Whether the client can insert texts with places to fill in.
    fn has_snippets(&self) -> bool {
        let client = self.snapshot.client.text_document.as_ref();
        let completion = client.and_then(|client| client.completion.as_ref());
        let item = completion.and_then(|completion| completion.completion_item.as_ref());
        item.is_some_and(|item| item.snippet_support == Some(true))
    }

    fn add(&mut self, item: Item) {
        self.items.push(item.into());
    }

    fn token_before(&self) -> Option<Token<'s>> {
        self.before.checked_sub(1).map(|index| self.tokens.code()[index])
    }

    fn is_before(&self, text: &str) -> bool {
        self.token_before().is_some_and(|token| token.is(text))
    }

    /// The index of the `#` of the directive that the word is in.
    fn directive_start(&self) -> Option<usize> {
        let last = self.token_before().filter(|last| last.is_in_directive)?;
        let text = self.snapshot.file().text();
        let between = text.get(last.end() as usize..self.in_document as usize)?;
        // A `\` continues the line.
        if between.replace("\\\r\n", "").replace("\\\n", "").contains('\n') {
            return None;
        }
        let code = &self.tokens.code()[..self.before];
        let of_line = code
            .iter()
            .rposition(|token| token.line != last.line || !token.is_in_directive);
        Some(of_line.map_or(0, |before| before + 1))
    }

    fn complete_directive(&mut self, hash: usize) {
        if self.before == hash + 1 {
            for name in documentation::directives() {
                let mut item = Item::new(name, CompletionItemKind::Keyword, Rank::Keyword);
                item.documentation = documentation::of_word(&format!("#{name}")).map(str::to_owned);
                self.add(item);
            }
            return;
        }
        match self.tokens.code()[hash + 1].text {
            "ifdef" | "ifndef" | "undef" => self.add_macros(),
            "if" | "elif" => {
                self.add_macros();
                self.add(Item::new("defined", CompletionItemKind::Keyword, Rank::Keyword));
            }
            "define" if self.before > hash + 2 => {
                if self.is_before(".") {
                    self.complete_member();
                    return;
                }
                self.add_macro_parameters(hash + 2);
                self.complete_word(Place::Statement);
            }
            _ => {}
        }
    }

    fn place(&self) -> Place {
        let mut depth = 0_usize;
        for token in &self.tokens.code()[..self.before] {
            match token.text {
                "{" if !token.is_in_directive => depth += 1,
                "}" if !token.is_in_directive => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        let starts = self
            .token_before()
            .is_none_or(|token| token.is_in_directive || matches!(token.text, ";" | "{" | "}"));
        match (depth, starts) {
            (0, true) => Place::Global,
            (0, false) if self.is_in_parameters() => Place::Parameters,
            (_, true) => Place::Statement,
            _ if self.begins_nested_statement() => Place::Statement,
            _ => Place::Expression,
        }
    }

    /// Whether the word is in the parentheses behind a declared name, where `f(` follows a type.
    fn is_in_parameters(&self) -> bool {
        let call = self.tokens.open_call(self.in_document);
        call.is_some_and(|call| self.tokens.is_declared(call.name))
    }

    /// Whether the word is in the initializer of a variable whose name is at a byte of the document.
    fn is_in_initializer_of(&self, name: u32) -> bool {
        let first = self.tokens.count_before(name) + 1;
        let between = self.tokens.code().get(first..self.before).unwrap_or_default();
        let mut depth = 0_usize;
        between.first().is_some_and(|token| token.is("="))
            && between.iter().all(|token| {
                match token.text {
                    "(" | "[" => depth += 1,
                    ")" | "]" => depth = depth.saturating_sub(1),
                    _ => {}
                }
                !(matches!(token.text, ";" | "{" | "}") || (token.is(",") && depth == 0))
            })
    }

    /// Whether the word follows `else`, `do`, a label, or the `)` of `if`, `for` or `while`.
    fn begins_nested_statement(&self) -> bool {
        let Some(last) = self.before.checked_sub(1) else {
            return false;
        };
        let code = self.tokens.code();
        match code[last].text {
            "else" | "do" => true,
            "(" => last > 0 && code[last - 1].is("for"),
            ")" => self
                .tokens
                .opening(last)
                .is_some_and(|open| open > 0 && matches!(code[open - 1].text, "if" | "for" | "while")),
            _ => false,
        }
    }

    /// The type of that name.
    fn type_named(&self, name: &str) -> Option<Type> {
        let types = self.snapshot.types().into_iter();
        let mut built_in = types.filter(|(known, _)| known == name).map(|(_, ty)| ty);
        let structure = || scope::structure(self.snapshot, name, self.at).map(Type::Struct);
        built_in.next().or_else(structure)
    }

    /// The type that an expression should have here: that of a parameter, or of what is assigned to.
    fn expected_type(&self) -> Option<Type> {
        let last = self.before.checked_sub(1)?;
        let code = self.tokens.code();
        if matches!(code[last].text, "=" | "+=" | "-=") {
            let end = last.checked_sub(1)?;
            let declared = end
                .checked_sub(1)
                .and_then(|index| self.type_named(code[index].text));
            let assigned = || scope::operand_type(self.snapshot, &self.tokens, end, self.at);
            return declared.or_else(assigned).filter(|&ty| ty != Type::Error);
        }
        if !matches!(code[last].text, "(" | ",") {
            return None;
        }
        let call = self.tokens.open_call(self.in_document)?;
        scope::parameter_type(self.snapshot, &self.tokens, &call, self.at)
    }
}

#[cfg(test)]
mod tests;
