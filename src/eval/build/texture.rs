//! Lookups of channels (§8.8) as operations. Volumes and cubes are black.

use toyproof_glsl::tree::{BuiltIn, ExprId, Input, Sampler, Scalar, Type};
use toyproof_glsl::{Filter, Sampling, Wrap};

use super::lvalue::component_count;
use super::{Builder, Result};
use crate::ir::{Fault, Kind, NONE, Operation, Predicate, Value, ValueDef};

/// A lookup at normalized coordinates.
#[derive(Debug, Clone, Copy)]
struct FilteredLookup {
    channel: u8,
    sampling: Sampling,
    /// In texels, −8 to 7.
    offset: [i32; 2],
}

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
        let sampling = self.sampling[usize::from(channel)];
        let has_mipmaps = sampling.filter == Filter::Mipmap;
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
            let level = values[1][0];
            return Ok(self.texels(channel, [at[0], at[1], level]).to_vec());
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
        let filtered = FilteredLookup {
            channel,
            sampling,
            offset,
        };
        let texels = if has_mipmaps {
            let level = self.level(function, channel, at, &values, call);
            self.between_levels(filtered, at, level)
        } else {
            let sizes = [0, 1].map(|axis| self.side(channel, axis));
            self.filtered(filtered, at, sizes, self.word(0))
        };
        Ok(self.substitute_undefined_all(texels).to_vec())
    }

    /// A side of the texture of a channel in texels, as a word; an unbound channel has one texel.
    fn side(&self, channel: u8, axis: u8) -> Value {
        let size = self.value(ValueDef::Input(Input::ChannelResolution, 3 * channel + axis));
        let size = self.unary(Operation::ToInt, size);
        self.binary(Operation::MaxInt, size, self.word(1))
    }

    /// A lookup at normalized coordinates between two levels of the mipmaps.
    fn between_levels(&self, lookup: FilteredLookup, at: [Value; 2], level: Value) -> [Value; 4] {
        use Operation as O;
        let sizes = [0, 1].map(|axis| self.side(lookup.channel, axis));
        // Often the whole texture is sampled explicitly.
        if self.writer.borrow().defs[level.0 as usize] == ValueDef::Float(0.0_f64.to_bits()) {
            return self.filtered(lookup, at, sizes, self.word(0));
        }
        // The last level is the binary logarithm of the longer side: the exponent of that float, which
        // follows 23 bits of fraction and has a bias of 127.
        let longer = self.unary(O::FromInt, self.binary(O::MaxInt, sizes[0], sizes[1]));
        let exponent = self.binary(O::ShiftRightUint, self.unary(O::ToBits, longer), self.word(23));
        let last = self.binary(O::SubWord, exponent, self.word(127));
        let level = self.clamp(level, self.float(0.0), self.unary(O::FromInt, last));
        let below = self.unary(O::Floor, level);
        let between = self.binary(O::Sub, level, below);
        let first = self.unary(O::ToInt, below);
        let second = self.binary(O::MinInt, self.binary(O::AddWord, first, self.word(1)), last);
        let [one, other] = [first, second].map(|level| {
            let sizes = sizes.map(|size| {
                let size = self.binary(O::ShiftRightUint, size, level);
                self.binary(O::MaxInt, size, self.word(1))
            });
            self.filtered(lookup, at, sizes, level)
        });
        let is_between = self.binary(O::Less, self.float(0.0), between);
        [0, 1, 2, 3].map(|i| {
            let mixed = self.mixed(one[i], other[i], between);
            self.select(is_between, mixed, one[i], Kind::Float)
        })
    }

    /// A lookup at normalized coordinates in one level, which has these sides. The steps are those of the
    /// text in `toyproof_translate`.
    fn filtered(
        &self,
        lookup: FilteredLookup,
        at: [Value; 2],
        sizes: [Value; 2],
        level: Value,
    ) -> [Value; 4] {
        use Operation as O;
        let Sampling { filter, wrap } = lookup.sampling;
        let is_nearest = filter == Filter::Nearest;
        let axis = |axis: usize| {
            let side = self.unary(O::FromInt, sizes[axis]);
            let (place, least, most) = match wrap {
                Wrap::Repeat => {
                    let fraction = self.binary(O::Sub, at[axis], self.unary(O::Floor, at[axis]));
                    (fraction, self.float(-1.0), side)
                }
                Wrap::Clamp => (
                    at[axis],
                    self.float(-16.0),
                    self.binary(O::Add, side, self.float(16.0)),
                ),
            };
            let mut texels = self.binary(O::Mul, place, side);
            if !is_nearest {
                texels = self.binary(O::Sub, texels, self.float(0.5));
            }
            // Far coordinates, and NaN, must fit an integer.
            let texels = self.clamp(texels, least, most);
            let below = self.unary(O::Floor, texels);
            let weight = self.binary(O::Sub, texels, below);
            let first = self.unary(O::ToInt, below);
            let offset = self.word(lookup.offset[axis].cast_unsigned());
            let first = self.binary(O::AddWord, first, offset);
            let next = self.binary(O::AddWord, first, self.word(1));
            let has_offset = lookup.offset[axis] != 0;
            let [first, next] = [first, next].map(|place| self.wrapped(place, sizes[axis], wrap, has_offset));
            (first, next, weight)
        };
        let ((left, right, across), (low, high, up)) = (axis(0), axis(1));
        let texels = |x, y| self.texels(lookup.channel, [x, y, level]);
        let a = texels(left, low);
        if is_nearest {
            return a;
        }
        let (b, c, d) = (texels(right, low), texels(left, high), texels(right, high));
        [0, 1, 2, 3].map(|i| {
            let lower = self.mixed(a[i], b[i], across);
            let upper = self.mixed(c[i], d[i], across);
            self.mixed(lower, upper, up)
        })
    }

    /// A coordinate in texels within a side. Without an offset it is −1 at least, and the side at most.
    fn wrapped(&self, place: Value, side: Value, wrap: Wrap, has_offset: bool) -> Value {
        use Operation as O;
        match wrap {
            Wrap::Clamp => {
                let last = self.binary(O::SubWord, side, self.word(1));
                self.binary(O::MinInt, self.binary(O::MaxInt, place, self.word(0)), last)
            }
            Wrap::Repeat if has_offset => {
                let many = self.binary(O::MulWord, side, self.word(32));
                self.binary(O::RemUint, self.binary(O::AddWord, place, many), side)
            }
            Wrap::Repeat => {
                let [above, below] =
                    [O::AddWord, O::SubWord].map(|operation| self.binary(operation, place, side));
                let is_left = self.binary(O::LessInt, place, self.word(0));
                let is_inside = self.binary(O::LessInt, place, side);
                let right = self.select(is_inside, place, below, Kind::Word);
                self.select(is_left, above, right, Kind::Word)
            }
        }
    }

    /// `a + (b − a)·weight`
    fn mixed(&self, a: Value, b: Value, weight: Value) -> Value {
        let difference = self.binary(Operation::Sub, b, a);
        let part = self.binary(Operation::Mul, difference, weight);
        self.binary(Operation::Add, a, part)
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
                    Fault::NonUniformDerivative,
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
