//! Samples on their way through the scene.

use super::super::ray::{First, Ray};
use super::super::real::{Real, Vector};
use super::super::sampler::Draws;

/// A ray to be followed: what it brings is multiplied by its throughput.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch<T: Real> {
    pub(super) ray: Ray<T>,
    pub(super) throughput: T::Vec3,
    /// How many segments there are from the camera to its end.
    pub(super) segments: u32,
}

/// A sample, and the ray that is followed for it.
#[derive(Debug)]
pub(in super::super) struct Walk<T: Real> {
    pub(super) branch: Branch<T>,
    /// What its ray meets first.
    pub(super) first: First<T>,
    /// Where among those that are put aside its last one is.
    aside: Option<usize>,
    pub(super) draws: Draws,
    /// What has been brought.
    pub(in super::super) sum: T::Vec3,
}

/// Rays that are still to be followed, each with the place of the one of the same sample that was put aside before.
pub(super) type Aside<T> = Vec<(Branch<T>, Option<usize>)>;

impl<T: Real> Walk<T> {
    /// Along a camera ray, which meets that first.
    #[inline]
    pub(in super::super) fn new(ray: Ray<T>, first: First<T>, draws: Draws) -> Self {
        Self {
            branch: Branch {
                ray,
                throughput: T::Vec3::from_f64([1.0; 3]),
                segments: 1,
            },
            first,
            aside: None,
            draws,
            sum: T::Vec3::ZERO,
        }
    }

    /// Light comes along the ray that is followed.
    #[inline]
    pub(super) fn bring(&mut self, light: T::Vec3) {
        self.sum = self.sum + self.branch.throughput * light;
    }

    /// Puts a ray aside.
    pub(super) fn put_aside(&mut self, branch: Branch<T>, aside: &mut Aside<T>) {
        aside.push((branch, self.aside));
        self.aside = Some(aside.len() - 1);
    }

    /// Turns to the ray that was put aside last; whether there was one.
    #[inline]
    pub(super) fn turn(&mut self, aside: &Aside<T>) -> bool {
        let Some(last) = self.aside else {
            return false;
        };
        (self.branch, self.aside) = aside[last];
        true
    }
}
