//! Light sources: point and sphere lights, and the background.

use toyproof_scene as scene;

use crate::lanes::{Lanes, Wide, Wide3};
use crate::ray::spherical_direction;
use crate::real::{Real, Vector};

#[derive(Debug)]
pub(super) struct Light<T: Real> {
    pub(super) position: T::Vec3,
    pub(super) color: T::Vec3,
    pub(super) shadow: bool,
    /// 0 for a point light.
    pub(super) radius: T,
    /// The emitter that coincides with the light and therefore does not occlude it.
    pub(super) surface: Option<usize>,
}

impl<T: Real> Light<T> {
    pub(super) fn new(light: &scene::Light, objects: &[scene::Object]) -> Self {
        let coincides = |object: &scene::Object| {
            let shape = scene::Shape::Sphere {
                center: light.position,
                radius: light.radius,
            };
            object.shape == shape && object.material.model == scene::Model::Emitter
        };
        Self {
            surface: objects.iter().position(coincides),
            position: T::Vec3::from_f64(light.position),
            color: T::Vec3::from_f64(light.color),
            shadow: light.shadow,
            radius: T::from_f64(light.radius),
        }
    }
}

#[derive(Debug)]
pub(super) struct Background<T: Real> {
    bottom: T::Vec3,
    top: T::Vec3,
}

impl<T: Real> Background<T> {
    pub(super) fn new(background: &scene::Background) -> Self {
        let (bottom, top) = match *background {
            scene::Background::Uniform(color) => (color, color),
            scene::Background::Gradient { bottom, top } => (bottom, top),
        };
        Self {
            bottom: T::Vec3::from_f64(bottom),
            top: T::Vec3::from_f64(top),
        }
    }

    /// Returns the radiance of rays that miss everything.
    #[inline(always)]
    pub(super) fn color<S: Lanes<T>>(&self, simd: S, direction: Wide3<T, S>) -> Wide3<T, S> {
        let [half, one] = [0.5, 1.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let [bottom, top] = [self.bottom, self.top].map(|color| Wide3::splat(simd, color.to_array()));
        let up = half * (one + direction.1);
        bottom * (one - up) + top * up
    }
}

/// The cone of directions that a sphere subtends at a point, one per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cone<T, S: Lanes<T>> {
    axis: Wide3<T, S>,
    /// Distance to the center of the sphere.
    distance: Wide<T, S>,
    /// (radius/distance)², the squared sine of the half angle. It is ≥ 1 inside the sphere, where the cone is
    /// the full sphere of directions.
    sine2: Wide<T, S>,
    /// 1 − cos of the half angle.
    max_one_minus_cosine: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> Cone<T, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, center: Wide3<T, S>, radius: Wide<T, S>, from: Wide3<T, S>) -> Self {
        let [one, two] = [1.0, 2.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let to_center = center - from;
        let distance = to_center.length(simd);
        let ratio = radius / distance;
        let sine2 = ratio * ratio;
        // 1 − √(1 − s²) without cancellation.
        let outside = sine2 / (one + (one - sine2).sqrt());
        Self {
            axis: to_center / distance,
            distance,
            sine2,
            max_one_minus_cosine: outside.select(sine2.less(one), two),
        }
    }

    /// Samples a direction uniformly in solid angle, and returns it with the distance to the sphere along it.
    /// The cosine to the axis is 1 − u·`max_one_minus_cosine`; v is the turn about the axis.
    #[inline(always)]
    pub(super) fn sample(&self, simd: S, [u, v]: [Wide<T, S>; 2], active: u32) -> (Wide3<T, S>, Wide<T, S>) {
        let one = Wide::splat(simd, T::one());
        let one_minus_cosine = u * self.max_one_minus_cosine;
        let cosine = one - one_minus_cosine;
        let sine2 = one_minus_cosine * (one + cosine);
        let direction = spherical_direction(simd, self.axis, [cosine, sine2.positive().sqrt(), v], active);
        let half_chord = (self.sine2 - sine2).positive().sqrt();
        let near = (cosine - half_chord).select(self.sine2.less(one), cosine + half_chord);
        (direction, self.distance * near)
    }

    /// Returns the probability density of [`Cone::sample`] in solid angle.
    #[inline(always)]
    pub(super) fn density(&self, simd: S) -> Wide<T, S> {
        let [one, tau] = [1.0, std::f64::consts::TAU].map(|number| Wide::splat(simd, T::from_f64(number)));
        one / (tau * self.max_one_minus_cosine)
    }
}
