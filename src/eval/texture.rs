//! Textures as channels sample them: single texels, and filters as exact operations, which strict shaders compute alike
//! (`toyproof_translate`).

use toyproof_glsl::{Filter, Sampling, Wrap};
use toyproof_image::Texture;

use crate::number::Number;

/// How a lookup reads a texture: what an instruction holds in 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Lookup {
    /// 0 to 3.
    pub(crate) channel: u8,
    /// 0 to 3.
    pub(crate) component: u8,
    pub(crate) sampling: Sampling,
    /// Added to the coordinates in texels, −8 to 7.
    pub(crate) offset: [i8; 2],
}

impl Lookup {
    /// The bits of the lookup.
    pub(crate) fn encoded(self) -> u32 {
        let filter = match self.sampling.filter {
            Filter::Nearest => 0,
            Filter::Linear => 1,
            Filter::Mipmap => 2,
        };
        let wrap = u32::from(self.sampling.wrap == Wrap::Repeat);
        let [x, y] = self.offset.map(|axis| u32::from(axis.cast_unsigned()));
        u32::from(self.channel) | u32::from(self.component) << 2 | filter << 4 | wrap << 6 | x << 8 | y << 16
    }

    /// The lookup with these bits.
    pub(crate) fn decoded(bits: u32) -> Self {
        let filter = match bits >> 4 & 3 {
            0 => Filter::Nearest,
            1 => Filter::Linear,
            _ => Filter::Mipmap,
        };
        let wrap = if bits >> 6 & 1 == 1 {
            Wrap::Repeat
        } else {
            Wrap::Clamp
        };
        Self {
            channel: (bits & 3) as u8,
            component: (bits >> 2 & 3) as u8,
            sampling: Sampling { filter, wrap },
            offset: [bits >> 8, bits >> 16].map(|axis| (axis as u8).cast_signed()),
        }
    }

    /// What an unbound channel has: opaque black.
    pub(crate) fn unbound<N: Number>(self) -> N {
        N::from_f64(f64::from(u8::from(self.component == 3)))
    }

    /// A component of a texel; coordinates and level are clamped to the texture, as naga does.
    pub(crate) fn texel<N: Number>(self, texture: &Texture, at: [i32; 2], level: i32) -> N {
        let level = (level as u32).min(texture.levels() - 1);
        let size = size(texture, level);
        let clamped = |axis: usize| (at[axis] as u32).min(size[axis] - 1);
        texel(texture, level, [clamped(0), clamped(1)], self.component)
    }

    /// A component at normalized coordinates; `detail` is the level of the mipmaps.
    pub(crate) fn sample<N: Number>(self, texture: &Texture, at: [N; 2], detail: N, noise: N::Noise) -> N {
        if self.sampling.filter != Filter::Mipmap {
            return self.level(texture, 0, at, noise);
        }
        let last = texture.levels() - 1;
        let detail = limited(detail, 0.0, f64::from(last));
        let below = detail.floor();
        let between = detail.sub(below, noise);
        let level = below.to_f64() as u32;
        let color = self.level(texture, level, at, noise);
        if between > N::default() {
            let next = self.level(texture, (level + 1).min(last), at, noise);
            mix(color, next, between, noise)
        } else {
            color
        }
    }

    /// A component at normalized coordinates in one level.
    fn level<N: Number>(self, texture: &Texture, level: u32, at: [N; 2], noise: N::Noise) -> N {
        let size = size(texture, level);
        let is_nearest = self.sampling.filter == Filter::Nearest;
        let axis = |axis: usize| {
            let side = f64::from(size[axis]);
            let place = match self.sampling.wrap {
                Wrap::Repeat => at[axis].sub(at[axis].floor(), noise),
                Wrap::Clamp => at[axis],
            };
            let texels = place.mul(N::from_f64(side), noise);
            let texels = if is_nearest {
                texels
            } else {
                texels.sub(N::from_f64(0.5), noise)
            };
            // Far coordinates, and NaN, must fit an integer.
            let texels = limited(texels, -16.0, side + 16.0);
            let below = texels.floor();
            let first = below.to_f64() as i32 + i32::from(self.offset[axis]);
            (first, texels.sub(below, noise))
        };
        let wrapped = |place: i32, axis: usize| match self.sampling.wrap {
            Wrap::Repeat => place.rem_euclid(size[axis].cast_signed()) as u32,
            Wrap::Clamp => place.clamp(0, size[axis].cast_signed() - 1) as u32,
        };
        let ((x, across), (y, up)) = (axis(0), axis(1));
        let texel = |x, y| texel::<N>(texture, level, [wrapped(x, 0), wrapped(y, 1)], self.component);
        if is_nearest {
            return texel(x, y);
        }
        let lower = mix(texel(x, y), texel(x + 1, y), across, noise);
        let upper = mix(texel(x, y + 1), texel(x + 1, y + 1), across, noise);
        mix(lower, upper, up, noise)
    }
}

/// `a + (b − a)·weight`
fn mix<N: Number>(a: N, b: N, weight: N, noise: N::Noise) -> N {
    a.add(b.sub(a, noise).mul(weight, noise), noise)
}

/// GLSL's `min(max(x, least), most)`; `least` for NaN.
fn limited<N: Number>(x: N, least: f64, most: f64) -> N {
    let (least, most) = (N::from_f64(least), N::from_f64(most));
    let x = if x > least { x } else { least };
    if x < most { x } else { most }
}

/// Width and height of a level, which exists.
fn size(texture: &Texture, level: u32) -> [u32; 2] {
    match texture {
        Texture::Single(levels) => levels[level as usize].size(),
        Texture::Double(levels) => levels[level as usize].size(),
    }
}

/// A component of a texel within the texture.
pub(crate) fn texel<N: Number>(texture: &Texture, level: u32, [x, y]: [u32; 2], component: u8) -> N {
    let component = usize::from(component);
    match texture {
        Texture::Single(levels) => N::from_f32(levels[level as usize].get(x, y)[component]),
        Texture::Double(levels) => N::from_f64(levels[level as usize].get(x, y)[component]),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_image::Image;

    use super::*;

    fn lookup(filter: Filter, wrap: Wrap) -> Lookup {
        Lookup {
            channel: 2,
            component: 1,
            sampling: Sampling { filter, wrap },
            offset: [-8, 7],
        }
    }

    #[test]
    fn bits_hold_every_lookup() {
        for filter in [Filter::Nearest, Filter::Linear, Filter::Mipmap] {
            for wrap in [Wrap::Clamp, Wrap::Repeat] {
                let lookup = lookup(filter, wrap);
                assert_eq!(Lookup::decoded(lookup.encoded()), lookup);
            }
        }
    }

    #[test]
    fn filters_and_wraps_of_a_ramp() {
        let pixels = (0..4).map(|x| [f64::from(x), f64::from(x), 0.0, 1.0]);
        let texture = Texture::from(Image::new(4, 1, pixels.collect())).with_mipmaps();
        let at = |filter, wrap, x: f64, detail: f64| {
            let mut lookup = lookup(filter, wrap);
            lookup.offset = [0, 0];
            lookup.sample::<f64>(&texture, [x, 0.5], detail, ())
        };
        use Filter::{Linear, Mipmap, Nearest};
        use Wrap::{Clamp, Repeat};
        // The centers of the texels are at 1/8, 3/8, 5/8 and 7/8.
        assert_eq!(at(Nearest, Clamp, 0.26, 0.0), 1.0);
        assert_eq!(
            [at(Nearest, Clamp, 1.3, 0.0), at(Nearest, Repeat, 1.3, 0.0)],
            [3.0, 1.0]
        );
        assert_eq!(
            [at(Linear, Clamp, 0.25, 0.0), at(Linear, Clamp, 0.0, 0.0)],
            [0.5, 0.0]
        );
        assert_eq!(
            [at(Linear, Repeat, 0.0, 0.0), at(Linear, Repeat, -0.25, 0.0)],
            [1.5, 2.5]
        );
        // Level 1 is (0.5, 2.5), level 2 is 1.5.
        assert_eq!(
            [at(Mipmap, Clamp, 0.25, 1.0), at(Mipmap, Clamp, 0.25, 7.0)],
            [0.5, 1.5]
        );
        assert_eq!(at(Mipmap, Clamp, 0.25, 1.5), 1.0);
        assert_eq!(
            [at(Linear, Clamp, 1e300, 0.0), at(Linear, Repeat, f64::NAN, 0.0)],
            [3.0, 3.0]
        );
    }
}
