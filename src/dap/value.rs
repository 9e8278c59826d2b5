//! Values of any type as text, and their parts.

use toyproof_eval::TraceValue;
use toyproof_glsl::tree::{Scalar, Tree, Type};
use toyproof_verify::NumberType;
use toyproof_verify::debug::digits;

use crate::recording::differs;

/// The longest text of a value that consists of parts, in characters.
const MAX_CHARS: usize = 100;

/// The number type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    Single,
    Double,
}

/// A value of any type, in f32 and in f64.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Value {
    pub(crate) ty: Type,
    /// The components: columns, members and elements in order.
    pub(crate) single: Vec<TraceValue>,
    pub(crate) double: Vec<TraceValue>,
}

/// A part of a value.
#[derive(Debug)]
pub(crate) struct Part {
    /// `x`, `center`, `[2]`.
    pub(crate) name: String,
    pub(crate) value: Value,
    /// The number of components before it.
    pub(crate) offset: usize,
}

impl Value {
    /// The text: the value in f32, and that in f64 where the two differ by more than 0.1 %.
    pub(crate) fn text(&self, tree: &Tree) -> String {
        let single = text(tree, self.ty, &self.single, Precision::Single);
        if self.diverges(tree) {
            let double = text(tree, self.ty, &self.double, Precision::Double);
            format!("{single} (f64: {double})")
        } else {
            single
        }
    }

    /// Whether a scalar, vector or matrix differs between f32 and f64 by more than 0.1 % of its largest
    /// component.
    fn diverges(&self, tree: &Tree) -> bool {
        match self.ty {
            Type::Struct(_) | Type::Array(_) => {
                let parts = self.parts(tree, 0, usize::MAX);
                parts.iter().any(|part| part.value.diverges(tree))
            }
            _ => {
                let scalar = self.ty.scalar().unwrap_or(Scalar::Float);
                let [single, double] = [&self.single, &self.double]
                    .map(|values| -> Vec<_> { values.iter().map(|&value| of_type(value, scalar)).collect() });
                differs(&single, &double)
            }
        }
    }

    /// The text with the value in f64, unless it is the same.
    pub(crate) fn full_text(&self, tree: &Tree) -> String {
        let single = text(tree, self.ty, &self.single, Precision::Single);
        let double = text(tree, self.ty, &self.double, Precision::Double);
        if single == double {
            single
        } else {
            format!("{single} (f64: {double})")
        }
    }

    /// The number of parts.
    pub(crate) fn part_count(&self, tree: &Tree) -> usize {
        match self.ty {
            Type::Vector(_, size) => usize::from(size),
            Type::Matrix { columns, .. } => usize::from(columns),
            Type::Struct(id) => tree[id].members.len(),
            Type::Array(id) => tree.array(id).size as usize,
            Type::Void | Type::Scalar(_) | Type::Sampler(_) | Type::Error => 0,
        }
    }

    /// Whether the parts have numbers instead of names.
    pub(crate) fn is_indexed(&self) -> bool {
        matches!(self.ty, Type::Array(_) | Type::Matrix { .. })
    }

    /// Some of the parts, in order.
    pub(crate) fn parts(&self, tree: &Tree, first: usize, count: usize) -> Vec<Part> {
        let mut parts = Vec::new();
        let last = first.saturating_add(count).min(self.part_count(tree));
        let mut start = 0;
        for index in 0..last {
            let (name, ty) = self.part(tree, index);
            let size = component_count(tree, ty);
            if index >= first {
                let of = |values: &[TraceValue]| {
                    let values = values.iter().skip(start).take(size);
                    values.copied().collect()
                };
                parts.push(Part {
                    name,
                    offset: start,
                    value: Self {
                        ty,
                        single: of(&self.single),
                        double: of(&self.double),
                    },
                });
            }
            start += size;
        }
        parts
    }

    /// The name and the type of a part.
    fn part(&self, tree: &Tree, index: usize) -> (String, Type) {
        match self.ty {
            Type::Vector(scalar, _) => {
                let name = ["x", "y", "z", "w"].get(index).copied().unwrap_or_default();
                (name.to_owned(), Type::Scalar(scalar))
            }
            Type::Matrix { rows, .. } => (format!("[{index}]"), Type::vector(Scalar::Float, rows)),
            Type::Struct(id) => {
                let member = &tree[id].members[index];
                (member.name.clone(), member.ty)
            }
            Type::Array(id) => (format!("[{index}]"), tree.array(id).element),
            ty => (String::new(), ty),
        }
    }
}

/// The number of components of a type; 0 for `void` and samplers.
pub(crate) fn component_count(tree: &Tree, ty: Type) -> usize {
    match ty {
        Type::Array(id) => {
            let array = tree.array(id);
            component_count(tree, array.element) * array.size as usize
        }
        Type::Struct(id) => {
            let members = tree[id].members.iter();
            members.map(|member| component_count(tree, member.ty)).sum()
        }
        _ => ty.component_count().map_or(0, usize::from),
    }
}

/// A value as one of its type: in a variable that was never written, a zero is a word.
pub(crate) fn of_type(value: TraceValue, scalar: Scalar) -> TraceValue {
    match (value, scalar) {
        (TraceValue::Word(0), Scalar::Float) => TraceValue::Float(0.0),
        (value, _) => value,
    }
}

/// The text of a value: `0.5`, `(1, 2, 3)`, `Ray((0, 0, 0), (0, 0, -1))`; long ones are truncated.
pub(crate) fn text(tree: &Tree, ty: Type, values: &[TraceValue], precision: Precision) -> String {
    let mut writer = Writer {
        tree,
        precision,
        values: values.iter(),
        text: String::new(),
    };
    writer.write(ty);
    one_line(&writer.text)
}

struct Writer<'a> {
    tree: &'a Tree,
    precision: Precision,
    values: std::slice::Iter<'a, TraceValue>,
    text: String,
}

impl Writer<'_> {
    fn write(&mut self, ty: Type) {
        // The rest would be truncated.
        if self.text.len() > 4 * MAX_CHARS {
            return;
        }
        match ty {
            Type::Scalar(scalar) => match self.values.next() {
                Some(&value) => self.text += &scalar_text(value, scalar, self.precision),
                None => self.text.push('?'),
            },
            Type::Vector(scalar, size) => self.list('(', ')', Type::Scalar(scalar), usize::from(size)),
            Type::Matrix { columns, rows } => {
                self.list('(', ')', Type::vector(Scalar::Float, rows), usize::from(columns));
            }
            Type::Array(id) => {
                let array = self.tree.array(id);
                self.list('[', ']', array.element, array.size as usize);
            }
            Type::Struct(id) => {
                self.text += &self.tree[id].name;
                self.text.push('(');
                for (at, member) in self.tree[id].members.iter().enumerate() {
                    self.text += if at == 0 { "" } else { ", " };
                    self.write(member.ty);
                }
                self.text.push(')');
            }
            Type::Void | Type::Sampler(_) | Type::Error => {}
        }
    }

    fn list(&mut self, open: char, close: char, ty: Type, count: usize) {
        self.text.push(open);
        for at in 0..count.min(MAX_CHARS) {
            self.text += if at == 0 { "" } else { ", " };
            self.write(ty);
        }
        self.text.push(close);
    }
}

fn scalar_text(value: TraceValue, scalar: Scalar, precision: Precision) -> String {
    match (of_type(value, scalar), scalar) {
        (TraceValue::Float(value), _) => digits(
            value,
            match precision {
                Precision::Single => NumberType::Single,
                Precision::Double => NumberType::Double,
            },
        ),
        (TraceValue::Word(word), Scalar::Bool) => (word != 0).to_string(),
        (TraceValue::Word(word), Scalar::Uint) => format!("{word}u"),
        (TraceValue::Word(word), _) => word.cast_signed().to_string(),
    }
}

/// Joins a text to one line, truncated to 100 characters.
pub(crate) fn one_line(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.chars().count() <= MAX_CHARS {
        return text;
    }
    text.chars().take(MAX_CHARS - 1).chain(['…']).collect()
}
