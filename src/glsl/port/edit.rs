//! The edits of a text.

use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use toyproof_diagnostic::{Diagnostic, Span};

use super::PortError;
use super::input::{Inputs, Spelling, declaration};
use super::names::{self, Known};
use crate::Checked;
use crate::dialect::{Dialect, InputValue, Language, Version};
use crate::source::Source;
use crate::token::Punctuator;
use crate::tree::{BuiltIn, Input, Place, SamplerShape, Scalar, Type, VariableId};

/// The storage qualifiers of what a shader reads from its host or writes for it.
const STORAGE: [&str; 4] = ["uniform", "varying", "in", "out"];
/// Other qualifiers of such declarations.
const QUALIFIERS: [&str; 8] = [
    "highp",
    "mediump",
    "lowp",
    "flat",
    "smooth",
    "centroid",
    "invariant",
    "noperspective",
];

/// The color in GLSL ES 1.00.
const FRAG_COLOR: &str = "gl_FragColor";
/// The colors in GLSL ES 1.00.
const FRAG_DATA: &str = "gl_FragData";

/// The macros of extensions of GLSL ES 1.00 that later versions have without a macro: as `GL_ES`, they are
/// defined there, too.
const EXTENSIONS: [&str; 3] = [
    "GL_OES_standard_derivatives",
    "GL_EXT_shader_texture_lod",
    "GL_EXT_frag_depth",
];

/// How a name of the text is written.
#[derive(Debug)]
enum Writing {
    /// As another name, wherever it occurs.
    Renamed(String),
    /// As an expression.
    Spelled(Spelling),
    /// As it is: it becomes a global variable, to which the expression is assigned.
    Global,
}

/// Where a shader that runs `main` has its color for a host that calls `mainImage`.
#[derive(Debug, PartialEq)]
enum Color {
    /// In the parameter, since only `main` uses it.
    Parameter,
    /// In a global variable of this name and type, which a function copies.
    Global(String, Type),
    /// As it is: the other host runs `main`, too.
    Kept,
}

/// A text that is being written for another host.
pub(super) struct Port<'a> {
    checked: &'a Checked,
    source: &'a Source<'a>,
    to: Dialect,
    version: Version,
    known: HashMap<String, (VariableId, Known)>,
    writings: HashMap<String, Writing>,
    inputs: Inputs,
    /// The inputs of the other host that are declared so far.
    declared: Vec<&'static str>,
    /// Global variables for inputs: their declarations, and their values.
    globals: Vec<(String, String)>,
    /// The names of the parameters of `mainImage`, of the color and of the wrapped `main`.
    fragment_color: String,
    position: String,
    wrapped: String,
    color: Color,
    /// The tokens of the body of `main`, with its braces.
    body: std::ops::Range<usize>,
    /// The author's functions and global variables that are named like built-in functions.
    built_in_names: HashSet<&'a str>,
    /// Where the author's functions are named: other uses of such a name are those of a built-in function.
    own_calls: HashSet<u32>,
    edits: Vec<(Span, String)>,
}

impl<'a> Port<'a> {
    /// Determines how each name is written.
    ///
    /// # Errors
    /// The host does not set an input.
    pub(super) fn new(
        checked: &'a Checked,
        source: &'a Source<'a>,
        to: Dialect,
        version: Version,
    ) -> Result<Self, PortError> {
        let words = names::words(source);
        let mut port = Self {
            checked,
            source,
            to,
            version,
            known: names::known(checked),
            writings: HashMap::new(),
            inputs: Inputs::new(to),
            declared: Vec::new(),
            globals: Vec::new(),
            fragment_color: names::fresh("fragColor", &words),
            position: names::fresh("fragCoord", &words),
            wrapped: names::fresh("mainColor", &words),
            color: Color::Kept,
            body: 0..0,
            built_in_names: names::built_in_names(checked, version),
            own_calls: names::own_calls(checked),
            edits: Vec::new(),
        };
        port.find_body();
        port.place_color(&words);
        if let Err(error) = port.spell_inputs(false) {
            // A page of the author's own may set all of the mouse.
            if !to.sets_any() {
                return Err(PortError::Host(error));
            }
            port.spell_inputs(true).map_err(PortError::Host)?;
        }
        port.rename(&words);
        Ok(port)
    }

    /// Whether the shader runs `main` and the other host calls `mainImage`, or the reverse.
    fn is_rewrapped(&self) -> bool {
        self.checked.dialect.calls_main_image() != self.to.calls_main_image()
    }

    fn becomes_main_image(&self) -> bool {
        self.is_rewrapped() && self.to.calls_main_image()
    }

    fn becomes_main(&self) -> bool {
        self.is_rewrapped() && !self.to.calls_main_image()
    }

    /// Finds the definition of `main`.
    fn find_body(&mut self) {
        let source = self.source;
        let mut depth = 0_usize;
        let mut found = None;
        for index in 0..source.len() {
            if source.is_in_directive(index) {
                continue;
            }
            match source.punctuator(index) {
                Some(Punctuator::LeftBrace) => {
                    let heads = source.token_text(index.saturating_sub(1)) == ")";
                    let is_main = (1..6).any(|back| {
                        index
                            .checked_sub(back)
                            .is_some_and(|at| source.token_text(at) == "main")
                    });
                    if depth == 0 && heads && is_main {
                        found = Some(index);
                    }
                    depth += 1;
                }
                Some(Punctuator::RightBrace) => {
                    depth = depth.saturating_sub(1);
                    if depth == 0
                        && let Some(open) = found.take()
                    {
                        self.body = open..index + 1;
                    }
                }
                _ => {}
            }
        }
    }

    /// Determines where the color of a shader that runs `main` is.
    fn place_color(&mut self, words: &HashSet<&str>) {
        let Some(output) = self.checked.output else {
            if self.becomes_main_image() {
                self.color = Color::Parameter;
            }
            return;
        };
        let variable = &self.checked.tree[output];
        let name = variable.name.clone();
        let source = self.source;
        let mut uses = (0..source.len())
            .filter(|&index| source.token_text(index) == name && !self.is_declaration_of(output, index));
        let is_element = |index: usize| {
            source.is(index + 1, Punctuator::LeftBracket) && source.token_text(index + 2) == "0"
        };
        let is_vector = variable.ty == Type::Vector(Scalar::Float, 4);
        let is_array = matches!(variable.ty, Type::Array(_));
        let is_local = |index: usize| {
            self.body.contains(&index)
                && !source.is_in_directive(index)
                && (is_vector || is_array && is_element(index))
        };
        if !self.becomes_main_image() {
            // GLSL ES 1.00 has its color by name, later versions declare it.
            if self.version == Version::Es100 && name != FRAG_COLOR && name != FRAG_DATA {
                self.writings
                    .insert(name, Writing::Renamed(FRAG_COLOR.to_owned()));
            } else if self.version != Version::Es100 && name == FRAG_COLOR && self.version.is_es() {
                let color = names::fresh("outColor", words);
                self.writings.insert(name, Writing::Renamed(color));
            }
            return;
        }
        if uses.all(is_local) {
            if name == "fragColor" {
                self.fragment_color.clone_from(&name);
            }
            self.color = Color::Parameter;
            self.writings
                .insert(name, Writing::Renamed(self.fragment_color.clone()));
        } else {
            let global = if name.starts_with("gl_") {
                names::fresh("outColor", words)
            } else {
                name.clone()
            };
            self.writings.insert(name, Writing::Renamed(global.clone()));
            self.color = Color::Global(global, variable.ty);
        }
    }

    fn is_declaration_of(&self, variable: VariableId, index: usize) -> bool {
        let declared = self.checked.tree[variable].at;
        declared.is_some_and(|at| at.span == self.source.span(index))
    }

    /// Determines the text of each input that the shader reads; `reads_click`: where the mouse was clicked, too.
    fn spell_inputs(&mut self, reads_click: bool) -> Result<(), Box<Diagnostic>> {
        self.inputs = Inputs::new(self.to);
        self.inputs.reads_click = reads_click;
        self.globals.clear();
        let known = &self.known;
        self.writings.retain(|name, _| !known.contains_key(name));
        let declared: HashMap<String, usize> = {
            let names = names::declared(self.checked).into_iter();
            names.map(|(name, count)| (name.to_owned(), count)).collect()
        };
        for index in 0..self.source.len() {
            if self.source.symbol(index).is_none() || self.is_member(index) {
                continue;
            }
            let name = self.source.token_text(index);
            let known = match self.known.get(name) {
                Some((id, known)) if !self.is_declaration_of(*id, index) => Some((Some(*id), known.clone())),
                Some(_) => None,
                None if self.writings.contains_key(name) || declared.contains_key(name) => None,
                None => names::constants(self.checked.dialect, name).map(|value| (None, Known::Input(value))),
            };
            let Some((id, Known::Input(value))) = known else {
                continue;
            };
            let at = Place::plain(self.source.span(index));
            if !self.writings.contains_key(name) {
                let is_declared = id.is_some_and(|id| self.checked.tree[id].at.is_some());
                let is_shadowed = declared.get(name).copied().unwrap_or_default() > usize::from(is_declared);
                self.spell_input(name, value, is_shadowed, at)?;
            }
            if let Some(channel) = self.element(index)
                && value == InputValue::Whole(Input::ChannelResolution)
            {
                self.inputs.channel_resolution(channel);
            }
            if let Some(Writing::Spelled(spelling)) = self.writings.get(name)
                && self.replacement(index, spelling).is_none()
            {
                let whole = &self.source.slice(
                    self.source
                        .span(index)
                        .to(self.source.span(self.input_end(index))),
                );
                return Err(self.inputs.missing(&format!("`{whole}`"), at));
            }
        }
        Ok(())
    }

    fn spell_input(
        &mut self,
        name: &str,
        value: InputValue,
        is_shadowed: bool,
        at: Place,
    ) -> Result<(), Box<Diagnostic>> {
        if let InputValue::Texture(channel) = value
            && self.checked.channels[usize::from(channel)] != SamplerShape::D2
            && self.to.calls_main_image() != self.checked.dialect.calls_main_image()
        {
            return Err(self
                .inputs
                .missing(&format!("`{name}`, which is not a 2D texture,"), at));
        }
        // The elements of `iChannelResolution` may be inputs of their own.
        let spelling = match self.inputs.spell(value) {
            None if value == InputValue::Whole(Input::ChannelResolution) => Spelling::Vector {
                whole: None,
                first: String::new(),
                same: 0,
                size: 0,
            },
            None => return Err(self.inputs.missing(&format!("`{name}`"), at)),
            Some(spelling) => spelling,
        };
        let writing = match spelling {
            Spelling::Name(other) => Writing::Renamed(other.to_owned()),
            spelling if !is_shadowed => Writing::Spelled(spelling),
            spelling => {
                let Some(whole) = spelling.whole() else {
                    return Err(self.inputs.missing(&format!("`{name}`"), at));
                };
                let ty = self.checked.tree.type_name(value.ty());
                self.globals
                    .push((format!("{ty} {name};"), format!("{name} = {whole};")));
                Writing::Global
            }
        };
        self.writings.insert(name.to_owned(), writing);
        Ok(())
    }

    /// Renames what would get another meaning.
    fn rename(&mut self, words: &HashSet<&str>) {
        let mut taken: Vec<&str> = self.inputs.used.iter().map(|(name, _)| *name).collect();
        taken.push(if self.to.calls_main_image() {
            "mainImage"
        } else {
            "main"
        });
        let language = names::language(self.version);
        let declared = names::declared(self.checked);
        let other = declared
            .keys()
            .copied()
            .filter(|name| names::is_word(name, &language) || self.built_in_names.contains(name));
        let is_kept = |name: &&str| {
            let is_entry = matches!(*name, "main" | "mainImage") && !self.is_rewrapped();
            is_entry || self.writings.contains_key(*name)
        };
        let renamed: Vec<&str> = taken
            .into_iter()
            .filter(|name| words.contains(name))
            .chain(other)
            .filter(|name| !is_kept(name))
            .collect();
        for name in renamed {
            let other = names::fresh(&format!("{name}_"), words);
            self.writings.insert(name.to_owned(), Writing::Renamed(other));
        }
    }

    /// The text for the other host.
    pub(super) fn text(mut self) -> String {
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
        if matches!(self.source.token_text(start + 1), "version" | "extension") {
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

    /// Edits a declaration of inputs or outputs, or of a precision; returns the index of its semicolon.
    fn declaration(&mut self, start: usize) -> Option<usize> {
        let source = self.source;
        let mut end = start;
        while !source.is(end, Punctuator::Semicolon) {
            if end >= source.len() || source.is(end, Punctuator::LeftBrace) {
                return None;
            }
            end += 1;
        }
        if source.token_text(start) == "precision" {
            if !self.to.calls_main_image() {
                return None;
            }
            self.remove_line(source.span(start).to(source.span(end)));
            return Some(end);
        }
        let mut at = start;
        let mut storage = None;
        loop {
            let text = source.token_text(at);
            if STORAGE.contains(&text) {
                storage = Some(at);
            } else if text == "layout" {
                at = source.partner(at + 1)?;
            } else if !QUALIFIERS.contains(&text) {
                break;
            }
            at += 1;
        }
        let storage = storage?;
        let ty = source.token_text(at);
        let mut lines = Vec::new();
        let mut is_edited = false;
        let mut first = at + 1;
        while first < end {
            let mut last = first;
            let mut depth = 0_usize;
            while last < end && (depth > 0 || !source.is(last, Punctuator::Comma)) {
                match source.punctuator(last) {
                    Some(Punctuator::LeftParen | Punctuator::LeftBracket | Punctuator::LeftBrace) => {
                        depth += 1
                    }
                    Some(Punctuator::RightParen | Punctuator::RightBracket | Punctuator::RightBrace) => {
                        depth = depth.saturating_sub(1);
                    }
                    _ => {}
                }
                last += 1;
            }
            let declarator = source.slice(source.span(first).to(source.span(last - 1)));
            let name = source.token_text(first);
            let head = source.slice(source.span(start).to(source.span(at)));
            match self.declarator(name, source.token_text(storage), ty, declarator) {
                None => lines.push(format!("{head} {declarator};")),
                Some(line) => {
                    is_edited = true;
                    lines.extend(line);
                }
            }
            first = last + 1;
        }
        if !is_edited {
            return None;
        }
        let span = source.span(start).to(source.span(end));
        if lines.is_empty() {
            self.remove_line(span);
        } else {
            self.edits.push((span, lines.join("\n")));
        }
        Some(end)
    }

    /// The lines in place of a declared input or output; `None` if it stays.
    fn declarator(&mut self, name: &str, storage: &str, ty: &str, declarator: &str) -> Option<Vec<String>> {
        let output = self.checked.output.map(|output| &*self.checked.tree[output].name);
        if output == Some(name) {
            let keeps = !self.becomes_main_image() && self.version != Version::Es100;
            return match &self.color {
                Color::Global(name, _) => Some(vec![format!("{ty} {name};")]),
                _ if keeps => None,
                _ => Some(Vec::new()),
            };
        }
        let becomes_global = || {
            let without_value = declarator.split('=').next().unwrap_or(declarator).trim_end();
            Some(vec![format!("{ty} {without_value};")])
        };
        match self.known.get(name).map(|(_, known)| known.clone()) {
            Some(Known::Input(value)) => {
                let mut lines = Vec::new();
                if matches!(self.writings.get(name), Some(Writing::Global)) {
                    let ty = self.checked.tree.type_name(value.ty());
                    lines.push(format!("{ty} {name};"));
                }
                if !self.to.calls_main_image() && self.writings.contains_key(name) {
                    lines.extend(self.declare_inputs_of(value));
                }
                Some(lines)
            }
            Some(Known::Value(ty, components)) if self.to.calls_main_image() => {
                let name = self.name(name);
                let written = self.checked.tree.type_name(ty);
                Some(vec![format!(
                    "const {written} {name} = {};",
                    value(&written, ty, &components)
                )])
            }
            Some(Known::Unset) | None if self.becomes_main_image() => becomes_global(),
            _ if storage == "varying" && self.version != Version::Es100 => {
                Some(vec![format!("in {ty} {declarator};")])
            }
            _ => None,
        }
    }

    /// Declares the inputs of the other host that the text of a value reads, unless they are declared.
    fn declare_inputs_of(&mut self, value: InputValue) -> Vec<String> {
        let mut inputs = Inputs::new(self.to);
        inputs.reads_click = self.inputs.reads_click;
        inputs.spell(value);
        let mut lines = Vec::new();
        for (name, value) in inputs.used {
            if !self.declared.contains(&name) {
                self.declared.push(name);
                lines.push(declaration(name, value));
            }
        }
        lines
    }

    /// The name that a declared one becomes.
    fn name(&self, name: &str) -> String {
        match self.writings.get(name) {
            Some(Writing::Renamed(other)) => other.clone(),
            _ => name.to_owned(),
        }
    }

    /// Whether a name is that of a member or components.
    fn is_member(&self, index: usize) -> bool {
        index > 0 && self.source.is(index - 1, Punctuator::Dot)
    }

    /// The index of the last token of an input: the components that follow it.
    fn input_end(&self, index: usize) -> usize {
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
    fn replacement(&self, index: usize, spelling: &Spelling) -> Option<(String, usize)> {
        if spelling.whole().is_none()
            && let Some(channel) = self.element(index)
            && let Some(element) = Inputs::new(self.to).channel_resolution(channel)
        {
            return self.with_components(index + 3, &element);
        }
        self.with_components(index, spelling)
    }

    /// The number of the channel whose element of an array the tokens after a name select.
    fn element(&self, index: usize) -> Option<u8> {
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
        if name == FRAG_DATA && self.color == Color::Parameter {
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
            Some(Writing::Global) => {}
            None if source.is(index + 1, Punctuator::LeftParen) => {
                if let Some(other) = self.texture_function(name) {
                    self.edits.push((span, other.to_owned()));
                }
            }
            None => {}
        }
        index + 1
    }

    /// The name of a function of textures in the other version.
    fn texture_function(&self, name: &str) -> Option<&'static str> {
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
    fn remove_line(&mut self, span: Span) {
        let text = self.source.text;
        let start = text[..span.start as usize].rfind('\n').map_or(0, |at| at + 1);
        let end = text[span.end as usize..]
            .find('\n')
            .map_or(text.len(), |at| span.end as usize + at + 1);
        let before = text[start..span.start as usize].trim();
        let after = text[span.end as usize..end].trim();
        let is_alone = before.is_empty() && (after.is_empty() || after.starts_with("//"));
        let whole = Span::new(self.source.file, start as u32, end as u32);
        self.edits
            .push((if is_alone { whole } else { span }, String::new()));
    }

    /// The edited text, with what stands before and after it.
    fn assemble(mut self) -> String {
        self.assign_globals();
        let mut head = String::new();
        if self.becomes_main() || self.version != self.checked.version {
            head += &self.precision();
        }
        if self.becomes_main() && names::words(self.source).contains("HW_PERFORMANCE") {
            head += "#define HW_PERFORMANCE 1\n";
        }
        if !self.to.calls_main_image() {
            for (name, value) in std::mem::take(&mut self.inputs.used) {
                if self.is_rewrapped() && !self.declared.contains(&name) {
                    head += &declaration(name, value);
                    head.push('\n');
                }
            }
        }
        let color = names::fresh("outColor", &names::words(self.source));
        let declares_color = self.version != Version::Es100 && !self.to.calls_main_image();
        let is_declared = self
            .checked
            .output
            .is_some_and(|output| self.checked.tree[output].at.is_some());
        if declares_color && !is_declared {
            let _ = writeln!(head, "out vec4 {color};");
        }
        if let Color::Global(name, ty) = &self.color
            && !is_declared
        {
            let _ = writeln!(head, "{} {name};", self.checked.tree.type_name(*ty));
        }
        for (declaration, _) in &self.globals {
            // Declared inputs are replaced where they are declared.
            if self.checked.dialect.is_implicit() {
                let _ = writeln!(head, "{declaration}");
            }
        }
        let color = if declares_color { &color } else { FRAG_COLOR };
        let tail = self.tail(color);
        let mut text = self.version_line();
        let source = self.source.text;
        let first = self.source.span(0).start as usize;
        self.edits.sort_by_key(|(span, _)| span.start);
        let mut body = String::new();
        let mut at = 0;
        if !head.is_empty() {
            head.push('\n');
        }
        let mut head = Some(head);
        for (span, edit) in &self.edits {
            let start = (span.start as usize).max(at);
            if start >= first
                && let Some(head) = head.take()
            {
                body += &source[at..first.max(at)];
                body += &head;
                at = first.max(at);
            }
            body += &source[at..start.max(at)];
            body += edit;
            at = (span.end as usize).max(at);
            // Of the empty lines around what was removed, one stays.
            if edit.is_empty() && (body.is_empty() || body.ends_with("\n\n")) {
                let rest = &source[at..];
                at += rest.len() - rest.strip_prefix("\n").unwrap_or(rest).len();
            }
        }
        if let Some(head) = head {
            body += &source[at..first.max(at)];
            body += &head;
            at = first.max(at);
        }
        body += &source[at..];
        text += without_empty_conditions(&body).trim_start_matches(['\n', '\r']);
        if !tail.is_empty() {
            text.truncate(text.trim_end().len());
            text += "\n\n";
            text += &tail;
        }
        text
    }

    fn version_line(&self) -> String {
        let mut line = match self.version {
            _ if self.to.calls_main_image() => return String::new(),
            Version::Es100 => String::new(),
            version => format!(
                "#version {}{}\n",
                version.number(),
                if version.is_es() { " es" } else { "" }
            ),
        };
        if self.version == Version::Es100 && self.checked.takes_derivatives() {
            line += "#extension GL_OES_standard_derivatives : enable\n";
        }
        line
    }

    /// The default precision, unless the text has one.
    fn precision(&self) -> String {
        // That of a shader with `mainImage` stands behind the inputs.
        let has_one = !self.becomes_main() && names::words(self.source).contains("precision");
        match self.version {
            _ if has_one || self.to.calls_main_image() || !self.version.is_es() => String::new(),
            Version::Es100 => "#ifdef GL_ES\nprecision highp float;\n#endif\n\n".to_owned(),
            _ => "precision highp float;\nprecision highp int;\n\n".to_owned(),
        }
    }

    /// Assigns the values of global variables at the beginning of `main`.
    fn assign_globals(&mut self) {
        let is_wrapped = self.becomes_main() || matches!(self.color, Color::Global(..));
        if is_wrapped || self.globals.is_empty() || self.body.is_empty() {
            return;
        }
        let open = self.source.span(self.body.start);
        let at = Span::new(open.file, open.end, open.end);
        let lines: String = self
            .globals
            .iter()
            .map(|(_, value)| format!("\n    {value}"))
            .collect();
        self.edits.push((at, lines));
    }

    /// The function that the other host runs, if the shader has only the one that it calls.
    fn tail(&self, color: &str) -> String {
        let mut lines: Vec<String> = self.globals.iter().map(|(_, value)| value.clone()).collect();
        if self.becomes_main() {
            if self.checked.tree.adds_to_color(self.checked.main_image) {
                lines.push(format!("{color} = vec4(0.0, 0.0, 0.0, 1.0);"));
            }
            let main_image = self.name("mainImage");
            lines.push(format!("{main_image}({color}, gl_FragCoord.xy);"));
            lines.push(format!("{color}.a = 1.0;"));
            return function("main()", &lines);
        }
        let Color::Global(global, ty) = &self.color else {
            return String::new();
        };
        lines.push(format!("{}();", self.wrapped));
        let value = match ty {
            Type::Vector(_, 3) => format!("vec4({global}, 1.0)"),
            Type::Array(_) => format!("{global}[0]"),
            _ => global.clone(),
        };
        lines.push(format!("{} = {value};", self.fragment_color));
        let head = format!(
            "mainImage(out vec4 {}, in vec2 {})",
            self.fragment_color, self.position
        );
        function(&head, &lines)
    }
}

fn function(head: &str, lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| format!("    {line}\n")).collect();
    format!("void {head} {{\n{lines}}}\n")
}

/// The text of a uniform's value.
fn value(name: &str, ty: Type, components: &[f64]) -> String {
    let scalar = ty.scalar().unwrap_or(Scalar::Float);
    let text = |component: &f64| match scalar {
        Scalar::Bool => (*component != 0.0).to_string(),
        Scalar::Int => format!("{component:.0}"),
        Scalar::Uint => format!("{component:.0}u"),
        Scalar::Float => format!("{component:?}"),
    };
    let components: Vec<_> = components.iter().map(text).collect();
    match &components[..] {
        [component] => component.clone(),
        _ => format!("{name}({})", components.join(", ")),
    }
}

/// The text without conditions of `GL_ES` in which nothing is left, and without the empty line behind them.
fn without_empty_conditions(text: &str) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut kept = String::new();
    let mut at = 0;
    while at < lines.len() {
        let line: String = lines[at].split_whitespace().collect::<Vec<_>>().join(" ");
        let is_condition = matches!(
            &*line,
            "#ifdef GL_ES" | "#if defined(GL_ES)" | "#if defined GL_ES"
        );
        let next = (at + 1..lines.len()).find(|&next| !lines[next].trim().is_empty());
        match next.filter(|&next| is_condition && lines[next].trim() == "#endif") {
            Some(end) => {
                at = end + 1;
                if lines.get(at).is_some_and(|line| line.trim().is_empty()) {
                    at += 1;
                }
            }
            None => {
                kept += lines[at];
                at += 1;
            }
        }
    }
    kept
}
