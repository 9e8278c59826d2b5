//! Properties that a function is stated to have, and cases that violate them.

use serde::Serialize;
use thiserror::Error;
use toyproof_glsl::tree::Scalar;

use super::domain::{Domain, Interval};
use super::evaluator::Evaluator;
use super::interface::{Interface, Unsupported, literal};
use super::sample::Sampler;
use super::{AccuracyError, Case, Outputs};
use crate::run::RunError;

/// A property of a function's result.
#[derive(Debug, Clone, PartialEq)]
pub enum Property {
    /// Its length is 1.
    Unit,
    /// It does not change with the sign of an input.
    Symmetric(String),
    /// It does not change if two inputs are exchanged.
    Swap(String, String),
    /// It only rises, or only falls, with an input.
    Monotone(String),
    /// It is in a range.
    Range(Interval),
}

/// A text is not a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("expected `unit`, `symmetric NAME`, `swap A,B`, `monotone NAME` or `range LOW..HIGH`")]
pub struct NotAProperty;

/// What is found about a property.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PropertyResult {
    /// The property, as it is stated.
    pub property: String,
    /// The number of tested cases, or pairs of cases.
    pub cases: u64,
    /// How many violate it in f32.
    pub violations: u64,
    /// How many violate it in f64.
    pub violations_in_double: u64,
    /// The case that violates it most in f32.
    pub worst: Option<Violation>,
}

/// A violation of a property.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Violation {
    /// The call, and the other one for a property of two.
    pub calls: Vec<String>,
    /// The result of each call in f32.
    pub results: Vec<Vec<f64>>,
    /// How far it is from the property.
    pub deviation: f64,
}

/// The deviation that rounding a result of a few operations explains, relative to the result: 8 ULP of f32. A
/// range is tested without.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

impl Property {
    /// Parses `unit`, `symmetric NAME`, `swap A,B`, `monotone NAME` or `range LOW..HIGH`.
    ///
    /// # Errors
    /// [`NotAProperty`].
    pub fn parse(text: &str) -> Result<Self, NotAProperty> {
        let (word, rest) = text
            .trim()
            .split_once(char::is_whitespace)
            .unwrap_or((text.trim(), ""));
        let name = || match rest.trim() {
            "" => Err(NotAProperty),
            name => Ok(name.to_owned()),
        };
        match word {
            "unit" if rest.is_empty() => Ok(Self::Unit),
            "symmetric" => Ok(Self::Symmetric(name()?)),
            "monotone" => Ok(Self::Monotone(name()?)),
            "swap" => {
                let (a, b) = rest.split_once(',').ok_or(NotAProperty)?;
                Ok(Self::Swap(a.trim().to_owned(), b.trim().to_owned()))
            }
            "range" => Interval::parse(rest).map(Self::Range).ok_or(NotAProperty),
            _ => Err(NotAProperty),
        }
    }

    /// The property as it is stated.
    #[must_use]
    pub fn text(&self) -> String {
        let number = |value| literal(Scalar::Float, value);
        match self {
            Self::Unit => "unit".to_owned(),
            Self::Symmetric(name) => format!("symmetric {name}"),
            Self::Swap(a, b) => format!("swap {a},{b}"),
            Self::Monotone(name) => format!("monotone {name}"),
            Self::Range(Interval { low, high }) => format!("range {}..{}", number(*low), number(*high)),
        }
    }

    /// The other case with which a case is compared; `None` for a property of single cases.
    fn partner(&self, interface: &Interface) -> Result<Option<Partner>, Unsupported> {
        Ok(match self {
            Self::Unit | Self::Range(_) => None,
            Self::Symmetric(name) => Some(Partner::Negative(interface.inputs_at(name)?)),
            Self::Swap(a, b) => {
                let (a, b) = (interface.inputs_at(a)?, interface.inputs_at(b)?);
                let scalars = |all: &[usize]| -> Vec<Scalar> {
                    all.iter().map(|&at| interface.inputs[at].scalar).collect()
                };
                if scalars(&a) != scalars(&b) {
                    let message = "inputs of different types cannot be exchanged";
                    return Err(Unsupported(message.to_owned()));
                }
                Some(Partner::Exchanged(a.into_iter().zip(b).collect()))
            }
            Self::Monotone(name) => {
                let [at] = interface.inputs_at(name)?[..] else {
                    let message = format!("`monotone {name}` needs a single number, such as `{name}.x`");
                    return Err(Unsupported(message));
                };
                Some(Partner::Larger(at))
            }
        })
    }

    /// Tests the property with random and special cases.
    ///
    /// # Errors
    /// [`AccuracyError`].
    pub(super) fn test(
        &self,
        evaluator: &Evaluator,
        interface: &Interface,
        domain: &Domain,
        (seed, case_count): (u64, usize),
    ) -> Result<PropertyResult, AccuracyError> {
        let partner = self.partner(interface)?;
        let mut sampler = Sampler::new(interface, domain, seed, "properties");
        let mut cases: Vec<Case> = (0..case_count)
            .map(|at| {
                if at % 4 == 0 {
                    sampler.special()
                } else {
                    sampler.uniform()
                }
            })
            .collect();
        let others: Option<Vec<Case>> = partner.as_ref().map(|partner| {
            cases
                .iter_mut()
                .map(|case| partner.of(case, domain, &mut sampler))
                .collect()
        });
        let mut single = Results::new::<f32>(evaluator, &cases, others.as_deref())?;
        let mut double = Results::new::<f64>(evaluator, &cases, others.as_deref())?;
        let results = result_count(interface);
        // The direction in which it changes more often is the right one.
        if matches!(partner, Some(Partner::Larger(_))) {
            for output in 0..results {
                let rising = double.direction(output);
                single.orient(output, rising);
                double.orient(output, rising);
            }
        }
        let deviations = |found: &Results| -> Vec<f64> {
            (0..cases.len())
                .map(|at| self.deviation(found, at, results))
                .collect()
        };
        let (singles, doubles) = (deviations(&single), deviations(&double));
        let count = |all: &[f64]| all.iter().filter(|deviation| **deviation > 0.0).count() as u64;
        let worst = (0..cases.len()).max_by(|&a, &b| singles[a].total_cmp(&singles[b]));
        let worst = worst.filter(|&at| singles[at] > 0.0).map(|at| Violation {
            calls: [Some(&cases), others.as_ref()]
                .into_iter()
                .flatten()
                .map(|cases| interface.call(&cases[at]))
                .collect(),
            results: single.at(at, results),
            deviation: singles[at],
        });
        Ok(PropertyResult {
            property: self.text(),
            cases: cases.len() as u64,
            violations: count(&singles),
            violations_in_double: count(&doubles),
            worst,
        })
    }

    /// How far results are from the property, beyond what rounding explains; 0 if they have it.
    fn deviation(&self, found: &Results, at: usize, results: usize) -> f64 {
        let one = &found.first[at][..results];
        let deviation = match (self, &found.second) {
            (Self::Unit, _) => {
                let length = one.iter().map(|x| x * x).sum::<f64>().sqrt();
                beyond((length - 1.0).abs(), ROUNDING)
            }
            (Self::Range(interval), _) => {
                let outside = |x: &f64| (interval.low - x).max(x - interval.high).max(0.0);
                one.iter()
                    .map(|x| if x.is_nan() { f64::NAN } else { outside(x) })
                    .fold(0.0, largest)
            }
            (property, Some(second)) => {
                let other = &second[at][..results];
                let scale = one
                    .iter()
                    .chain(other)
                    .fold(0.0, |scale: f64, x| scale.max(x.abs()));
                let differences = one.iter().zip(other).enumerate().map(|(output, (one, other))| {
                    // Equal infinities have no difference.
                    match property {
                        _ if one == other => 0.0,
                        Self::Monotone(_) if found.rises[output] => one - other,
                        Self::Monotone(_) => other - one,
                        _ => (one - other).abs(),
                    }
                });
                beyond(differences.fold(0.0, largest), ROUNDING * scale)
            }
            (_, None) => 0.0,
        };
        // NaN has no property.
        if deviation.is_nan() {
            f64::INFINITY
        } else {
            deviation
        }
    }
}

/// The larger of two numbers; NaN if one is NaN.
fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// A deviation, or 0 within a margin.
fn beyond(deviation: f64, margin: f64) -> f64 {
    if deviation <= margin { 0.0 } else { deviation }
}

/// The components of what the properties are about: the result, or all outputs of a void function.
fn result_count(interface: &Interface) -> usize {
    let is_result = |component: &&super::interface::Component| component.code.starts_with("tpResult");
    match interface.outputs.iter().filter(is_result).count() {
        0 => interface.outputs.len(),
        count => count,
    }
}

/// How the other case is made.
enum Partner {
    Negative(Vec<usize>),
    Exchanged(Vec<(usize, usize)>),
    /// The other has a larger value.
    Larger(usize),
}

impl Partner {
    /// The other case. Of two that differ in an input, the first becomes the smaller one.
    fn of(&self, case: &mut Case, domain: &Domain, sampler: &mut Sampler) -> Case {
        let mut other = case.clone();
        match self {
            Self::Negative(components) => components.iter().for_each(|&at| other[at] = -other[at]),
            Self::Exchanged(pairs) => {
                for &(a, b) in pairs {
                    (other[a], other[b]) = (case[b], case[a]);
                }
            }
            Self::Larger(at) => {
                other[*at] = sampler.component_near(case, *at);
                if other[*at] < case[*at] {
                    std::mem::swap(case, &mut other);
                }
                debug_assert!(domain.intervals[*at].contains(other[*at]));
            }
        }
        other
    }
}

/// The outputs of all cases, and of their partners.
struct Results {
    first: Vec<Outputs>,
    second: Option<Vec<Outputs>>,
    /// Whether each output rises with the input of a monotone function.
    rises: Vec<bool>,
}

impl Results {
    fn new<N: toyproof_eval::Number>(
        evaluator: &Evaluator,
        cases: &[Case],
        others: Option<&[Case]>,
    ) -> Result<Self, RunError> {
        let evaluate = |cases: &[Case]| -> Result<Vec<Outputs>, RunError> {
            evaluator.evaluate::<N>(cases, N::Noise::default())
        };
        let first = evaluate(cases)?;
        Ok(Self {
            rises: vec![true; first.first().map_or(0, |outputs| outputs.len())],
            second: others.map(evaluate).transpose()?,
            first,
        })
    }

    /// Whether an output is larger for more of the partners than smaller.
    fn direction(&self, output: usize) -> bool {
        let pairs = self.first.iter().zip(self.second.iter().flatten());
        let signs = pairs.map(|(one, other)| match one[output].partial_cmp(&other[output]) {
            Some(std::cmp::Ordering::Less) => 1i64,
            Some(std::cmp::Ordering::Greater) => -1,
            _ => 0,
        });
        signs.sum::<i64>() >= 0
    }

    fn orient(&mut self, output: usize, rises: bool) {
        self.rises[output] = rises;
    }

    fn at(&self, at: usize, results: usize) -> Vec<Vec<f64>> {
        let both = [Some(&self.first), self.second.as_ref()].into_iter().flatten();
        both.map(|all| all[at][..results].to_vec()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn properties_are_parsed_and_written_alike() {
        for text in [
            "unit",
            "symmetric p.x",
            "swap a,b",
            "monotone t",
            "range 0.0..1.0",
        ] {
            assert_eq!(Property::parse(text).unwrap().text(), text);
        }
        for wrong in ["", "odd x", "unit x", "symmetric", "swap a", "range 1..0"] {
            assert_eq!(Property::parse(wrong), Err(NotAProperty), "{wrong}");
        }
    }
}
