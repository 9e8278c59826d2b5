//! Lookups of channels (§8.8), by the steps of strict shaders. Volumes and cubes are black.

use toyproof::eval::Fault;
use toyproof::glsl::tree::{self, BuiltIn, ExprId, Sampler, Scalar, Type};
use toyproof::glsl::{Filter, Sampling, Wrap};
use toyproof::image::Texture;
use toyproof::math::longer_square;

use super::builtin::{max, min};
use super::operator::{is_int, to_int};
use super::real::{Real, Transcendental};
use super::value::{Component, Value, floats, size};
use super::{Result, Run};

/// A lookup at normalized coordinates.
#[derive(Clone, Copy)]
struct Lookup {
    channel: u8,
    sampling: Sampling,
    /// In texels.
    offset: [i32; 2],
}

/// One more than the last level of the largest texture.
const MOST_LEVELS: u32 = 15;

impl<N: Real> Run<'_, N> {
    /// A call of a texture function.
    pub(super) fn texture(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        expr: ExprId,
    ) -> Result<Value<N>, N> {
        use BuiltIn as B;
        let tree = self.tree;
        let channel = self.channel(arguments[0]);
        let mut values = Vec::new();
        for &argument in &arguments[1..] {
            values.push(self.value(argument)?);
        }
        let Some(channel) = channel.filter(|_| tree[arguments[0]].ty == Type::Sampler(Sampler::D2)) else {
            return Ok(self.missing(function, channel.is_some(), &values, expr));
        };
        let sampling = self.interpreter.checked.sampling[usize::from(channel)];
        let has_mipmaps = sampling.filter == Filter::Mipmap;
        let sides = self.sides(channel);
        if function == B::TextureSize {
            let level = values[0][0].bits();
            self.fault(
                Fault::NoLevel,
                expr,
                level >= if has_mipmaps { MOST_LEVELS } else { 1 },
            );
            let shift = if has_mipmaps { level & 31 } else { 0 };
            let sides = sides.map(|side| Component::Int((side >> shift).max(1) as i32));
            return Ok(self.settle_all(sides.to_vec()));
        }
        if matches!(function, B::TexelFetch | B::TexelFetchOffset) {
            let at = [0, 1].map(|axis| {
                let offset = if function == B::TexelFetchOffset {
                    values[2][axis].bits()
                } else {
                    0
                };
                values[0][axis].bits().wrapping_add(offset)
            });
            return Ok(floats(self.texel(channel, at, values[1][0].bits())));
        }
        let coordinates = &values[0];
        let mut at = [0, 1].map(|axis| coordinates[axis].real());
        if is_projected(function) {
            let divisor = coordinates[coordinates.len() - 1].real();
            at = at.map(|x| x / divisor);
        }
        for x in at {
            self.fault(Fault::NoPlace, expr, !is_int(x));
        }
        let is_undefined = std::mem::take(&mut self.is_undefined);
        let lookup = Lookup {
            channel,
            sampling,
            offset: self.offset(function, &arguments[1..]),
        };
        let texels = if has_mipmaps {
            let level = self.level(function, at, sides, &values, expr)?;
            self.between_levels(lookup, at, level)
        } else {
            self.filtered(lookup, at, sides, 0)
        };
        self.is_undefined = is_undefined;
        Ok(self.settle_all(floats(texels)))
    }

    /// Settles all components of the result of one operation.
    fn settle_all(&mut self, value: Value<N>) -> Value<N> {
        let is_undefined = self.is_undefined;
        let settled = value.into_iter().map(|component| {
            self.is_undefined = is_undefined;
            self.settle(component)
        });
        settled.collect()
    }

    /// The result of a lookup of a texture that is missing: opaque black. A channel that is bound has one texel.
    fn missing(
        &mut self,
        function: BuiltIn,
        is_channel: bool,
        values: &[Value<N>],
        expr: ExprId,
    ) -> Value<N> {
        let ty = self.tree[expr].ty;
        let count = size(self.tree, ty);
        if function == BuiltIn::TextureSize {
            let sides = vec![Component::Int(i32::from(is_channel)); count];
            let has_no_level = values.first().is_some_and(|level| level[0].bits() >= 1);
            self.fault(Fault::NoLevel, expr, has_no_level);
            return self.settle_all(sides);
        }
        let is_opaque = |at: usize| u8::from(at == 3);
        let component = |at| match ty.scalar() {
            Some(Scalar::Int) => Component::Int(is_opaque(at).into()),
            Some(Scalar::Uint) => Component::Uint(is_opaque(at).into()),
            _ => Component::float(is_opaque(at).into()),
        };
        (0..count).map(component).collect()
    }

    /// The sides of a texture in texels; an unbound channel has one.
    fn sides(&self, channel: u8) -> [u32; 2] {
        let texture = &self.interpreter.frame.channels[usize::from(channel)];
        texture.as_ref().map_or([1, 1], Texture::size)
    }

    /// A texel, or zeros where there is none.
    fn texel(&self, channel: u8, [x, y]: [u32; 2], level: u32) -> [N; 4] {
        let zeros = [0.0; 4].map(N::from_f64);
        let Some(texture) = &self.interpreter.frame.channels[usize::from(channel)] else {
            let is_there = [x, y, level] == [0; 3];
            return if is_there {
                [0.0, 0.0, 0.0, 1.0].map(N::from_f64)
            } else {
                zeros
            };
        };
        if level >= texture.levels() {
            return zeros;
        }
        let level = level as usize;
        let ([width, height], read): (_, &dyn Fn() -> [f64; 4]) = match texture {
            Texture::Single(levels) => (levels[level].size(), &|| levels[level].get(x, y).map(f64::from)),
            Texture::Double(levels) => (levels[level].size(), &|| levels[level].get(x, y)),
        };
        if x < width && y < height {
            read().map(N::from_f64)
        } else {
            zeros
        }
    }

    /// The offset of a lookup in texels, a constant expression.
    fn offset(&self, function: BuiltIn, arguments: &[ExprId]) -> [i32; 2] {
        use BuiltIn as B;
        let position = match function {
            B::TextureOffset | B::TextureProjOffset => 1,
            B::TextureLodOffset | B::TextureProjLodOffset => 2,
            B::TextureGradOffset | B::TextureProjGradOffset => 3,
            _ => return [0; 2],
        };
        let value = self
            .tree
            .value(arguments[position])
            .expect("an offset is constant");
        [0, 1].map(|axis| match value.components()[axis] {
            tree::Value::Int(texels) => texels,
            other => panic!("an offset of {other:?}"),
        })
    }

    /// The level of the mipmaps.
    fn level(
        &mut self,
        function: BuiltIn,
        at: [N; 2],
        sides: [u32; 2],
        values: &[Value<N>],
        expr: ExprId,
    ) -> Result<N, N> {
        use BuiltIn as B;
        let along = match function {
            B::TextureLod | B::TextureLodOffset | B::TextureProjLod | B::TextureProjLodOffset => {
                return Ok(values[1][0].real());
            }
            B::TextureGrad | B::TextureGradOffset | B::TextureProjGrad | B::TextureProjGradOffset => {
                [1, 2].map(|argument: usize| [0, 1].map(|axis: usize| values[argument][axis].real()))
            }
            _ => {
                let [mut along_x, mut along_y] = [at; 2];
                for axis in 0..2 {
                    along_x[axis] = self.derivative(at[axis], 1, expr)?;
                    along_y[axis] = self.derivative(at[axis], 2, expr)?;
                }
                [along_x, along_y]
            }
        };
        let [along_x, along_y] =
            along.map(|along| [0, 1].map(|axis: usize| along[axis] * N::from_f64(sides[axis].into())));
        let square = longer_square(&along_x, &along_y);
        let level = square.transcendental(Transcendental::Log2) * N::from_f64(0.5);
        let bias = match function {
            B::Texture | B::TextureProj => values.get(1),
            B::TextureOffset | B::TextureProjOffset => values.get(2),
            _ => None,
        };
        Ok(bias.map_or(level, |bias| level + bias[0].real()))
    }

    /// A lookup between two levels of the mipmaps.
    fn between_levels(&self, lookup: Lookup, at: [N; 2], level: N) -> [N; 4] {
        let sides = self.sides(lookup.channel);
        let last = sides[0].max(sides[1]).ilog2();
        let level = min(max(level, N::from_f64(0.0)), N::from_f64(last.into()));
        let below = level.floor();
        let weight = level - below;
        let first = to_int(below.to_f64()) as u32;
        let of_level = |level: u32| {
            let sides = sides.map(|side| (side >> level).max(1));
            self.filtered(lookup, at, sides, level)
        };
        let one = of_level(first);
        if weight > N::from_f64(0.0) {
            let other = of_level((first + 1).min(last));
            [0, 1, 2, 3].map(|i| mixed(one[i], other[i], weight))
        } else {
            one
        }
    }

    /// A lookup in one level, which has these sides.
    fn filtered(&self, lookup: Lookup, at: [N; 2], sides: [u32; 2], level: u32) -> [N; 4] {
        let Sampling { filter, wrap } = lookup.sampling;
        let is_nearest = filter == Filter::Nearest;
        let axis = |axis: usize| {
            let side = N::from_f64(sides[axis].into());
            let (place, least, most) = match wrap {
                Wrap::Repeat => (at[axis] - at[axis].floor(), N::from_f64(-1.0), side),
                Wrap::Clamp => (at[axis], N::from_f64(-16.0), side + N::from_f64(16.0)),
            };
            let mut texels = place * side;
            if !is_nearest {
                texels = texels - N::from_f64(0.5);
            }
            // Far coordinates, and NaN, must fit an integer.
            let texels = min(max(texels, least), most);
            let below = texels.floor();
            let first = i64::from(to_int(below.to_f64())) + i64::from(lookup.offset[axis]);
            let length = i64::from(sides[axis]);
            let [first, next] = [first, first + 1].map(|texel| match wrap {
                Wrap::Clamp => texel.clamp(0, length - 1) as u32,
                Wrap::Repeat => texel.rem_euclid(length) as u32,
            });
            (first, next, texels - below)
        };
        let ((left, right, across), (low, high, up)) = (axis(0), axis(1));
        let texel = |x, y| self.texel(lookup.channel, [x, y], level);
        if is_nearest {
            return texel(left, low);
        }
        let (a, b, c, d) = (
            texel(left, low),
            texel(right, low),
            texel(left, high),
            texel(right, high),
        );
        [0, 1, 2, 3].map(|i| mixed(mixed(a[i], b[i], across), mixed(c[i], d[i], across), up))
    }
}

/// `a + (b − a)·weight`
fn mixed<N: Real>(a: N, b: N, weight: N) -> N {
    a + (b - a) * weight
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
