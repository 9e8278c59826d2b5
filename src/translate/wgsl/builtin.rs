//! Built-in functions: most have the same name in WGSL, some are operators there, few are missing.

use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, SamplerShape, Scalar, Type, VariableKind, Wgsl};

use super::Unprintable;
use super::style::Style;
use super::writer::{Class, Text, TextResult, Writer};

impl Writer<'_> {
    pub(super) fn built_in(&mut self, function: BuiltIn, arguments: &[ExprId], ty: Type) -> TextResult {
        use BuiltIn as B;
        if function.is_texture() {
            return self.lookup(function, arguments, ty);
        }
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.cx.tree[argument].ty)
            .collect();
        let outer = self.suffixed;
        let is_abstract = arguments.iter().all(|&argument| self.is_abstract(argument));
        self.suffixed |= is_abstract;
        let texts = self.values(arguments);
        self.suffixed = outer;
        let mut texts = texts?;
        if let Wgsl::Operator(op) = function.wgsl() {
            // WGSL compares vectors component by component, like numbers.
            let code: Vec<_> = texts.into_iter().map(Text::term).collect();
            return Ok(Text::new(
                code.join(&format!(" {} ", op.symbol())),
                Class::Relation,
            ));
        }
        self.uses_derivatives |= function.is_derivative();
        let name = match (function, function.wgsl()) {
            (B::Mod, _) => return self.modulo(texts, ty, types.last().copied().unwrap_or(ty)),
            (B::Not, _) => {
                let operand = texts.pop().ok_or(Unprintable::Construct("this call"))?.operand();
                return Ok(Text::new(format!("!{operand}"), Class::Unary));
            }
            (B::Atan, _) if texts.len() == 2 => "atan2",
            (B::DFdy, _) if self.style.is_upside_down(self.cx.stage) => {
                let operand = Self::list(texts);
                return Ok(Text::new(format!("-dpdy({operand})"), Class::Unary));
            }
            (B::DFdy, _) => "dpdy",
            (B::Mix, _) if types.last().and_then(|ty| ty.scalar()) == Some(Scalar::Bool) => "select",
            (_, Wgsl::Bitcast) => {
                let name = self.type_name(ty);
                return Ok(Text::primary(format!("bitcast<{name}>({})", Self::list(texts))));
            }
            (_, Wgsl::Missing) => return Err(Unprintable::Construct("this built-in function")),
            (_, Wgsl::Named(name)) => name,
            (other, _) => other.name(),
        };
        // WGSL does not extend scalars to vectors, except in the last argument of `mix`.
        let splats = function == B::Mix || function.wgsl() == Wgsl::Splat;
        if let (true, Type::Vector(..)) = (splats, ty) {
            let vector = self.type_name(ty);
            let last = texts.len() - 1;
            for (at, (text, from)) in texts.iter_mut().zip(&types).enumerate() {
                if matches!(from, Type::Scalar(_)) && !(function == B::Mix && at == last) {
                    *text = Text::primary(format!("{vector}({})", text.code));
                }
            }
        }
        Ok(Text::primary(format!("{name}({})", Self::list(texts))))
    }

    /// Prints `mod` as a call of a helper function: WGSL's `%` truncates.
    fn modulo(&mut self, texts: Vec<Text>, ty: Type, divisor: Type) -> TextResult {
        let [x, mut y] = <[Text; 2]>::try_from(texts).map_err(|_| Unprintable::Construct("this call"))?;
        if self.indent == 0 {
            // Module-scope initializers cannot call functions.
            let [x, y] = [x.operand(), y.operand()];
            return Ok(Text::new(format!("{x} - {y} * floor({x} / {y})"), Class::Sum));
        }
        let name = self.type_name(ty);
        if ty != divisor {
            y = Text::primary(format!("{name}({})", y.code));
        }
        let stem = match ty {
            Type::Vector(..) => format!("modulo_{name}"),
            _ => "modulo".to_owned(),
        };
        let is_taken = |word: &str| self.names.all.contains(word);
        let function = super::names::free(&stem, is_taken);
        let call = format!("{function}({})", Self::list(vec![x, y]));
        self.helpers.insert(
            function.clone(),
            format!(
                "// `mod` of GLSL: WGSL's `%` rounds towards zero.\n\
                 fn {function}(x: {name}, y: {name}) -> {name} {{\n    return x - y * floor(x / y);\n}}\n"
            ),
        );
        Ok(Text::primary(call))
    }
}

// Texture lookups: a channel is a texture and a sampler.

impl Writer<'_> {
    pub(super) fn lookup(&mut self, function: BuiltIn, arguments: &[ExprId], ty: Type) -> TextResult {
        use BuiltIn as B;
        let (&sampler, rest) = arguments
            .split_first()
            .ok_or(Unprintable::Construct("this call"))?;
        let tree = &self.cx.tree;
        let channel = match tree[sampler].kind {
            ExprKind::Variable(id) => match (tree[id].kind, tree[id].ty) {
                (VariableKind::Channel(channel), Type::Sampler(sampler))
                    if sampler.shape != SamplerShape::D2Array && !sampler.shadow =>
                {
                    channel
                }
                _ => return Err(Unprintable::Construct("this texture argument")),
            },
            _ => return Err(Unprintable::Construct("this texture argument")),
        };
        if function == B::TextureSize {
            let level = self.value(rest.first().copied().ok_or(Unprintable::Construct("this call"))?)?;
            let size = self.type_name(ty);
            let texture = self.style.texture(channel);
            return Ok(Text::primary(format!(
                "{size}(textureDimensions({texture}, {}))",
                level.code
            )));
        }
        let list = Self::list(self.values(rest)?);
        let texture = self.style.texture(channel);
        let pair = format!("{texture}, {}", self.style.sampler(channel));
        let code = match (function, rest.len()) {
            // Compute shaders have no derivatives; the host's textures have one level.
            (B::Texture, 1) if self.style == Style::ComputeToys => {
                format!("textureSampleLevel({pair}, {list}, 0.0)")
            }
            (B::Texture, 1) => {
                self.uses_derivatives = true;
                format!("textureSample({pair}, {list})")
            }
            (B::Texture, 2) => {
                self.uses_derivatives = true;
                format!("textureSampleBias({pair}, {list})")
            }
            (B::TextureLod, 2) => format!("textureSampleLevel({pair}, {list})"),
            (B::TextureGrad, 3) => format!("textureSampleGrad({pair}, {list})"),
            (B::TexelFetch, 2) => {
                let function = self.texel_fetch(tree[sampler].ty);
                format!("{function}({texture}, {list})")
            }
            _ => return Err(Unprintable::Construct("this texture function")),
        };
        Ok(Text::primary(code))
    }

    /// Adds the function that fetches a texel of a texture of this type, and returns its name: beyond the
    /// texture, WGSL's `textureLoad` returns any texel or zeros.
    fn texel_fetch(&mut self, sampler: Type) -> String {
        let is_volume = matches!(sampler, Type::Sampler(sampler) if sampler.shape == SamplerShape::D3);
        let (stem, size) = if is_volume {
            ("texel_fetch_3d", 3)
        } else {
            ("texel_fetch", 2)
        };
        let is_taken = |word: &str| self.names.all.contains(word);
        let function = super::names::free(stem, is_taken);
        self.helpers.insert(
            function.clone(),
            format!(
                "// `texelFetch` of GLSL: zeros beyond the texture, where `textureLoad` may return any texel.\n\
                 fn {function}(source: texture_{size}d<f32>, texel: vec{size}i, level: i32) -> vec4f {{\n    \
                 if level < 0 || level >= i32(textureNumLevels(source))\n        \
                 || any(vec{size}u(texel) >= textureDimensions(source, level)) {{\n        \
                 return vec4f();\n    }}\n    \
                 return textureLoad(source, texel, level);\n}}\n"
            ),
        );
        function
    }
}
