//! What a host declares in front of a shader.

use std::fmt::Write;

use toyproof_diagnostic::{File, FileId, Files};
use toyproof_glsl::UniformValue;

use crate::node::{Node, Value};
use crate::project::Project;

/// Text in front of a shader, and the values of the uniforms in it.
#[derive(Debug, Default)]
pub(crate) struct Declarations {
    pub(crate) text: String,
    pub(crate) uniforms: Vec<UniformValue>,
}

/// A text with what its host declares.
#[derive(Debug)]
pub enum Declared {
    /// A shader with one pass.
    Shader(FileId),
    /// The passes of a shader of ISF.
    Project(Box<Project>),
}

impl Declarations {
    pub(crate) fn line(&mut self, line: &str) {
        self.text += line;
        self.text.push('\n');
    }

    pub(crate) fn uniform(&mut self, ty: &str, name: &str, components: Option<Vec<f64>>) {
        let _ = writeln!(self.text, "uniform {ty} {name};");
        self.uniforms.extend(components.map(|components| UniformValue {
            name: name.to_owned(),
            components,
        }));
    }
}

/// Adds a text behind its declarations; returns the file itself if there are none.
pub(crate) fn in_front_of(files: &mut Files, file: FileId, declarations: String) -> FileId {
    if declarations.is_empty() {
        return file;
    }
    let name = files.get(file).name().to_owned();
    let declarations = files.add(File::new(format!("<declarations of {name}>"), declarations));
    files.join(name, &[declarations, file])
}

/// The components of a number, a list of numbers, or a truth value.
pub(crate) fn components(node: &Node) -> Option<Vec<f64>> {
    match &node.value {
        Value::Number(number) => Some(vec![number.parse().ok()?]),
        Value::Bool(value) => Some(vec![f64::from(*value)]),
        Value::Array(nodes) => nodes
            .iter()
            .map(|node| match &node.value {
                Value::Number(number) => number.parse().ok(),
                _ => None,
            })
            .collect(),
        _ => None,
    }
}

/// Whether a text is a name in GLSL.
pub(crate) fn is_name(text: &str) -> bool {
    let mut characters = text.chars();
    characters
        .next()
        .is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
        && characters.all(|character| character.is_ascii_alphanumeric() || character == '_')
}
