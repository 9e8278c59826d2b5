//! Light sources: point and sphere lights, and the background.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene as scene;

use crate::lanes::{Columns, Kernel, Lanes, MAX_LANES, Wide, Wide3};
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

/// Kernel that computes the directions and shadow rays from the first `count` points to a point light.
#[derive(Debug)]
pub(super) struct ToPointLight<'a, T> {
    pub(super) count: usize,
    pub(super) points: &'a Columns<T>,
    pub(super) normals: &'a Columns<T>,
    pub(super) light: [T; 3],
    /// The offset of shadow rays from the surface.
    pub(super) offset: T,
    /// Receives the results.
    pub(super) output: &'a mut LightDirections<T>,
}

/// Directions to a point light, and shadow rays.
#[derive(Debug)]
pub(super) struct LightDirections<T> {
    /// Unit directions from the points.
    pub(super) directions: Columns<T>,
    /// Origins and directions of the shadow rays.
    pub(super) shadow_rays: [Columns<T>; 2],
    /// Distances from the origins of the shadow rays to the light.
    pub(super) distances: [T; MAX_LANES],
    /// Cosines between normals and directions.
    pub(super) cosines: [T; MAX_LANES],
}

impl<T: Real> LightDirections<T> {
    pub(super) fn zero() -> Self {
        let zeros = || Columns::splat([T::zero(); 3]);
        Self {
            directions: zeros(),
            shadow_rays: [zeros(), zeros()],
            distances: [T::zero(); MAX_LANES],
            cosines: [T::zero(); MAX_LANES],
        }
    }
}

impl<T: Real> Kernel<T> for ToPointLight<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let output = self.output;
        let light = Wide3::splat(simd, self.light);
        let [zero, offset] = [T::zero(), self.offset].map(|number| Wide::splat(simd, number));
        let mut at = 0;
        while at < self.count {
            let (point, normal) = (self.points.load(simd, at), self.normals.load(simd, at));
            let direction = (light - point).normalize(simd);
            let cosine = normal.dot(direction);
            let offset = (-offset).select(cosine.less(zero), offset);
            let origin = point + normal * offset;
            let to_light = light - origin;
            let distance = to_light.length(simd);
            output.directions.store(direction, at);
            output.shadow_rays[0].store(origin, at);
            output.shadow_rays[1].store(to_light / distance, at);
            distance.store(&mut output.distances[at..]);
            cosine.store(&mut output.cosines[at..]);
            at += S::COUNT;
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

    pub(super) fn color(&self, direction: T::Vec3) -> T::Vec3 {
        let [_, y, _] = direction.to_array();
        let up = T::from_f64(0.5) * (T::one() + y);
        self.bottom * (T::one() - up) + self.top * up
    }
}

/// The cone of directions that a sphere subtends at a point.
#[derive(Debug)]
pub(super) struct Cone<T: Real> {
    axis: T::Vec3,
    /// Distance to the center of the sphere.
    distance: T,
    /// (radius/distance)², the squared sine of the half angle. It is ≥ 1 inside the sphere, where the cone is
    /// the full sphere of directions.
    sine2: T,
    /// 1 − cos of the half angle.
    max_one_minus_cosine: T,
}

impl<T: Real> Cone<T> {
    pub(super) fn new(center: T::Vec3, radius: T, from: T::Vec3) -> Self {
        let to_center = center - from;
        let distance = to_center.length();
        let ratio = radius / distance;
        let sine2 = ratio * ratio;
        let max_one_minus_cosine = if sine2 < T::one() {
            // 1 − √(1 − s²) without cancellation.
            sine2 / (T::one() + (T::one() - sine2).sqrt())
        } else {
            T::from_f64(2.0)
        };
        Self {
            axis: to_center / distance,
            distance,
            sine2,
            max_one_minus_cosine,
        }
    }

    /// Samples a direction uniformly in solid angle, and returns it with the distance to the sphere along it.
    /// The cosine to the axis is 1 − u·`max_one_minus_cosine`; v is the turn about the axis.
    pub(super) fn sample(&self, [u, v]: [T; 2]) -> (T::Vec3, T) {
        let one_minus_cosine = u * self.max_one_minus_cosine;
        let cosine = T::one() - one_minus_cosine;
        let sine2 = one_minus_cosine * (T::one() + cosine);
        let direction = spherical_direction::<T>(self.axis, cosine, sine2.max(T::zero()).sqrt(), v);
        let half_chord = (self.sine2 - sine2).max(T::zero()).sqrt();
        let near = if self.sine2 < T::one() {
            cosine - half_chord
        } else {
            cosine + half_chord
        };
        (direction, self.distance * near)
    }

    /// Returns the probability density of [`Cone::sample`] in solid angle.
    pub(super) fn density(&self) -> T {
        (T::from_f64(std::f64::consts::TAU) * self.max_one_minus_cosine).recip()
    }
}
