//! The state of printing, and what every construct needs: names, types, indentation.

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{FunctionId, Place, Type, VariableId};

use super::Lowered;
use super::names::Names;
use crate::lower::Draft;

/// Prints a draft.
pub(super) struct Printer<'a> {
    pub(super) draft: &'a Draft,
    pub(super) names: &'a Names,
    pub(super) out: Lowered,
    indent: usize,
}

impl<'a> Printer<'a> {
    pub(super) fn new(draft: &'a Draft, names: &'a Names) -> Self {
        Self {
            draft,
            names,
            out: Lowered::default(),
            indent: 0,
        }
    }

    /// Text that prints what the author wrote there.
    pub(super) fn word(&mut self, text: &str, at: Place) {
        self.out.push(text, Some(at.span));
    }

    /// Text of our own, or between two words of the author.
    pub(super) fn plain(&mut self, text: &str) {
        self.out.push(text, None);
    }

    pub(super) fn spanned(&mut self, text: &str, span: Option<Span>) {
        self.out.push(text, span);
    }

    /// Begins a line.
    pub(super) fn line(&mut self) {
        self.plain(&"    ".repeat(self.indent));
    }

    /// ` {`, the lines inside, and `}`.
    pub(super) fn braces(&mut self, inside: impl FnOnce(&mut Self)) {
        self.plain("{\n");
        self.inset(inside);
        self.line();
        self.plain("}");
    }

    /// Lines one step further in.
    pub(super) fn inset(&mut self, inside: impl FnOnce(&mut Self)) {
        self.indent += 1;
        inside(self);
        self.indent -= 1;
    }

    pub(super) fn variable(&self, id: VariableId) -> &'a str {
        self.names.variables.get(&id).unwrap_or(&self.draft.tree[id].name)
    }

    pub(super) fn function(&self, id: FunctionId) -> &'a str {
        self.names.functions.get(&id).unwrap_or(&self.draft.tree[id].name)
    }

    /// The type as naga reads it: `float[3][2]` for two arrays of three, since naga applies sizes from left to right.
    pub(super) fn type_name(&self, mut ty: Type) -> String {
        let mut sizes = String::new();
        while let Type::Array(id) = ty {
            let array = self.draft.tree.array(id);
            sizes.insert_str(0, &format!("[{}]", array.size));
            ty = array.element;
        }
        match ty {
            Type::Struct(id) => self.names.structs.get(&id).cloned().unwrap_or_default() + &sizes,
            _ => self.draft.tree.type_name(ty) + &sizes,
        }
    }
}
