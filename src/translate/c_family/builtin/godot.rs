//! Built-in functions in Godot's language: those of GLSL, with few exceptions.

use toyproof_glsl::tree::{BuiltIn, ExprId, Scalar, Type};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in_of_godot(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        use BuiltIn as B;
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
}
