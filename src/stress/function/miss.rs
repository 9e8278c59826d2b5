//! How a function reports a miss, determined by evaluating it.

use glam::DVec3;

use super::Signature;
use crate::case::RaySphere;
use crate::random::Random;
use crate::tally::Outcome;

/// Rays that clearly miss a sphere: a result common to several of them is how the function reports a
/// miss.
pub(crate) fn clear_misses() -> Vec<RaySphere> {
    let random = &mut Random::new(0, &["clear misses"]);
    let ray_spheres = (0..16).map(|_| {
        let c = random.direction() * random.between(0.0, 3.0);
        let r = random.between(0.5, 1.5);
        let ahead = random.direction();
        let aside = ahead.cross(random.direction()).normalize_or(DVec3::X);
        let o = c - ahead * random.between(3.0, 8.0) + aside * (r * random.between(2.0, 5.0));
        RaySphere::rounded(o, ahead, c, r)
    });
    ray_spheres.collect()
}

/// How to interpret the color of a function's call: t, flag and second t.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MissConvention {
    has_second_root: bool,
    has_flag: bool,
    /// Results for clear misses: colors that occur more than once.
    misses: Vec<[f64; 3]>,
}

impl MissConvention {
    /// Derives the convention of a function from its colors for [`clear_misses`].
    pub(crate) fn new(signature: &Signature, colors: &[[f64; 3]]) -> Self {
        let same = |color: &&[f64; 3]| colors.iter().filter(|other| same_bits(other, color)).count() > 1;
        let mut misses: Vec<[f64; 3]> = Vec::new();
        for color in colors.iter().filter(same) {
            if !misses.iter().any(|other| same_bits(other, color)) {
                misses.push(*color);
            }
        }
        Self {
            has_second_root: signature.has_second_root(),
            has_flag: signature.has_flag(),
            misses,
        }
    }

    /// Whether a negative t is a miss: unless the function has a flag, or reports misses by a positive
    /// number.
    pub(crate) fn behind_is_miss(&self) -> bool {
        !self.has_flag && !self.misses.iter().any(|[t, ..]| *t > 0.0)
    }

    pub(crate) fn outcome(&self, color: [f64; 3]) -> Outcome {
        let [t, flag, second] = color;
        if self.has_flag {
            // A function that is wrong enough never reports a miss.
            let is_miss_flag = |miss: &[f64; 3]| miss[1] == flag;
            if self.misses.iter().any(is_miss_flag) || (self.misses.is_empty() && flag <= 0.0) {
                return Outcome::Miss;
            }
        } else if !t.is_nan() && self.misses.iter().any(|miss| same_bits(miss, &color)) {
            return Outcome::Miss;
        }
        match (t, self.has_second_root) {
            (t, _) if !t.is_finite() => Outcome::Nan,
            (t, _) if t > 0.0 => Outcome::Hit(t),
            (_, true) if second > 0.0 => Outcome::Hit(second),
            (_, true) => Outcome::Miss,
            _ if self.behind_is_miss() => Outcome::Miss,
            (t, _) => Outcome::Hit(t),
        }
    }

    /// The result for a miss: t, flag and second t.
    pub(crate) fn miss(&self) -> Option<[f64; 3]> {
        self.misses.first().copied()
    }

    /// The positive number that the function returns for a miss, if any.
    pub(crate) fn positive_miss(&self) -> Option<f64> {
        let first = self.misses.first().map(|miss| miss[0]);
        first.filter(|t| *t > 0.0)
    }
}

fn same_bits(a: &[f64; 3], b: &[f64; 3]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}
