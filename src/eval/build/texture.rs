//! Lookups of channels (§8.8) as operations. Volumes and cubes are black.

use toyproof_glsl::Filter;
use toyproof_glsl::tree::{BuiltIn, ExprId, Input, Sampler, Scalar, Type};

use super::lvalue::component_count;
use super::{Builder, Result};
use crate::ir::{NONE, Operation, Value, ValueDef};
use crate::observe::{Fault, Predicate};
use crate::texture::Lookup;

/// One more than the last level of the largest texture.
const MOST_LEVELS: u32 = 15;

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
        let sampler_2d = Type::Sampler(Sampler::D2);
        let Some(channel) = channel.filter(|_| self.ty(sampler) == sampler_2d) else {
            let nothing = self.nothing(function, channel.is_some(), self.ty(call));
            let (B::TextureSize, Some(&[level, ..])) = (function, values.first().map(Vec::as_slice)) else {
                return Ok(nothing);
            };
            let each = nothing.into_iter().map(|size| {
                self.check(
                    Fault::NoLevel,
                    self.at(call),
                    Predicate::AtLeast(1),
                    [level, NONE],
                );
                self.substitute_undefined(size)
            });
            return Ok(each.collect());
        };
        let mut lookup = Lookup {
            channel,
            component: 0,
            sampling: self.sampling[usize::from(channel)],
            offset: [0; 2],
        };
        let has_mipmaps = lookup.sampling.filter == Filter::Mipmap;
        if function == B::TextureSize {
            let level = values[0][0];
            let levels = if has_mipmaps { MOST_LEVELS } else { 1 };
            self.check(
                Fault::NoLevel,
                self.at(call),
                Predicate::AtLeast(levels),
                [level, NONE],
            );
            let size = [0, 1].map(|at| {
                let size = self.value(ValueDef::Input(Input::ChannelResolution, 3 * channel + at));
                let mut size = self.unary(Operation::ToInt, size);
                if has_mipmaps {
                    size = self.binary(Operation::ShiftRightUint, size, level);
                }
                // An unbound channel has one texel.
                self.binary(Operation::MaxInt, size, self.word(1))
            });
            return Ok(self.substitute_undefined_all(size).to_vec());
        }
        if matches!(function, B::TexelFetch | B::TexelFetchOffset) {
            let mut at = [values[0][0], values[0][1]];
            if function == B::TexelFetchOffset {
                at = [0, 1].map(|axis| self.binary(Operation::AddWord, at[axis], values[2][axis]));
            }
            return Ok(self.texels(lookup, false, [at[0], at[1], values[1][0]]).to_vec());
        }
        let coordinates = &values[0];
        let mut at = [coordinates[0], coordinates[1]];
        if is_projected(function) {
            let by = coordinates[coordinates.len() - 1];
            at = at.map(|x| self.binary(Operation::Div, x, by));
        }
        for x in at {
            self.check(Fault::NoPlace, self.at(call), Predicate::NotInt, [x, NONE]);
        }
        if let Some(position) = offset_position(function)
            && let Some(value) = others.get(position).and_then(|&offset| self.tree.value(offset))
        {
            for (axis, scalar) in lookup.offset.iter_mut().zip(value.components()) {
                if let toyproof_glsl::tree::Value::Int(texels) = scalar {
                    *axis = *texels as i8;
                }
            }
        }
        let level = if has_mipmaps {
            self.level(function, channel, at, &values, call)
        } else {
            self.float(0.0)
        };
        let texels = self.texels(lookup, true, [at[0], at[1], level]);
        Ok(self.substitute_undefined_all(texels).to_vec())
    }

    /// The level of the mipmaps for a lookup with these arguments after the sampler.
    fn level(
        &mut self,
        function: BuiltIn,
        channel: u8,
        at: [Value; 2],
        values: &[Vec<Value>],
        call: ExprId,
    ) -> Value {
        use BuiltIn as B;
        let gradients = match function {
            B::TextureLod | B::TextureLodOffset | B::TextureProjLod | B::TextureProjLodOffset => {
                return values[1][0];
            }
            B::TextureGrad | B::TextureGradOffset | B::TextureProjGrad | B::TextureProjGradOffset => {
                [1, 2].map(|argument| [values[argument][0], values[argument][1]])
            }
            _ => {
                self.check(
                    Fault::LonelyDerivative,
                    self.at(call),
                    Predicate::PartialQuad,
                    [NONE, NONE],
                );
                [Operation::DFdx, Operation::DFdy].map(|along| at.map(|x| self.unary(along, x)))
            }
        };
        let gradients = gradients.map(|gradient| {
            [0, 1].map(|axis| {
                let size = self.value(ValueDef::Input(Input::ChannelResolution, 3 * channel + axis));
                // An unbound channel has one texel.
                let size = self.binary(Operation::Max, size, self.float(1.0));
                self.term(self.binary(Operation::Mul, gradient[usize::from(axis)], size))
            })
        });
        let square = toyproof_math::longer_square(&gradients[0], &gradients[1]);
        let length = self.unary(Operation::Log2, square.value);
        let level = self.binary(Operation::Mul, length, self.float(0.5));
        let bias = match function {
            B::Texture | B::TextureProj => values.get(1),
            B::TextureOffset | B::TextureProjOffset => values.get(2),
            _ => None,
        };
        bias.map_or(level, |bias| self.binary(Operation::Add, level, bias[0]))
    }

    fn texels(&self, lookup: Lookup, is_filtered: bool, at: [Value; 3]) -> [Value; 4] {
        [0, 1, 2, 3].map(|component| {
            self.value(ValueDef::Texel {
                lookup: Lookup { component, ..lookup },
                is_filtered,
                at,
            })
        })
    }

    /// Returns the result of a lookup in a missing texture: black; its size is one texel if it is a channel.
    fn nothing(&self, function: BuiltIn, is_channel: bool, ty: Type) -> Vec<Value> {
        let size = component_count(self.tree, ty);
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

/// Returns the position of the offset among the arguments after the sampler.
fn offset_position(function: BuiltIn) -> Option<usize> {
    use BuiltIn as B;
    match function {
        B::TextureOffset | B::TextureProjOffset => Some(1),
        B::TextureLodOffset | B::TextureProjLodOffset => Some(2),
        B::TextureGradOffset | B::TextureProjGradOffset => Some(3),
        _ => None,
    }
}
