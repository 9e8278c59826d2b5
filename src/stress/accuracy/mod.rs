//! The accuracy of any function of a shader: how far its results in f32 are from those in double precision,
//! for which inputs they are farthest, whether the inputs or the formula are the reason, and which operation
//! loses the digits. Also properties that the function should have.
//!
//! The reference of the search is the function in double precision, checked by random rounding: an error
//! counts only if rounding in f64 changes the reference by a small part of it. That of the reported cases has
//! 160 bits.
//!
//! - `interface`: inputs and outputs by component; `domain`: their ranges; `observe`: those that occur.
//! - `sample`: random, special and neighboring cases; `search`: the worst ones; `extremes`: beyond ranges.
//! - `evaluator`, `measure`: results, errors and condition numbers; `cause`: the operation.
//! - `property`: properties and violations; `pairs`: errors over two inputs; `report`: all of it.

mod cause;
mod domain;
mod evaluator;
mod extremes;
mod interface;
mod measure;
mod observe;
mod pairs;
mod property;
mod report;
mod sample;
mod search;
#[cfg(test)]
mod tests;

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

pub use cause::Cause;
pub use domain::{GivenRange, Interval, Source};
pub use extremes::Extreme;
pub use interface::{Component, Interface, Unsupported};
pub use pairs::PairMap;
pub use property::{NotAProperty, Property, PropertyResult, Violation};
pub use report::{InputRange, OutputErrors, Report, WorstCase};
use thiserror::Error;
use toyproof_glsl::Checked;

use self::domain::Domain;
use self::evaluator::Evaluator;
use self::search::Limits;
use crate::run::RunError;

/// The value of each input component: exactly an f32, an integer, or 0 and 1.
type Case = Box<[f64]>;

/// The value of each output component.
type Outputs = Box<[f64]>;

/// The cases for each property.
const PROPERTY_CASES: usize = 20_000;

/// How a function is examined.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The ranges that are set; others are observed.
    pub ranges: &'a [GivenRange],
    /// The properties to test.
    pub properties: &'a [Property],
    /// The seed of all cases.
    pub seed: u64,
    /// The number of random cases.
    pub cases: usize,
    /// The time limit of the examination; the search ends in time for the rest.
    pub timeout: Option<Duration>,
    /// Other threads may interrupt it.
    pub interrupt: &'a AtomicBool,
}

/// Why a function is not examined.
#[derive(Debug, Error)]
pub enum AccuracyError {
    /// The request does not fit the function.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The function cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// The number of steps of an examination, each of which calls `done`.
#[must_use]
pub fn step_count(properties: usize) -> u64 {
    search::STEPS + 2 + properties as u64
}

/// Examines a function of a shader; calls `done` after each step.
///
/// # Errors
/// [`AccuracyError`].
pub fn examine(
    text: &str,
    checked: &Checked,
    interface: &Interface,
    request: Request,
    done: &dyn Fn(),
) -> Result<Report, AccuracyError> {
    let start = Instant::now();
    let left = || {
        request
            .timeout
            .map(|timeout| timeout.saturating_sub(start.elapsed()))
    };
    let evaluator = Evaluator::new(text, checked, interface, left())?;
    // A shader that takes too long to render has the default ranges.
    let observed = match observe::observe(text, checked, interface, left().map(|left| left / 4)) {
        Err(RunError::Cpu(_)) => None,
        other => other?,
    };
    let domain = Domain::new(interface, request.ranges, observed.as_ref())?;
    done();
    let mut properties = Vec::new();
    for property in request.properties {
        let amount = (request.seed, PROPERTY_CASES);
        properties.push(property.test(&evaluator, interface, &domain, amount)?);
        done();
    }
    let limits = Limits {
        cases: request.cases,
        seed: request.seed,
        time: left().map(|left| left / 2),
        interrupt: request.interrupt,
    };
    let found = search::search(&evaluator, interface, &domain, limits, done)?;
    let extremes = extremes::extremes(&evaluator, interface, &domain, request.seed)?;
    done();
    let mut outputs = Vec::new();
    for (output, worst) in found.outputs.iter().enumerate() {
        let cause = |case: &Case| cause::cause(text, checked, interface, output, case, left());
        outputs.push(OutputErrors::new(
            &evaluator,
            interface,
            output,
            (&found.random, worst),
            &cause,
        )?);
    }
    Ok(Report {
        function: interface.name.clone(),
        prototype: interface.prototype.clone(),
        seed: request.seed,
        cases: found.random.len() as u64,
        evaluated: found.evaluated,
        is_cut: found.is_cut,
        inputs: report::input_ranges(interface, &domain),
        outputs,
        maps: pairs::pair_maps(interface, &domain, &found.random),
        extremes,
        properties,
    })
}
