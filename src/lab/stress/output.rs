//! Results as CSV, JSON and heat maps.

use serde::{Serialize, Serializer};
use toyproof_diagnostic::spreadsheet_text;

use super::axis::{Axis, Kind, axes};
use super::case::Step;
use super::{CPU, Report, Row};
use crate::chart::{self, Band, HeatMap, Panel};
use crate::csv_table;

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

pub(super) fn serialize_step<S: Serializer>(step: &Step, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(step)
}

impl Report {
    /// A table (RFC 4180) with a header row. Errors are empty if there was no hit.
    #[must_use]
    pub fn csv(&self) -> String {
        csv_table(COLUMNS, self.rows.iter().map(Row::cells))
    }

    /// All results as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        self.json_with(&serde_json::json!({}))
    }

    /// All results as JSON, with additional members.
    pub(super) fn json_with(&self, more: &serde_json::Value) -> String {
        #[derive(Serialize)]
        struct Whole<'a> {
            version: u32,
            tool: &'static str,
            #[serde(flatten)]
            more: &'a serde_json::Value,
            #[serde(flatten)]
            report: &'a Report,
        }
        let whole = Whole {
            version: 2,
            tool: concat!("toyproof ", env!("CARGO_PKG_VERSION")),
            more,
            report: self,
        };
        // Infinite and NaN values become null.
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }
}

impl Row {
    fn cells(&self) -> Vec<String> {
        let tally = &self.tally;
        let errors = tally.t_error_ulp.map_or_else(Default::default, |errors| {
            errors.map(|error| format!("{error:.3}"))
        });
        let before = [
            spreadsheet_text(&self.formula),
            self.precision.to_string(),
            spreadsheet_text(&self.device),
            self.axis.to_string(),
            self.value.to_string(),
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
}

// Heat maps of the results.

/// The value of a row that a heat map shows.
type CellValue = fn(&Row) -> Option<f64>;

impl Report {
    /// The heat maps that have data, each with its file name without an extension.
    #[must_use]
    pub fn heat_maps(&self) -> Vec<(&'static str, HeatMap)> {
        let failing: CellValue = |row| (row.tally.cases > 0).then(|| row.tally.failing_share());
        let error: CellValue = |row| row.tally.t_error_ulp.map(|[_, p99, _]| p99);
        let share = format!("Unusable results, share of {} cases per cell:", self.cases);
        let ulp = "Error of t, 99th percentile, in units in the last place (ULP); blank: no hits:".to_owned();
        let maps = [
            (
                "stress-spheres",
                "Ray–sphere intersection: where each formula fails",
                Kind::Spheres,
                (share.clone(), shares()),
                failing,
            ),
            (
                "stress-errors",
                "Ray–sphere intersection: accuracy of t for correctly detected hits",
                Kind::Spheres,
                (ulp, errors()),
                error,
            ),
            (
                "stress-quadrics",
                "Ray–quadric intersection: where each formula fails",
                Kind::Quadrics,
                (share.clone(), shares()),
                failing,
            ),
            (
                "stress-secondary",
                "Rays leaving a sphere: self-intersections and missed nearby surfaces",
                Kind::Secondaries,
                (share, shares()),
                failing,
            ),
        ];
        let maps = maps
            .into_iter()
            .filter_map(|(file, title, kind, (legend, bands), value)| {
                let panels: Vec<_> = axes()
                    .iter()
                    .filter(|axis| axis.kind == kind)
                    .filter_map(|axis| self.panel(axis, value))
                    .collect();
                let map = HeatMap {
                    title: title.to_owned(),
                    legend,
                    bands,
                    panels,
                };
                (!map.panels.is_empty()).then_some((file, map))
            });
        maps.collect()
    }

    /// The panel of an axis: rows of the CPU, and of GPUs whose results differ from it.
    fn panel(&self, axis: &Axis, value: CellValue) -> Option<Panel> {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.axis == axis.name).collect();
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

fn errors() -> Vec<Band> {
    bands([
        (0.0, "up to 4", [38, 70, 112]),
        (4.0, "4–32", [120, 165, 205]),
        (32.0, "32–10³", [250, 215, 120]),
        (1e3, "10³–10⁵", [235, 130, 60]),
        (1e5, "more than 10⁵", [170, 25, 35]),
    ])
}
