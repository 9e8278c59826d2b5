//! The edits of directives and words.

use toyproof_diagnostic::Span;

use super::{Color, Port, Writing};
use crate::dialect::{Language, Version};
use crate::port::input::{Inputs, Spelling};
use crate::token::Punctuator;
use crate::tree::{BuiltIn, Type};

/// The macros of extensions of GLSL ES 1.00 that later versions have without a macro: as `GL_ES`, they are
/// defined there, too.
const EXTENSIONS: [&str; 3] = [
    "GL_OES_standard_derivatives",
    "GL_EXT_shader_texture_lod",
    "GL_EXT_frag_depth",
];

impl Port<'_> {
    /// The text for the other host.
    pub(in crate::port) fn text(mut self) -> String {
        let mut depth = 0_usize;
        let mut starts = true;
        let mut index = 0;
        while index < self.source.len() {
            if self.source.is_in_directive(index) {
                index = self.directive(index);
                starts = true;
                continue;
            }
            if depth == 0
                && starts
                && let Some(end) = self.declaration(index)
            {
                index = end + 1;
                continue;
            }
            match self.source.punctuator(index) {
                Some(Punctuator::LeftBrace) => depth += 1,
                Some(Punctuator::RightBrace) => depth = depth.saturating_sub(1),
                _ => {}
            }
            starts = matches!(
                self.source.punctuator(index),
                Some(Punctuator::Semicolon | Punctuator::RightBrace)
            );
            index = self.word(index);
        }
        self.assemble()
    }

    /// Edits a directive; returns the index after it.
    fn directive(&mut self, start: usize) -> usize {
        let line = self.source.line(start);
        let mut end = start;
        while end < self.source.len() && self.source.line(end) == line {
            end += 1;
        }
        let is_removed = match self.source.token_text(start + 1) {
            // The values of uniforms are for editors; the uniforms are declared.
            "version" | "iUniform" => true,
            // Extensions of GLSL ES 1.00 are parts of later versions.
            "extension" => self.checked.version != Version::Es100 || self.version != Version::Es100,
            _ => false,
        };
        if is_removed {
            self.remove_line(self.source.span(start).to(self.source.span(end - 1)));
            return end;
        }
        let mut index = start;
        while index < end {
            let is_extension = EXTENSIONS.contains(&self.source.token_text(index));
            if is_extension && self.checked.version == Version::Es100 && self.version != Version::Es100 {
                self.edits.push((self.source.span(index), "GL_ES".to_owned()));
            }
            index = self.word(index);
        }
        end
    }

    /// The index of the last token of an input: the components that follow it.
    pub(super) fn input_end(&self, index: usize) -> usize {
        let dot = if self.source.is(index + 1, Punctuator::LeftBracket) {
            index + 4
        } else {
            index + 1
        };
        if self.source.is(dot, Punctuator::Dot) && self.source.symbol(dot + 1).is_some() {
            dot + 1
        } else {
            index
        }
    }

    /// The text in place of an input that is an expression, and the index of the last token that it replaces.
    pub(super) fn replacement(&self, index: usize, spelling: &Spelling) -> Option<(String, usize)> {
        // No other input has no component that the host sets.
        if matches!(spelling, Spelling::Vector { same: 0, .. })
            && let Some(channel) = self.element(index)
            && let Some(element) = Inputs::new(self.to).channel_resolution(channel)
        {
            return self.with_components(index + 3, &element);
        }
        self.with_components(index, spelling)
    }

    /// The number of the channel whose element of an array the tokens after a name select.
    pub(super) fn element(&self, index: usize) -> Option<u8> {
        let source = self.source;
        let is_element =
            source.is(index + 1, Punctuator::LeftBracket) && source.is(index + 3, Punctuator::RightBracket);
        let channel = source.token_text(index + 2).parse().ok();
        channel.filter(|channel| is_element && *channel < 4)
    }

    /// [`Self::replacement`], with the components that follow the token at `last`.
    fn with_components(&self, last: usize, spelling: &Spelling) -> Option<(String, usize)> {
        let source = self.source;
        let is_swizzle = |text: &str| text.len() <= 4 && text.chars().all(|c| "xyzwrgbastpq".contains(c));
        let components = source.token_text(last + 2);
        if source.is(last + 1, Punctuator::Dot) && is_swizzle(components) {
            return spelling.components(components).map(|text| (text, last + 2));
        }
        spelling.whole().map(|whole| (whole.to_owned(), last))
    }

    /// Edits a word; returns the index after it.
    fn word(&mut self, index: usize) -> usize {
        let source = self.source;
        if source.symbol(index).is_none() {
            return index + 1;
        }
        if let Some(next) = self.edit_lookup(index) {
            return next;
        }
        let name = source.token_text(index);
        let span = source.span(index);
        if self.is_member(index) {
            // Members are renamed like variables, with which they may share a macro.
            let is_swizzle = name.len() <= 4 && name.chars().all(|c| "xyzwrgbastpq".contains(c));
            if let Some(Writing::Renamed(other)) = self.writings.get(name).filter(|_| !is_swizzle) {
                self.edits.push((span, other.clone()));
            }
            return index + 1;
        }
        if name == "main" && self.becomes_main_image() && source.is(index + 1, Punctuator::LeftParen) {
            return self.entry(index);
        }
        let is_position =
            name == "gl_FragCoord" && self.color == Color::Parameter && self.body.contains(&index);
        if is_position && source.is(index + 1, Punctuator::Dot) {
            let components = source.token_text(index + 2);
            let text = match components {
                "xy" => self.position.clone(),
                "x" | "y" | "yx" => format!("{}.{components}", self.position),
                _ => return index + 1,
            };
            self.edits.push((span.to(source.span(index + 2)), text));
            return index + 3;
        }
        if self.color == Color::Parameter && self.is_color_array(name) {
            let element = span.to(source.span(index + 3));
            self.edits.push((element, self.fragment_color.clone()));
            return index + 4;
        }
        match self.writings.get(name) {
            Some(Writing::Renamed(other)) => {
                let is_call = source.is(index + 1, Punctuator::LeftParen);
                let is_built_in =
                    self.built_in_names.contains(name) && is_call && !self.own_calls.contains(&span.start);
                if other != name && !is_built_in {
                    self.edits.push((span, other.clone()));
                }
            }
            Some(Writing::Spelled(spelling)) => {
                if let Some((text, last)) = self.replacement(index, spelling) {
                    self.edits.push((span.to(source.span(last)), text));
                    return last + 1;
                }
            }
            None if source.is(index + 1, Punctuator::LeftParen) => {
                if let Some(other) = self.texture_function(name) {
                    self.edits.push((span, other.to_owned()));
                }
            }
            Some(Writing::Global) | None => {}
        }
        index + 1
    }

    /// The name of a function of textures in the other version.
    pub(super) fn texture_function(&self, name: &str) -> Option<&'static str> {
        let language = |version| Language {
            version,
            is_lenient: false,
        };
        if self.version == Version::Es100 {
            let is_new = name == BuiltIn::Texture.name() && self.checked.version != Version::Es100;
            return is_new.then_some("texture2D");
        }
        let (function, _) = language(self.checked.version).old_texture_function(name)?;
        Some(function.name())
    }

    /// Whether a name is that of an array, of which the first element is the color.
    fn is_color_array(&self, name: &str) -> bool {
        let output = self.checked.output.map(|output| &self.checked.tree[output]);
        output.is_some_and(|output| output.name == name && matches!(output.ty, Type::Array(_)))
    }

    /// Edits the head of `main`, and adds the values of global variables to its body.
    fn entry(&mut self, index: usize) -> usize {
        let source = self.source;
        let close = if source.is(index + 2, Punctuator::RightParen) {
            index + 2
        } else {
            index + 3
        };
        let head = match self.color {
            Color::Global(..) => format!("{}()", self.wrapped),
            _ => format!(
                "mainImage(out vec4 {}, in vec2 {})",
                self.fragment_color, self.position
            ),
        };
        self.edits.push((source.span(index).to(source.span(close)), head));
        close + 1
    }

    /// Removes a statement, with its line and the comment behind it if nothing else stands there.
    pub(super) fn remove_line(&mut self, span: Span) {
        let text = self.source.text;
        let before = text[..span.start as usize].trim_end_matches([' ', '\t']);
        let after = text[span.end as usize..].trim_start_matches([' ', '\t', '\r']);
        let begins_line = before.is_empty() || before.ends_with('\n');
        let ends_line = after.is_empty() || after.starts_with('\n') || after.starts_with("//");
        let removed = if begins_line && ends_line {
            let rest = after.find('\n').map_or("", |end| &after[end + 1..]);
            Span::new(
                self.source.file,
                before.len() as u32,
                (text.len() - rest.len()) as u32,
            )
        } else {
            span
        };
        self.edits.push((removed, String::new()));
    }
}
