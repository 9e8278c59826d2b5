//! What was found, for people and for programs: a file for each format, all of them functions of the records.

mod csv;
mod explain;
mod gradescope;
mod html;
mod junit;
mod record;
mod rubric;
mod sarif;
mod story;
mod terminal;
#[cfg(test)]
mod tests;

pub use csv::csv;
pub use explain::{Explanation, explain, explanations};
pub use gradescope::gradescope;
pub use html::{BUDGET, Exhibit, Gallery, every, html};
pub use junit::junit;
pub use record::{Mistake, Record, Report, SCHEMA, Seconds};
pub use rubric::{Mark, Rubric, Visibility};
pub use sarif::sarif;
pub use story::{Story, Subject};
pub use terminal::{Tally, line, place, summary};
use terminal::{details, plain};
