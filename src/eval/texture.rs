//! A channel's texture: one level of texels, repeated in both directions.

use toyproof_image::Image;

use super::number::Number;

/// A picture that is read by its coordinates: row 0 is the bottom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Texture<'a>(pub(crate) &'a Image);

impl Texture<'_> {
    /// One component of a texel; the nearest one where there is none, as naga holds it.
    pub(crate) fn fetched(self, place: [i32; 2], component: usize) -> f32 {
        let size = self.0.size();
        let held = |axis: usize| (place[axis] as u32).min(size[axis] - 1);
        self.0.get(held(0), held(1))[component]
    }

    /// One component between four texels, weighed by how near they are: 1 in a coordinate is the whole texture.
    pub(crate) fn filtered<N: Number>(
        self,
        at: [N; 2],
        offset: [i32; 2],
        component: usize,
        noise: N::Noise,
    ) -> N {
        let size = self.0.size();
        let half = N::from_f64(0.5);
        let axis = |axis: usize| {
            let texels = at[axis]
                .mul(N::from_f64(f64::from(size[axis])), noise)
                .sub(half, noise);
            let below = texels.floor();
            let weight = texels.sub(below, noise);
            let wrap = |step: f64| {
                let place = below.to_f64() + step + f64::from(offset[axis]);
                place.rem_euclid(f64::from(size[axis])) as u32
            };
            (
                wrap(0.0).min(size[axis] - 1),
                wrap(1.0).min(size[axis] - 1),
                weight,
            )
        };
        let (left, right, across) = axis(0);
        let (low, high, up) = axis(1);
        let texel = |x, y| N::from_f64(f64::from(self.0.get(x, y)[component]));
        let between = |a: N, b: N, weight: N| a.add(b.sub(a, noise).mul(weight, noise), noise);
        let lower = between(texel(left, low), texel(right, low), across);
        let upper = between(texel(left, high), texel(right, high), across);
        between(lower, upper, up)
    }
}
