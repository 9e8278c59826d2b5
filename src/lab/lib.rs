//! Measurements for authors of shaders and of this tool: accuracy against time ([`trade`]), failures of
//! formulas at extreme arguments ([`stress`]), and the charts of both ([`chart`]).
//!
//! ```
//! use toyproof_lab::stress::formula::FORMULAS;
//!
//! // The ray–sphere formulas whose failures `stress` measures.
//! assert!(FORMULAS.iter().any(|formula| formula.name == "textbook"));
//! ```

pub mod chart;
pub mod stress;
pub mod trade;
