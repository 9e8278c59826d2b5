//! Results of a study as CSV, JSON, a chart, and text.

use serde::Serialize;
use toyproof_diagnostic::{grouped, magnitude, plural};

use super::{MethodResult, Report};
use crate::chart::{Point, Scatter};
use crate::stress::formula::RECENTERED;
use crate::trade::method::Group;

const COLUMNS: &str = "way,group,runs,outliers,median_ms,mad_ms,rmse,max,mismatches_8bit,flips,pareto";

/// Error limits of interest to users, with their text.
pub const ERROR_LIMITS: [(f64, &str); 3] =
    [(1.0 / 255.0, "1/255"), (0.5 / 255.0, "0.5/255"), (1e-3, "1/1000")];

impl Report {
    /// A table (RFC 4180) with a header row. Flips are empty if the background is unknown.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.results.iter().map(MethodResult::cells);
        let rows = [COLUMNS.to_owned()].into_iter().chain(rows);
        rows.map(|row| row + "\r\n").collect()
    }

    /// All results as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        #[derive(Serialize)]
        struct Whole<'a> {
            version: u32,
            tool: &'static str,
            #[serde(flatten)]
            report: &'a Report,
        }
        let whole = Whole {
            version: 1,
            tool: concat!("toyproof ", env!("CARGO_PKG_VERSION")),
            report: self,
        };
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }

    /// A chart of error against time. Methods without any error are drawn below all others.
    #[must_use]
    pub fn chart(&self) -> Scatter {
        let errors = self
            .results
            .iter()
            .map(|result| result.error.rmse)
            .filter(|&rmse| rmse > 0.0);
        let least = errors.fold(1e-3f64, f64::min) / 10.0;
        let used: Vec<_> = Group::ALL
            .iter()
            .map(|(_, name)| *name)
            .filter(|name| self.results.iter().any(|result| result.group == *name))
            .collect();
        let points = self.results.iter().map(|result| Point {
            x: 1e3 * result.seconds.median.max(1e-9),
            y: result.error.rmse.max(least),
            name: result.method.clone(),
            group: used.iter().position(|name| *name == result.group).unwrap_or(0),
            on_front: result.on_front,
        });
        Scatter {
            title: format!("{}: {}x{} pixels", self.subject, self.size[0], self.size[1]),
            x_title: "median time of a frame (ms)".to_owned(),
            y_title: "root mean square error, colors in [0, 1] (no error: at the bottom)".to_owned(),
            groups: used.iter().map(|name| (*name).to_owned()).collect(),
            points: points.collect(),
            reference_lines: ERROR_LIMITS
                .iter()
                .map(|&(error, name)| (error, name.to_owned()))
                .collect(),
        }
    }

    /// The cost of the stable ray–sphere formula relative to the shader's own; `None` if that was not
    /// measured.
    #[must_use]
    pub fn stable_formula_cost(&self) -> Option<String> {
        let groups = [Group::Strict, Group::Evaluator32].map(super::group_name);
        let mut own = groups.iter().filter_map(|group| {
            let is_own = |result: &&MethodResult| result.group == *group && !result.method.contains(", ");
            self.results.iter().find(is_own)
        });
        own.find_map(|own| {
            let name = format!("{}, {}", own.method, RECENTERED.name);
            let stable = self.results.iter().find(|result| result.method == name)?;
            let [before, after] = [own, stable].map(|result| 1e3 * result.seconds.median);
            Some(format!(
                "with the {} formula for spheres, {} takes {after:.2} ms a frame where its own takes {before:.2} ({:+.0} %); the error is {} \
                 where it is {}",
                RECENTERED.name,
                own.method,
                100.0 * (after / before - 1.0),
                magnitude(stable.error.rmse),
                magnitude(own.error.rmse)
            ))
        })
    }

    /// The cheapest method within an error limit.
    #[must_use]
    pub fn cheapest_line(&self, error: f64, limit: &str) -> String {
        let Some(result) = self.cheapest(error) else {
            let ways = match &self.results[..] {
                [only] => format!("{}, the only way that was measured, is not", only.method),
                _ => "no way that was measured is".to_owned(),
            };
            let rest = match self.skipped.len() {
                0 => String::new(),
                _ => format!("; {}", self.skipped_line()),
            };
            return format!("{ways} within {limit} of the truth{rest}");
        };
        let which = match self.results.len() {
            1 => format!(
                "{}, the only way that was measured, is within {limit} of the truth",
                result.method
            ),
            _ => format!(
                "the cheapest way to be within {limit} of the truth is {}",
                result.method
            ),
        };
        format!(
            "{which}: {:.2} ms a frame (±{:.2}), error {}",
            1e3 * result.seconds.median,
            1e3 * result.seconds.deviation,
            magnitude(result.error.rmse)
        )
    }

    /// The number of methods that were not measured, with advice.
    #[must_use]
    pub fn skipped_line(&self) -> String {
        let ways = self.skipped.len() as u64;
        format!(
            "there was no time for {} {}; a longer --budget or a smaller --size measures more",
            grouped(ways),
            plural(ways, "way", "ways")
        )
    }
}

impl MethodResult {
    fn cells(&self) -> String {
        let Self {
            method,
            group,
            seconds,
            error,
            on_front,
        } = self;
        format!(
            "\"{method}\",\"{group}\",{},{},{:.4},{:.4},{:e},{:e},{},{},{}",
            seconds.runs,
            seconds.outliers,
            1e3 * seconds.median,
            1e3 * seconds.deviation,
            error.rmse,
            error.max,
            error.mismatches_8bit,
            error.flips.map_or_else(String::new, |flips| flips.to_string()),
            u8::from(*on_front)
        )
    }
}
