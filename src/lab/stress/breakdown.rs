//! From where on a formula fails, in words.

use serde::Serialize;

use super::Row;
use super::axis::{Axis, Easy, Kind, Step};

/// A step fails if more than this share of its cases cannot be used.
const LARGEST_SHARE: f64 = 0.01;

/// Where a formula fails on an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Breakdown {
    /// The formula.
    pub formula: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// The axis.
    pub axis: &'static str,
    /// The first step that fails, seen from the easy ones.
    pub from: String,
    /// The share of cases there whose answer cannot be used, in [0, 1].
    pub failing: f64,
    /// What happens, to stand after “fails”.
    pub says: String,
}

/// All of them, for the rows of one formula in one precision on one device.
pub(super) fn breakdowns(axes: &[Axis], rows: &[&Row]) -> Vec<Breakdown> {
    axes.iter().flat_map(|axis| of_axis(axis, rows)).collect()
}

/// “a, b and c”
pub(super) fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn of_axis(axis: &Axis, rows: &[&Row]) -> Vec<Breakdown> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.axis == axis.name).copied().collect();
    let name = axis.name;
    let told = |row: &Row, says: String| Breakdown {
        formula: row.formula.clone(),
        precision: row.precision,
        axis: name,
        from: row.value.to_string(),
        failing: row.tally.failing_share(),
        says,
    };
    let fails = |row: &&&Row| row.tally.failing_share() > LARGEST_SHARE;
    let is = |row: &&&Row, side: fn(f64) -> bool| matches!(row.value, Step::Number(x) if side(x));
    let found: Vec<_> = match axis.easy {
        Easy::First => {
            let first = rows.iter().find(fails);
            first
                .map(|row| told(row, format!("from {name} {} on", row.value)))
                .into_iter()
                .collect()
        }
        Easy::One => {
            let low = rows.iter().rev().filter(|row| is(row, |x| x <= 1.0)).find(fails);
            let high = rows.iter().filter(|row| is(row, |x| x > 1.0)).find(fails);
            let low = low.map(|row| told(row, format!("from {name} {} down", row.value)));
            let high = high.map(|row| told(row, format!("from {name} {} up", row.value)));
            low.into_iter().chain(high).collect()
        }
        Easy::Ends => {
            let size = |row: &Row| match row.value {
                Step::Number(x) => Step::Number(x.abs()),
                word @ Step::Word(_) => word,
            };
            let hits = rows.iter().filter(|row| is(row, |x| x > 0.0)).find(fails);
            let misses = rows.iter().rev().filter(|row| is(row, |x| x < 0.0)).find(fails);
            let hits = hits.map(|row| told(row, format!("on hits that graze from |δ| {} on", size(row))));
            let misses =
                misses.map(|row| told(row, format!("on misses that graze from |δ| {} on", size(row))));
            hits.into_iter().chain(misses).collect()
        }
        Easy::Any => rows
            .iter()
            .filter(fails)
            .map(|row| told(row, any(axis, row)))
            .collect(),
    };
    found
}

fn any(axis: &Axis, row: &Row) -> String {
    let percent = |count: u64| 100.0 * count as f64 / row.tally.cases.max(1) as f64;
    match axis.kind {
        Kind::Secondaries => {
            let parts = [
                (row.tally.self_hits, "meet their own surface"),
                (row.tally.lost, "lose what is near"),
            ];
            let parts = parts.into_iter().filter(|(count, _)| *count > 0);
            let parts: Vec<_> = parts
                .map(|(count, says)| format!("{:.1} % {says}", percent(count)))
                .collect();
            format!("for {} at {} ({})", axis.name, row.value, listed(&parts))
        }
        _ => format!("with {}", row.value),
    }
}
