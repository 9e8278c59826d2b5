//! Measurements for authors of shaders and of this tool: what accuracy costs in time ([`trade`]), where formulas fail at
//! the extremes of their arguments ([`stress`]), and the charts of both ([`chart`]).
//!
//! ```
//! use toyproof_lab::stress::formula::FORMULAS;
//!
//! // The formulas for where a ray meets a sphere whose failures `stress` measures.
//! assert!(FORMULAS.iter().any(|formula| formula.name == "textbook"));
//! ```

pub mod chart;
pub mod stress;
pub mod trade;
