//! Reports of the findings, for people and for programs: one file per format, each a function of the records.

mod assigned;
mod class;
mod csv;
mod earlier;
mod explanation;
mod frames;
mod gradescope;
mod growth;
mod hints;
mod html;
mod junit;
mod reason;
mod record;
mod repair;
mod rubric;
mod rubrics;
mod sarif;
mod submitted;
mod terminal;
mod trace;

pub use assigned::{FunctionRecord, RulesRecord, Violation};
pub use class::ClassTable;
pub use csv::csv;
pub use earlier::{Change, Earlier};
pub use explanation::{Explanation, explain, explanations};
pub use frames::{CheckedFrame, FrameRecord};
pub use gradescope::gradescope;
pub use growth::{CauseName, GrowthFrame, GrowthRecord};
pub use hints::Hints;
pub use html::{
    Exhibit, Gallery, MAX_IMAGE_BYTES, MAX_PAGE_SHADERS, MAX_SHADERS_WITH_IMAGES, PARTS, PagePart, html,
    html_index, part_name, subsample,
};
pub use junit::junit;
pub use reason::{Statement, failure_position, loop_truncated, state};
pub use record::{Alternative, Mistake, Position, Record, Report, SCHEMA, Seconds};
pub use repair::{Repair, RepairEdit, SourceRange, Suspect};
#[cfg(feature = "lab")]
pub(crate) use rubric::optional_points;
pub use rubric::{Mark, Rubric, Visibility};
pub use rubrics::Rubrics;
pub use sarif::sarif;
pub use submitted::{Late, Submitted};
pub use terminal::{Detail, Layout, Tally, lines, place, summary};
use terminal::{details, plain};
pub use trace::{PixelTrace, TracedPixel};
