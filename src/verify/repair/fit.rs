//! Fits one number of an edit to the wrong pixels by the secant method (Press et al., Numerical Recipes,
//! §9.2).

use toyproof_eval::PointEvaluator;

use super::probe::{FIRST_MEANS, Probes};
use super::schema::Selection;
use super::term::Numbers;

/// The number of probes that are evaluated for a fit: those that are evaluated first.
const PROBES: usize = 16;

/// The largest number of steps, and the difference of colors at which they end.
const MAX_STEPS: u32 = 12;
const CONVERGED: f64 = 1e-10;

/// The largest number of pixels from which a fit is started.
const MAX_STARTS: usize = 2;

/// The numbers of decimal digits to which a fitted number is rounded: authors write short numbers.
const DIGITS: std::ops::RangeInclusive<usize> = 1..=8;

/// Returns the numbers that make some wrong pixel right, each followed by what it may be a rounding of.
/// `start` is the number with which the edit changes nothing, `before` the colors there.
pub(super) fn fitted(
    probes: &Probes,
    evaluator: &mut PointEvaluator,
    selection: impl Fn(f64) -> Selection,
    start: f64,
    before: &[[f64; 3]],
) -> Vec<f64> {
    if probes.are_means() {
        return fitted_to_means(probes, evaluator, selection, start);
    }
    let count = probes.all.len().min(PROBES);
    let mut colors = |number: f64| {
        let colors = probes.first_colors(evaluator, &selection(number), count)?;
        colors
            .iter()
            .flatten()
            .all(|part| part.is_finite())
            .then_some(colors)
    };
    let step = 1e-3 * start.abs().max(0.1);
    let Some(moved) = colors(start + step) else {
        return Vec::new();
    };
    // The components that depend on the number most, relative to what is missing.
    let mut components: Vec<(f64, usize, usize)> = Vec::new();
    for (at, probe) in probes.all[..count]
        .iter()
        .enumerate()
        .filter(|(_, probe)| probe.is_wrong)
    {
        let target = probe.target();
        for i in 0..3 {
            let slope = (moved[at][i] - before[at][i]) / step;
            let missing = target[i] - before[at][i];
            // A component at its limit says only how large a number must be at least.
            if slope.abs() > 1e-9 && missing.abs() > 1e-6 && (1e-6..1.0 - 1e-6).contains(&target[i]) {
                components.push(((missing / slope).abs(), at, i));
            }
        }
    }
    components.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let middle = components.len() / 2;
    let starts = [components.get(middle), components.first()];
    let mut numbers = Vec::new();
    for &(_, at, i) in starts.into_iter().flatten().take(MAX_STARTS) {
        let target = probes.all[at].target()[i];
        let mut error = |number: f64| Some(colors(number)?[at][i] - target);
        let first = before[at][i] - target;
        if let Some(number) = secant(&mut error, [start, start + step], [first, moved[at][i] - target]) {
            numbers.extend(roundings(number));
        }
    }
    numbers.dedup_by(|a, b| a.to_bits() == b.to_bits());
    numbers
}

/// Returns the numbers that remove the bias of a stochastic shader from some of its pixels.
fn fitted_to_means(
    probes: &Probes,
    evaluator: &mut PointEvaluator,
    selection: impl Fn(f64) -> Selection,
    start: f64,
) -> Vec<f64> {
    let count = probes.all.len().min(FIRST_MEANS);
    let mut amplitude = |number: f64| {
        let colors = probes.first_colors(evaluator, &selection(number), count)?;
        probes.project(&colors).map(|projection| projection.amplitude)
    };
    let second = start + 0.05 * start.abs().max(0.1);
    let errors = [start, second].map(&mut amplitude);
    let [Some(first), Some(moved)] = errors else {
        return Vec::new();
    };
    let zero = secant(&mut amplitude, [start, second], [first, moved]);
    zero.map_or_else(Vec::new, |number| {
        [1, 2, 3].map(|digits| rounded(number, digits)).to_vec()
    })
}

/// Returns colors that make some wrong pixel right, one fitted number for each of its components, the
/// shortest decimals first.
pub(super) fn fitted_colors(
    probes: &Probes,
    evaluator: &mut PointEvaluator,
    selection: impl Fn(&Numbers) -> Selection,
    start: &Numbers,
    before: &[[f64; 3]],
) -> Vec<Numbers> {
    if probes.are_means() {
        return Vec::new();
    }
    let count = probes.all.len().min(PROBES);
    let mut colors = |numbers: &Numbers| probes.first_colors(evaluator, &selection(numbers), count);
    let step = start.map(|start| 1e-3 * start.abs().max(0.1));
    let second: Numbers = std::array::from_fn(|i| start[i] + step[i]);
    let Some(moved) = colors(&second) else {
        return Vec::new();
    };
    let depends = |at: usize| (0..3).all(|i| (moved[at][i] - before[at][i]).abs() > 1e-9);
    let Some(at) = (0..count).find(|&at| probes.all[at].is_wrong && depends(at)) else {
        return Vec::new();
    };
    let target = probes.all[at].target();
    // Each component by itself, all three in one evaluation.
    let error = |colors: &[[f64; 3]]| -> Numbers { std::array::from_fn(|i| colors[at][i] - target[i]) };
    let (mut last, mut numbers) = (*start, second);
    let (mut last_error, mut errors) = (error(before), error(&moved));
    for _ in 0..MAX_STEPS {
        let next: Numbers = std::array::from_fn(|i| {
            let slope = (errors[i] - last_error[i]) / (numbers[i] - last[i]);
            if errors[i].abs() < CONVERGED {
                numbers[i]
            } else {
                numbers[i] - errors[i] / slope
            }
        });
        let Some(colors) = next
            .iter()
            .all(|number| number.is_finite())
            .then(|| colors(&next))
            .flatten()
        else {
            return Vec::new();
        };
        (last, numbers) = (numbers, next);
        (last_error, errors) = (errors, error(&colors));
        if errors.iter().all(|error| error.abs() < CONVERGED) {
            break;
        }
    }
    let mut found: Vec<Numbers> = [2, 3, 4, 8]
        .map(|digits| numbers.map(|number| rounded(number, digits)))
        .into();
    found.dedup();
    found
}

/// Finds a zero of a function from two arguments and their values.
fn secant(error: &mut dyn FnMut(f64) -> Option<f64>, mut at: [f64; 2], mut errors: [f64; 2]) -> Option<f64> {
    for _ in 0..MAX_STEPS {
        let next = at[1] - errors[1] * (at[1] - at[0]) / (errors[1] - errors[0]);
        if !next.is_finite() {
            return None;
        }
        let new = error(next)?;
        (at, errors) = ([at[1], next], [errors[1], new]);
        if new.abs() < CONVERGED {
            return Some(next);
        }
    }
    (errors[1].abs() < 1e3 * CONVERGED).then_some(at[1])
}

/// The short decimals next to a number, the shortest first, as far as they are near enough to be meant.
fn roundings(number: f64) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::new();
    for digits in DIGITS {
        let rounded = rounded(number, digits);
        let is_near = (rounded - number).abs() <= 2e-3 * number.abs();
        if is_near && all.last().is_none_or(|last| last.to_bits() != rounded.to_bits()) {
            all.push(rounded);
        }
    }
    all
}

/// Rounds a number to some decimal digits.
pub(super) fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_is_found_and_rounded_as_an_author_would_write_it() {
        let mut error = |x: f64| Some(x * x - 0.49);
        let zero = secant(&mut error, [1.0, 1.001], [0.51, 0.512_001]).unwrap();
        assert!((zero - 0.7).abs() < 1e-9);
        assert_eq!(roundings(zero), [0.7]);
        assert_eq!(roundings(1.0 / 3.0).last(), Some(&0.333_333_33));
        assert_eq!(rounded(0.1 + 0.2, 12), 0.3);
    }

    #[test]
    fn a_function_without_a_zero_has_none() {
        assert_eq!(secant(&mut |_| Some(1.0), [0.0, 1.0], [1.0, 1.0]), None);
        assert_eq!(secant(&mut |x| Some(x * x + 1.0), [1.0, 2.0], [2.0, 5.0]), None);
    }
}
