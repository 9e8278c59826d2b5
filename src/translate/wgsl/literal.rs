//! Literals. WGSL evaluates expressions of unsuffixed literals in 64 bits, GLSL in 32.

use toyproof_glsl::tree::{ExprId, ExprKind, Literal, Place, Type, UnaryOp, Value};

use super::writer::Writer;
use crate::author::{float, is_hexadecimal};

impl Writer<'_> {
    /// Whether an expression consists of literals only, so that WGSL gives it an abstract type. Results are
    /// cached and found by iteration, since each operator of a chain checks its operands.
    pub(super) fn is_abstract(&mut self, root: ExprId) -> bool {
        let tree = &self.cx.tree;
        let mut pending = vec![(root, false)];
        while let Some((id, operands_done)) = pending.pop() {
            if self.abstract_numbers.contains_key(&id) {
                continue;
            }
            let may_be = match &tree[id].kind {
                ExprKind::Literal(literal) => {
                    matches!(literal.value, Value::Float(_) | Value::Int(_)) && !self.is_macro(id)
                }
                ExprKind::Unary { op, .. } => matches!(op, UnaryOp::Minus | UnaryOp::Plus),
                ExprKind::Binary { .. } | ExprKind::BuiltIn { .. } => true,
                _ => false,
            };
            if may_be && !operands_done {
                pending.push((id, true));
                tree[id]
                    .kind
                    .for_each_operand(|operand| pending.push((operand, false)));
                continue;
            }
            let mut is_abstract = may_be;
            if may_be {
                tree[id]
                    .kind
                    .for_each_operand(|operand| is_abstract &= self.abstract_numbers[&operand]);
            }
            self.abstract_numbers.insert(id, is_abstract);
        }
        self.abstract_numbers[&root]
    }

    /// Prints a literal, or the constant of the macro that it comes from.
    pub(super) fn literal(&mut self, literal: &Literal, at: Place) -> String {
        if let Some(name) = self.macro_of(literal, at) {
            return name;
        }
        self.number(literal)
    }

    fn number(&self, literal: &Literal) -> String {
        match literal.value {
            Value::Bool(value) => value.to_string(),
            Value::Float(value) => {
                let suffix = if self.suffixed { "f" } else { "" };
                float(&literal.text, value) + suffix
            }
            Value::Int(value) => {
                let suffix = if self.suffixed { "i" } else { "" };
                if value == i32::MIN {
                    "i32(-2147483648)".to_owned()
                } else if value > 0 && is_hexadecimal(&literal.text) {
                    format!("{}{suffix}", literal.text)
                } else {
                    format!("{value}{suffix}")
                }
            }
            Value::Uint(_) if is_hexadecimal(&literal.text) => {
                format!("{}u", literal.text.trim_end_matches(['u', 'U']))
            }
            Value::Uint(value) => format!("{value}u"),
        }
    }

    /// The macro whose entire replacement is this literal; it is declared as a constant of the same name.
    fn macro_of(&mut self, literal: &Literal, at: Place) -> Option<String> {
        let name = self.macro_name(at)?;
        let ty = match literal.value {
            Value::Float(_) => "f32",
            Value::Int(_) => "i32",
            Value::Uint(_) => "u32",
            Value::Bool(_) => "bool",
        };
        let suffixed = std::mem::take(&mut self.suffixed);
        let declaration = format!("const {name}: {ty} = {};", self.number(literal));
        self.suffixed = suffixed;
        self.macros.declare(&name, declaration, at).then_some(name)
    }

    /// Whether a literal is printed as the name of a macro.
    fn is_macro(&self, id: ExprId) -> bool {
        self.macro_name(self.cx.tree[id].at).is_some()
    }

    fn macro_name(&self, at: Place) -> Option<String> {
        let name = self.source.macro_name(at)?;
        let is_free = !super::names::is_taken(name) && !self.names.all.contains(name);
        is_free.then(|| name.to_owned())
    }

    /// The zero value of a type.
    pub(super) fn zero(&self, ty: Type) -> String {
        match ty {
            Type::Scalar(scalar) => match scalar {
                toyproof_glsl::tree::Scalar::Bool => "false".to_owned(),
                toyproof_glsl::tree::Scalar::Float => "0.0".to_owned(),
                toyproof_glsl::tree::Scalar::Int => "0".to_owned(),
                toyproof_glsl::tree::Scalar::Uint => "0u".to_owned(),
            },
            _ => format!("{}()", self.type_name(ty)),
        }
    }
}
