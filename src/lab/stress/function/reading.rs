//! How a function tells that there is no hit, found out by asking it.

use super::super::axis::Shot;
use super::super::random::Random;
use super::super::tally::Outcome;
use super::Signature;

/// Rays that pass a sphere by far: what a function says of several of them alike is how it says no.
pub(in super::super) fn clear_misses() -> Vec<Shot> {
    let random = &mut Random::new(0, &["clear misses"]);
    let shots = (0..16).map(|_| {
        let c = random.direction() * random.between(0.0, 3.0);
        let r = random.between(0.5, 1.5);
        let ahead = random.direction();
        let aside = ahead.cross(random.direction()).normalize_or(glam::DVec3::X);
        let o = c - ahead * random.between(3.0, 8.0) + aside * (r * random.between(2.0, 5.0));
        Shot {
            o: o.to_array().map(|x| x as f32),
            d: ahead.to_array().map(|x| x as f32),
            c: c.to_array().map(|x| x as f32),
            r: r as f32,
        }
    });
    shots.collect()
}

/// How the colour that a function's call leaves is read: t, flag and second t.
#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    two: bool,
    flag: bool,
    /// What it says of clear misses: colours that several have in common.
    misses: Vec<[f64; 3]>,
}

impl Answers {
    /// Of a function, from what it says of [`clear_misses`].
    pub(in super::super) fn of(signature: &Signature, told: &[[f64; 3]]) -> Self {
        let same = |color: &&[f64; 3]| told.iter().filter(|other| alike(other, color)).count() > 1;
        let mut misses: Vec<[f64; 3]> = Vec::new();
        for color in told.iter().filter(same) {
            if !misses.iter().any(|other| alike(other, color)) {
                misses.push(*color);
            }
        }
        Self {
            two: signature.gives_two(),
            flag: signature.gives_flag(),
            misses,
        }
    }

    /// Whether a negative t is a way to say no: unless no is said by a number of its own that is positive, or by a flag.
    pub(in super::super) fn behind_is_miss(&self) -> bool {
        !self.flag && !self.misses.iter().any(|[t, ..]| *t > 0.0)
    }

    pub(in super::super) fn outcome(&self, color: [f64; 3]) -> Outcome {
        let [t, flag, second] = color;
        if self.flag {
            // A function that is wrong enough never says no.
            let is_no = |miss: &[f64; 3]| miss[1] == flag;
            if self.misses.iter().any(is_no) || (self.misses.is_empty() && flag <= 0.0) {
                return Outcome::Miss;
            }
        } else if !t.is_nan() && self.misses.iter().any(|miss| alike(miss, &color)) {
            return Outcome::Miss;
        }
        match (t, self.two) {
            (t, _) if !t.is_finite() => Outcome::Nan,
            (t, _) if t > 0.0 => Outcome::Hit(t),
            (_, true) if second > 0.0 => Outcome::Hit(second),
            (_, true) => Outcome::Miss,
            _ if self.behind_is_miss() => Outcome::Miss,
            (t, _) => Outcome::Hit(t),
        }
    }

    /// What it says of a miss: t, flag and second t.
    pub(in super::super) fn miss(&self) -> Option<[f64; 3]> {
        self.misses.first().copied()
    }

    /// The positive number that it returns for a miss, if it has one.
    #[must_use]
    pub fn positive_miss(&self) -> Option<f64> {
        let first = self.misses.first().map(|miss| miss[0]);
        first.filter(|t| *t > 0.0)
    }
}

fn alike(a: &[f64; 3], b: &[f64; 3]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}
