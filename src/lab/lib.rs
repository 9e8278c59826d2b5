//! Measurements for authors of shaders and of this tool: accuracy against time ([`trade`]), failures of
//! formulas at extreme arguments ([`stress`]), and the charts of both ([`chart`]).
//!
//! ```
//! use toyproof_lab::stress::formula::FORMULAS;
//!
//! // The ray–sphere formulas whose failures `stress` measures.
//! assert!(FORMULAS.iter().any(|formula| formula.name == "textbook"));
//! ```
//!
//! # Parts
//!
//! - [`stress`]: formulas and authors' own functions against exact integers.
//! - [`trade`]: accuracy against time of all methods to render an image, within a budget.
//! - [`chart`]: scatter plots and heat maps.

pub mod chart;
pub mod stress;
pub mod trade;

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
