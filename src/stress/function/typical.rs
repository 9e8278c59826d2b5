//! Tests a function with rays and spheres of typical size, in f64.

use std::time::Duration;

use glam::DVec3;
use toyproof_glsl as glsl;

use super::mistake::{self, Mistake};
use super::{FunctionRunner, MissConvention, Signature};
use crate::case::{Case, RaySphere};
use crate::cells::{RayStart, Reference};
use crate::random::Random;
use crate::run::RunError;
use crate::tally::Outcome;

/// The results of a function for rays and spheres of typical size.
#[derive(Debug, Clone, Copy)]
pub struct TypicalResults {
    /// The number of cases.
    pub cases: u64,
    /// The number of cases with the right result.
    pub right: u64,
    /// The mistake that explains the others.
    pub mistake: Option<Mistake>,
}

/// Tests a function of a shader in f64, for rays of length 1 and spheres of typical size. `timeout` is the
/// time limit of its compilation and of its evaluation.
///
/// # Errors
///
/// [`RunError`] if the function cannot be run in time.
pub fn test_typical(
    text: &str,
    signature: &Signature,
    options: &glsl::Options,
    timeout: Duration,
) -> Result<TypicalResults, RunError> {
    let runner = FunctionRunner::new(text, signature, options, Some(timeout))?;
    let convention = runner.miss_convention::<f64>()?;
    let outcomes = runner.typical_outcomes(DirectionLength::Unit, &convention)?;
    let is_right = |(ray_sphere, outcome): &&(RaySphere, Outcome)| {
        outcome.is_right(&Reference::new(&Case::Sphere(*ray_sphere), RayStart::Anywhere))
    };
    Ok(TypicalResults {
        cases: outcomes.len() as u64,
        right: outcomes.iter().filter(is_right).count() as u64,
        mistake: mistake::recognize(&outcomes, &[], &convention, signature),
    })
}

/// The length of the directions of typical rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DirectionLength {
    Unit,
    /// From 0.3 to 4.
    Any,
}

impl FunctionRunner<'_> {
    /// The typical cases with the function's outcomes.
    pub(super) fn typical_outcomes(
        &self,
        length: DirectionLength,
        convention: &MissConvention,
    ) -> Result<Vec<(RaySphere, Outcome)>, RunError> {
        let ray_spheres = typical_cases(length);
        let outcomes = self.outcomes::<f64>(&ray_spheres, convention)?;
        Ok(ray_spheres.into_iter().zip(outcomes).collect())
    }
}

/// The number of typical cases: a mistake that concerns one ray in twenty shows in a dozen of them.
const TYPICAL_CASES: usize = 240;

/// The minimum |δ| of a typical case, which no function that is right gets wrong.
const MIN_TYPICAL_DELTA: f64 = 0.02;

/// Rays and spheres of typical size, from all sides and from inside; none is nearly tangent.
fn typical_cases(length: DirectionLength) -> Vec<RaySphere> {
    let random = &mut Random::new(1, &["ordinary"]);
    let mut ray_spheres = Vec::new();
    while ray_spheres.len() < TYPICAL_CASES {
        let r = random.between(0.4, 2.5);
        let c = random.direction() * random.between(0.5, 4.0);
        let inside = random.unit() < 0.25;
        let away = if inside {
            random.between(0.1, 0.8)
        } else {
            random.between(1.5, 6.0)
        };
        let ahead = random.direction();
        let aside = ahead.cross(random.direction()).normalize_or(DVec3::X);
        let o = c - ahead * (away * r);
        let target = c + aside * (r * random.between(0.0, 1.6));
        let d = (target - o).normalize() * if random.unit() < 0.2 { -1.0 } else { 1.0 };
        let stretch = match length {
            DirectionLength::Unit => 1.0,
            DirectionLength::Any => random.log_between(0.3, 4.0),
        };
        let ray_sphere = RaySphere::rounded(o, d * stretch, c, r);
        let intersection = ray_sphere.intersection();
        if intersection.is_some_and(|intersection| intersection.discriminant.abs() > MIN_TYPICAL_DELTA) {
            ray_spheres.push(ray_sphere);
        }
    }
    ray_spheres
}
