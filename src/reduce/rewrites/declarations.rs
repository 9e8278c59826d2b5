//! Deletes directives and declarations at global scope, and expands macros.

use std::ops::Range;

use super::Source;
use crate::outline::{Directive, Outline, is_word};
use crate::rewrite::Rewrite;

/// Each `#if` replaced by one of its branches, and each other directive deleted.
pub(super) fn conditions(source: &Source) -> Vec<Rewrite> {
    let outline = &source.outline;
    let directives = &outline.directives;
    let name = |directive: &Directive| {
        directive
            .tokens
            .get(1)
            .map_or("", |range| &outline.text[range.clone()])
    };
    let mut rewrites = Vec::new();
    // The open groups, each with the directives between its branches.
    let mut groups: Vec<Vec<&Directive>> = Vec::new();
    for directive in directives {
        match name(directive) {
            "if" | "ifdef" | "ifndef" => groups.push(vec![directive]),
            "elif" | "else" => {
                if let Some(group) = groups.last_mut() {
                    group.push(directive);
                }
            }
            "endif" => {
                let Some(mut group) = groups.pop() else { continue };
                group.push(directive);
                let whole = group[0].range.start..directive.range.end;
                rewrites.push(Rewrite::delete(whole.clone()));
                let branches = group.windows(2);
                rewrites.extend(branches.map(|ends| {
                    let branch = ends[0].range.end..ends[1].range.start;
                    Rewrite::keep(&branch, &whole)
                }));
            }
            _ => rewrites.push(Rewrite::delete(directive.range.clone())),
        }
    }
    rewrites
}

/// The deletions of declarations that the function of the host does not reach.
pub(super) fn unreachable(source: &Source) -> Vec<Rewrite> {
    let outline = &source.outline;
    let reached = outline.reachable_items();
    let items = outline.items.iter().enumerate();
    items
        .filter(|(number, _)| !reached.contains(number))
        .map(|(_, item)| Rewrite::delete(outline.bytes(&item.tokens)))
        .collect()
}

/// The deletions of all declarations, from the last to the first, since the first ones are used most.
pub(super) fn all(source: &Source) -> Vec<Rewrite> {
    let outline = &source.outline;
    let items = outline.items.iter().rev();
    items
        .map(|item| Rewrite::delete(outline.bytes(&item.tokens)))
        .collect()
}

/// Each `#define` deleted, and its uses replaced by its text.
pub(super) fn macros(source: &Source) -> Vec<Rewrite> {
    let outline = &source.outline;
    let definitions = outline
        .directives
        .iter()
        .filter_map(|directive| Macro::new(outline, directive));
    definitions
        .filter_map(|definition| definition.expanded(outline))
        .collect()
}

/// A macro.
struct Macro<'a> {
    name: &'a str,
    /// The names of its parameters; `None` for a macro without a list of them.
    parameters: Option<Vec<&'a str>>,
    /// The tokens of its text.
    body: Vec<&'a str>,
    directive: Range<usize>,
}

impl<'a> Macro<'a> {
    fn new(outline: &Outline<'a>, directive: &Directive) -> Option<Self> {
        let texts: Vec<&str> = directive
            .tokens
            .iter()
            .map(|range| &outline.text[range.clone()])
            .collect();
        let &["#", "define", name, ref rest @ ..] = &texts[..] else {
            return None;
        };
        let is_list = rest.first() == Some(&"(") && directive.tokens[2].end == directive.tokens[3].start;
        let (parameters, body) = if is_list {
            let close = rest.iter().position(|&token| token == ")")?;
            let names = rest[1..close].iter().copied().filter(|&token| token != ",");
            (Some(names.collect()), &rest[close + 1..])
        } else {
            (None, rest)
        };
        Some(Self {
            name,
            parameters,
            body: body.to_vec(),
            directive: directive.range.clone(),
        })
    }

    /// The deletion of the macro with the replacement of its uses outside of directives; `None` if an
    /// argument uses it, too.
    fn expanded(&self, outline: &Outline) -> Option<Rewrite> {
        let mut rewrite = Rewrite::delete(self.directive.clone());
        let mut index = 0;
        while index < outline.tokens.len() {
            let start = index;
            index += 1;
            if outline.token(start) != self.name {
                continue;
            }
            let mut arguments = Vec::new();
            if let Some(parameters) = &self.parameters {
                if outline.token(index) != "(" {
                    continue;
                }
                let elements = outline.elements(index)?;
                index = outline.partner(index)? + 1;
                arguments.extend(
                    elements
                        .into_iter()
                        .map(|tokens| &outline.text[outline.bytes(&tokens)]),
                );
                if arguments.len() != parameters.len()
                    || (start + 1..index).any(|inside| outline.token(inside) == self.name)
                {
                    return None;
                }
            }
            let text = self.text(&arguments);
            rewrite = rewrite.and(outline.bytes(&(start..index)), text);
        }
        Some(rewrite)
    }

    /// The text with arguments.
    fn text(&self, arguments: &[&str]) -> String {
        let mut text = String::new();
        for &token in &self.body {
            let names = self.parameters.iter().flatten();
            let argument = names.zip(arguments).find(|(name, _)| **name == token);
            let token = argument.map_or(token, |(_, argument)| argument);
            let is_apart = text.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.');
            if is_apart && (is_word(token) || token.starts_with(|c: char| c.is_ascii_digit() || c == '.')) {
                text.push(' ');
            }
            text.push_str(token);
        }
        text
    }
}
