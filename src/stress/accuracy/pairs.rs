//! Errors over pairs of inputs, for heat maps.

use serde::Serialize;

use super::domain::Domain;
use super::interface::Interface;
use super::measure::Measured;

/// The errors over two inputs, while the others are random.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairMap {
    /// The input of the columns.
    pub x: String,
    /// The input of the rows.
    pub y: String,
    /// The middle of each column.
    pub columns: Vec<f64>,
    /// The middle of each row.
    pub rows: Vec<f64>,
    /// For each row the 99th percentile of the error in each cell, in ULPs; `None` without cases.
    pub errors: Vec<Vec<Option<f64>>>,
}

/// The cells in each direction.
const CELLS: usize = 16;

/// The inputs that are paired: those on which the error depends most.
const MAX_INPUTS: usize = 8;

/// The number of maps.
const MAX_MAPS: usize = 4;

/// The maps of the pairs of inputs on which the error depends most, the first most.
pub(super) fn pair_maps(interface: &Interface, domain: &Domain, random: &[Measured]) -> Vec<PairMap> {
    let errors: Vec<Option<f64>> = random.iter().map(|one| largest_error(interface, one)).collect();
    let varying = (0..interface.inputs.len()).filter(|&at| {
        let interval = domain.intervals[at];
        interval.low < interval.high
    });
    let cell = |at: usize, one: &Measured| {
        let share = domain.intervals[at].share(one.case[at]);
        ((share * CELLS as f64) as usize).min(CELLS - 1)
    };
    let mut inputs: Vec<(f64, usize)> = varying
        .map(|at| {
            (
                dependence(CELLS, random.iter().map(|one| cell(at, one)), &errors),
                at,
            )
        })
        .collect();
    inputs.sort_by(|a, b| b.0.total_cmp(&a.0));
    inputs.truncate(MAX_INPUTS);
    let mut pairs = Vec::new();
    for (index, &(_, x)) in inputs.iter().enumerate() {
        for &(_, y) in &inputs[index + 1..] {
            let (x, y) = (x.min(y), x.max(y));
            let cells = random.iter().map(|one| cell(y, one) * CELLS + cell(x, one));
            pairs.push((dependence(CELLS * CELLS, cells, &errors), x, y));
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs.truncate(MAX_MAPS);
    let maps = pairs.into_iter().map(|(_, x, y)| {
        let mut cells = vec![Vec::new(); CELLS * CELLS];
        for (one, error) in random.iter().zip(&errors) {
            cells[cell(y, one) * CELLS + cell(x, one)].extend(*error);
        }
        let percentile = |errors: &mut Vec<f64>| {
            let at = errors.len().checked_sub(1)? * 99 / 100;
            Some(*errors.select_nth_unstable_by(at, f64::total_cmp).1)
        };
        let errors: Vec<Option<f64>> = cells.iter_mut().map(percentile).collect();
        let middles = |at: usize| {
            let middle = |cell: usize| domain.intervals[at].at((cell as f64 + 0.5) / CELLS as f64);
            (0..CELLS).map(middle).collect()
        };
        PairMap {
            x: interface.inputs[x].path.clone(),
            y: interface.inputs[y].path.clone(),
            columns: middles(x),
            rows: middles(y),
            errors: errors.chunks(CELLS).map(<[_]>::to_vec).collect(),
        }
    });
    maps.collect()
}

/// The largest error of the outputs.
fn largest_error(interface: &Interface, one: &Measured) -> Option<f64> {
    let errors = (0..interface.outputs.len()).filter_map(|output| one.error(interface, output));
    errors.reduce(f64::max)
}

/// How much errors depend on the cell: the variance of the cells' means, of the errors' logarithms.
fn dependence(count: usize, cells: impl Iterator<Item = usize>, errors: &[Option<f64>]) -> f64 {
    let mut sums = vec![(0.0, 0u32); count];
    for (cell, error) in cells.zip(errors) {
        if let Some(error) = error {
            sums[cell].0 += error.ln_1p();
            sums[cell].1 += 1;
        }
    }
    let filled = sums.iter().filter(|(_, count)| *count > 0);
    let means: Vec<f64> = filled.map(|(sum, count)| sum / f64::from(*count)).collect();
    let mean = means.iter().sum::<f64>() / means.len().max(1) as f64;
    means.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>() / means.len().max(1) as f64
}
