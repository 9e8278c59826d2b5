//! Built-in functions: each language has its own names for some of them, and lacks a few.

mod godot;
mod hlsl;
mod msl;

use toyproof_glsl::tree::{BuiltIn, ExprId, Type};

use super::Unprintable;
use super::expression::{Parts, level};
use super::language::Language;
use super::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        if function.is_texture() {
            return self.lookup(function, arguments);
        }
        match self.language() {
            Language::Hlsl => self.built_in_of_hlsl(function, arguments, ty),
            Language::Godot => self.built_in_of_godot(function, arguments, ty),
            Language::Glsl => Ok((Self::call(function.name(), arguments), level::POSTFIX)),
            Language::Msl => self.built_in_of_metal(function, arguments, ty),
        }
    }

    /// Adds the function that divides a matrix by a number, column by column, and returns its name: some
    /// compilers multiply by the reciprocal.
    pub(super) fn division(&mut self, matrix: Type) -> PrintResult<String> {
        let Type::Matrix { columns, .. } = matrix else {
            return Err(Unprintable::Construct("this division"));
        };
        let columns: Vec<_> = (0..columns).map(|column| format!("x[{column}] / y")).collect();
        let body = format!("return {}({});", self.type_name(matrix)?, columns.join(", "));
        self.helper_function("divide", &[matrix, Type::FLOAT], matrix, "", &body)
    }

    /// Adds the function `mix(x, y, a)` of a `bool` for each component, and returns its name.
    fn mix_of_bool(&mut self, types: &[Type], ty: Type) -> PrintResult<String> {
        let body = mix_of_bool(&self.type_name(ty)?, ty.component_count().unwrap_or(1));
        let name = match self.language() {
            Language::Hlsl => "mix",
            Language::Msl | Language::Godot | Language::Glsl => "mixBool",
        };
        self.helper_function(name, types, ty, "", &body)
    }

    /// Adds a function that replaces a built-in one, with parameters `x`, `y`, `a` of these types, and
    /// returns its name.
    pub(super) fn helper_function(
        &mut self,
        name: &str,
        types: &[Type],
        returned: Type,
        comment: &str,
        body: &str,
    ) -> PrintResult<String> {
        // Members of a structure are computed at run time.
        if self.indent == 0 && self.language() != Language::Msl {
            return Err(Unprintable::Construct(
                "this built-in function in a global constant",
            ));
        }
        let function = self.free(name);
        let parameters = types
            .iter()
            .zip(["x", "y", "a"])
            .map(|(&ty, name)| self.declarator(ty, name));
        let parameters = parameters.collect::<PrintResult<Vec<_>>>()?.join(", ");
        let returned = self.type_name(returned)?;
        let text = format!("{comment}{returned} {function}({parameters}) {{\n    {body}\n}}\n");
        self.helpers.insert((function.clone(), parameters), text);
        Ok(function)
    }
}

/// The body of `mix(x, y, a)` of a `bool` for each component. HLSL selects components in different ways
/// before and since its version of 2021.
fn mix_of_bool(ty: &str, size: u8) -> String {
    if size == 1 {
        return "return a ? y : x;".to_owned();
    }
    let component = |at: u8| {
        let letter = char::from(b"xyzw"[usize::from(at)]);
        format!("a.{letter} ? y.{letter} : x.{letter}")
    };
    let components: Vec<_> = (0..size.min(4)).map(component).collect();
    format!("return {ty}({});", components.join(", "))
}
