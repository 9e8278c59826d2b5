//! What was found as a table and as JSON.

use serde::{Serialize, Serializer};

use super::axis::Step;
use super::breakdown::listed;
use super::{Report, Row};

const COLUMNS: &str =
    "formula,precision,device,axis,value,cases,wrong_hits,t_ulp_p50,t_ulp_p99,t_ulp_max,nan,self_hits,lost";

pub(super) fn word<S: Serializer>(step: &Step, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(step)
}

impl Report {
    /// A table (RFC 4180), its first row the names of its columns. Errors are empty where no hit was found.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.rows.iter().map(Row::cells);
        [COLUMNS.to_owned()]
            .into_iter()
            .chain(rows)
            .map(|row| row + "\r\n")
            .collect()
    }

    /// Everything that was found.
    #[must_use]
    pub fn json(&self) -> String {
        self.json_with(&serde_json::json!({}))
    }

    /// The same with more beside it.
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
        // Numbers that are not finite are null.
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }

    /// A line for each formula and precision that fails somewhere: where.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let same =
            |a: &super::Breakdown, b: &super::Breakdown| a.formula == b.formula && a.precision == b.precision;
        let groups = self.breakdowns.chunk_by(same);
        groups
            .map(|group| {
                let says: Vec<_> = group.iter().map(|one| one.says.clone()).collect();
                let first = &group[0];
                format!("{} {} fails {}", first.formula, first.precision, listed(&says))
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
