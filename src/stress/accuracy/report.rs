//! What is found out about a function, and its summary as text.

use serde::Serialize;
use toyproof_diagnostic::{columns, grouped, magnitude, plural};
use toyproof_eval::Wide;
use toyproof_glsl::tree::Scalar;

use super::Case;
use super::cause::Cause;
use super::domain::{Domain, Source};
use super::evaluator::Evaluator;
use super::extremes::Extreme;
use super::interface::{Interface, literal};
use super::measure::{Comparison, Measured};
use super::pairs::PairMap;
use super::property::PropertyResult;
use super::search::{Candidate, Worst};
use crate::run::RunError;

/// The results for a function.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The name of the function.
    pub function: String,
    /// Its declaration.
    pub prototype: String,
    /// The seed of the cases.
    pub seed: u64,
    /// The number of random cases.
    pub cases: u64,
    /// The number of all cases, with those of the search.
    pub evaluated: u64,
    /// Whether the time limit ended the search.
    pub is_cut: bool,
    /// The inputs.
    pub inputs: Vec<InputRange>,
    /// The outputs.
    pub outputs: Vec<OutputErrors>,
    /// The results outside of the ranges.
    pub extremes: Vec<Extreme>,
    /// The properties.
    pub properties: Vec<PropertyResult>,
    /// The errors over pairs of inputs.
    pub maps: Vec<PairMap>,
}

/// The tested values of an input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputRange {
    /// The component.
    pub path: String,
    /// The smallest value.
    pub low: f64,
    /// The largest value.
    pub high: f64,
    /// Whether it belongs to a vector of length 1.
    pub is_unit: bool,
    /// Why it is this range.
    pub source: Source,
}

/// The errors of an output, in units in the last place of f32; of integers, the differences.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutputErrors {
    /// The component.
    pub path: String,
    /// Whether it is a float.
    pub is_float: bool,
    /// The random cases with a finite reference.
    pub compared: u64,
    /// The error that half of the random cases do not exceed.
    pub median: f64,
    /// The error that 99 % do not exceed.
    pub p99: f64,
    /// The largest error of the random cases, before the search.
    pub largest_random: f64,
    /// The largest absolute error of all cases.
    pub largest_absolute: f64,
    /// The random cases in which f32 alone has NaN or infinity.
    pub not_finite: u64,
    /// A call for which f32 alone has NaN or infinity, and the operation that has it first.
    pub not_finite_example: Option<(String, Option<Cause>)>,
    /// The case with the largest error.
    pub worst: Option<WorstCase>,
    /// The case whose error exceeds most what rounding the inputs explains; `None` if no error exceeds a few
    /// units.
    pub worst_of_formula: Option<WorstCase>,
}

/// A case with a large error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstCase {
    /// The call.
    pub call: String,
    /// The value of each input component.
    pub inputs: Vec<f64>,
    /// The result in f32.
    pub single: f64,
    /// The reference.
    pub reference: f64,
    /// The error, in units in the last place of f32.
    pub ulps: f64,
    /// The precision of the reference: 160 bits, or 53 if these take too long.
    pub reference_bits: u32,
    /// The error of double precision, in the same units; if the reference has it, too, as estimated by random
    /// rounding.
    pub double_ulps: f64,
    /// The condition number for each input component.
    pub condition: Vec<f64>,
    /// The error that rounding the inputs to f32 causes in every formula, in the same units.
    pub inherent_ulps: f64,
    /// The error divided by the sum of that and half a unit.
    pub excess: f64,
    /// The operation that loses the digits.
    pub cause: Option<Cause>,
}

/// An error this many times larger than that of rounded inputs is the formula's: as some thirty roundings of
/// operations cause it, if they add up.
const FORMULA_EXCESS: f64 = 32.0;

pub(super) fn input_ranges(interface: &Interface, domain: &Domain) -> Vec<InputRange> {
    let inputs = interface.inputs.iter().enumerate();
    let ranges = inputs.map(|(at, input)| InputRange {
        path: input.path.clone(),
        low: domain.intervals[at].low,
        high: domain.intervals[at].high,
        is_unit: domain.is_unit(at),
        source: domain.sources[at],
    });
    ranges.collect()
}

/// Finds the operation that loses digits for a case.
type FindCause<'a> = &'a dyn Fn(&Case) -> Result<Option<Cause>, RunError>;

impl OutputErrors {
    pub(super) fn new(
        evaluator: &Evaluator,
        interface: &Interface,
        output: usize,
        (random, worst): (&[Measured], &Worst),
        cause: FindCause,
    ) -> Result<Self, RunError> {
        let mut errors: Vec<f64> = random
            .iter()
            .filter_map(|one| one.error(interface, output))
            .collect();
        errors.sort_by(f64::total_cmp);
        let share = |share: f64| {
            let at = (errors.len() as f64 * share) as usize;
            errors
                .get(at.min(errors.len().saturating_sub(1)))
                .copied()
                .unwrap_or(0.0)
        };
        let not_finite = random
            .iter()
            .filter(|one| one.compare(interface, output) == Comparison::NotFinite)
            .count();
        let worst_case = |candidate: &Option<Candidate>| {
            let candidate = candidate.as_ref();
            candidate
                .map(|candidate| WorstCase::new(evaluator, interface, output, candidate, cause))
                .transpose()
        };
        let example = worst.not_finite.as_ref();
        let example = example
            .map(|one| Ok::<_, RunError>((interface.call(&one.case), cause(&one.case)?)))
            .transpose()?;
        Ok(Self {
            path: interface.outputs[output].path.clone(),
            is_float: interface.outputs[output].scalar == Scalar::Float,
            compared: (errors.len() + not_finite) as u64,
            median: share(0.5),
            p99: share(0.99),
            largest_random: errors.last().copied().unwrap_or(0.0),
            largest_absolute: worst.absolute,
            not_finite: not_finite as u64,
            not_finite_example: example,
            worst: worst_case(&worst.error)?,
            worst_of_formula: worst_case(&worst.excess)?,
        })
    }
}

impl WorstCase {
    fn new(
        evaluator: &Evaluator,
        interface: &Interface,
        output: usize,
        candidate: &Candidate,
        cause: FindCause,
    ) -> Result<Self, RunError> {
        let measured = &candidate.measured;
        let double_ulps = match candidate.double_error {
            Some(error) => error,
            None => evaluator.reference_errors(&[measured], output)?[0],
        };
        let sensitivity = candidate.sensitivity.as_ref();
        Ok(Self {
            call: interface.call(&measured.case),
            inputs: measured.case.to_vec(),
            single: measured.single[output],
            reference: measured.reference[output],
            reference_bits: if candidate.double_error.is_some() {
                Wide::BITS
            } else {
                f64::MANTISSA_DIGITS
            },
            ulps: candidate.error,
            double_ulps,
            condition: sensitivity.map_or_else(Vec::new, |sensitivity| sensitivity.condition.clone()),
            inherent_ulps: sensitivity.map_or(f64::INFINITY, |sensitivity| sensitivity.ulps),
            excess: sensitivity.map_or(0.0, |sensitivity| sensitivity.excess(candidate.error)),
            cause: cause(&measured.case)?,
        })
    }

    /// The input on which the result depends most, and its condition number.
    fn largest_condition<'a>(&self, inputs: &'a [InputRange]) -> Option<(&'a str, f64)> {
        let numbers = inputs.iter().zip(&self.condition);
        let largest = numbers.max_by(|a, b| a.1.total_cmp(b.1));
        largest.map(|(input, number)| (input.path.as_str(), *number))
    }
}

// The summary.

/// Describes an operation with its line.
type Place<'a> = &'a dyn Fn(&Cause) -> String;

impl Report {
    /// The summary: the ranges, the errors of each output, and what is wrong. `place` describes an operation
    /// with its line.
    #[must_use]
    pub fn summary(&self, place: Place) -> Vec<String> {
        let mut lines = vec![format!(
            "{}: {} random inputs, {} evaluated",
            self.prototype,
            grouped(self.cases),
            grouped(self.evaluated)
        )];
        lines.extend(self.ranges());
        lines.push(String::new());
        lines.extend(self.table());
        lines.push(String::new());
        for output in &self.outputs {
            lines.extend(self.explanation(output, place));
        }
        lines.extend(self.failing_extremes());
        for property in &self.properties {
            lines.extend(property.summary());
        }
        if self.is_cut {
            lines.push("The time limit ended the search early.".to_owned());
        }
        while lines.last().is_some_and(String::is_empty) {
            lines.pop();
        }
        lines
    }

    /// Figures beside the summary: the condition numbers of the worst cases, and how certain the reference
    /// is.
    #[must_use]
    pub fn details(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for output in &self.outputs {
            for worst in [&output.worst, &output.worst_of_formula].into_iter().flatten() {
                let numbers = self.inputs.iter().zip(&worst.condition);
                let numbers: Vec<_> = numbers
                    .map(|(input, number)| format!("{} {}", input.path, short(*number)))
                    .collect();
                let double = if worst.reference_bits == f64::MANTISSA_DIGITS {
                    "uncertain in double precision by"
                } else {
                    "the error of double precision is"
                };
                lines.push(format!(
                    "{} for {}: condition numbers {}; {double} {} ULP of float32",
                    output.path,
                    worst.call,
                    numbers.join(", "),
                    magnitude(worst.double_ulps)
                ));
            }
        }
        lines
    }

    /// Whether a stated property is violated.
    #[must_use]
    pub fn violates(&self) -> bool {
        self.properties.iter().any(|property| property.violations > 0)
    }

    /// The inputs with their ranges; components with equal ranges are one.
    fn ranges(&self) -> Vec<String> {
        let mut rows: Vec<Vec<String>> = Vec::new();
        for inputs in self.inputs.chunk_by(is_alike) {
            let (first, last) = (&inputs[0], &inputs[inputs.len() - 1]);
            let path = if inputs.len() == 1 {
                first.path.clone()
            } else if is_whole_vector(inputs) {
                first.path[..first.path.len() - 2].to_owned()
            } else {
                format!("{} to {}", first.path, last.path)
            };
            let range = if first.is_unit {
                "length 1".to_owned()
            } else if first.low == first.high {
                number(first.low)
            } else {
                format!("{} to {}", number(first.low), number(first.high))
            };
            let source = match first.source {
                Source::Given => "",
                Source::Observed => "observed",
                Source::Default => "default: the shader does not call it; set ranges with --range",
            };
            rows.push(vec![path, range, source.to_owned()]);
        }
        columns("  ", &rows, &[])
    }

    /// The table of errors.
    fn table(&self) -> Vec<String> {
        let header = [
            "output",
            "median",
            "99 %",
            "worst",
            "absolute",
            "condition",
            "NaN or infinite",
        ];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for output in &self.outputs {
            let unit = |error: f64| {
                if output.is_float {
                    format!("{} ULP", short(error))
                } else {
                    format!("{error}")
                }
            };
            let worst = output.worst.as_ref();
            let condition = worst.and_then(|worst| worst.largest_condition(&self.inputs));
            rows.push(vec![
                output.path.clone(),
                unit(output.median),
                unit(output.p99),
                unit(worst.map_or(0.0, |worst| worst.ulps)),
                magnitude(output.largest_absolute),
                condition.map_or_else(|| "–".to_owned(), |(_, number)| short(number)),
                match output.not_finite_example {
                    None => "never".to_owned(),
                    Some(_) if output.not_finite == 0 => "found by search".to_owned(),
                    Some(_) => format!("{} of {}", grouped(output.not_finite), grouped(output.compared)),
                },
            ]);
        }
        columns("  ", &rows, &[1, 2, 3, 4, 5, 6])
    }

    /// The worst inputs of an output.
    fn explanation(&self, output: &OutputErrors, place: Place) -> Vec<String> {
        let mut lines = Vec::new();
        let path = &output.path;
        if let Some((call, cause)) = &output.not_finite_example {
            lines.push(format!("{path} is NaN or infinite in float32 alone for"));
            lines.push(format!("    {call}"));
            lines.extend(cause.as_ref().map(|cause| format!("  first at {}", place(cause))));
        }
        let of_formula = output
            .worst_of_formula
            .as_ref()
            .filter(|worst| worst.excess > FORMULA_EXCESS);
        if let Some(worst) = of_formula {
            lines.push(format!(
                "{path}: the formula loses digits; the error is {} ULP, and rounded inputs explain {} ULP, \
                 for",
                short(worst.ulps),
                short(worst.inherent_ulps)
            ));
            lines.extend(worst.detail(output, place));
        }
        let Some(worst) = output.worst.as_ref() else {
            lines.push(format!("{path} has no error."));
            return lines;
        };
        if of_formula.is_some_and(|of_formula| of_formula.inputs == worst.inputs) {
            return lines;
        }
        if !output.is_float {
            lines.push(format!(
                "{path} differs from the exact result by up to {}, for",
                worst.ulps
            ));
        } else if worst.excess > FORMULA_EXCESS {
            lines.push(format!(
                "{path}: the largest error, {} ULP, is also the formula's, for",
                short(worst.ulps)
            ));
        } else if let Some((input, condition)) = worst.largest_condition(&self.inputs)
            && worst.ulps > FORMULA_EXCESS
        {
            lines.push(format!(
                "{path}: the largest error, {} ULP, is that of ill-conditioned inputs, and any formula has \
                 it (condition number {} for {input}), for",
                short(worst.ulps),
                short(condition)
            ));
        } else {
            lines.push(format!(
                "{path} is accurate: the largest error is {} ULP, for",
                short(worst.ulps)
            ));
        }
        lines.extend(worst.detail(output, place));
        lines
    }

    /// From which size of a parameter on f32 alone has NaN or infinity.
    fn failing_extremes(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut failing: Vec<&Extreme> = self.extremes.iter().filter(|one| one.not_finite > 0).collect();
        // The mildest factor of each direction comes first.
        let mildness = |one: &Extreme| {
            if one.factor == 0.0 {
                f64::MAX
            } else {
                one.factor.log10().abs()
            }
        };
        failing.sort_by(|a, b| mildness(a).total_cmp(&mildness(b)));
        let mut known: Vec<(&str, bool)> = Vec::new();
        for one in failing {
            let direction = (one.path.as_str(), one.factor > 1.0);
            if known.contains(&direction) {
                continue;
            }
            known.push(direction);
            let side = if one.factor > 1.0 { "or more" } else { "or less" };
            lines.push(format!(
                "With {} multiplied by {} {side}, {} of {} results are NaN or infinite in float32 alone, \
                 such as",
                one.path,
                factor(one.factor),
                one.not_finite,
                one.compared
            ));
            lines.extend(one.call.as_ref().map(|call| format!("    {call}")));
        }
        lines
    }
}

impl WorstCase {
    fn detail(&self, output: &OutputErrors, place: Place) -> Vec<String> {
        let scalar = if output.is_float {
            Scalar::Float
        } else {
            Scalar::Int
        };
        let mut lines = vec![
            format!("    {}", self.call),
            format!(
                "  expected {:.9e}, got {}",
                self.reference,
                literal(scalar, self.single)
            ),
        ];
        if !output.is_float {
            lines[1] = format!("  expected {}, got {}", self.reference, self.single);
        }
        lines.extend(
            self.cause
                .as_ref()
                .map(|cause| format!("  digits are lost at {}", place(cause))),
        );
        lines
    }
}

impl PropertyResult {
    fn summary(&self) -> Vec<String> {
        let property = &self.property;
        let Some(worst) = &self.worst else {
            return vec![format!(
                "property `{property}` holds for {} inputs",
                grouped(self.cases)
            )];
        };
        let also = match self.violations_in_double {
            0 => "in float32 alone",
            _ => "also in double precision",
        };
        let mut lines = vec![format!(
            "property `{property}` is violated by {} of {} {}, {also}; most, by {}, for",
            grouped(self.violations),
            grouped(self.cases),
            plural(self.cases, "input", "inputs"),
            magnitude(worst.deviation)
        )];
        for (call, results) in worst.calls.iter().zip(&worst.results) {
            let results: Vec<_> = results
                .iter()
                .map(|&value| literal(Scalar::Float, value))
                .collect();
            lines.push(format!("    {call} = {}", results.join(", ")));
        }
        lines
    }
}

fn is_alike(a: &InputRange, b: &InputRange) -> bool {
    let parent = |one: &InputRange| one.path.rsplit_once('.').map(|(parent, _)| parent.to_owned());
    parent(a).is_some()
        && parent(a) == parent(b)
        && (a.is_unit == b.is_unit)
        && (a.is_unit || (a.low, a.high) == (b.low, b.high))
        && a.source == b.source
}

/// Whether these are all components of a vector, which begins with `x`.
fn is_whole_vector(inputs: &[InputRange]) -> bool {
    inputs
        .iter()
        .zip(["x", "y", "z", "w"])
        .all(|(input, name)| input.path.ends_with(&format!(".{name}")))
}

/// A number of a range: three digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

/// An error or condition number: two digits.
fn short(value: f64) -> String {
    match value {
        _ if value.is_infinite() => "∞".to_owned(),
        _ if value >= 1e4 => format!("{value:.1e}"),
        _ if value >= 10.0 => format!("{value:.0}"),
        _ => format!("{value:.1}"),
    }
}

fn factor(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:e}")
    }
}
