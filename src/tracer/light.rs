//! Where light comes from.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene as scene;

use super::lanes::{Columns, Kernel, Lanes, MOST_LANES, Wide, Wide3};
use super::ray::around;
use super::real::{Real, Vector};

#[derive(Debug)]
pub(super) struct Light<T: Real> {
    pub(super) position: T::Vec3,
    pub(super) color: T::Vec3,
    pub(super) shadow: bool,
    /// 0 for a point.
    pub(super) radius: T,
    /// The emitter that is where the light is, and does not hide it.
    pub(super) surface: Option<usize>,
}

impl<T: Real> Light<T> {
    pub(super) fn new(light: &scene::Light, objects: &[scene::Object]) -> Self {
        let is_its_own = |object: &scene::Object| {
            let shape = scene::Shape::Sphere {
                center: light.position,
                radius: light.radius,
            };
            object.shape == shape && object.material.model == scene::Model::Emitter
        };
        Self {
            surface: objects.iter().position(is_its_own),
            position: T::Vec3::from_f64(light.position),
            color: T::Vec3::from_f64(light.color),
            shadow: light.shadow,
            radius: T::from_f64(light.radius),
        }
    }
}

/// The ways from the first `count` of some points, where the normals are these, to a light that is a point.
#[derive(Debug)]
pub(super) struct Toward<'a, T> {
    pub(super) count: usize,
    pub(super) points: &'a Columns<T>,
    pub(super) normals: &'a Columns<T>,
    pub(super) light: [T; 3],
    /// How far off the surface rays start.
    pub(super) offset: T,
    /// They are put here.
    pub(super) ways: &'a mut Ways<T>,
}

/// Ways to a light.
#[derive(Debug)]
pub(super) struct Ways<T> {
    /// From the points, of length 1.
    pub(super) directions: Columns<T>,
    /// Where shadow rays start, and where they go.
    pub(super) rays: [Columns<T>; 2],
    /// From there.
    pub(super) distances: [T; MOST_LANES],
    /// Between normal and direction.
    pub(super) cosines: [T; MOST_LANES],
}

impl<T: Real> Ways<T> {
    pub(super) fn nowhere() -> Self {
        let zeros = || Columns::splat([T::zero(); 3]);
        Self {
            directions: zeros(),
            rays: [zeros(), zeros()],
            distances: [T::zero(); MOST_LANES],
            cosines: [T::zero(); MOST_LANES],
        }
    }
}

impl<T: Real> Kernel<T> for Toward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let ways = self.ways;
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
            ways.directions.store(direction, at);
            ways.rays[0].store(origin, at);
            ways.rays[1].store(to_light / distance, at);
            distance.store(&mut ways.distances[at..]);
            cosine.store(&mut ways.cosines[at..]);
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

/// The cone of directions in which a sphere is seen from a point.
#[derive(Debug)]
pub(super) struct Cone<T: Real> {
    axis: T::Vec3,
    /// To the sphere's centre.
    distance: T,
    /// (radius/distance)², the sine of the half angle squared; ≥ 1 from within, where the cone is all directions.
    sine2: T,
    /// 1 − cos of the half angle.
    depth: T,
}

impl<T: Real> Cone<T> {
    pub(super) fn new(center: T::Vec3, radius: T, from: T::Vec3) -> Self {
        let to_center = center - from;
        let distance = to_center.length();
        let ratio = radius / distance;
        let sine2 = ratio * ratio;
        let depth = if sine2 < T::one() {
            // 1 − √(1 − s²) without its cancellation.
            sine2 / (T::one() + (T::one() - sine2).sqrt())
        } else {
            T::from_f64(2.0)
        };
        Self {
            axis: to_center / distance,
            distance,
            sine2,
            depth,
        }
    }

    /// A direction drawn uniformly over the solid angle, and how far the sphere is along it: the cosine to the axis is
    /// 1 − u·depth, and v turns it.
    pub(super) fn draw(&self, [u, v]: [T; 2]) -> (T::Vec3, T) {
        let short = u * self.depth;
        let cosine = T::one() - short;
        let sine2 = short * (T::one() + cosine);
        let direction = around::<T>(self.axis, cosine, sine2.max(T::zero()).sqrt(), v);
        let half_chord = (self.sine2 - sine2).max(T::zero()).sqrt();
        let near = if self.sine2 < T::one() {
            cosine - half_chord
        } else {
            cosine + half_chord
        };
        (direction, self.distance * near)
    }

    /// The density of [`Cone::draw`] over the solid angle.
    pub(super) fn density(&self) -> T {
        (T::from_f64(std::f64::consts::TAU) * self.depth).recip()
    }
}
