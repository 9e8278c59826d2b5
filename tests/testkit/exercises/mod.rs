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

use crate::{Edit, Exercise};

/// The name of a change, and its edits.
pub type Named = (&'static str, &'static [Edit]);

/// An exercise with its mistakes and its rewrites.
#[derive(Debug)]
pub struct Edited {
    /// The exercise.
    pub exercise: &'static Exercise,
    /// Its mistakes.
    pub faults: &'static [Named],
    /// Its rewrites: several lists, since some are shared by exercises.
    pub rewrites: &'static [&'static [Named]],
}

/// The later exercises.
pub static EDITED: [&Edited; 10] = [
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
