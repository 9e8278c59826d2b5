//! Lookups of channels (§8.8) as operations.

mod filter;

use toyproof_glsl::Filter;
use toyproof_glsl::tree::{BuiltIn, ExprId, Input, Sampler, SamplerShape, Scalar, Type, Value as Constant};

use self::filter::Lookup;
use super::lvalue::component_count;
use super::{Builder, Result};
use crate::ir::{Fault, Kind, NONE, Operation, Predicate, Value, ValueDef};

/// One more than the last level of the largest texture.
const MOST_LEVELS: u32 = 15;

/// A channel with a texture that is sampled.
#[derive(Debug, Clone, Copy)]
struct Channel {
    number: u8,
    shape: SamplerShape,
}

impl Channel {
    /// The number of its normalized coordinates.
    fn coordinates(self) -> usize {
        match self.shape {
            SamplerShape::D2 | SamplerShape::D2Array => 2,
            SamplerShape::D3 | SamplerShape::Cube => 3,
        }
    }

    /// The number of sides that a size has.
    fn sides(self) -> u8 {
        if self.shape == SamplerShape::D3 { 3 } else { 2 }
    }
}

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
        let number = self.channel(sampler);
        let mut values = Vec::with_capacity(others.len());
        for &argument in others {
            values.push(self.expression(argument)?);
        }
        let shape = sampled_shape(self.ty(sampler));
        let Some((number, shape)) = number.zip(shape) else {
            return Ok(self.missing(function, number.is_some(), &values, call));
        };
        let channel = Channel { number, shape };
        let sampling = self.sampling[usize::from(number)];
        let has_mipmaps = sampling.filter == Filter::Mipmap;
        if function == B::TextureSize {
            return Ok(self.size_of_level(channel, values[0][0], has_mipmaps, call));
        }
        if matches!(function, B::TexelFetch | B::TexelFetchOffset) {
            return Ok(self.fetch(channel, function, &values).to_vec());
        }
        let coordinates = &values[0];
        let mut at = coordinates[..channel.coordinates()].to_vec();
        if is_projected(function) {
            let by = coordinates[coordinates.len() - 1];
            for coordinate in &mut at {
                *coordinate = self.binary(Operation::Div, *coordinate, by);
            }
        }
        let (place, face) = match shape {
            SamplerShape::Cube => self.cube_place(&at),
            _ => (at.clone(), self.word(0)),
        };
        for &x in &place {
            self.check(Fault::NoPlace, self.at(call), Predicate::NotInt, [x, NONE]);
        }
        let lookup = Lookup {
            channel,
            sampling,
            offset: self.offset(function, others),
            at: &place,
            face,
        };
        let texels = if has_mipmaps {
            let level = self.level(function, channel, &at, &values, call);
            self.between_levels(lookup, level)
        } else {
            self.in_first_level(lookup)
        };
        Ok(self.substitute_undefined_all(texels).to_vec())
    }

    /// The result of `textureSize`.
    fn size_of_level(
        &mut self,
        channel: Channel,
        level: Value,
        has_mipmaps: bool,
        call: ExprId,
    ) -> Vec<Value> {
        let levels = if has_mipmaps { MOST_LEVELS } else { 1 };
        let checked = [level, NONE];
        self.check(Fault::NoLevel, self.at(call), Predicate::AtLeast(levels), checked);
        let size = [0, 1, 2].map(|axis| {
            // There is a third side only of a volume.
            let mut side = self.extent(channel, axis.min(channel.sides() - 1));
            if has_mipmaps {
                side = self.binary(Operation::ShiftRightUint, side, level);
            }
            self.binary(Operation::MaxInt, side, self.word(1))
        });
        self.substitute_undefined_all(size)[..usize::from(channel.sides())].to_vec()
    }

    /// The texel of `texelFetch` or `texelFetchOffset`.
    fn fetch(&self, channel: Channel, function: BuiltIn, values: &[Vec<Value>]) -> [Value; 4] {
        use Operation as O;
        let mut at = values[0].clone();
        if function == BuiltIn::TexelFetchOffset {
            for (place, &offset) in at.iter_mut().zip(&values[2]) {
                *place = self.binary(O::AddWord, *place, offset);
            }
        }
        let level = values[1][0];
        let &[x, y, z] = &at[..] else {
            return self.texels(channel.number, [at[0], at[1], level]);
        };
        // A row beyond the slice is one of another slice, so that it must become one beyond the volume.
        let height = self.binary(O::ShiftRightUint, self.extent(channel, 1), level);
        let height = self.binary(O::MaxInt, height, self.word(1));
        let row = self.binary(O::AddWord, self.binary(O::MulWord, z, height), y);
        let is_inside = self.binary(O::LessUint, y, height);
        let is_near = self.binary(O::LessUint, z, self.word(1 << 15));
        let is_inside = self.binary(O::And, is_inside, is_near);
        let row = self.select(is_inside, row, self.word(u32::MAX), Kind::Word);
        self.texels(channel.number, [x, row, level])
    }

    /// The coordinates on the face of a cube map that a direction points to, and the number of the face.
    fn cube_place(&self, direction: &[Value]) -> (Vec<Value>, Value) {
        let direction = [0, 1, 2].map(|axis: usize| self.term(direction[axis]));
        let [face, s, t] = toyproof_math::cube_place(direction).map(|term| term.value);
        (vec![s, t], self.unary(Operation::ToInt, face))
    }

    /// The constant offset of a lookup in texels.
    fn offset(&self, function: BuiltIn, arguments: &[ExprId]) -> [i32; 3] {
        let mut offset = [0; 3];
        if let Some(position) = offset_position(function)
            && let Some(value) = arguments
                .get(position)
                .and_then(|&offset| self.tree.value(offset))
        {
            for (axis, scalar) in offset.iter_mut().zip(value.components()) {
                if let Constant::Int(texels) = scalar {
                    *axis = *texels;
                }
            }
        }
        offset
    }

    /// The sides of the texture of a channel in texels, as words; an unbound channel has one texel.
    fn sides(&self, channel: Channel) -> Vec<Value> {
        (0..channel.sides())
            .map(|axis| self.extent(channel, axis))
            .collect()
    }

    fn extent(&self, channel: Channel, axis: u8) -> Value {
        let Channel { number, shape } = channel;
        let side = match shape {
            SamplerShape::Cube | SamplerShape::D3 => self.value(ValueDef::Extent {
                channel: number,
                axis,
            }),
            SamplerShape::D2 | SamplerShape::D2Array => {
                self.value(ValueDef::Input(Input::ChannelResolution, 3 * number + axis))
            }
        };
        let side = self.unary(Operation::ToInt, side);
        self.binary(Operation::MaxInt, side, self.word(1))
    }

    /// The level of the mipmaps for a lookup at `at` with these arguments after the sampler.
    fn level(
        &mut self,
        function: BuiltIn,
        channel: Channel,
        at: &[Value],
        values: &[Vec<Value>],
        call: ExprId,
    ) -> Value {
        use BuiltIn as B;
        let derivatives: [Vec<Value>; 2] = match function {
            B::TextureLod | B::TextureLodOffset | B::TextureProjLod | B::TextureProjLodOffset => {
                return values[1][0];
            }
            B::TextureGrad | B::TextureGradOffset | B::TextureProjGrad | B::TextureProjGradOffset => {
                [values[1].clone(), values[2].clone()]
            }
            _ => {
                self.check(
                    Fault::NonUniformDerivative,
                    self.at(call),
                    Predicate::PartialQuad,
                    [NONE, NONE],
                );
                [Operation::DFdx, Operation::DFdy]
                    .map(|along| at.iter().map(|&x| self.unary(along, x)).collect())
            }
        };
        let gradients = derivatives.map(|derivative| {
            let derivative: Vec<_> = match channel.shape {
                SamplerShape::Cube => {
                    let [direction, derivative] =
                        [at, &derivative].map(|vector| [0, 1, 2].map(|axis: usize| self.term(vector[axis])));
                    toyproof_math::cube_gradient(direction, derivative).to_vec()
                }
                _ => derivative.iter().map(|&component| self.term(component)).collect(),
            };
            let sides = self.sides(channel);
            let scaled = derivative.iter().zip(sides).map(|(component, side)| {
                let side = self.unary(Operation::FromInt, side);
                self.term(self.binary(Operation::Mul, component.value, side))
            });
            scaled.collect::<Vec<_>>()
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

    fn texels(&self, channel: u8, at: [Value; 3]) -> [Value; 4] {
        [0, 1, 2, 3].map(|component| {
            self.value(ValueDef::Texel {
                channel,
                component,
                at,
            })
        })
    }

    /// Returns the result of a lookup in a missing texture: black; its size is one texel if it is a channel.
    fn missing(
        &mut self,
        function: BuiltIn,
        is_channel: bool,
        values: &[Vec<Value>],
        call: ExprId,
    ) -> Vec<Value> {
        let ty = self.ty(call);
        let count = component_count(self.tree, ty);
        if function == BuiltIn::TextureSize {
            let Some(&[level, ..]) = values.first().map(Vec::as_slice) else {
                return Vec::new();
            };
            let size = (0..count).map(|_| {
                let checked = [level, NONE];
                self.check(Fault::NoLevel, self.at(call), Predicate::AtLeast(1), checked);
                self.substitute_undefined(self.word(u32::from(is_channel)))
            });
            return size.collect();
        }
        let float = ty.scalar() == Some(Scalar::Float);
        (0..count)
            .map(|at| match (at == 3, float) {
                (false, true) => self.float(0.0),
                (true, true) => self.float(1.0),
                (last, false) => self.word(u32::from(last)),
            })
            .collect()
    }
}

/// The shape of a texture of floats that channels may have.
fn sampled_shape(sampler: Type) -> Option<SamplerShape> {
    let Type::Sampler(sampler) = sampler else {
        return None;
    };
    let is_channel = sampler.shape != SamplerShape::D2Array && sampler == Sampler::float(sampler.shape);
    is_channel.then_some(sampler.shape)
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
