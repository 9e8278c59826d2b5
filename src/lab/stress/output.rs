//! Results as a table, JSON, text and heat maps.

use serde::{Serialize, Serializer};
use toyproof_image::Image;

use super::axis::{Axis, Kind, Step, axes};
use super::tally::join_list;
use super::{CPU, Report, Row};
use crate::chart::{Band, HeatMap, Panel};

const COLUMNS: &str =
    "formula,precision,device,axis,value,cases,wrong_hits,t_ulp_p50,t_ulp_p99,t_ulp_max,nan,self_hits,lost";

pub(super) fn serialize_step<S: Serializer>(step: &Step, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(step)
}

impl Report {
    /// A table (RFC 4180) with a header row. Errors are empty if there was no hit.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.rows.iter().map(Row::cells);
        [COLUMNS.to_owned()]
            .into_iter()
            .chain(rows)
            .map(|row| row + "\r\n")
            .collect()
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
            version: 1,
            tool: concat!("toyproof ", env!("CARGO_PKG_VERSION")),
            more,
            report: self,
        };
        // Infinite and NaN values become null.
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }

    /// A line for each formula and precision that fails anywhere, with its failures.
    #[must_use]
    pub fn breakdown_lines(&self) -> Vec<String> {
        let same =
            |a: &super::Breakdown, b: &super::Breakdown| a.formula == b.formula && a.precision == b.precision;
        let groups = self.breakdowns.chunk_by(same);
        groups
            .map(|group| {
                let says: Vec<_> = group.iter().map(|one| one.description.clone()).collect();
                let first = &group[0];
                format!("{} {} fails {}", first.formula, first.precision, join_list(&says))
            })
            .collect()
    }
}

impl Row {
    fn cells(&self) -> String {
        let tally = &self.tally;
        let errors = tally.t_ulp.map_or_else(
            || ",,".to_owned(),
            |errors| errors.map(|error| format!("{error:.3}")).join(","),
        );
        let quoted = |cell: &str| {
            if cell.contains(['"', ',']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.to_owned()
            }
        };
        format!(
            "{},{},{},{},{},{},{},{errors},{},{},{}",
            quoted(&self.formula),
            self.precision,
            quoted(&self.device),
            self.axis,
            self.value,
            tally.cases,
            tally.wrong_hits,
            tally.nan,
            tally.self_hits,
            tally.lost
        )
    }
}

// Heat maps of the results.

/// The value of a row that a heat map shows.
type CellValue = fn(&Row) -> Option<f64>;

impl Report {
    /// The heat maps that have data, each with its file name without an extension.
    #[must_use]
    pub fn heat_maps(&self) -> Vec<(&'static str, Image)> {
        let failing: CellValue = |row| (row.tally.cases > 0).then(|| row.tally.failing_share());
        let error: CellValue = |row| row.tally.t_ulp.map(|[_, p99, _]| p99);
        let maps = [
            (
                "stress-spheres",
                "Rays and spheres: answers that cannot be used",
                Kind::Spheres,
                shares(),
                failing,
            ),
            (
                "stress-errors",
                "Rays and spheres: errors of t that one hit in 100 exceeds",
                Kind::Spheres,
                errors(),
                error,
            ),
            (
                "stress-quadrics",
                "Rays and quadrics: answers that cannot be used",
                Kind::Quadrics,
                shares(),
                failing,
            ),
            (
                "stress-secondary",
                "Rays that leave a sphere: self-hits and near roots lost",
                Kind::Secondaries,
                shares(),
                failing,
            ),
        ];
        let maps = maps.into_iter().filter_map(|(file, title, kind, bands, value)| {
            let panels: Vec<_> = axes()
                .iter()
                .filter(|axis| axis.kind == kind)
                .filter_map(|axis| self.panel(axis, value))
                .collect();
            let map = HeatMap {
                title: title.to_owned(),
                bands,
                panels,
            };
            (!map.panels.is_empty()).then(|| (file, map.image()))
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
                let device = if first.device == CPU { "" } else { " GPU" };
                let name = format!("{} {}{device}", first.formula, first.precision);
                lines.push((name, group.iter().map(|row| value(row)).collect()));
            }
        }
        (!lines.is_empty()).then(|| Panel {
            title: axis.name.to_owned(),
            columns: axis.steps.iter().map(ToString::to_string).collect(),
            rows: lines,
        })
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
        (0.0, "none", [38, 70, 112]),
        (1e-9, "up to 1 %", [120, 165, 205]),
        (0.01, "1 to 10 %", [250, 215, 120]),
        (0.1, "10 to 50 %", [235, 130, 60]),
        (0.5, "more", [170, 25, 35]),
    ])
}

fn errors() -> Vec<Band> {
    bands([
        (0.0, "up to 4 ULP", [38, 70, 112]),
        (4.0, "to 32", [120, 165, 205]),
        (32.0, "to 1e3", [250, 215, 120]),
        (1e3, "to 1e5", [235, 130, 60]),
        (1e5, "more", [170, 25, 35]),
    ])
}
