//! Texture lookups: a channel is a texture and a sampler in HLSL.

use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, SamplerShape, Type, VariableKind};

use super::Unprintable;
use super::expression::{Part, Parts, level};
use super::language::Language;
use super::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn lookup(&mut self, function: BuiltIn, arguments: &[ExprId]) -> PrintResult<Parts> {
        use BuiltIn as B;
        const ARGUMENT: Unprintable = Unprintable::Construct("this texture argument");
        let (&sampler, rest) = arguments.split_first().ok_or(ARGUMENT)?;
        let tree = &self.cx.tree;
        let ExprKind::Variable(id) = tree[sampler].kind else {
            return Err(ARGUMENT);
        };
        if self.language() == Language::Glsl {
            return Ok((Self::call(function.name(), arguments), level::POSTFIX));
        }
        let shape = match (tree[id].kind, tree[id].ty) {
            (VariableKind::Channel(_), Type::Sampler(sampler))
                if sampler.shape != SamplerShape::D2Array && !sampler.shadow =>
            {
                sampler.shape
            }
            _ => return Err(ARGUMENT),
        };
        let name = self.variable(id);
        match self.language() {
            Language::Hlsl | Language::Glsl => {}
            Language::Msl => return self.lookup_in_metal(function, name, shape, rest),
            Language::Godot => {
                let mut parts = vec![Part::Token(format!("{}({name}, ", function.name()))];
                parts.extend(Self::list(rest));
                parts.push(Part::token(")"));
                return Ok((parts, level::POSTFIX));
            }
        }
        let method = match (function, rest.len()) {
            (B::Texture, 1) => "Sample",
            (B::Texture, 2) => "SampleBias",
            (B::TextureLod, 2) => "SampleLevel",
            (B::TextureGrad, 3) => "SampleGrad",
            (B::TexelFetch, 2) => {
                let whole = match shape {
                    SamplerShape::D3 => "int4",
                    _ => "int3",
                };
                let mut parts = Self::call(format!("{name}.Load({whole}"), rest);
                parts.push(Part::token(")"));
                return Ok((parts, level::POSTFIX));
            }
            (B::TextureSize, 1) => {
                let mut parts = vec![Part::Token(format!("{}({name}, ", self.size_function(shape)))];
                parts.extend(Self::list(rest));
                parts.push(Part::token(")"));
                return Ok((parts, level::POSTFIX));
            }
            _ => return Err(Unprintable::Construct("this texture function")),
        };
        let mut parts = vec![Part::Token(format!("{name}.{method}({name}_sampler, "))];
        parts.extend(Self::list(rest));
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    /// Adds the function that returns the size of a level of a texture, and returns its name.
    fn size_function(&mut self, shape: SamplerShape) -> String {
        let function = self.free("textureSize");
        let ty = Language::Hlsl.texture_type(shape);
        let (returned, depth, size) = match shape {
            SamplerShape::D3 => ("int3", ", depth", "int3(width, height, depth)"),
            _ => ("int2", "", "int2(width, height)"),
        };
        let text = format!(
            "{returned} {function}({ty} image, int level) {{\n    uint width, height{depth}, levels;\n    \
             image.GetDimensions(level, width, height{depth}, levels);\n    return {size};\n}}\n"
        );
        self.helpers.insert((function.clone(), ty), text);
        function
    }
}
