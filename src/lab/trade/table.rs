//! What was measured as a table, as JSON, as a chart, and in words.

use serde::Serialize;
use toyproof_verify::compare::{grouped, magnitude, plural};

use super::way::Group;
use super::{Measured, Report};
use crate::chart::{Point, Scatter};
use crate::stress::formula::RECENTRED;

const COLUMNS: &str = "way,group,runs,outliers,median_ms,mad_ms,rmse,max,mismatches_8bit,flips,pareto";

/// Errors that people ask for, and how they are written.
pub const ERRORS: [(f64, &str); 3] = [(1.0 / 255.0, "1/255"), (0.5 / 255.0, "0.5/255"), (1e-3, "1/1000")];

impl Report {
    /// A table (RFC 4180), its first row the names of its columns. Flips are empty where they are not known.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.ways.iter().map(Measured::cells);
        let rows = [COLUMNS.to_owned()].into_iter().chain(rows);
        rows.map(|row| row + "\r\n").collect()
    }

    /// Everything that was measured.
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

    /// Error over time. What has no error at all is drawn below everything else.
    #[must_use]
    pub fn chart(&self) -> Scatter {
        let errors = self
            .ways
            .iter()
            .map(|way| way.error.rmse)
            .filter(|&rmse| rmse > 0.0);
        let least = errors.fold(1e-3f64, f64::min) / 10.0;
        let used: Vec<_> = Group::ALL
            .iter()
            .map(|(_, word)| *word)
            .filter(|word| self.ways.iter().any(|way| way.group == *word))
            .collect();
        let points = self.ways.iter().map(|way| Point {
            x: 1e3 * way.seconds.median.max(1e-9),
            y: way.error.rmse.max(least),
            name: way.way.clone(),
            group: used.iter().position(|word| *word == way.group).unwrap_or(0),
            best: way.best,
        });
        Scatter {
            title: format!("{}: {}x{} pixels", self.subject, self.size[0], self.size[1]),
            x: "median time of a frame (ms)".to_owned(),
            y: "root mean square error (none: at the bottom)".to_owned(),
            groups: used.iter().map(|word| (*word).to_owned()).collect(),
            points: points.collect(),
            lines: ERRORS
                .iter()
                .map(|&(error, word)| (error, word.to_owned()))
                .collect(),
        }
    }

    /// What the stable formula costs where a shader meets spheres in another way; none where that was not measured.
    #[must_use]
    pub fn stability(&self) -> Option<String> {
        let groups = [Group::Strict, Group::Evaluator32].map(super::word);
        let mut own = groups.iter().filter_map(|group| {
            let is_own = |way: &&Measured| way.group == *group && !way.way.contains(", ");
            self.ways.iter().find(is_own)
        });
        own.find_map(|own| {
            let name = format!("{}, {}", own.way, RECENTRED.name);
            let stable = self.ways.iter().find(|way| way.way == name)?;
            let [before, after] = [own, stable].map(|way| 1e3 * way.seconds.median);
            Some(format!(
                "with the {} formula for spheres, {} takes {after:.2} ms a frame where its own takes {before:.2} ({:+.0} %); the error is {} \
                 where it is {}",
                RECENTRED.name,
                own.way,
                100.0 * (after / before - 1.0),
                magnitude(stable.error.rmse),
                magnitude(own.error.rmse)
            ))
        })
    }

    /// Which way is the cheapest that is near enough.
    #[must_use]
    pub fn line(&self, error: f64, word: &str) -> String {
        let Some(way) = self.cheapest(error) else {
            let ways = match &self.ways[..] {
                [only] => format!("{}, the only way that was measured, is not", only.way),
                _ => "no way that was measured is".to_owned(),
            };
            let rest = match self.left_out.len() {
                0 => String::new(),
                _ => format!("; {}", self.unmeasured()),
            };
            return format!("{ways} within {word} of the truth{rest}");
        };
        let which = match self.ways.len() {
            1 => format!(
                "{}, the only way that was measured, is within {word} of the truth",
                way.way
            ),
            _ => format!("the cheapest way to be within {word} of the truth is {}", way.way),
        };
        format!(
            "{which}: {:.2} ms a frame (±{:.2}), error {}",
            1e3 * way.seconds.median,
            1e3 * way.seconds.deviation,
            magnitude(way.error.rmse)
        )
    }

    /// How many ways were not measured, and what to do about it.
    #[must_use]
    pub fn unmeasured(&self) -> String {
        let ways = self.left_out.len() as u64;
        format!(
            "there was no time for {} {}; a longer --budget or a smaller --size measures more",
            grouped(ways),
            plural(ways, "way", "ways")
        )
    }
}

impl Measured {
    fn cells(&self) -> String {
        let Self {
            way,
            group,
            seconds,
            error,
            best,
        } = self;
        format!(
            "\"{way}\",\"{group}\",{},{},{:.4},{:.4},{:e},{:e},{},{},{}",
            seconds.runs,
            seconds.outliers,
            1e3 * seconds.median,
            1e3 * seconds.deviation,
            error.rmse,
            error.max,
            error.mismatches_8bit,
            error.flips.map_or_else(String::new, |flips| flips.to_string()),
            u8::from(*best)
        )
    }
}
