//! Built-in functions in Godot's language: those of GLSL, with few exceptions.

use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, Literal, Scalar, Type, Value};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in_of_godot(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        use BuiltIn as B;
        // Godot's compiler takes these functions of literals for ones of floats.
        if let Some(value) = self.of_integers(function, arguments) {
            return Ok((
                vec![Part::Token(value.to_string())],
                if value < 0 { level::UNARY } else { level::POSTFIX },
            ));
        }
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.cx.tree[argument].ty)
            .collect();
        let name = match function {
            B::Mix if types.last().and_then(|ty| ty.scalar()) == Some(Scalar::Bool) => {
                self.mix_of_bool(&types, ty)?
            }
            // Square matrices only.
            B::OuterProduct if self.type_name(ty).is_err() => {
                return Err(Unprintable::Construct("a matrix that is not square"));
            }
            other => other.name().to_owned(),
        };
        Ok((Self::call(name, arguments), level::POSTFIX))
    }

    /// The value of a function of literal integers.
    fn of_integers(&self, function: BuiltIn, arguments: &[ExprId]) -> Option<i32> {
        let values = arguments
            .iter()
            .map(|&argument| match &self.cx.tree[argument].kind {
                ExprKind::Literal(Literal {
                    value: Value::Int(value),
                    ..
                }) => Some(*value),
                _ => None,
            });
        match (function, &values.collect::<Option<Vec<i32>>>()?[..]) {
            (BuiltIn::Min, &[a, b]) => Some(a.min(b)),
            (BuiltIn::Max, &[a, b]) => Some(a.max(b)),
            (BuiltIn::Clamp, &[x, low, high]) => Some(x.max(low).min(high)),
            (BuiltIn::Abs, &[x]) => x.checked_abs(),
            (BuiltIn::Sign, &[x]) => Some(x.signum()),
            _ => None,
        }
    }
}
