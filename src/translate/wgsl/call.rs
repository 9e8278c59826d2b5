//! Calls of the author's functions. What is `out` or `inout` is a pointer, which WGSL gives to local variables only: others are copied in
//! and out.

use toyproof_glsl::tree::{ExprId, ExprKind, FunctionId, Type, VariableKind};

use super::Unprintable;
use super::facts::is_out;
use super::text::{Printed, Text};
use super::writer::Writer;

impl Writer<'_> {
    /// The pointer that an `out` argument is passed as, if it is a variable that a function may be given one of.
    pub(super) fn pointer(&self, argument: ExprId) -> Option<String> {
        let ExprKind::Variable(id) = self.draft.tree[argument].kind else {
            return None;
        };
        match self.draft.tree[id].kind {
            _ if is_out(self.draft, id) => Some(self.variable(id).to_owned()),
            VariableKind::Local | VariableKind::Parameter(_) => Some(format!("&{}", self.variable(id))),
            _ => None,
        }
    }

    /// A call of a function of the author's.
    pub(super) fn call(&mut self, function: FunctionId, arguments: &[ExprId], ty: Type) -> Printed {
        let parameters = &self.draft.tree[function].parameters;
        let mut plain = Vec::new();
        let mut back = Vec::new();
        for (&argument, &parameter) in arguments.iter().zip(parameters) {
            if !is_out(self.draft, parameter) {
                plain.push(argument);
            } else if self.pointer(argument).is_none() {
                back.push(argument);
            }
        }
        let mut values = self.values(&plain)?.into_iter();
        let mut copies = Vec::new();
        for &argument in &back {
            let value = self.value(argument)?;
            let name = self.temporary(&format!(
                "{}_copy",
                value.words.rsplit('.').next().unwrap_or_default()
            ));
            self.line(&format!("var {name} = {};", value.words));
            copies.push((argument, name));
        }
        let mut names = copies.iter();
        let mut texts = Vec::new();
        for (&argument, &parameter) in arguments.iter().zip(parameters) {
            texts.push(if !is_out(self.draft, parameter) {
                values.next().ok_or(Unprintable("a call"))?
            } else if let Some(pointer) = self.pointer(argument) {
                Text::primary(pointer)
            } else {
                let (_, name) = names.next().ok_or(Unprintable("a call"))?;
                Text::primary(format!("&{name}"))
            });
        }
        let call = format!("{}({})", self.function(function), Self::list(texts));
        if copies.is_empty() {
            return Ok(Text::primary(call));
        }
        let result = if ty == Type::Void {
            self.line(&format!("{call};"));
            Text::primary("")
        } else {
            self.keep_as("result", &Text::primary(call))
        };
        for (argument, name) in copies {
            self.set(argument, &Text::primary(name))?;
        }
        Ok(result)
    }
}
