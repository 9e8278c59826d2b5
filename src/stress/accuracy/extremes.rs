//! Inputs far outside of the usual ranges: each parameter in turn is zero, tiny or huge.

use serde::Serialize;
use toyproof_glsl::tree::Scalar;

use super::Case;
use super::domain::Domain;
use super::evaluator::Evaluator;
use super::interface::Interface;
use super::measure::{Comparison, Measured};
use super::sample::Sampler;
use crate::run::RunError;

/// The results for a parameter at an extreme.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Extreme {
    /// The parameter.
    pub path: String,
    /// The factor by which its usual values are multiplied.
    pub factor: f64,
    /// The number of cases with a finite reference.
    pub compared: u64,
    /// How many of them have NaN or infinity in f32.
    pub not_finite: u64,
    /// The first of these, as a call.
    pub call: Option<String>,
}

/// The factors, from near 1 on in both directions: up to where squares and their squares overflow, and down
/// to denormals and zero.
const FACTORS: [f64; 16] = [
    1e3, 1e6, 1e10, 1e15, 1e19, 1e25, 1e30, 1e35, 1e-3, 1e-6, 1e-10, 1e-15, 1e-20, 1e-30, 1e-40, 0.0,
];

/// The cases for each parameter and factor.
const CASES: usize = 64;

/// Multiplies each parameter by factors, and counts results that f32 alone does not have.
pub(super) fn extremes(
    evaluator: &Evaluator,
    interface: &Interface,
    domain: &Domain,
    seed: u64,
) -> Result<Vec<Extreme>, RunError> {
    let mut sampler = Sampler::new(interface, domain, seed, "extremes");
    let is_float = |at: &usize| interface.inputs[*at].scalar == Scalar::Float;
    let mut places = Vec::new();
    let mut cases = Vec::new();
    for (path, range) in interface.input_ranges() {
        let floats: Vec<usize> = range.filter(is_float).collect();
        if floats.is_empty() {
            continue;
        }
        for factor in FACTORS {
            places.push((path, factor));
            cases.extend((0..CASES).map(|_| {
                let mut case: Case = sampler.uniform();
                for &at in &floats {
                    let scaled = (case[at] * factor) as f32;
                    case[at] = f64::from(scaled.clamp(-f32::MAX, f32::MAX));
                }
                case
            }));
        }
    }
    let measured = evaluator.measure(cases)?;
    let outputs = 0..interface.outputs.len();
    let found = places
        .into_iter()
        .zip(measured.chunks(CASES))
        .map(|((path, factor), measured)| {
            let has = |one: &Measured, wanted: Comparison| {
                outputs
                    .clone()
                    .any(|output| one.compare(interface, output) == wanted)
            };
            let is_known = |one: &&Measured| {
                outputs
                    .clone()
                    .all(|output| one.compare(interface, output) != Comparison::Undefined)
            };
            let known = || measured.iter().filter(is_known);
            let mut wrong = known().filter(|one| has(one, Comparison::NotFinite));
            Extreme {
                path: path.to_owned(),
                factor,
                compared: known().count() as u64,
                not_finite: wrong.clone().count() as u64,
                call: wrong.next().map(|one| interface.call(&one.case)),
            }
        });
    Ok(found.collect())
}
