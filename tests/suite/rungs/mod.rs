//! What students get wrong in the later rungs, and what they say otherwise: a file for each rung.

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

use crate::support::{Edit, Rung};

/// What is edited, and how.
pub(crate) type Named = (&'static str, &'static [Edit]);

/// A rung with its mistakes and its rewrites.
pub(crate) struct Edited {
    pub(crate) rung: &'static Rung,
    pub(crate) faults: &'static [Named],
    /// Several lists, since some are common to several rungs.
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
