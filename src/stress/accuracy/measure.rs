//! The error of a function in f32 for single cases, and how much its result depends on its inputs.

use toyproof_glsl::tree::Scalar;
use toyproof_verify::debug::ulps;

use super::evaluator::Evaluator;
use super::interface::Interface;
use super::{Case, Outputs};
use crate::run::RunError;

/// A case with its outputs in f32 and the reference: the same in f64, or in 160 bits.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    pub(super) case: Case,
    pub(super) single: Outputs,
    pub(super) reference: Outputs,
}

/// The comparison of an output in f32 with the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Comparison {
    /// There is nothing to compare with: the reference is not finite, or beyond the range of f32.
    Undefined,
    /// f32 has NaN or infinity.
    NotFinite,
    /// The error: in units in the last place of f32 for floats, else the difference.
    Error(f64),
}

impl Measured {
    pub(super) fn compare(&self, interface: &Interface, output: usize) -> Comparison {
        let (single, reference) = (self.single[output], self.reference[output]);
        if !reference.is_finite() || reference.abs() > f64::from(f32::MAX) {
            Comparison::Undefined
        } else if !single.is_finite() {
            Comparison::NotFinite
        } else if interface.outputs[output].scalar == Scalar::Float {
            // f32 has no numbers between 0 and the smallest normal one.
            let is_flushed = (single - reference).abs() <= f64::from(f32::MIN_POSITIVE);
            Comparison::Error(if is_flushed { 0.0 } else { ulps(single, reference) })
        } else {
            Comparison::Error((single - reference).abs())
        }
    }

    /// The error of an output; `None` if the two cannot be compared.
    pub(super) fn error(&self, interface: &Interface, output: usize) -> Option<f64> {
        match self.compare(interface, output) {
            Comparison::Error(error) => Some(error),
            _ => None,
        }
    }
}

/// How an output depends on the inputs at a case.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    /// The condition number for each input: the relative change of the output over that of the input.
    pub(super) condition: Vec<f64>,
    /// The change of the output if each input changes by half a unit in the last place of f32, in such units
    /// of the output. Inputs that were rounded to f32 cause an error of this size in every formula.
    pub(super) ulps: f64,
}

/// The error of an output that rounding its inputs and the output itself explains, in ULPs, is at most the
/// sensitivity and this.
const OWN_ROUNDING_ULPS: f64 = 0.5;

impl Sensitivity {
    /// How many times larger an error is than that of a formula that only rounds its inputs and its output.
    pub(super) fn excess(&self, error: f64) -> f64 {
        error / (self.ulps + OWN_ROUNDING_ULPS)
    }
}

impl Evaluator<'_> {
    /// Evaluates cases in f32 and f64.
    pub(super) fn measure(&self, cases: Vec<Case>) -> Result<Vec<Measured>, RunError> {
        let single = self.evaluate::<f32>(&cases, ())?;
        let reference = self.evaluate::<f64>(&cases, ())?;
        let all = cases.into_iter().zip(single.into_iter().zip(reference));
        Ok(all
            .map(|(case, (single, reference))| Measured {
                case,
                single,
                reference,
            })
            .collect())
    }

    /// The sensitivity of an output at each case: in f64, from the neighbors of each float input in f32.
    pub(super) fn sensitivities(
        &self,
        interface: &Interface,
        measured: &[&Measured],
        output: usize,
    ) -> Result<Vec<Sensitivity>, RunError> {
        let floats = interface.inputs.iter().enumerate();
        let floats = floats.filter(|(_, input)| input.scalar == Scalar::Float);
        let floats: Vec<usize> = floats.map(|(at, _)| at).collect();
        let mut neighbors = Vec::with_capacity(measured.len() * floats.len() * 2);
        for Measured { case, .. } in measured {
            for &at in &floats {
                for step in [f32::next_up, f32::next_down] {
                    let mut neighbor = case.clone();
                    neighbor[at] = f64::from(step(case[at] as f32));
                    neighbors.push(neighbor);
                }
            }
        }
        let outputs = self.evaluate::<f64>(&neighbors, ())?;
        let mut pairs = neighbors.chunks(2).zip(outputs.chunks(2));
        let sensitivities = measured.iter().map(|Measured { case, reference, .. }| {
            let mut found = Sensitivity {
                condition: vec![0.0; interface.inputs.len()],
                ulps: 0.0,
            };
            for (&at, (neighbors, outputs)) in floats.iter().zip(pairs.by_ref()) {
                let value = reference[output];
                // Zero has no relative change, and its neighbors are denormals.
                if case[at] == 0.0 {
                    continue;
                }
                let mut change = 0.0f64;
                for (neighbor, outputs) in neighbors.iter().zip(outputs) {
                    let step = (neighbor[at] - case[at]).abs() / case[at].abs();
                    let size = (outputs[output] - value).abs();
                    let size = if size.is_nan() { f64::INFINITY } else { size };
                    found.condition[at] = found.condition[at].max(size / value.abs() / step);
                    change = change.max(size);
                }
                found.ulps += ulps(value + change, value) / 2.0;
            }
            found
        });
        Ok(sensitivities.collect())
    }

    /// The largest distance of f64 results with random rounding from that without, in ULPs of f32: the
    /// uncertainty of the reference.
    pub(super) fn reference_errors(
        &self,
        measured: &[&Measured],
        output: usize,
    ) -> Result<Vec<f64>, RunError> {
        let cases: Vec<Case> = measured.iter().map(|measured| measured.case.clone()).collect();
        let mut errors = vec![0.0f64; cases.len()];
        for seed in PERTURBATIONS {
            let perturbed = self.perturbed(&cases, seed)?;
            for ((error, perturbed), measured) in errors.iter_mut().zip(perturbed).zip(measured) {
                *error = error.max(ulps(perturbed[output], measured.reference[output]));
            }
        }
        Ok(errors)
    }
}

/// The seeds of random rounding: an error in f64 stays hidden in all three with a probability of 1 in 27.
const PERTURBATIONS: std::ops::RangeInclusive<u64> = 1..=3;
