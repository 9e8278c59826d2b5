//! Random inputs, special ones, and neighbors of a case.

use std::ops::Range;

use toyproof_glsl::tree::Scalar;

use super::Case;
use super::domain::{Domain, Interval};
use super::interface::Interface;
use crate::random::Random;

/// Samples inputs of a function within its domain.
#[derive(Debug)]
pub(super) struct Sampler<'a> {
    interface: &'a Interface,
    domain: &'a Domain,
    pub(super) random: Random,
}

/// The number of bits of an f32.
const DIGITS: f64 = 24.0;

/// How often a component of a special case has a special value.
const SPECIAL_SHARE: f64 = 0.3;

impl<'a> Sampler<'a> {
    pub(super) fn new(interface: &'a Interface, domain: &'a Domain, seed: u64, label: &str) -> Self {
        Self {
            interface,
            domain,
            random: Random::new(seed, &[&interface.name, label]),
        }
    }

    /// A case of which each component is uniformly distributed, or its logarithm.
    pub(super) fn uniform(&mut self) -> Case {
        let mut case: Case = (0..self.interface.inputs.len())
            .map(|at| self.uniform_component(at))
            .collect();
        for unit in &self.domain.units {
            self.set_direction(&mut case, unit);
        }
        self.fit(&mut case);
        case
    }

    /// A case in which some components are zeros, ends of ranges, ones, small, or nearly equal to others.
    pub(super) fn special(&mut self) -> Case {
        let mut case = self.uniform();
        for at in 0..case.len() {
            if self.random.unit() < SPECIAL_SHARE {
                case[at] = self.special_component(&case, at);
            }
        }
        self.fit(&mut case);
        case
    }

    /// A case near another one: some components are changed, by anything from a unit in the last place to
    /// their range.
    pub(super) fn neighbor(&mut self, center: &Case) -> Case {
        let mut case = center.clone();
        let count = case.len();
        let changes = match self.random.below(3) {
            0 => 1,
            1 => 2.min(count),
            _ => 1 + self.random.below(count),
        };
        for _ in 0..changes {
            let at = self.random.below(count);
            case[at] = self.near_component(&case, at);
        }
        self.fit(&mut case);
        case
    }

    /// A value near that of a component, or anywhere in its interval.
    pub(super) fn component_near(&mut self, case: &Case, at: usize) -> f64 {
        let Interval { low, high } = self.interval(at);
        rounded(self.scalar(at), self.near_component(case, at).clamp(low, high))
    }

    fn scalar(&self, at: usize) -> Scalar {
        self.interface.inputs[at].scalar
    }

    fn interval(&self, at: usize) -> Interval {
        self.domain.intervals[at]
    }

    fn uniform_component(&mut self, at: usize) -> f64 {
        let Interval { low, high } = self.interval(at);
        match self.scalar(at) {
            Scalar::Float => self.interval(at).at(self.random.unit()),
            _ => (low + (self.random.unit() * (high - low + 1.0)).floor()).min(high),
        }
    }

    fn special_component(&mut self, case: &Case, at: usize) -> f64 {
        let Interval { low, high } = self.interval(at);
        let far = low.abs().max(high.abs());
        match self.random.below(8) {
            0 => low,
            1 => high,
            2 => 0.0,
            3 => self.random.sign(),
            4 => case[at].round(),
            5 => (2.0 * case[at]).round() / 2.0,
            // Small, by the logarithm, but not so small that f32 has no square of it.
            6 => self.random.sign() * far * (-self.random.unit() * 2.0 * DIGITS).exp2(),
            _ => self.near_other(case, at),
        }
    }

    /// A value equal to another component, or its negative, or a few units in the last place beside it.
    fn near_other(&mut self, case: &Case, at: usize) -> f64 {
        let other = self.random.below(case.len());
        let value = if other == at {
            case[at].round()
        } else {
            self.random.sign() * case[other]
        };
        self.step(value)
    }

    /// A value at most eight units in the last place away.
    fn step(&mut self, value: f64) -> f64 {
        let mut value = value as f32;
        let is_up = self.random.sign() > 0.0;
        for _ in 0..self.random.below(9) {
            value = if is_up { value.next_up() } else { value.next_down() };
        }
        f64::from(value)
    }

    fn near_component(&mut self, case: &Case, at: usize) -> f64 {
        let value = case[at];
        if self.scalar(at) != Scalar::Float {
            return match self.random.below(3) {
                0 => self.uniform_component(at),
                1 => self.special_component(case, at).round(),
                _ => value + self.random.sign(),
            };
        }
        let Interval { low, high } = self.interval(at);
        let shrink = (-self.random.unit() * DIGITS).exp2() * self.random.sign();
        match self.random.below(8) {
            0 | 1 => value + (high - low) * shrink,
            2 | 3 => value * (1.0 + shrink),
            4 => self.step(value),
            5 => self.near_other(case, at),
            6 => self.special_component(case, at),
            _ => self.uniform_component(at),
        }
    }

    fn set_direction(&mut self, case: &mut Case, unit: &Range<usize>) {
        loop {
            for at in unit.clone() {
                case[at] = self.random.between(-1.0, 1.0);
            }
            let squared: f64 = unit.clone().map(|at| case[at] * case[at]).sum();
            // Uniform in the ball, and not so short that its direction has few digits.
            if (1e-6..1.0).contains(&squared) {
                break;
            }
        }
        normalize(case, unit);
    }

    /// Rounds a case to numbers of the inputs' types within the domain.
    fn fit(&self, case: &mut Case) {
        for unit in &self.domain.units {
            normalize(case, unit);
        }
        for (at, value) in case.iter_mut().enumerate() {
            let Interval { low, high } = self.domain.intervals[at];
            *value = rounded(self.interface.inputs[at].scalar, value.clamp(low, high));
            // f32 takes denormals for zeros, which is no error of the function.
            if value.abs() < f64::from(f32::MIN_POSITIVE) {
                *value = 0.0;
            }
        }
    }
}

/// The nearest number of a type.
fn rounded(scalar: Scalar, value: f64) -> f64 {
    match scalar {
        Scalar::Float => f64::from(value as f32),
        _ => value.round(),
    }
}

/// Scales a vector to length 1, in f32; the zero vector becomes an axis.
fn normalize(case: &mut Case, unit: &Range<usize>) {
    let vector = &mut case[unit.clone()];
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        vector[0] = 1.0;
        return;
    }
    for x in vector {
        *x = f64::from((*x / length) as f32);
    }
}
