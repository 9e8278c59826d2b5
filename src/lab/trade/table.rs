//! Results of a study as CSV, JSON, a chart, and text.

use toyproof_diagnostic::{all_of, columns, grouped, magnitude, plural, spreadsheet_text};
use toyproof_stress::formula::{FORMULAS, Formula, RECENTERED};

use super::{Configuration, MethodResult, Report, median};
use crate::chart::{Point, Scatter};
use crate::{csv_table, json_file};

const COLUMNS: [&str; 20] = [
    "renderer",
    "precision",
    "sampler",
    "samples_per_pixel",
    "max_depth",
    "sphere_formula",
    "settings",
    "group",
    "runs",
    "outliers",
    "seconds_per_frame",
    "seconds_median_absolute_deviation",
    "rmse",
    "max_error",
    "differing_pixels_8bit",
    "visible_pixels",
    "flip",
    "changed_pixels",
    "silhouette_flips",
    "on_pareto_front",
];

/// Error limits of interest to users, with their text: from the loosest to the strictest.
const ERROR_LIMITS: [(f64, &str); 3] = [(1.0 / 255.0, "1/255"), (0.5 / 255.0, "0.5/255"), (1e-3, "1/1000")];

impl Report {
    /// A table (RFC 4180) with a header row. Settings that do not apply and unknown values are empty.
    #[must_use]
    pub fn csv(&self) -> String {
        csv_table(COLUMNS, self.results.iter().map(MethodResult::cells))
    }

    /// All results as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        json_file(self)
    }

    /// A chart of error against time.
    #[must_use]
    pub fn chart(&self) -> Scatter {
        let mut used: Vec<&str> = self.results.iter().map(|result| &*result.group).collect();
        used.sort_unstable();
        used.dedup();
        let points = self.results.iter().map(|result| Point {
            x: 1e3 * result.seconds_per_frame.median.max(1e-9),
            y: result.error.rmse,
            name: result.configuration.to_string(),
            group: used.iter().position(|name| *name == result.group).unwrap_or(0),
            on_front: result.on_pareto_front,
        });
        // Limits far from all errors would leave most of the chart empty.
        let errors = self.results.iter().map(|result| result.error.rmse);
        let lines = ERROR_LIMITS.iter().filter(|(limit, _)| {
            let is_near = |error: f64| (0.1..=10.0).contains(&(error / limit));
            errors.clone().any(is_near)
                || (errors.clone().any(|error| error < *limit) && errors.clone().any(|error| error > *limit))
        });
        let [width, height] = self.size;
        Scatter {
            title: format!(
                "{}: error against rendering time, {width}×{height} pixels",
                self.subject
            ),
            x_title: "median time per frame (ms)".to_owned(),
            y_title: "root mean square error (colors in [0, 1])".to_owned(),
            groups: used.iter().map(|name| (*name).to_owned()).collect(),
            points: points.collect(),
            reference_lines: lines.map(|&(limit, name)| (limit, name.to_owned())).collect(),
        }
    }

    /// Summarizes the measurement: the fastest configuration for each error limit, and the cost of f64.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let [width, height] = self.size;
        let error = match self.reference_error {
            0.0 => "0".to_owned(),
            error => format!("about {}", magnitude(error)),
        };
        let count = self.results.len() as u64;
        let mut lines = vec![
            format!(
                "Speed against accuracy: {}, {width}×{height} pixels",
                self.subject
            ),
            format!("Reference: {} (its own error: {error})", self.reference),
            format!(
                "{} {} measured in {:.1} s",
                grouped(count),
                plural(count, "configuration", "configurations"),
                self.seconds
            ),
            String::new(),
        ];
        lines.extend(self.role_table());
        lines.push(String::new());
        lines.extend(self.double_precision_cost());
        lines.extend(self.advice());
        if !self.skipped.is_empty() {
            lines.push(self.skipped_line());
        }
        lines
    }

    /// A table of the configurations that a user may choose: the fastest one for each error limit, and the
    /// most accurate one.
    fn role_table(&self) -> Vec<String> {
        let fastest = ERROR_LIMITS.map(|(limit, name)| {
            let found = self.results.iter().position(|result| result.error.rmse <= limit);
            (found, name)
        });
        let most_accurate = self.results.iter().rposition(|result| result.on_pareto_front);
        let mut rows = vec![
            ["RMSE", "time per frame", "configuration", "role"]
                .map(str::to_owned)
                .to_vec(),
        ];
        for (index, result) in self.results.iter().enumerate() {
            let limits = fastest.iter().filter(|(found, _)| *found == Some(index));
            let limits: Vec<&str> = limits.map(|(_, name)| *name).collect();
            let mut roles = Vec::new();
            match (index, &limits[..]) {
                (0, []) => roles.push("fastest".to_owned()),
                (0, [.., strictest]) => roles.push(format!("fastest, below {strictest}")),
                (_, []) => {}
                (_, limits) => roles.push(format!("fastest below {}", all_of(limits))),
            }
            if most_accurate == Some(index) {
                roles.push("most accurate".to_owned());
            }
            if !roles.is_empty() {
                rows.push(vec![
                    magnitude(result.error.rmse),
                    milliseconds(result.seconds_per_frame.median),
                    result.configuration.to_string(),
                    roles.join(", "),
                ]);
            }
        }
        // The limits are sorted, so the first unreachable one is the one to report.
        if let Some((_, name)) = fastest.iter().find(|(found, _)| found.is_none()) {
            rows.push(vec!["–".to_owned(), "–".to_owned(), format!("none below {name}")]);
        }
        columns("  ", &rows, &[0, 1])
    }

    /// A table of all configurations, and how they were measured.
    #[must_use]
    pub fn details(&self) -> Vec<String> {
        let head = [
            "RMSE",
            "max. error",
            "time per frame",
            "±",
            "runs",
            "configuration",
            "",
        ];
        let rows = self.results.iter().map(|result| {
            vec![
                magnitude(result.error.rmse),
                magnitude(result.error.max),
                milliseconds(result.seconds_per_frame.median),
                milliseconds(result.seconds_per_frame.deviation),
                grouped(result.seconds_per_frame.runs as u64),
                result.configuration.to_string(),
                if result.on_pareto_front {
                    "Pareto front"
                } else {
                    ""
                }
                .to_owned(),
            ]
        });
        let rows: Vec<_> = [head.map(str::to_owned).to_vec()]
            .into_iter()
            .chain(rows)
            .collect();
        let mut lines = vec![format!(
            "Error of the reference: {}. Times: median ± median absolute deviation.",
            self.reference_error_estimate
        )];
        lines.extend(columns("  ", &rows, &[0, 1, 2, 3, 4]));
        if !self.skipped.is_empty() {
            lines.push(format!("not measured: {}", self.skipped.join("; ")));
        }
        lines.extend(self.stable_formula_cost());
        lines.extend(self.formula_descriptions());
        lines.extend(self.notes.iter().cloned());
        lines.extend(self.tried_table());
        lines
    }

    /// The cost and the effect of f64, over all pairs of configurations that differ only in precision; `None`
    /// if there are none.
    #[must_use]
    pub fn double_precision_cost(&self) -> Option<String> {
        let pairs = self.results.iter().filter_map(|double| {
            let single = Configuration {
                precision: "f32",
                ..double.configuration.clone()
            };
            let is_pair = double.configuration.precision == "f64";
            let single = self.results.iter().find(|result| result.configuration == single);
            single.filter(|_| is_pair).map(|single| (single, double))
        });
        let pairs: Vec<_> = pairs.collect();
        let ratio = |(single, double): &(&MethodResult, &MethodResult)| {
            double.seconds_per_frame.median / single.seconds_per_frame.median.max(1e-9)
        };
        let ratios: Vec<f64> = pairs.iter().map(ratio).collect();
        let changes = pairs
            .iter()
            .map(|(single, double)| (single.error.rmse - double.error.rmse).abs());
        let change = changes.fold(0.0, f64::max);
        let effect = if change == 0.0 {
            "does not change the RMSE".to_owned()
        } else {
            format!("changes the RMSE by at most {}", magnitude(change))
        };
        (!pairs.is_empty())
            .then(|| format!("f64 takes {:.1}× the time of f32 and {effect}.", median(&ratios)))
    }

    /// The cost of the stable ray–sphere formula relative to the shader's own; `None` if that was not
    /// measured.
    #[must_use]
    pub fn stable_formula_cost(&self) -> Option<String> {
        let mut stable = self.results.iter().filter(|result| {
            result.configuration.sphere_formula == Some(RECENTERED.name)
                && result.configuration.precision == "f32"
        });
        // GPUs before the evaluator.
        let stable = stable
            .clone()
            .find(|result| result.configuration.renderer.ends_with("strict"))
            .or_else(|| stable.next())?;
        let own = Configuration {
            sphere_formula: None,
            ..stable.configuration.clone()
        };
        let own = self.results.iter().find(|result| result.configuration == own)?;
        let [before, after] = [own, stable].map(|result| result.seconds_per_frame.median);
        let [error_before, error_after] = [own, stable].map(|result| magnitude(result.error.rmse));
        let percent = 100.0 * (after / before - 1.0);
        let slower = if percent < 0.0 { "less time" } else { "longer" };
        let effect = if error_before == error_after {
            format!("the RMSE stays {error_after}")
        } else {
            format!("the RMSE changes from {error_before} to {error_after}")
        };
        Some(format!(
            "The {} sphere formula takes {:.0} % {slower} on {} ({} instead of {}); {effect}.",
            RECENTERED.name,
            percent.abs(),
            own.configuration,
            milliseconds(after),
            milliseconds(before)
        ))
    }

    /// The settings that were tried on small images.
    fn tried_table(&self) -> Vec<String> {
        if self.tried.is_empty() {
            return Vec::new();
        }
        let head = ["tried on a small image", "time", "visible pixels"].map(str::to_owned);
        let rows = self.tried.iter().map(|tried| {
            vec![
                tried.setting.to_string(),
                format!("{:.2}", tried.time),
                format!("{:.2} %", 100.0 * tried.changed_share),
            ]
        });
        let rows: Vec<_> = [head.to_vec()].into_iter().chain(rows).collect();
        columns("  ", &rows, &[1, 2])
    }

    /// What the formulas of the configurations are.
    fn formula_descriptions(&self) -> impl Iterator<Item = String> {
        let is_used = |formula: &&Formula| {
            let mut results = self.results.iter();
            results.any(|result| result.configuration.sphere_formula == Some(formula.name))
        };
        // The text of each begins with a comment that describes it.
        FORMULAS.iter().filter(is_used).map(|formula| {
            let description = formula.text.lines().next().unwrap_or_default();
            format!(
                "{} formula: {}",
                formula.name,
                description.trim_start_matches("// ")
            )
        })
    }

    /// The fastest configuration within an error limit.
    #[must_use]
    pub fn fastest_line(&self, error: f64) -> String {
        match self.fastest(error) {
            Some(result) => format!(
                "fastest configuration with RMSE ≤ {error}: {} ({} per frame, RMSE {})",
                result.configuration,
                milliseconds(result.seconds_per_frame.median),
                magnitude(result.error.rmse)
            ),
            None => format!("no measured configuration has RMSE ≤ {error}"),
        }
    }

    /// The number of configurations that were not measured, with advice.
    #[must_use]
    pub fn skipped_line(&self) -> String {
        let skipped = self.skipped.len() as u64;
        format!(
            "{} {} did not fit in the time budget; use a longer --budget or a smaller --size to measure more",
            grouped(skipped),
            plural(skipped, "configuration", "configurations")
        )
    }
}

/// A time in milliseconds with three significant digits.
fn milliseconds(seconds: f64) -> String {
    let time = 1e3 * seconds;
    let digits = match time {
        100.0.. => 0,
        10.0.. => 1,
        _ => 2,
    };
    format!("{time:.digits$} ms")
}

impl MethodResult {
    fn cells(&self) -> Vec<String> {
        let Self {
            configuration,
            group,
            seconds_per_frame: seconds,
            error,
            changed_pixels,
            on_pareto_front,
        } = self;
        let number = |value: Option<u64>| value.map_or_else(String::new, |value| value.to_string());
        let settings: Vec<String> = configuration.settings.iter().map(ToString::to_string).collect();
        vec![
            spreadsheet_text(&configuration.renderer),
            configuration.precision.to_owned(),
            configuration.sampler.unwrap_or_default().to_owned(),
            number(configuration.samples_per_pixel.map(u64::from)),
            number(configuration.max_depth.map(u64::from)),
            configuration.sphere_formula.unwrap_or_default().to_owned(),
            spreadsheet_text(&settings.join("; ")),
            spreadsheet_text(group),
            seconds.runs.to_string(),
            seconds.outliers.to_string(),
            format!("{:e}", seconds.median),
            format!("{:e}", seconds.deviation),
            format!("{:e}", error.rmse),
            format!("{:e}", error.max),
            error.differing_pixels_8bit.to_string(),
            error.visible_pixels.to_string(),
            error.flip.map_or_else(String::new, |flip| format!("{flip:e}")),
            number(*changed_pixels),
            number(error.silhouette_flips),
            on_pareto_front.to_string(),
        ]
    }
}
