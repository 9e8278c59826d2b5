//! The edits of a text: how each name is written, and where the color is.

mod assembly;
mod declarations;
mod isf;
mod words;

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::{Diagnostic, Span};

use self::isf::{ISF_NAMES, Lookups};
use super::input::{Inputs, Spelling};
use super::names::{self, Known};
use crate::Checked;
use crate::dialect::{Dialect, InputValue, Version};
use crate::source::Source;
use crate::token::Punctuator;
use crate::tree::{Input, Place, SamplerShape, Scalar, Type, VariableId};

/// The color in GLSL ES 1.00.
const FRAG_COLOR: &str = "gl_FragColor";
/// The colors in GLSL ES 1.00.
const FRAG_DATA: &str = "gl_FragData";

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
    /// The lookups of textures, if the other host is ISF.
    lookups: Lookups,
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
    ) -> Result<Self, Box<Diagnostic>> {
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
            lookups: Lookups::default(),
        };
        port.find_body();
        port.place_color(&words);
        if let Err(error) = port.spell_inputs(false) {
            // A page of the author's own may set all of the mouse.
            if !to.sets_any() {
                return Err(error);
            }
            port.spell_inputs(true)?;
        }
        if port.is_for_isf() {
            port.find_lookups()?;
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
        let vector = Type::Vector(Scalar::Float, 4);
        let is_vector = variable.ty == vector;
        let is_array =
            matches!(variable.ty, Type::Array(id) if self.checked.tree.array(id).element == vector);
        let is_local = |index: usize| {
            self.body.contains(&index)
                && !source.is_in_directive(index)
                && (is_vector || is_array && is_element(index))
        };
        if !self.becomes_main_image() {
            // GLSL ES 1.00 has its color by name, later versions declare it.
            let has_frag_color = self.version == Version::Es100 || self.is_for_isf();
            if has_frag_color && name != FRAG_COLOR && name != FRAG_DATA {
                let color = if is_array { FRAG_DATA } else { FRAG_COLOR };
                self.writings.insert(name, Writing::Renamed(color.to_owned()));
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

    /// Determines the text of each input that the shader reads; `reads_click`: where the mouse was clicked,
    /// too.
    fn spell_inputs(&mut self, reads_click: bool) -> Result<(), Box<Diagnostic>> {
        self.inputs = Inputs::new(self.to);
        self.inputs.reads_click = reads_click;
        self.globals.clear();
        let known = &self.known;
        self.writings.retain(|name, _| !known.contains_key(name));
        let parameters = names::macro_parameters(self.source);
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
                let is_shadowed = declared.get(name).copied().unwrap_or_default() > usize::from(is_declared)
                    || parameters.contains(name);
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
        // The mouse of ISF is a long expression.
        let is_long = self.is_for_isf() && value == InputValue::Whole(Input::Mouse);
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
            spelling if !is_shadowed && !is_long => Writing::Spelled(spelling),
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
        if self.is_for_isf() {
            taken.extend(ISF_NAMES);
        }
        let declared = names::declared(self.checked);
        // A local variable hides the function that replaces one of another name.
        let textures: HashSet<&str> = words
            .iter()
            .filter_map(|name| self.texture_function(name))
            .collect();
        let other = declared.keys().copied().filter(|name| {
            names::is_word(name, &language)
                || self.built_in_names.contains(name)
                || textures.contains(name)
                || self.to.declares(name)
        });
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
}
