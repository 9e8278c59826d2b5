//! What was found as heat maps.

use toyproof_image::Image;

use super::axis::{Axis, Kind, axes};
use super::{CPU, Report, Row};
use crate::chart::{Band, HeatMap, Panel};

/// What a heat map shows of a row.
type Shown = fn(&Row) -> Option<f64>;

impl Report {
    /// The pictures that there is something to show in, each with the name of its file without an ending.
    #[must_use]
    pub fn pictures(&self) -> Vec<(&'static str, Image)> {
        let failing: Shown = |row| (row.tally.cases > 0).then(|| row.tally.failing_share());
        let error: Shown = |row| row.tally.t_ulp.map(|[_, p99, _]| p99);
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
        let maps = maps.into_iter().filter_map(|(file, title, kind, bands, shown)| {
            let panels: Vec<_> = axes()
                .iter()
                .filter(|axis| axis.kind == kind)
                .filter_map(|axis| self.panel(axis, shown))
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

    /// Of the CPU, and of a GPU wherever that differs from it.
    fn panel(&self, axis: &Axis, shown: Shown) -> Option<Panel> {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.axis == axis.name).collect();
        let same =
            |a: &&Row, b: &&Row| (&a.formula, a.precision, &a.device) == (&b.formula, b.precision, &b.device);
        let mut lines: Vec<(String, Vec<Option<f64>>)> = Vec::new();
        let mut of_cpu: Option<&[&Row]> = None;
        for group in rows.chunk_by(same) {
            let first = group[0];
            let is_new = first.device == CPU || !of_cpu.is_some_and(|cpu| is_same(cpu, group));
            if (first.device.as_str(), first.precision) == (CPU, "f32") {
                of_cpu = Some(group);
            }
            if is_new {
                let device = if first.device == CPU { "" } else { " GPU" };
                let name = format!("{} {}{device}", first.formula, first.precision);
                lines.push((name, group.iter().map(|row| shown(row)).collect()));
            }
        }
        (!lines.is_empty()).then(|| Panel {
            title: axis.name.to_owned(),
            columns: axis.steps.iter().map(ToString::to_string).collect(),
            rows: lines,
        })
    }
}

fn is_same(cpu: &[&Row], gpu: &[&Row]) -> bool {
    cpu.len() == gpu.len() && cpu.iter().zip(gpu).all(|(cpu, gpu)| cpu.tally == gpu.tally)
}

fn bands<const N: usize>(bands: [(f64, &str, [u8; 3]); N]) -> Vec<Band> {
    let bands = bands.into_iter().map(|(above, says, color)| Band {
        above,
        says: says.to_owned(),
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
