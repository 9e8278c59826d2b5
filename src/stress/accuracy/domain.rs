//! The inputs from which cases are sampled: an interval for each component, and vectors of length 1.

use std::ops::Range;

use serde::Serialize;
use toyproof_glsl::tree::Scalar;

use super::interface::{Interface, Unsupported};
use crate::function::Role;

/// A range that the user sets: `p=-2..2`, `ray.d=unit`.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenRange {
    /// The input, or a part of it.
    pub path: String,
    /// The values of each of its components; `None` for vectors of length 1.
    pub interval: Option<Interval>,
}

/// A closed interval of f32 numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// The smallest value.
    pub low: f64,
    /// The largest value.
    pub high: f64,
}

/// Why an input has its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// The user set it.
    Given,
    /// The smallest and largest values that the shader passes in some frames.
    Observed,
    /// The default for its type.
    Default,
}

/// All inputs that are tested.
#[derive(Debug, Clone)]
pub(super) struct Domain {
    pub(super) intervals: Vec<Interval>,
    pub(super) sources: Vec<Source>,
    /// The vectors of length 1.
    pub(super) units: Vec<Range<usize>>,
}

/// What the shader passes to the function.
#[derive(Debug, Clone)]
pub(super) struct Observed {
    pub(super) intervals: Vec<Interval>,
    /// Whether each of [`Interface::vectors`] always has length 1.
    pub(super) are_unit: Vec<bool>,
}

/// How far lengths of unit vectors in f32 are from 1: a few roundings.
pub(super) const UNIT_TOLERANCE: f64 = 1e-5;

/// The ratio of the ends of an interval above which its values are sampled by their logarithm.
const LOG_RATIO: f64 = 1000.0;

impl Interval {
    pub(super) const UNIT: Self = Self { low: -1.0, high: 1.0 };

    /// Parses `LOW..HIGH`, or a single value.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let number = |text: &str| {
            let value = text.trim().parse::<f32>().ok()?;
            value.is_finite().then(|| f64::from(value))
        };
        let (low, high) = text.split_once("..").unwrap_or((text, text));
        let (low, high) = (number(low)?, number(high)?);
        (low <= high).then_some(Self { low, high })
    }

    /// The interval that a component has by its type alone.
    fn default_of(scalar: Scalar) -> Self {
        let (low, high) = match scalar {
            Scalar::Float | Scalar::Int => (-10.0, 10.0),
            Scalar::Uint => (0.0, 20.0),
            Scalar::Bool => (0.0, 1.0),
        };
        Self { low, high }
    }

    /// Whether values are sampled by their logarithm: both ends have one sign, and are far apart.
    pub(super) fn is_logarithmic(self) -> bool {
        let [near, far] = self.magnitudes();
        self.low * self.high > 0.0 && far / near > LOG_RATIO
    }

    /// The smaller and the larger magnitude of the ends.
    fn magnitudes(self) -> [f64; 2] {
        let (low, high) = (self.low.abs(), self.high.abs());
        [low.min(high), low.max(high)]
    }

    /// The value at a share of the interval, from 0 to 1.
    pub(super) fn at(self, share: f64) -> f64 {
        let value = if self.is_logarithmic() {
            self.low * (self.high / self.low).powf(share)
        } else {
            self.low + (self.high - self.low) * share
        };
        value.clamp(self.low, self.high)
    }

    /// The share of the interval at which a value is: the inverse of [`at`](Self::at).
    pub(super) fn share(self, value: f64) -> f64 {
        let share = if self.is_logarithmic() {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        if share.is_finite() { share } else { 0.0 }
    }

    pub(super) fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    fn include(&mut self, other: Self) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }
}

impl Domain {
    /// The domain of a function: what is given, else what is observed, else the defaults.
    ///
    /// # Errors
    /// States which given range does not fit the function.
    pub(super) fn new(
        interface: &Interface,
        given: &[GivenRange],
        observed: Option<&Observed>,
    ) -> Result<Self, Unsupported> {
        let inputs = &interface.inputs;
        let mut domain = match observed {
            Some(observed) => Self {
                intervals: observed.intervals.clone(),
                sources: vec![Source::Observed; inputs.len()],
                units: Vec::new(),
            },
            None => Self {
                intervals: inputs
                    .iter()
                    .map(|input| Interval::default_of(input.scalar))
                    .collect(),
                sources: vec![Source::Default; inputs.len()],
                units: Vec::new(),
            },
        };
        for (index, vector) in interface.vectors.iter().enumerate() {
            let is_unit = match observed {
                // One that never changes stays as it is.
                Some(observed) => {
                    let mut intervals = observed.intervals[vector.clone()].iter();
                    observed.are_unit[index] && intervals.any(|interval| interval.low < interval.high)
                }
                None => is_named_as_unit(interface, vector),
            };
            if is_unit {
                domain.set_unit(vector.clone());
            }
        }
        for range in given {
            let components = interface.inputs_at(&range.path)?;
            domain
                .units
                .retain(|unit| !components.iter().any(|at| unit.contains(at)));
            for &at in &components {
                domain.sources[at] = Source::Given;
            }
            if let Some(interval) = range.interval {
                for &at in &components {
                    domain.intervals[at] = interval.within_type(inputs[at].scalar, &range.path)?;
                }
            } else {
                let vectors = interface.vectors.iter();
                let inside: Vec<_> = vectors
                    .filter(|vector| (*vector).clone().all(|at| components.contains(&at)))
                    .collect();
                if inside.is_empty() {
                    return Err(Unsupported(format!(
                        "`{}` is not a vector of floats, so it cannot be `unit`",
                        range.path
                    )));
                }
                for vector in inside {
                    domain.set_unit(vector.clone());
                }
            }
        }
        Ok(domain)
    }

    fn set_unit(&mut self, vector: Range<usize>) {
        for at in vector.clone() {
            self.intervals[at] = Interval::UNIT;
        }
        self.units.push(vector);
    }

    /// Whether a component belongs to a vector of length 1.
    pub(super) fn is_unit(&self, at: usize) -> bool {
        self.units.iter().any(|unit| unit.contains(&at))
    }
}

impl Interval {
    /// The part of the interval that values of a type have.
    fn within_type(self, scalar: Scalar, path: &str) -> Result<Self, Unsupported> {
        let (low, high) = match scalar {
            Scalar::Float => return Ok(self),
            Scalar::Int => (f64::from(i32::MIN), f64::from(i32::MAX)),
            Scalar::Uint => (0.0, f64::from(u32::MAX)),
            Scalar::Bool => (0.0, 1.0),
        };
        let whole = Self {
            low: self.low.ceil().max(low),
            high: self.high.floor().min(high),
        };
        if whole.low > whole.high {
            let ty = scalar.name();
            return Err(Unsupported(format!("no {ty} is in the range of `{path}`")));
        }
        Ok(whole)
    }
}

/// Whether a vector has a name that directions and normals usually have.
fn is_named_as_unit(interface: &Interface, vector: &Range<usize>) -> bool {
    let path = &interface.inputs[vector.start].path;
    let path = path.strip_suffix(".x").unwrap_or(path);
    let name = path
        .rsplit('.')
        .next()
        .unwrap_or(path)
        .to_lowercase()
        .replace('_', "");
    vector.len() == 3
        && (Role::Direction.has_name(&name)
            || ["n", "nor", "norm", "normal", "axis"].contains(&name.as_str()))
}

impl Observed {
    /// Nothing yet.
    pub(super) fn empty(interface: &Interface) -> Self {
        let nothing = Interval {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        Self {
            intervals: vec![nothing; interface.inputs.len()],
            are_unit: vec![true; interface.vectors.len()],
        }
    }

    pub(super) fn include(&mut self, at: usize, interval: Interval) {
        self.intervals[at].include(interval);
    }

    /// Whether each component was observed.
    pub(super) fn is_complete(&self) -> bool {
        self.intervals
            .iter()
            .all(|interval| interval.low <= interval.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_parsed() {
        let interval = |low, high| Some(Interval { low, high });
        assert_eq!(Interval::parse("-2..2"), interval(-2.0, 2.0));
        assert_eq!(Interval::parse("1e-3 .. 1e3"), interval(f64::from(1e-3f32), 1e3));
        assert_eq!(Interval::parse("0.5"), interval(0.5, 0.5));
        for wrong in ["", "..", "1..", "2..1", "a..b", "0..inf", "nan", "0..1e99"] {
            assert_eq!(Interval::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn wide_positive_intervals_are_logarithmic() {
        let wide = Interval { low: 1e-3, high: 1e3 };
        assert!((wide.at(0.5) - 1.0).abs() < 1e-12);
        assert!((wide.share(1.0) - 0.5).abs() < 1e-12);
        let narrow = Interval { low: -3.0, high: 1.0 };
        assert_eq!((narrow.at(0.75), narrow.share(0.0)), (0.0, 0.75));
        assert_eq!(Interval { low: 2.0, high: 2.0 }.share(2.0), 0.0);
    }
}
