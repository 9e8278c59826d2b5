//! Lookups of textures. A channel is a texture and a sampler.

use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, Input, SamplerShape, Type, VariableKind};

use super::Unprintable;
use super::style::Style;
use super::text::{Printed, Text};
use super::writer::Writer;

impl Writer<'_> {
    pub(super) fn lookup(&mut self, function: BuiltIn, arguments: &[ExprId], ty: Type) -> Printed {
        use BuiltIn as B;
        let (&sampler, rest) = arguments.split_first().ok_or(Unprintable("a call"))?;
        let tree = &self.draft.tree;
        let channel = match tree[sampler].kind {
            ExprKind::Variable(id) => match (tree[id].kind, tree[id].ty) {
                (VariableKind::Input(Input::Channel(channel)), Type::Sampler(sampler))
                    if sampler.shape != SamplerShape::D2Array && !sampler.shadow =>
                {
                    channel
                }
                _ => return Err(Unprintable("that texture")),
            },
            _ => return Err(Unprintable("that texture")),
        };
        if function == B::TextureSize {
            let level = self.value(rest.first().copied().ok_or(Unprintable("a call"))?)?;
            let size = self.type_name(ty);
            let texture = self.style.texture(channel);
            return Ok(Text::primary(format!(
                "{size}(textureDimensions({texture}, {}))",
                level.words
            )));
        }
        let list = Self::list(self.values(rest)?);
        let texture = self.style.texture(channel);
        let pair = format!("{texture}, {}", self.style.sampler(channel));
        let words = match (function, rest.len()) {
            // Compute shaders have no neighbours; the host's textures have one level.
            (B::Texture, 1) if self.style == Style::ComputeToys => {
                format!("textureSampleLevel({pair}, {list}, 0.0)")
            }
            (B::Texture, 1) => {
                self.derives = true;
                format!("textureSample({pair}, {list})")
            }
            (B::Texture, 2) => {
                self.derives = true;
                format!("textureSampleBias({pair}, {list})")
            }
            (B::TextureLod, 2) => format!("textureSampleLevel({pair}, {list})"),
            (B::TextureGrad, 3) => format!("textureSampleGrad({pair}, {list})"),
            (B::TexelFetch, 2) => format!("textureLoad({texture}, {list})"),
            _ => return Err(Unprintable("that lookup of a texture")),
        };
        Ok(Text::primary(words))
    }
}
