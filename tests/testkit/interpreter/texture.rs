//! Lookups of channels (§8.8), by the steps of strict shaders. The neighbors of a cube map's texels are found
//! by their distances.

use toyproof::eval::Fault;
use toyproof::glsl::tree::{self, BuiltIn, ExprId, Sampler, SamplerShape, Scalar, Type};
use toyproof::glsl::{Filter, Sampling, Wrap};
use toyproof::image::{Shape, Texels, Texture, cube};
use toyproof::math::{cube_gradient, cube_place, longer_square};

use super::builtin::{max, min};
use super::operator::{is_int, to_int};
use super::real::{Real, Transcendental};
use super::value::{Component, Value, floats, size};
use super::{Result, Run};

/// A lookup at normalized coordinates.
#[derive(Clone)]
struct Lookup<N> {
    channel: u8,
    shape: SamplerShape,
    sampling: Sampling,
    /// In texels.
    offset: [i32; 3],
    /// The coordinates; of a cube map, those on the face.
    at: Vec<N>,
    /// The face of a cube map.
    face: u32,
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
        let shapes = [SamplerShape::D2, SamplerShape::D3, SamplerShape::Cube];
        let shape = shapes
            .into_iter()
            .find(|shape| tree[arguments[0]].ty == Type::Sampler(Sampler::float(*shape)));
        let Some((channel, shape)) = channel.zip(shape) else {
            return Ok(self.missing(function, channel.is_some(), &values, expr));
        };
        let sampling = self.interpreter.checked.sampling[usize::from(channel)];
        let has_mipmaps = sampling.filter == Filter::Mipmap;
        let sides = self.sides(channel, shape);
        if function == B::TextureSize {
            let level = values[0][0].bits();
            self.fault(
                Fault::NoLevel,
                expr,
                level >= if has_mipmaps { MOST_LEVELS } else { 1 },
            );
            let shift = if has_mipmaps { level & 31 } else { 0 };
            let sides = sides
                .iter()
                .map(|side| Component::Int((side >> shift).max(1) as i32));
            return Ok(self.settle_all(sides.collect()));
        }
        if matches!(function, B::TexelFetch | B::TexelFetchOffset) {
            let at = (0..sides.len()).map(|axis| {
                let offset = if function == B::TexelFetchOffset {
                    values[2][axis].bits()
                } else {
                    0
                };
                values[0][axis].bits().wrapping_add(offset)
            });
            let at: Vec<_> = at.collect();
            return Ok(floats(self.texel((channel, shape, 0), &at, values[1][0].bits())));
        }
        let coordinates = &values[0];
        let count = if shape == SamplerShape::D2 { 2 } else { 3 };
        let mut at: Vec<N> = coordinates[..count]
            .iter()
            .map(|component| component.real())
            .collect();
        if is_projected(function) {
            let divisor = coordinates[coordinates.len() - 1].real();
            at = at.into_iter().map(|x| x / divisor).collect();
        }
        let (place, face) = match (shape, &at[..]) {
            (SamplerShape::Cube, &[x, y, z]) => {
                let [face, s, t] = cube_place([x, y, z]);
                (vec![s, t], to_int(face.to_f64()) as u32)
            }
            _ => (at.clone(), 0),
        };
        for &x in &place {
            self.fault(Fault::NoPlace, expr, !is_int(x));
        }
        let is_undefined = std::mem::take(&mut self.is_undefined);
        let lookup = Lookup {
            channel,
            shape,
            sampling,
            offset: self.offset(function, &arguments[1..]),
            at: place,
            face,
        };
        let texels = if has_mipmaps {
            let level = self.level(function, (shape, &at), &sides, &values, expr)?;
            self.between_levels(&lookup, level)
        } else {
            self.filtered(&lookup, &sides, 0)
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

    /// The texture of a channel, if it has the shape of its sampler.
    fn texture_of(&self, channel: u8, shape: SamplerShape) -> Option<&Texture> {
        let own = match shape {
            SamplerShape::D3 => Shape::Volume,
            SamplerShape::Cube => Shape::Cube,
            SamplerShape::D2 | SamplerShape::D2Array => Shape::Flat,
        };
        let texture = self.interpreter.frame.channels[usize::from(channel)].as_ref();
        texture.filter(|texture| texture.shape() == own)
    }

    /// The sides of a texture in texels; an unbound channel has one.
    fn sides(&self, channel: u8, shape: SamplerShape) -> Vec<u32> {
        let texture = self.texture_of(channel, shape);
        let [width, height] = texture.map_or([1, 1], Texture::size);
        match shape {
            SamplerShape::D3 => vec![width, height, texture.map_or(1, Texture::layers)],
            _ => vec![width, height],
        }
    }

    /// A texel of an image, a volume or the face of a cube map, or zeros where there is none.
    fn texel(&self, (channel, shape, face): (u8, SamplerShape, u32), at: &[u32], level: u32) -> [N; 4] {
        let zeros = [0.0; 4].map(N::from_f64);
        let Some(texture) = self.texture_of(channel, shape) else {
            let is_there = level == 0 && at.iter().all(|place| *place == 0);
            return if is_there {
                [0.0, 0.0, 0.0, 1.0].map(N::from_f64)
            } else {
                zeros
            };
        };
        if level >= texture.levels() {
            return zeros;
        }
        let [width, height] = texture.size().map(|side| (side >> level).max(1));
        let layers = match shape {
            SamplerShape::D3 => (texture.layers() >> level).max(1),
            _ => texture.layers(),
        };
        let layer = at.get(2).copied().unwrap_or(face);
        if at[0] >= width || at[1] >= height || layer >= layers {
            return zeros;
        }
        // The faces of a cube map are stored with borders.
        let border = u32::from(shape == SamplerShape::Cube);
        let (x, y) = (at[0] + border, layer * (height + 2 * border) + border + at[1]);
        let level = level as usize;
        match texture.texels() {
            Texels::Single(levels) => levels[level].get(x, y).map(f64::from),
            Texels::Double(levels) => levels[level].get(x, y),
        }
        .map(N::from_f64)
    }

    /// A texel on a face of a cube map, or the one that continues it beyond an edge; at a corner, where three
    /// faces meet, the mean of the others.
    fn cube_texel(&self, channel: u8, face: u32, at: [i64; 2], side: u32, level: u32) -> [N; 4] {
        let whole = i64::from(side);
        let texel = |(face, at): (u32, [u32; 2])| self.texel((channel, SamplerShape::Cube, face), &at, level);
        let inside = at.map(|place| place.clamp(0, whole - 1) as u32);
        let is_outside = [0, 1].map(|axis| at[axis] != i64::from(inside[axis]));
        match is_outside {
            [false, false] => texel((face, inside)),
            [true, true] => {
                let beside = [[at[0], inside[1].into()], [inside[0].into(), at[1]]];
                let [one, other] = beside.map(|at| self.cube_texel(channel, face, at, side, level));
                let own = texel((face, inside));
                let is_single = self
                    .texture_of(channel, SamplerShape::Cube)
                    .is_none_or(|texture| matches!(texture.texels(), Texels::Single(_)));
                // A texture in float32 also holds its border in float32.
                let mean = |sum: [N; 3]| {
                    if is_single {
                        let [a, b, c] = sum.map(Real::to_f32);
                        N::from_f64(((a + b + c) / 3.0).into())
                    } else {
                        (sum[0] + sum[1] + sum[2]) / N::from_f64(3.0)
                    }
                };
                [0, 1, 2, 3].map(|i| mean([own[i], one[i], other[i]]))
            }
            _ => texel(nearest_beyond(face, inside, at, side)),
        }
    }

    /// The offset of a lookup in texels, a constant expression.
    fn offset(&self, function: BuiltIn, arguments: &[ExprId]) -> [i32; 3] {
        use BuiltIn as B;
        let position = match function {
            B::TextureOffset | B::TextureProjOffset => 1,
            B::TextureLodOffset | B::TextureProjLodOffset => 2,
            B::TextureGradOffset | B::TextureProjGradOffset => 3,
            _ => return [0; 3],
        };
        let value = self
            .tree
            .value(arguments[position])
            .expect("an offset is constant");
        [0, 1, 2].map(|axis| match value.components().get(axis) {
            None => 0,
            Some(tree::Value::Int(texels)) => *texels,
            other => panic!("an offset of {other:?}"),
        })
    }

    /// The level of the mipmaps.
    fn level(
        &mut self,
        function: BuiltIn,
        (shape, at): (SamplerShape, &[N]),
        sides: &[u32],
        values: &[Value<N>],
        expr: ExprId,
    ) -> Result<N, N> {
        use BuiltIn as B;
        let along = match function {
            B::TextureLod | B::TextureLodOffset | B::TextureProjLod | B::TextureProjLodOffset => {
                return Ok(values[1][0].real());
            }
            B::TextureGrad | B::TextureGradOffset | B::TextureProjGrad | B::TextureProjGradOffset => [1, 2]
                .map(|argument: usize| -> Vec<N> {
                    values[argument]
                        .iter()
                        .map(|component| component.real())
                        .collect()
                }),
            _ => {
                let [mut along_x, mut along_y] = [at, at].map(<[N]>::to_vec);
                for axis in 0..at.len() {
                    along_x[axis] = self.derivative(at[axis], 1, expr)?;
                    along_y[axis] = self.derivative(at[axis], 2, expr)?;
                }
                [along_x, along_y]
            }
        };
        let [along_x, along_y] = along.map(|along| -> Vec<N> {
            let along = match (shape, at, &along[..]) {
                (SamplerShape::Cube, &[x, y, z], &[dx, dy, dz]) => {
                    cube_gradient([x, y, z], [dx, dy, dz]).to_vec()
                }
                _ => along,
            };
            let sides = sides.iter().map(|side| N::from_f64((*side).into()));
            along
                .into_iter()
                .zip(sides)
                .map(|(along, side)| along * side)
                .collect()
        });
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
    fn between_levels(&self, lookup: &Lookup<N>, level: N) -> [N; 4] {
        let sides = self.sides(lookup.channel, lookup.shape);
        let last = sides.iter().max().map_or(0, |side| side.ilog2());
        let level = min(max(level, N::from_f64(0.0)), N::from_f64(last.into()));
        let below = level.floor();
        let weight = level - below;
        let first = to_int(below.to_f64()) as u32;
        let of_level = |level: u32| {
            let sides = sides.iter().map(|side| (side >> level).max(1));
            self.filtered(lookup, &sides.collect::<Vec<_>>(), level)
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
    fn filtered(&self, lookup: &Lookup<N>, sides: &[u32], level: u32) -> [N; 4] {
        let Sampling { filter, wrap } = lookup.sampling;
        let is_nearest = filter == Filter::Nearest;
        let is_cube = lookup.shape == SamplerShape::Cube;
        let axis = |axis: usize| {
            let (at, side) = (lookup.at[axis], N::from_f64(sides[axis].into()));
            let (place, least, most) = match wrap {
                _ if is_cube => (at, N::from_f64(-1.0), side),
                Wrap::Repeat => (at - at.floor(), N::from_f64(-1.0), side),
                Wrap::Clamp => (at, N::from_f64(-16.0), side + N::from_f64(16.0)),
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
            let places = [first, first + 1].map(|texel| match wrap {
                _ if is_cube => texel.clamp(-1, length - i64::from(is_nearest)),
                Wrap::Clamp => texel.clamp(0, length - 1),
                Wrap::Repeat => texel.rem_euclid(length),
            });
            (places, texels - below)
        };
        let axes: Vec<_> = (0..sides.len()).map(axis).collect();
        let texel = |corner: usize| {
            let places = axes
                .iter()
                .enumerate()
                .map(|(at, (places, _))| places[corner >> at & 1]);
            let places: Vec<_> = places.collect();
            if is_cube {
                self.cube_texel(
                    lookup.channel,
                    lookup.face,
                    [places[0], places[1]],
                    sides[0],
                    level,
                )
            } else {
                let places: Vec<_> = places.iter().map(|place| *place as u32).collect();
                self.texel((lookup.channel, lookup.shape, 0), &places, level)
            }
        };
        if is_nearest {
            return texel(0);
        }
        let mut corners: Vec<_> = (0..1 << axes.len()).map(texel).collect();
        for (_, weight) in &axes {
            let pairs = corners.chunks_exact(2);
            let mixed = pairs.map(|pair| [0, 1, 2, 3].map(|i| mixed(pair[0][i], pair[1][i], *weight)));
            corners = mixed.collect();
        }
        corners[0]
    }
}

/// The texel of another face that is nearest to a texel at the edge of a face, beyond the edge that `outside`
/// has crossed.
fn nearest_beyond(face: u32, inside: [u32; 2], outside: [i64; 2], side: u32) -> (u32, [u32; 2]) {
    let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>();
    let own = cube::texel_direction(face, inside, side);
    // A corner has two neighbors: the step across the edge leads towards one of them.
    let step = [0, 1].map(|axis| (outside[axis] - i64::from(inside[axis])) as f64);
    let [across, up] = [[inside[0] + 1, inside[1]], [inside[0], inside[1] + 1]]
        .map(|next| cube::texel_direction(face, next, side));
    let towards = [0, 1, 2]
        .map(|i: usize| own[i] + 0.1 * (step[0] * (across[i] - own[i]) + step[1] * (up[i] - own[i])));
    let all = (0..cube::FACES).filter(|other| *other != face);
    let all = all.flat_map(|face| (0..side * side).map(move |at| (face, [at % side, at / side])));
    let measured = all.map(|(face, at)| {
        let center = cube::texel_direction(face, at, side);
        ((distance(own, center), distance(towards, center)), (face, at))
    });
    let nearest = measured.min_by(|(a, _), (b, _)| {
        let is_nearer = a.0 - b.0;
        if is_nearer.abs() > 1e-9 {
            a.0.total_cmp(&b.0)
        } else {
            a.1.total_cmp(&b.1)
        }
    });
    nearest.expect("there are five other faces").1
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
