//! The output of `stress`: results as CSV, JSON and heat maps.

use serde::Serialize;
use toyproof_diagnostic::spreadsheet_text;
use toyproof_stress::axis::{Axis, Kind, axes};
use toyproof_stress::case::Step;
use toyproof_stress::{CPU, Report, Row};

use crate::chart::{self, Band, HeatMap, Panel};
use crate::{csv_table, json_file};

const COLUMNS: [&str; 14] = [
    "formula",
    "precision",
    "device",
    "axis",
    "step",
    "cases",
    "failing",
    "wrong_hits",
    "t_error_ulp_median",
    "t_error_ulp_p99",
    "t_error_ulp_max",
    "non_finite",
    "self_intersections",
    "missed_nearby",
];

/// A table (RFC 4180) with a header row. Errors are empty if there was no hit.
#[must_use]
pub fn csv(report: &Report) -> String {
    csv_table(COLUMNS, report.rows.iter().map(cells))
}

/// All results as JSON: a [`Report`], or the [`Findings`](toyproof_stress::function::Findings) of a function.
#[must_use]
pub fn json(results: &impl Serialize) -> String {
    json_file(results)
}

fn cells(row: &Row) -> Vec<String> {
    let tally = &row.tally;
    let errors = tally.t_error_ulp.map_or_else(Default::default, |errors| {
        errors.map(|error| format!("{error:.3}"))
    });
    let before = [
        spreadsheet_text(&row.formula),
        row.precision.to_string(),
        spreadsheet_text(&row.device),
        row.axis.to_string(),
        row.value.to_string(),
    ];
    let counts = [tally.cases, tally.failing, tally.wrong_hits].map(|count| count.to_string());
    let after = [tally.non_finite, tally.self_intersections, tally.missed_nearby];
    let after = after.map(|count| count.to_string());
    before
        .into_iter()
        .chain(counts)
        .chain(errors)
        .chain(after)
        .collect()
}

// Heat maps of the results.

/// The value of a row that a heat map shows.
type CellValue = fn(&Row) -> Option<f64>;

/// A heat map of a report.
struct Map {
    /// The name of the chart's file, without an extension.
    file: &'static str,
    title: &'static str,
    kind: Kind,
    legend: String,
    bands: Vec<Band>,
    value: CellValue,
}

/// The heat maps that have data, each with its file name without an extension.
#[must_use]
pub fn heat_maps(report: &Report) -> Vec<(&'static str, HeatMap)> {
    let shares = |file, title, kind| Map {
        file,
        title,
        kind,
        legend: format!("Unusable results, share of {} cases per cell:", report.cases),
        bands: shares(),
        value: |row| (row.tally.cases > 0).then(|| row.tally.failing_share()),
    };
    let maps = [
        shares(
            "stress-spheres",
            "Ray–sphere intersection: where each formula fails",
            Kind::Spheres,
        ),
        Map {
            file: "stress-errors",
            title: "Ray–sphere intersection: accuracy of t for correctly detected hits",
            kind: Kind::Spheres,
            legend: "Error of t, 99th percentile, in units in the last place (ULP); blank: no hits:"
                .to_owned(),
            bands: errors(),
            value: |row| row.tally.t_error_ulp.map(|[_, p99, _]| p99),
        },
        shares(
            "stress-quadrics",
            "Ray–quadric intersection: where each formula fails",
            Kind::Quadrics,
        ),
        shares(
            "stress-secondary",
            "Rays leaving a sphere: self-intersections and missed nearby surfaces",
            Kind::Secondaries,
        ),
    ];
    let maps = maps.into_iter().filter_map(|map| {
        let panels: Vec<_> = axes()
            .iter()
            .filter(|axis| axis.kind == map.kind)
            .filter_map(|axis| panel(report, axis, map.value))
            .collect();
        let heat_map = HeatMap {
            title: map.title.to_owned(),
            legend: map.legend,
            bands: map.bands,
            panels,
        };
        (!heat_map.panels.is_empty()).then_some((map.file, heat_map))
    });
    maps.collect()
}

/// The panel of an axis: rows of the CPU, and of GPUs whose results differ from it.
fn panel(report: &Report, axis: &Axis, value: CellValue) -> Option<Panel> {
    let rows: Vec<&Row> = report.rows.iter().filter(|row| row.axis == axis.name).collect();
    let same =
        |a: &&Row, b: &&Row| (&a.formula, a.precision, &a.device) == (&b.formula, b.precision, &b.device);
    let mut lines: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    let mut cpu_rows: Option<&[&Row]> = None;
    for group in rows.chunk_by(same) {
        let first = group[0];
        let is_new = first.device == CPU || !cpu_rows.is_some_and(|cpu| has_equal_tallies(cpu, group));
        if (first.device.as_str(), first.precision) == (CPU, "f32") {
            cpu_rows = Some(group);
        }
        if is_new {
            let device = if first.device == CPU { "" } else { ", GPU" };
            let name = format!("{}, {}{device}", first.formula, first.precision);
            lines.push((name, group.iter().map(|row| value(row)).collect()));
        }
    }
    // Steps without any value, such as errors of t where there are no hits, have no column.
    let shown: Vec<usize> = (0..axis.steps.len())
        .filter(|&step| lines.iter().any(|(_, values)| values[step].is_some()))
        .collect();
    let lines = lines.into_iter().map(|(name, values)| {
        let values = shown.iter().map(|&step| values[step]);
        (name, values.collect())
    });
    (!shown.is_empty()).then(|| Panel {
        title: chart::capitalized(axis.label),
        x_title: axis.axis_title.to_owned(),
        columns: shown.iter().map(|&step| column_label(axis.steps[step])).collect(),
        rows: lines.collect(),
    })
}

/// The label of a step's column: `0`, `1`, `10`, `10⁻³`, `−10⁻³`, or its name.
fn column_label(step: Step) -> String {
    match step {
        Step::Number(number) if number < 0.0 => format!("−{}", chart::tick(-number)),
        Step::Number(number) if number > 0.0 => chart::tick(number),
        step => step.to_string(),
    }
}

fn has_equal_tallies(cpu: &[&Row], gpu: &[&Row]) -> bool {
    cpu.len() == gpu.len() && cpu.iter().zip(gpu).all(|(cpu, gpu)| cpu.tally == gpu.tally)
}

fn bands<const N: usize>(bands: [(f64, &str, [u8; 3]); N]) -> Vec<Band> {
    let bands = bands.into_iter().map(|(min, label, color)| Band {
        min,
        label: label.to_owned(),
        color,
    });
    bands.collect()
}

fn shares() -> Vec<Band> {
    bands([
        (0.0, "0 %", [38, 70, 112]),
        (1e-9, "up to 1 %", [120, 165, 205]),
        (0.01, "1–10 %", [250, 215, 120]),
        (0.1, "10–50 %", [235, 130, 60]),
        (0.5, "more than 50 %", [170, 25, 35]),
    ])
}

pub(crate) fn errors() -> Vec<Band> {
    bands([
        (0.0, "up to 4", [38, 70, 112]),
        (4.0, "4–32", [120, 165, 205]),
        (32.0, "32–10³", [250, 215, 120]),
        (1e3, "10³–10⁵", [235, 130, 60]),
        (1e5, "more than 10⁵", [170, 25, 35]),
    ])
}
