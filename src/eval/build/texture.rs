//! Lookups of channels (§8.8). Channels have one level, repeat, and are filtered between texels; volumes and cubes are black.

use toyproof_glsl::tree::{BuiltIn, ExprId, Input, Sampler, Scalar, Type};

use super::{Builder, Result, layout};
use crate::ir::function::{Lookup, NONE, Origin, Value};
use crate::ir::operation::Operation;
use crate::observe::{Fault, Predicate};

impl Builder<'_> {
    pub(super) fn texture(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        call: ExprId,
    ) -> Result<Vec<Value>> {
        use BuiltIn as B;
        let Some((&sampler, others)) = arguments.split_first() else {
            return Ok(Vec::new());
        };
        let channel = self.channel(sampler);
        let mut values = Vec::with_capacity(others.len());
        for &argument in others {
            values.push(self.expression(argument)?);
        }
        let flat = Type::Sampler(Sampler::D2);
        let Some(channel) = channel.filter(|_| self.ty(sampler) == flat) else {
            let nothing = self.nothing(function, channel.is_some(), self.ty(call));
            let (B::TextureSize, Some(&[level, ..])) = (function, values.first().map(Vec::as_slice)) else {
                return Ok(nothing);
            };
            let each = nothing.into_iter().map(|size| {
                self.check(Fault::NoLevel, self.at(call), Predicate::From(1), [level, NONE]);
                self.settle(size)
            });
            return Ok(each.collect());
        };
        if function == B::TextureSize {
            let level = values[0][0];
            self.check(Fault::NoLevel, self.at(call), Predicate::From(1), [level, NONE]);
            let size = [0, 1].map(|at| {
                let size = self.value(Origin::Input(Input::ChannelResolution, 3 * channel + at));
                let size = self.unary(Operation::ToInt, size);
                // What reads black is one texel.
                self.binary(Operation::MaxInt, size, self.word(1))
            });
            return Ok(self.settle_all(size).to_vec());
        }
        if matches!(function, B::TexelFetch | B::TexelFetchOffset) {
            let mut at = [values[0][0], values[0][1]];
            if function == B::TexelFetchOffset {
                at = [0, 1].map(|axis| self.binary(Operation::AddWord, at[axis], values[2][axis]));
            }
            return Ok(self.texels(channel, Lookup::Fetched, at).to_vec());
        }
        let coordinates = &values[0];
        let mut at = [coordinates[0], coordinates[1]];
        if is_projected(function) {
            let by = coordinates[coordinates.len() - 1];
            at = at.map(|x| self.binary(Operation::Div, x, by));
        }
        for x in at {
            self.check(Fault::NoPlace, self.at(call), Predicate::NoInt, [x, NONE]);
        }
        let mut offset = [0; 2];
        if let Some(position) = offset_position(function)
            && let Some(value) = others.get(position).and_then(|&offset| self.tree.value(offset))
        {
            for (axis, scalar) in offset.iter_mut().zip(value.components()) {
                if let toyproof_glsl::tree::Value::Int(texels) = scalar {
                    *axis = *texels;
                }
            }
        }
        let texels = self.texels(channel, Lookup::Filtered { offset }, at);
        Ok(self.settle_all(texels).to_vec())
    }

    fn texels(&self, channel: u8, lookup: Lookup, at: [Value; 2]) -> [Value; 4] {
        [0, 1, 2, 3].map(|component| {
            self.value(Origin::Texel {
                channel,
                lookup,
                component,
                at,
            })
        })
    }

    /// What a texture gives that is not there: black, of one texel if it is a channel.
    fn nothing(&self, function: BuiltIn, is_channel: bool, ty: Type) -> Vec<Value> {
        let size = layout::size(self.tree, ty);
        if function == BuiltIn::TextureSize {
            return vec![self.word(u32::from(is_channel)); size];
        }
        let float = ty.scalar() == Some(Scalar::Float);
        (0..size)
            .map(|at| match (at == 3, float) {
                (false, true) => self.float(0.0),
                (true, true) => self.float(1.0),
                (last, false) => self.word(u32::from(last)),
            })
            .collect()
    }
}

fn is_projected(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::TextureProj
            | B::TextureProjOffset
            | B::TextureProjLod
            | B::TextureProjLodOffset
            | B::TextureProjGrad
            | B::TextureProjGradOffset
    )
}

/// Which argument after the sampler is the offset.
fn offset_position(function: BuiltIn) -> Option<usize> {
    use BuiltIn as B;
    match function {
        B::TextureOffset | B::TextureProjOffset => Some(1),
        B::TextureLodOffset | B::TextureProjLodOffset => Some(2),
        B::TextureGradOffset | B::TextureProjGradOffset => Some(3),
        _ => None,
    }
}
