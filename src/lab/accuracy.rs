//! The output of `stress` for any function: its errors as CSV and as a heat map.

use toyproof_diagnostic::spreadsheet_text;
use toyproof_stress::accuracy::{OutputErrors, PairMap, Report, WorstCase};

use crate::chart::{self, HeatMap, Panel};
use crate::csv_table;
use crate::stress::errors;

const COLUMNS: [&str; 16] = [
    "function",
    "output",
    "case",
    "cases",
    "error_ulp_median",
    "error_ulp_p99",
    "non_finite",
    "error_ulp",
    "absolute_error",
    "inherent_error_ulp",
    "excess",
    "double_error_ulp",
    "reference_bits",
    "f32",
    "reference",
    "call",
];

/// A table (RFC 4180) with a header row: for each output the case with the largest error, and the one whose
/// error exceeds most what rounding its inputs explains.
#[must_use]
pub fn csv(report: &Report) -> String {
    let rows = report.outputs.iter().flat_map(|output| {
        let cases = [
            ("largest error", &output.worst),
            ("formula", &output.worst_of_formula),
        ];
        let found = cases
            .into_iter()
            .filter_map(|(kind, worst)| Some((kind, worst.as_ref()?)));
        found.map(|(kind, worst)| cells(report, output, kind, worst))
    });
    csv_table(COLUMNS, rows)
}

fn cells(report: &Report, output: &OutputErrors, kind: &str, worst: &WorstCase) -> Vec<String> {
    let number = |value: f64| format!("{value:.3e}");
    vec![
        spreadsheet_text(&report.function),
        spreadsheet_text(&output.path),
        kind.to_owned(),
        output.compared.to_string(),
        number(output.median),
        number(output.p99),
        output.not_finite.to_string(),
        number(worst.ulps),
        number((worst.single - worst.reference).abs()),
        number(worst.inherent_ulps),
        number(worst.excess),
        number(worst.double_ulps),
        worst.reference_bits.to_string(),
        format!("{:e}", worst.single as f32),
        format!("{:e}", worst.reference),
        spreadsheet_text(&worst.call),
    ]
}

/// The heat map of the pairs of inputs on which the error depends most; `None` for a function of one input.
#[must_use]
pub fn heat_map(report: &Report) -> Option<HeatMap> {
    let panels: Vec<_> = report.maps.iter().map(panel).collect();
    (!panels.is_empty()).then(|| HeatMap {
        title: format!("{}: errors over pairs of inputs", report.function),
        legend: "Error in float32, 99th percentile, in units in the last place (ULP):".to_owned(),
        bands: errors(),
        panels,
    })
}

fn panel(map: &PairMap) -> Panel {
    let rows = map.rows.iter().zip(&map.errors);
    // The largest value is at the top, as in a diagram.
    let rows = rows.rev().map(|(value, errors)| (label(*value), errors.clone()));
    Panel {
        title: format!("{} over {}", map.y, map.x),
        x_title: map.x.clone(),
        columns: map.columns.iter().map(|&value| label(value)).collect(),
        rows: rows.collect(),
    }
}

/// The middle of a cell, in three digits.
fn label(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    match rounded {
        _ if rounded < 0.0 => format!("−{}", chart::tick(-rounded)),
        _ if rounded > 0.0 => chart::tick(rounded),
        _ => "0".to_owned(),
    }
}
