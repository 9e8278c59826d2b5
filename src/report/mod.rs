//! What was found, for people and for programs.

mod record;
mod story;
mod terminal;

pub use record::{Mistake, Record, Report, SCHEMA, Seconds};
pub use story::{Story, Subject};
pub use terminal::{Tally, line, place, summary};
