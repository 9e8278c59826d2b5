//! The declarations of inputs and outputs, and of precisions.

use super::{Color, Port, Writing};
use crate::dialect::{InputValue, Version};
use crate::port::input::{Inputs, declaration};
use crate::port::names::Known;
use crate::token::Punctuator;
use crate::tree::{Input, Scalar, Type};

/// The storage qualifiers of what a shader reads from its host or writes for it.
const STORAGE: [&str; 4] = ["uniform", "varying", "in", "out"];
/// The qualifiers of precision.
const PRECISIONS: [&str; 3] = ["highp", "mediump", "lowp"];
/// Other qualifiers of such declarations.
const QUALIFIERS: [&str; 5] = ["flat", "smooth", "centroid", "invariant", "noperspective"];

impl Port<'_> {
    /// Edits a declaration of inputs or outputs, or of a precision; returns the index of its semicolon.
    pub(super) fn declaration(&mut self, start: usize) -> Option<usize> {
        let source = self.source;
        let mut end = start;
        while !source.is(end, Punctuator::Semicolon) {
            if end >= source.len() || source.is(end, Punctuator::LeftBrace) {
                return None;
            }
            end += 1;
        }
        if source.token_text(start) == "precision" {
            if !self.to.calls_main_image() && !self.is_for_isf() {
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
            } else if !QUALIFIERS.contains(&text) && !PRECISIONS.contains(&text) {
                break;
            }
            at += 1;
        }
        let storage = storage?;
        let precision = (start..at)
            .map(|index| source.token_text(index))
            .find(|text| PRECISIONS.contains(text));
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
                        depth += 1;
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
            let renamed = declarator.strip_prefix(name).unwrap_or_default();
            let renamed = self.name(name) + renamed;
            match self.declarator(name, source.token_text(storage), (precision, ty), &renamed) {
                None => lines.push(format!("{head} {renamed};")),
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
    fn declarator(
        &mut self,
        name: &str,
        storage: &str,
        (precision, ty): (Option<&str>, &str),
        declarator: &str,
    ) -> Option<Vec<String>> {
        let output = self.checked.output.map(|output| &*self.checked.tree[output].name);
        if output == Some(name) {
            let keeps = !self.becomes_main_image() && self.version != Version::Es100 && !self.is_for_isf();
            return match &self.color {
                Color::Global(name, of) => {
                    Some(vec![format!("{};", self.checked.tree.declaration(name, *of))])
                }
                _ if keeps => None,
                _ => Some(Vec::new()),
            };
        }
        let becomes_global = || {
            let without_value = declarator.split('=').next().unwrap_or(declarator).trim_end();
            Some(vec![format!("{ty} {without_value};")])
        };
        match self.known.get(name).map(|(_, known)| known.clone()) {
            // The header of ISF declares its inputs.
            Some(Known::Value(..) | Known::Unset) if self.is_for_isf() && storage == "uniform" => {
                Some(Vec::new())
            }
            Some(Known::Input(value)) => {
                let mut lines = Vec::new();
                if matches!(self.writings.get(name), Some(Writing::Global)) {
                    let ty = self.checked.tree.type_name(value.ty());
                    lines.push(format!("{ty} {name};"));
                }
                if !self.to.calls_main_image() && !self.is_for_isf() && self.writings.contains_key(name) {
                    let declared = self.declare_inputs_of(value).into_iter();
                    lines.extend(declared.map(|line| match precision {
                        Some(precision) => line.replacen("uniform", &format!("uniform {precision}"), 1),
                        None => line,
                    }));
                }
                Some(lines)
            }
            // A uniform has a value of its own in desktop GLSL only.
            Some(Known::Value(ty, components)) if self.to.calls_main_image() || declarator.contains('=') => {
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
        if value == InputValue::Whole(Input::ChannelResolution) {
            let sizes = self.inputs.used.iter();
            inputs
                .used
                .extend(sizes.filter(|(_, of)| matches!(of, InputValue::TextureSize(_))));
        }
        let mut lines = Vec::new();
        for (name, value) in inputs.used {
            if !self.declared.contains(&name) {
                self.declared.push(name);
                lines.push(declaration(name, value));
            }
        }
        lines
    }
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
