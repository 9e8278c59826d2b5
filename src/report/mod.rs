//! What was found, for people and for programs.

mod record;
mod terminal;

pub use record::{Record, Report, SCHEMA, Seconds};
pub use terminal::{line, place, summary};
