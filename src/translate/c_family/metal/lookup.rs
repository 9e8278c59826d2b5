//! Texture lookups in Metal.

use toyproof_glsl::tree::{BuiltIn, ExprId, SamplerShape};

use crate::c_family::Unprintable;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    /// A lookup in the texture `name` with the arguments after the sampler.
    pub(in super::super) fn lookup_in_metal(
        &mut self,
        function: BuiltIn,
        name: &str,
        shape: SamplerShape,
        rest: &[ExprId],
    ) -> PrintResult<Parts> {
        use BuiltIn as B;
        let gradient = match shape {
            SamplerShape::D3 => "gradient3d",
            SamplerShape::Cube => "gradientcube",
            SamplerShape::D2 | SamplerShape::D2Array => "gradient2d",
        };
        // The function of the second argument's option, how many arguments it has, and an offset after it.
        let (option, count, has_offset) = match (function, rest.len()) {
            (B::TexelFetch, 2) => {
                let helper = self.fetch_function(shape);
                return Ok((Self::with_texture(&helper, name, rest), level::POSTFIX));
            }
            (B::TextureSize, 1) => {
                let helper = self.size_function_of_metal(shape);
                return Ok((Self::with_texture(&helper, name, rest), level::POSTFIX));
            }
            (B::Texture, 1) => ("", 0, false),
            (B::Texture, 2) => ("bias", 1, false),
            (B::TextureLod, 2) => ("level", 1, false),
            (B::TextureGrad, 3) => (gradient, 2, false),
            (B::TextureOffset, 2) => ("", 0, true),
            (B::TextureLodOffset, 3) => ("level", 1, true),
            (B::TextureGradOffset, 4) => (gradient, 2, true),
            _ => return Err(Unprintable::Construct("this texture function")),
        };
        let (coordinates, rest) = rest.split_at(1);
        let (options, offset) = rest.split_at(count);
        let mut parts = vec![Part::Token(format!("{name}.sample({name}_sampler, "))];
        parts.extend(Self::list(coordinates));
        if count > 0 {
            parts.push(Part::Token(format!(", {option}(")));
            parts.extend(Self::list(options));
            parts.push(Part::token(")"));
        }
        if has_offset {
            parts.push(Part::token(", "));
            parts.extend(Self::list(offset));
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    /// `helper(texture, a, b)`
    fn with_texture(helper: &str, texture: &str, rest: &[ExprId]) -> Vec<Part> {
        let mut parts = vec![Part::Token(format!("{helper}({texture}, "))];
        parts.extend(Self::list(rest));
        parts.push(Part::token(")"));
        parts
    }

    /// Adds the function that fetches a texel, and returns its name. It returns zeros outside the texture,
    /// where Metal leaves the result open.
    fn fetch_function(&mut self, shape: SamplerShape) -> String {
        let function = self.free("texelFetch");
        let ty = self.language().texture_type(shape);
        let (size, depth) = match shape {
            SamplerShape::D3 => (3, ", image.get_depth(level)"),
            _ => (2, ""),
        };
        let text = format!(
            "// `texelFetch` of GLSL: zeros outside the texture.\n\
             float4 {function}({ty} image, int{size} texel, int level) {{\n    \
             if (level < 0 || level >= int(image.get_num_mip_levels())) {{\n        return float4(0.0);\n    }}\n    \
             uint{size} size = uint{size}(image.get_width(level), image.get_height(level){depth});\n    \
             if (!all(uint{size}(texel) < size)) {{\n        return float4(0.0);\n    }}\n    \
             return image.read(uint{size}(texel), level);\n}}\n"
        );
        self.helpers.insert((function.clone(), ty), text);
        function
    }

    /// Adds the function that returns the size of a level of a texture, and returns its name.
    fn size_function_of_metal(&mut self, shape: SamplerShape) -> String {
        let function = self.free("textureSize");
        let ty = self.language().texture_type(shape);
        let (returned, depth) = match shape {
            SamplerShape::D3 => ("int3", ", image.get_depth(level)"),
            _ => ("int2", ""),
        };
        let text = format!(
            "{returned} {function}({ty} image, int level) {{\n    \
             return {returned}(image.get_width(level), image.get_height(level){depth});\n}}\n"
        );
        self.helpers.insert((function.clone(), ty), text);
        function
    }
}
