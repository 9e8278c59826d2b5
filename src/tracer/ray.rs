//! Rays, and their intersections with surfaces.

use crate::lanes::{Lanes, MAX_LANES, Wide, Wide3, lanes_of};
use crate::real::Real;
use crate::spheres::NO_SURFACE;

/// A ray o + t·d with t > 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray<T: Real> {
    pub(super) origin: T::Vec3,
    /// Of unit length, up to rounding.
    pub(super) direction: T::Vec3,
    /// The surface on which the origin lies.
    pub(super) from: Option<usize>,
}

/// Where a ray starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RayKind {
    /// At the camera.
    Camera,
    /// On a surface.
    Secondary,
}

impl<T: Real> Ray<T> {
    pub(super) fn kind(&self) -> RayKind {
        match self.from {
            None => RayKind::Camera,
            Some(_) => RayKind::Secondary,
        }
    }
}

/// The first surface along a ray, if any.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstHit<T> {
    /// Infinite if there is no hit.
    t: T,
    /// The index of the surface.
    surface: u32,
}

impl<T: Real> FirstHit<T> {
    /// Creates a hit of `surface` at t; an infinite t is a miss.
    #[inline]
    pub(super) fn new(t: T, surface: u32) -> Self {
        Self { t, surface }
    }

    pub(super) fn none() -> Self {
        Self::new(T::infinity(), NO_SURFACE)
    }

    /// Returns t and the index of the surface.
    #[inline]
    pub(super) fn get(self) -> Option<(T, usize)> {
        (self.t < T::infinity()).then_some((self.t, self.surface as usize))
    }

    /// Replaces the hit if the given one is nearer. At equal t, the smaller surface index wins.
    pub(super) fn update(&mut self, t: Option<T>, surface: usize) {
        if let Some(t) = t
            && (t < self.t || (t == self.t && t < T::infinity() && surface < self.surface as usize))
        {
            *self = Self::new(t, surface as u32);
        }
    }
}

/// Completes the unit vectors w to orthonormal bases: a = normalize(up × w), b = w × a, where up is y, or x
/// if |w.y| > 0.9.
#[inline(always)]
fn tangent_basis<T: Real, S: Lanes<T>>(simd: S, w: Wide3<T, S>) -> [Wide3<T, S>; 2] {
    let is_steep = Wide::splat(simd, T::from_f64(0.9)).less(w.1.abs());
    let [zero, one] = [T::zero(), T::one()];
    let up = Wide3::splat(simd, [one, zero, zero]).select(is_steep, Wide3::splat(simd, [zero, one, zero]));
    let a = up.cross(w).normalize(simd);
    [a, w.cross(a)]
}

/// Returns the directions at an angle to w, given by its cosine and sine, rotated about w by `turn` full
/// turns.
#[inline(always)]
pub(super) fn spherical_direction<T: Real, S: Lanes<T>>(
    simd: S,
    w: Wide3<T, S>,
    [cosine, sine, turn]: [Wide<T, S>; 3],
    active: u32,
) -> Wide3<T, S> {
    let [a, b] = tangent_basis(simd, w);
    let angles = (Wide::splat(simd, T::from_f64(std::f64::consts::TAU)) * turn).to_array();
    let [mut sines, mut cosines] = [[T::zero(); MAX_LANES]; 2];
    for lane in lanes_of(active) {
        (sines[lane], cosines[lane]) = angles[lane].sine_and_cosine();
    }
    let [s, c] = [sines, cosines].map(|numbers| Wide::load(simd, &numbers));
    a * (sine * c) + b * (sine * s) + w * cosine
}

/// The surface that the camera sees at one point of the screen.
#[derive(Debug, Clone, Copy)]
pub(super) enum PrimaryHit<T: Real> {
    /// A screen-space figure, by its index in the scene.
    Figure(usize),
    /// The camera ray and its first hit.
    Scene(Ray<T>, FirstHit<T>),
}

impl<T: Real> PrimaryHit<T> {
    /// Returns the index of the figure and of the surface; both are `None` for the background.
    pub(super) fn id(&self) -> [Option<usize>; 2] {
        match self {
            Self::Figure(figure) => [Some(*figure), None],
            Self::Scene(_, first) => [None, first.get().map(|(_, surface)| surface)],
        }
    }
}
