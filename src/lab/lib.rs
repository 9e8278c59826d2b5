//! Measurements for authors of shaders and of this tool: accuracy against time ([`trade`]), the output of
//! `toyproof_stress` ([`stress`]), and the charts of both ([`chart`]).
//!
//! ```
//! use toyproof_lab::chart::{Point, Scatter};
//!
//! let point = Point { x: 2.0, y: 0.1, name: "a".to_owned(), group: 0, on_front: true };
//! let scatter = Scatter {
//!     title: "Error against time".to_owned(),
//!     x_title: "time (ms)".to_owned(),
//!     y_title: "error".to_owned(),
//!     groups: vec!["one".to_owned()],
//!     points: vec![point],
//!     reference_lines: Vec::new(),
//! };
//! assert!(scatter.svg().contains("Error against time"));
//! ```
//!
//! # Parts
//!
//! - [`stress`]: tables and heat maps of the failures of formulas; [`accuracy`]: those of the errors of a
//!   function.
//! - [`trade`]: accuracy against time of all methods to render an image, within a budget.
//! - [`chart`]: scatter plots and heat maps.

pub mod accuracy;
pub mod chart;
pub mod stress;
pub mod trade;

use serde::Serialize;

/// A file of results in JSON, with the version of its format. Infinite and NaN values are null.
fn json_file(results: &impl Serialize) -> String {
    #[derive(Serialize)]
    struct File<'a, R> {
        version: u32,
        tool: &'static str,
        #[serde(flatten)]
        results: &'a R,
    }
    let file = File {
        version: 2,
        tool: concat!("toyproof ", env!("CARGO_PKG_VERSION")),
        results,
    };
    let json = serde_json::to_string_pretty(&file);
    json.expect("strings and numbers always serialize") + "\n"
}

/// A table in the format of RFC 4180, with a row of the columns' names.
fn csv_table<const N: usize>(columns: [&str; N], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut table = csv::WriterBuilder::new()
        .terminator(csv::Terminator::CRLF)
        .from_writer(Vec::new());
    let written = table.write_record(columns).and_then(|()| {
        let mut rows = rows;
        rows.try_for_each(|row| table.write_record(row))
    });
    let bytes = written.ok().and_then(|()| table.into_inner().ok());
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).ok());
    text.expect("rows of equal length are written to memory as UTF-8")
}
