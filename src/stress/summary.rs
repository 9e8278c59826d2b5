//! The summary of a study as text: where each formula stops being right, and which one is recommended.

use std::fmt::Write as _;

use toyproof_diagnostic::{columns, grouped, plural};

use crate::axis::{Axis, EasySteps, Kind, axes};
use crate::case::Step;
use crate::study::{CPU, Report, Row};
use crate::tally::{Breakdown, MAX_FAILING_SHARE, directions};

/// Scales and direction lengths of ordinary scenes are within this factor of 1.
const MAX_ORDINARY_SCALE: f64 = 1e15;

/// The meaning of the cells, between the tables and the recommendations.
const LEGEND: [&str; 5] = [
    "",
    "–: no failure in the tested range. ≤ and ≥: the first step that fails. %: the share of wrong results.",
    "δ = 1 − (distance of the ray's line from the center / radius)², so that grazing rays have δ near 0.",
    "docs/evidence/accuracy.md describes the formulas.",
    "",
];

/// The range of steps in which a formula does not fail.
struct FailureFree<'a> {
    formula: &'a str,
    /// The number of steps in the range.
    right: usize,
    /// The number of all steps.
    steps: usize,
}

impl Report {
    /// The summary of the built-in formulas in f32, then the recommendations.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let mut lines = self.sphere_and_quadric_tables("f32");
        lines.extend(self.strategy_table("f32"));
        lines.extend(LEGEND.map(str::to_owned));
        lines.extend(self.recommendations());
        lines.extend(self.gpu_lines());
        lines
    }

    /// The same tables in f64, for comparison.
    #[must_use]
    pub fn double_precision_summary(&self) -> Vec<String> {
        let mut lines = vec![String::new()];
        lines.extend(self.sphere_and_quadric_tables("f64"));
        lines.extend(self.strategy_table("f64"));
        lines
    }

    /// The first failing steps of one function, in f32 and f64.
    #[must_use]
    pub fn function_summary(&self) -> Vec<String> {
        let columns = ["f32", "f64"].map(|precision| {
            let of_precision = move |one: &&Breakdown| one.precision == precision;
            let found: Vec<&Breakdown> = self.breakdowns.iter().filter(of_precision).collect();
            (precision.to_owned(), found)
        });
        let mut lines = vec![self.table_heading()];
        lines.extend(first_failing_steps(Kind::Spheres, &columns));
        lines.extend(self.gpu_lines());
        lines
    }

    fn table_heading(&self) -> String {
        let cases = self.cases as u64;
        format!(
            "First step with more than {} % wrong results ({} {} per step, reference: 160-bit arithmetic):",
            100.0 * MAX_FAILING_SHARE,
            grouped(cases),
            plural(cases, "case", "cases")
        )
    }

    fn sphere_and_quadric_tables(&self, precision: &'static str) -> Vec<String> {
        let number_type = number_type(precision);
        let mut lines = vec![
            format!("Where ray–sphere formulas stop being right in {number_type}"),
            self.table_heading(),
            String::new(),
        ];
        lines.extend(first_failing_steps(
            Kind::Spheres,
            &self.columns(Kind::Spheres, precision),
        ));
        lines.extend([
            String::new(),
            format!("Where ray–quadric formulas stop being right in {number_type}:"),
            String::new(),
        ]);
        lines.extend(first_failing_steps(
            Kind::Quadrics,
            &self.columns(Kind::Quadrics, precision),
        ));
        lines
    }

    /// The breakdowns of each formula of a kind.
    fn columns(&self, kind: Kind, precision: &'static str) -> Vec<(String, Vec<&Breakdown>)> {
        let names = self.formulas(kind, precision).into_iter();
        names
            .map(|name| {
                let breakdowns = self.breakdowns.iter();
                let of_formula = |one: &&Breakdown| one.formula == name && one.precision == precision;
                (name.to_owned(), breakdowns.filter(of_formula).collect())
            })
            .collect()
    }

    /// The names of the formulas of a kind that were tested.
    fn formulas(&self, kind: Kind, precision: &'static str) -> Vec<&str> {
        let axes = axes();
        let mut names: Vec<&str> = Vec::new();
        for row in self.cpu_rows(precision) {
            let is_of_kind = axes.iter().any(|axis| axis.name == row.axis && axis.kind == kind);
            if is_of_kind && !names.contains(&row.formula.as_str()) {
                names.push(&row.formula);
            }
        }
        names
    }

    fn cpu_rows<'a>(&'a self, precision: &'static str) -> impl Iterator<Item = &'a Row> {
        let rows = self.rows.iter();
        rows.filter(move |row| row.device == CPU && row.precision == precision)
    }

    /// The failures of strategies for rays that leave a surface.
    fn strategy_table(&self, precision: &'static str) -> Vec<String> {
        let head = ["start of the ray", "self-intersections", "nearby surfaces missed"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        for name in self.formulas(Kind::Secondaries, precision) {
            let worst = |count: fn(&Row) -> u64| {
                let rows = self.cpu_rows(precision).filter(|row| row.formula == name);
                let share = |row: &Row| count(row) as f64 / row.tally.cases.max(1) as f64;
                match rows.map(share).fold(0.0, f64::max) {
                    0.0 => "–".to_owned(),
                    share => format!("{:.1} %", 100.0 * share),
                }
            };
            rows.push(vec![
                name.to_owned(),
                worst(|row| row.tally.self_intersections),
                worst(|row| row.tally.missed_nearby),
            ]);
        }
        let mut lines = vec![
            String::new(),
            format!(
                "Rays that leave a sphere in {}, worst of {} scenes:",
                number_type(precision),
                scene_count()
            ),
            String::new(),
        ];
        lines.extend(columns("  ", &rows, &[1, 2]));
        lines
    }

    /// The formulas and strategies with the largest range without failures in f32.
    fn recommendations(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (kind, what) in [
            (Kind::Spheres, "spheres"),
            (Kind::Quadrics, "quadrics"),
            (Kind::Secondaries, "secondary rays"),
        ] {
            let Some(ordinary) = self.best(kind, is_ordinary) else {
                continue;
            };
            let extreme = self
                .best(kind, |_, _| true)
                .filter(|extreme| extreme.formula != ordinary.formula);
            let range = match extreme {
                Some(_) => format!(
                    " at scales from {:e} to {MAX_ORDINARY_SCALE:e}",
                    1.0 / MAX_ORDINARY_SCALE
                ),
                None => String::new(),
            };
            let FailureFree {
                formula,
                right,
                steps,
            } = ordinary;
            let mut line = format!("Recommended for {what}: {formula} ");
            let range = if right == steps {
                format!("(right in all {steps} steps{range})")
            } else {
                format!("(largest range without failures{range}: {right} of {steps} steps)")
            };
            line += &range;
            if let Some(extreme) = extreme {
                let _ = write!(line, "\n  at any scale: {}", extreme.formula);
            }
            lines.push(line);
        }
        lines
    }

    /// The formula with the largest range without failures in f32, the first of several, counting only some
    /// steps of each axis.
    fn best(&self, kind: Kind, counts: fn(&Axis, Step) -> bool) -> Option<FailureFree<'_>> {
        let axes = axes();
        let ranges = self.formulas(kind, "f32").into_iter().map(|name| {
            let rows: Vec<&Row> = self.cpu_rows("f32").filter(|row| row.formula == name).collect();
            let (mut right, mut steps) = (0, 0);
            for axis in axes.iter().filter(|axis| axis.kind == kind) {
                for direction in directions(axis) {
                    let counted = direction.steps.into_iter();
                    let counted: Vec<Step> = counted.filter(|step| counts(axis, *step)).collect();
                    let fails = |step: &Step| {
                        let mut rows = rows.iter();
                        rows.any(|row| row.axis == axis.name && row.value == *step && row.tally.fails())
                    };
                    right += counted.iter().position(fails).unwrap_or(counted.len());
                    steps += counted.len();
                }
            }
            FailureFree {
                formula: name,
                right,
                steps,
            }
        });
        ranges.min_by_key(|range| range.steps - range.right)
    }

    /// Whether a GPU's results agree with the CPU's.
    fn gpu_lines(&self) -> Vec<String> {
        let mut devices: Vec<&str> = Vec::new();
        for row in &self.rows {
            if row.device != CPU && !devices.contains(&row.device.as_str()) {
                devices.push(&row.device);
            }
        }
        let lines = devices.into_iter().map(|device| {
            let rows: Vec<&Row> = self.rows.iter().filter(|row| row.device == device).collect();
            let differs = |row: &&&Row| {
                let same = |cpu: &Row| {
                    (&cpu.formula, cpu.axis, cpu.value) == (&row.formula, row.axis, row.value)
                        && cpu.tally == row.tally
                };
                !self.cpu_rows("f32").any(same)
            };
            let total = grouped(rows.len() as u64);
            match rows.iter().filter(differs).count() as u64 {
                0 => format!("{device}: same results as the CPU in all {total} steps"),
                count => format!(
                    "{device}: results differ from the CPU's in {} of {total} steps",
                    grouped(count)
                ),
            }
        });
        lines.collect()
    }
}

/// Whether a step is not an extreme scale.
fn is_ordinary(axis: &Axis, step: Step) -> bool {
    let range = 1.0 / MAX_ORDINARY_SCALE..=MAX_ORDINARY_SCALE;
    axis.easy != EasySteps::One || !matches!(step, Step::Number(x) if !range.contains(&x))
}

fn number_type(precision: &'static str) -> &'static str {
    if precision == "f32" {
        "float32"
    } else {
        "double precision"
    }
}

/// The number of steps of all axes of secondary rays.
fn scene_count() -> usize {
    let axes = axes();
    let secondary = axes.iter().filter(|axis| axis.kind == Kind::Secondaries);
    secondary.map(|axis| axis.steps.len()).sum()
}

/// A table with a column for each formula, and a row for each direction in which one of them fails.
fn first_failing_steps(kind: Kind, columns: &[(String, Vec<&Breakdown>)]) -> Vec<String> {
    let names = columns.iter().map(|(name, _)| name.clone());
    let mut rows: Vec<Vec<String>> = vec![[String::new()].into_iter().chain(names).collect()];
    let mut right = Vec::new();
    for axis in axes().iter().filter(|axis| axis.kind == kind) {
        let mut fails = false;
        for direction in directions(axis) {
            let cell = |breakdowns: &[&Breakdown]| {
                let mut found = breakdowns.iter();
                let found =
                    found.find(|one| one.axis == axis.name && one.condition == direction.condition)?;
                Some(match axis.easy {
                    EasySteps::Unordered => format!("{:.0} %", 100.0 * found.failing_share),
                    _ => found.first_failing_step.clone(),
                })
            };
            let cells: Vec<_> = columns.iter().map(|(_, found)| cell(found)).collect();
            if cells.iter().any(Option::is_some) {
                fails = true;
                let cells = cells.into_iter().map(|cell| cell.unwrap_or("–".to_owned()));
                rows.push([direction.condition.clone()].into_iter().chain(cells).collect());
            }
        }
        if !fails {
            right.push(axis.label);
        }
    }
    let mut lines = if rows.len() > 1 {
        toyproof_diagnostic::columns("  ", &rows, &(1..=columns.len()).collect::<Vec<_>>())
    } else {
        Vec::new()
    };
    if !right.is_empty() {
        lines.push(format!("  no failures: {}", right.join(", ")));
    }
    lines
}
