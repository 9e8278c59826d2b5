//! Mistakes and equivalent rewrites for the later exercises, a file for each.

mod accelerator;
mod animation;
mod diffuse;
mod disney;
mod importance_sampling;
mod parallel_rays;
mod quadrics;
mod sampling;
mod soft_shadows;
mod sphere;
mod whitted;

use crate::support::{Edit, Exercise};

/// The name of a change, and its edits.
pub(crate) type Named = (&'static str, &'static [Edit]);

/// An exercise with its mistakes and its rewrites.
pub(crate) struct Edited {
    pub(crate) exercise: &'static Exercise,
    pub(crate) faults: &'static [Named],
    /// Several lists, since some are shared by exercises.
    pub(crate) rewrites: &'static [&'static [Named]],
}

pub(crate) static EDITED: [&Edited; 10] = [
    &sampling::EDITED,
    &diffuse::EDITED,
    &disney::EDITED,
    &soft_shadows::EDITED,
    &quadrics::EDITED,
    &animation::EDITED,
    &whitted::EDITED,
    &importance_sampling::EDITED,
    &accelerator::EDITED,
    &parallel_rays::EDITED,
];
