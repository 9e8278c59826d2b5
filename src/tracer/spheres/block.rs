//! Eight spheres side by side.

use super::super::real::Real;
use super::formula::unit;
use super::{EIGHT, Eight, Numbered};

/// Up to eight spheres: what a ray needs to meet them, in three lines of the cache in f32. Places that are empty hold
/// NaN, which nothing meets.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Block<T> {
    pub(super) center: [Eight<T>; 3],
    /// One over the unit that lengths are counted in, a power of two in scene units.
    pub(super) per_unit: Eight<T>,
    /// (radius/unit)², in [1, 4)
    pub(super) radius2: Eight<T>,
    pub(super) numbers: [u32; EIGHT],
}

/// How far the spheres of a block reach.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Reach<T> {
    /// How far from the centre along each axis a ray may pass that [`super::formula`] says meets the sphere: a little more
    /// than the radius. See [`margin`].
    pub(super) reach: Eight<T>,
    pub(super) count: usize,
}

/// What is added to boxes, relative to the radius, and to the t's at their sides, relative to these, so that no box
/// leaves out a ray for which the formula finds a hit.
///
/// The formula takes the point P at f·d/a along the ray, and finds a hit where the square that it computes of P's distance from
/// the centre is at most r². With u half of the epsilon, each component of P − c is off by at most
/// u (2 |o − c| + 3 r) along its own axis: f is rounded, the product with d and the sum. The square and the sum of squares are off by 4 u of themselves, hence
/// the distance by 2 u r. So P lies on the ray, and within r + u (2 |o − c| + 5 r) of the centre along each axis. The side of a box
/// is met at (side − o)/d, off by 4 u of itself, and so the t's of sides must differ by 4 + 2 times u, relative to
/// themselves, from what they are, and the radius by 5 + 2 + 4 times u. Here both have 32 u.
pub(super) fn margin<T: Real>() -> T {
    T::from_f64(16.0) * T::epsilon()
}

/// A block of at most eight, and how far they reach.
pub(super) fn block<T: Real>(spheres: &[Numbered<T>]) -> (Block<T>, Reach<T>) {
    let nan = [T::nan(); EIGHT];
    let mut block = Block {
        center: [nan; 3],
        per_unit: nan,
        radius2: nan,
        numbers: [super::NONE; EIGHT],
    };
    let mut reach = Reach {
        reach: nan,
        count: spheres.len(),
    };
    for (at, sphere) in spheres.iter().enumerate() {
        let radius = sphere.radius;
        let per_unit = unit(radius).recip();
        let scaled = radius * per_unit;
        let size = sphere.center.iter().fold(T::zero(), |size, c| size.max(c.abs()));
        for (axis, component) in sphere.center.into_iter().enumerate() {
            block.center[axis][at] = component;
        }
        block.per_unit[at] = per_unit;
        block.radius2[at] = scaled * scaled;
        block.numbers[at] = sphere.number;
        // The sides of boxes are rounded as well, by an epsilon of the centre's size.
        reach.reach[at] = radius
            + (margin::<T>() * radius + (T::epsilon() + T::epsilon()) * size)
            + T::min_positive_value();
    }
    (block, reach)
}

impl<T: Real> Reach<T> {
    /// The box of a block: the lowest and the highest corner.
    pub(super) fn bounds(&self, block: &Block<T>) -> [[T; 3]; 2] {
        let side = |axis: usize, sign: T| {
            (0..self.count).map(move |at| block.center[axis][at] + sign * self.reach[at])
        };
        [
            [0, 1, 2].map(|axis| side(axis, -T::one()).fold(T::infinity(), T::min)),
            [0, 1, 2].map(|axis| side(axis, T::one()).fold(T::neg_infinity(), T::max)),
        ]
    }
}
