//! The state of printing: lines, names, types. An expression that does something is printed as lines before the statement that it
//! stands in, so that what is left of it is a value.

use std::collections::{BTreeMap, HashMap, HashSet};

use toyproof_diagnostic::{Deadline, Files};
use toyproof_glsl::tree::{ExprId, FunctionId, Place, Scalar, Type, VariableId};

use super::comment::Comments;
use super::facts::Facts;
use super::names::Names;
use super::style::Style;
use super::{Unprintable, wrap};
use crate::lower::Draft;
use crate::print::Order;

/// Prints a draft.
pub(super) struct Writer<'a> {
    pub(super) draft: &'a Draft,
    pub(super) names: &'a Names,
    pub(super) facts: &'a Facts,
    pub(super) style: Style,
    pub(super) comments: Comments<'a>,
    pub(super) deadline: &'a Deadline,
    pub(super) out: String,
    pub(super) indent: usize,
    /// Names of our own that are in use in this function.
    pub(super) temporaries: HashSet<String>,
    /// Every number gets its suffix: what stands among numbers only is computed in 32 bits, too.
    pub(super) suffixed: bool,
    /// Which expressions are made of numbers only, as far as it was found out.
    pub(super) abstract_numbers: HashMap<ExprId, bool>,
    /// Steps that are done at the end of their statement.
    pub(super) waiting: HashSet<ExprId>,
    /// Which expressions print lines before their value, as far as it was found out.
    pub(super) hoisting: HashMap<ExprId, bool>,
    /// Macros that stand for a number, by name, with what they are declared as.
    pub(super) macros: BTreeMap<String, String>,
    /// Functions of our own that are called, by name.
    pub(super) helpers: BTreeMap<String, String>,
    /// Whether something compares with the pixel's neighbours.
    pub(super) derives: bool,
    /// Whether `gl_FragCoord` is read elsewhere than by `mainImage`'s caller.
    pub(super) reads_position: bool,
}

impl<'a> Writer<'a> {
    pub(super) fn new(
        draft: &'a Draft,
        names: &'a Names,
        facts: &'a Facts,
        style: Style,
        files: &'a Files,
        deadline: &'a Deadline,
    ) -> Self {
        Self {
            draft,
            names,
            facts,
            style,
            comments: Comments::new(files),
            deadline,
            out: String::new(),
            indent: 0,
            temporaries: HashSet::new(),
            abstract_numbers: HashMap::new(),
            suffixed: false,
            waiting: HashSet::new(),
            hoisting: HashMap::new(),
            macros: BTreeMap::new(),
            helpers: BTreeMap::new(),
            derives: false,
            reads_position: false,
        }
    }

    /// Fails if the time is over, to be told as such by whoever asked for the text.
    pub(super) fn in_time(&self) -> Result<(), Unprintable> {
        if self.deadline.is_over() {
            return Err(Unprintable("what takes too long"));
        }
        Ok(())
    }

    /// A line at the present depth.
    pub(super) fn line(&mut self, text: &str) {
        wrap::put(&mut self.out, text, self.indent);
    }

    /// Lines one step further in.
    pub(super) fn inset<T>(&mut self, inside: impl FnOnce(&mut Self) -> T) -> T {
        self.indent += 1;
        let value = inside(self);
        self.indent -= 1;
        value
    }

    /// The comment lines above a place, if they were not printed yet.
    pub(super) fn comment(&mut self, at: Place) {
        for line in self.comments.above(at) {
            self.line(&line);
        }
    }

    /// Puts the comment that the author has behind a place behind the line that was printed from there on, or above several.
    pub(super) fn comment_behind(&mut self, at: Place, from: usize) {
        let Some(comment) = self.comments.behind(at) else {
            return;
        };
        let is_one_line = self.out[from..].matches('\n').count() == 1;
        if is_one_line {
            self.out.pop();
            self.out.push(' ');
            self.out.push_str(&comment);
            self.out.push('\n');
        } else {
            let lines = self.out.split_off(from);
            self.line(&comment);
            self.out.push_str(&lines);
        }
    }

    /// A name of our own that nothing has.
    pub(super) fn temporary(&mut self, stem: &str) -> String {
        let is_taken = |name: &str| {
            super::word::is_taken(name) || self.names.all.contains(name) || self.temporaries.contains(name)
        };
        let name = super::word::free(stem, is_taken);
        self.temporaries.insert(name.clone());
        name
    }

    pub(super) fn variable(&self, id: VariableId) -> &'a str {
        self.names.variables.get(&id).unwrap_or(&self.draft.tree[id].name)
    }

    pub(super) fn function(&self, id: FunctionId) -> &'a str {
        self.names.functions.get(&id).unwrap_or(&self.draft.tree[id].name)
    }

    pub(super) fn type_name(&self, ty: Type) -> String {
        type_name(self.draft, self.names, ty)
    }

    /// The whole text: the author's first comment, the style's head, the items, the style's end.
    pub(super) fn write(mut self, order: &Order) -> Result<String, Unprintable> {
        let mut first = self
            .comments
            .first(self.draft.tree[self.draft.main_image].at)
            .join("\n");
        if !first.is_empty() {
            first.push_str("\n\n");
        }
        for &item in &order.items {
            self.item(item)?;
        }
        let items = std::mem::take(&mut self.out);
        self.style_end();
        let end = std::mem::take(&mut self.out);
        self.style_head(order)?;
        let mut text = first + &std::mem::take(&mut self.out);
        if !self.macros.is_empty() {
            for declaration in self.macros.values() {
                text.push_str(declaration);
                text.push('\n');
            }
            text.push('\n');
        }
        for helper in self.helpers.values() {
            text.push_str(helper);
            text.push('\n');
        }
        text.push_str(items.trim_start_matches('\n'));
        text.push_str(&end);
        Ok(text)
    }
}

/// A type as WGSL calls it.
pub(super) fn type_name(draft: &Draft, names: &Names, ty: Type) -> String {
    let suffix = |scalar| match scalar {
        Scalar::Float => Some('f'),
        Scalar::Int => Some('i'),
        Scalar::Uint => Some('u'),
        Scalar::Bool => None,
    };
    match ty {
        Type::Scalar(scalar) => scalar_name(scalar).to_owned(),
        Type::Vector(scalar, size) => match suffix(scalar) {
            Some(suffix) => format!("vec{size}{suffix}"),
            None => format!("vec{size}<bool>"),
        },
        Type::Matrix { columns, rows } => format!("mat{columns}x{rows}f"),
        Type::Struct(id) => names.structs.get(&id).cloned().unwrap_or_default(),
        Type::Array(id) => {
            let array = draft.tree.array(id);
            format!(
                "array<{}, {}>",
                type_name(draft, names, array.element),
                array.size
            )
        }
        Type::Void | Type::Sampler(_) | Type::Error => String::new(),
    }
}

/// A scalar type as WGSL calls it.
pub(super) fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::Int => "i32",
        Scalar::Uint => "u32",
        Scalar::Float => "f32",
    }
}
