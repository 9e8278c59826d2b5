//! Filtered lookups of a channel: of the nearest texel, or between texels and between levels.
//!
//! The steps are those of the text in `toyproof_translate`.

use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{Filter, Sampling, Wrap};

use super::Channel;
use crate::build::Builder;
use crate::ir::{Kind, Operation, Value, ValueDef};

/// A lookup at normalized coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lookup<'a> {
    pub(super) channel: Channel,
    pub(super) sampling: Sampling,
    /// In texels, −8 to 7.
    pub(super) offset: [i32; 3],
    /// The coordinates: of a cube map, those on the face.
    pub(super) at: &'a [Value],
    /// The number of the face of a cube map, as a word.
    pub(super) face: Value,
}

/// The texels along one axis of a lookup.
struct Axis {
    first: Value,
    next: Value,
    /// The weight of the next one.
    weight: Value,
}

impl Builder<'_> {
    /// A lookup in the whole texture.
    pub(super) fn in_first_level(&self, lookup: Lookup<'_>) -> [Value; 4] {
        let sides = self.sides(lookup.channel);
        self.filtered(lookup, &sides, self.word(0))
    }

    /// A lookup between two levels of the mipmaps.
    pub(super) fn between_levels(&self, lookup: Lookup<'_>, level: Value) -> [Value; 4] {
        use Operation as O;
        // Often the whole texture is sampled explicitly.
        if self.writer.borrow().defs[level.0 as usize] == ValueDef::Float(0.0_f64.to_bits()) {
            return self.in_first_level(lookup);
        }
        let sides = self.sides(lookup.channel);
        // The last level is the binary logarithm of the longest side: the exponent of that float, which
        // follows 23 bits of fraction and has a bias of 127.
        let longest = sides[1..]
            .iter()
            .fold(sides[0], |longest, &side| self.binary(O::MaxInt, longest, side));
        let longest = self.unary(O::FromInt, longest);
        let exponent = self.binary(O::ShiftRightUint, self.unary(O::ToBits, longest), self.word(23));
        let last = self.binary(O::SubWord, exponent, self.word(127));
        let level = self.clamp(level, self.float(0.0), self.unary(O::FromInt, last));
        let below = self.unary(O::Floor, level);
        let between = self.binary(O::Sub, level, below);
        let first = self.unary(O::ToInt, below);
        let second = self.binary(O::MinInt, self.binary(O::AddWord, first, self.word(1)), last);
        let [one, other] = [first, second].map(|level| {
            let sides = sides.iter().map(|&side| {
                let side = self.binary(O::ShiftRightUint, side, level);
                self.binary(O::MaxInt, side, self.word(1))
            });
            self.filtered(lookup, &sides.collect::<Vec<_>>(), level)
        });
        let is_between = self.binary(O::Less, self.float(0.0), between);
        [0, 1, 2, 3].map(|i| {
            let mixed = self.mixed(one[i], other[i], between);
            self.select(is_between, mixed, one[i], Kind::Float)
        })
    }

    /// A lookup in one level, which has these sides.
    fn filtered(&self, lookup: Lookup<'_>, sides: &[Value], level: Value) -> [Value; 4] {
        let axes: Vec<_> = (0..sides.len())
            .map(|axis| self.axis(lookup, axis, sides[axis]))
            .collect();
        let texel = |at: &[Value]| self.layer_texel(lookup, at, sides, level);
        if lookup.sampling.filter == Filter::Nearest {
            return texel(&axes.iter().map(|axis| axis.first).collect::<Vec<_>>());
        }
        // The corners in the order of their numbers, whose bits choose the next texel along an axis.
        let corners = (0..1_usize << axes.len()).map(|corner| {
            let places = axes.iter().enumerate();
            let places = places.map(|(at, axis)| {
                if corner >> at & 1 == 0 {
                    axis.first
                } else {
                    axis.next
                }
            });
            texel(&places.collect::<Vec<_>>())
        });
        let mut corners: Vec<[Value; 4]> = corners.collect();
        for axis in &axes {
            let pairs = corners.chunks_exact(2);
            let mixed =
                pairs.map(|pair| [0, 1, 2, 3].map(|i| self.mixed(pair[0][i], pair[1][i], axis.weight)));
            corners = mixed.collect();
        }
        corners[0]
    }

    /// The texels along an axis, of a level with this side.
    fn axis(&self, lookup: Lookup<'_>, axis: usize, side: Value) -> Axis {
        use Operation as O;
        let Sampling { filter, wrap } = lookup.sampling;
        let is_cube = lookup.channel.shape == SamplerShape::Cube;
        let (at, texels) = (lookup.at[axis], self.unary(O::FromInt, side));
        let (place, least, most) = match wrap {
            _ if is_cube => (at, self.float(-1.0), texels),
            Wrap::Repeat => {
                let fraction = self.binary(O::Sub, at, self.unary(O::Floor, at));
                (fraction, self.float(-1.0), texels)
            }
            Wrap::Clamp => (
                at,
                self.float(-16.0),
                self.binary(O::Add, texels, self.float(16.0)),
            ),
        };
        let mut place = self.binary(O::Mul, place, texels);
        if filter != Filter::Nearest {
            place = self.binary(O::Sub, place, self.float(0.5));
        }
        // Far coordinates, and NaN, must fit an integer.
        let place = self.clamp(place, least, most);
        let below = self.unary(O::Floor, place);
        let weight = self.binary(O::Sub, place, below);
        let first = self.unary(O::ToInt, below);
        let offset = self.word(lookup.offset[axis].cast_unsigned());
        let first = self.binary(O::AddWord, first, offset);
        let next = self.binary(O::AddWord, first, self.word(1));
        if is_cube {
            // The border has the texels beside the face.
            let last = match filter {
                Filter::Nearest => self.binary(O::SubWord, side, self.word(1)),
                Filter::Linear | Filter::Mipmap => side,
            };
            let [first, next] = [first, next].map(|place| self.binary(O::MinInt, place, last));
            return Axis { first, next, weight };
        }
        let has_offset = lookup.offset[axis] != 0;
        let [first, next] = [first, next].map(|place| self.wrapped(place, side, wrap, has_offset));
        Axis { first, next, weight }
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

    /// A texel of a level by its place on the face of a cube map, in a volume, or in an image.
    fn layer_texel(&self, lookup: Lookup<'_>, at: &[Value], sides: &[Value], level: Value) -> [Value; 4] {
        use Operation as O;
        let Channel { number, shape } = lookup.channel;
        let [x, y] = match shape {
            SamplerShape::Cube => {
                let whole = self.binary(O::AddWord, sides[0], self.word(2));
                let row = self.binary(O::MulWord, lookup.face, whole);
                let inside = [at[0], at[1]].map(|place| self.binary(O::AddWord, place, self.word(1)));
                [inside[0], self.binary(O::AddWord, row, inside[1])]
            }
            SamplerShape::D3 => {
                let row = self.binary(O::MulWord, at[2], sides[1]);
                [at[0], self.binary(O::AddWord, row, at[1])]
            }
            SamplerShape::D2 | SamplerShape::D2Array => [at[0], at[1]],
        };
        self.texels(number, [x, y, level])
    }

    /// `a + (b − a)·weight`
    fn mixed(&self, a: Value, b: Value, weight: Value) -> Value {
        let difference = self.binary(Operation::Sub, b, a);
        let part = self.binary(Operation::Mul, difference, weight);
        self.binary(Operation::Add, a, part)
    }
}
