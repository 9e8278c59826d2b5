//! Numerical stability of ray–surface intersection at extreme arguments: finds where formulas, and authors'
//! own functions, stop being right. And the accuracy of any function of a shader.
//!
//! A subject is a shader that reads rays and surfaces from its channels and returns its results, one pixel
//! per case. It runs in f32 and f64 on the evaluator, and on a GPU; [`exact`] computes the reference from the
//! same floats.
//!
//! ```
//! use toyproof_stress::formula::FORMULAS;
//!
//! // The ray–sphere formulas whose failures `stress` measures.
//! assert!(FORMULAS.iter().any(|formula| formula.name == "textbook"));
//! ```
//!
//! # Parts
//!
//! - [`exact`]: the oracle, in integers.
//! - [`axis`]: the quantities that are taken to their extremes, and [`case`], the rays and surfaces.
//! - [`formula`]: the built-in subjects.
//! - [`function`]: an author's own function as a subject: its signature, and the mistake that it makes.
//! - [`accuracy`]: the errors of any other function, its worst inputs, and its properties.
//! - [`study`]: tests subjects on all axes, and counts failures; its report has a summary as text.
//! - [`ShaderRunner`]: runs a shader on the evaluator.

pub mod accuracy;
pub mod axis;
mod body;
pub mod case;
mod case_sampler;
mod cells;
pub mod exact;
pub mod formula;
pub mod function;
mod random;
mod run;
mod study;
mod summary;
mod tally;

pub use run::{RunError, ShaderRunner};
pub use study::{CPU, Gpu, Report, Row, Settings, run_count, study};
pub use tally::{Breakdown, Tally};
