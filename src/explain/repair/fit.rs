//! Fits numbers of edits to the wrong pixels by the secant method (Press et al., Numerical Recipes, §9.2),
//! for a group of edits side by side.

use super::group::{Group, Run};
use super::probe::Probes;
use super::term::Numbers;
use super::trials::one;

/// The number of probes from which a fit is started: those that are evaluated first.
const PROBES: usize = 16;

/// The largest number of steps, and the difference of colors at which they end.
const MAX_STEPS: u32 = 12;
const CONVERGED: f64 = 1e-10;

/// The largest number of pixels from which a fit is started.
const MAX_STARTS: usize = 2;

/// The number of decimal digits of a fitted number, and of one that is fitted to means.
const DIGITS: usize = 8;
const DIGITS_OF_MEANS: usize = 3;

/// A number to be fitted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// The place of the edit in its group.
    pub(super) candidate: usize,
    /// The number with which the edit changes nothing.
    pub(super) start: f64,
    /// The cost of the edit with a fitted number.
    pub(super) cost: u32,
}

impl Fit {
    fn run(&self, number: f64, probes: std::ops::Range<usize>) -> Run {
        Run {
            candidate: Some(self.candidate),
            numbers: one(number),
            probes,
        }
    }
}

/// A search for the zero of an error.
struct Secant {
    /// The index of the fit.
    fit: usize,
    error: ErrorOf,
    /// The last two numbers and their errors.
    at: [f64; 2],
    errors: [f64; 2],
}

/// The quantity that a number should make zero.
#[derive(Debug, Clone, Copy)]
enum ErrorOf {
    /// The distance of a component of the color of a probe from its target.
    Component { probe: usize, component: usize },
    /// The bias at the first probes.
    Mean,
}

impl ErrorOf {
    fn probes(self, probes: &Probes) -> std::ops::Range<usize> {
        match self {
            Self::Component { probe, .. } => probe..probe + 1,
            Self::Mean => 0..probes.screening(),
        }
    }

    /// The error, by the colors of its probes.
    fn of(self, probes: &Probes, colors: &[[f64; 3]]) -> Option<f64> {
        match self {
            Self::Component { probe, component } => {
                let target = probes.all[probe].target()[component];
                Some(colors.first()?[component] - target)
            }
            Self::Mean => probes.project(colors).map(|projection| projection.amplitude),
        }
    }
}

impl Secant {
    /// The number to try next; `None` if the search has ended.
    fn next(&self) -> Option<f64> {
        let ([a, b], [error_a, error_b]) = (self.at, self.errors);
        let next = b - error_b * (b - a) / (error_b - error_a);
        (error_b.abs() >= CONVERGED && next.is_finite()).then_some(next)
    }

    fn step(&mut self, number: f64, error: f64) {
        self.at = [self.at[1], number];
        self.errors = [self.errors[1], error];
    }

    /// The zero, if the search has found one.
    fn zero(&self) -> Option<f64> {
        (self.errors[1].abs() < 1e3 * CONVERGED).then_some(self.at[1])
    }
}

/// Returns numbers that make some wrong pixel right, each with the index of its fit. `before` are the colors
/// of the shader at the probes.
pub(super) fn fitted(
    probes: &Probes,
    group: &mut Group,
    fits: &[Fit],
    before: &[[f64; 3]],
) -> Vec<(usize, f64)> {
    let mut searches = if probes.are_means() {
        starts_of_means(probes, group, fits)
    } else {
        starts(probes, group, fits, before)
    };
    for _ in 0..MAX_STEPS {
        let next: Vec<(&mut Secant, f64)> = searches
            .iter_mut()
            .filter_map(|search| search.next().map(|number| (search, number)))
            .collect();
        if next.is_empty() {
            break;
        }
        let runs: Vec<Run> = next
            .iter()
            .map(|(search, number)| fits[search.fit].run(*number, search.error.probes(probes)))
            .collect();
        for ((search, number), colors) in next.into_iter().zip(group.colors(probes, &runs)) {
            // Without a number, the search ends here.
            let error = colors.and_then(|colors| search.error.of(probes, &colors));
            search.step(number, error.unwrap_or(f64::NAN));
        }
    }
    let digits = if probes.are_means() {
        DIGITS_OF_MEANS
    } else {
        DIGITS
    };
    let mut found: Vec<(usize, f64)> = searches
        .iter()
        .filter_map(|search| Some((search.fit, rounded(search.zero()?, digits))))
        .collect();
    found.dedup_by(|a, b| a.0 == b.0 && a.1.to_bits() == b.1.to_bits());
    found
}

/// Searches from those components of wrong pixels that depend on a number most, relative to the missing
/// difference.
fn starts(probes: &Probes, group: &mut Group, fits: &[Fit], before: &[[f64; 3]]) -> Vec<Secant> {
    let count = probes.all.len().min(PROBES);
    let step = |fit: &Fit| 1e-3 * fit.start.abs().max(0.1);
    let runs: Vec<Run> = fits
        .iter()
        .map(|fit| fit.run(fit.start + step(fit), 0..count))
        .collect();
    let mut searches = Vec::new();
    for (number, (fit, moved)) in fits.iter().zip(group.colors(probes, &runs)).enumerate() {
        let Some(moved) = moved.filter(|moved| moved.iter().flatten().all(|part| part.is_finite())) else {
            continue;
        };
        let mut components: Vec<(f64, usize, usize)> = Vec::new();
        for at in (0..count).filter(|&at| probes.all[at].is_wrong) {
            let target = probes.all[at].target();
            for i in 0..3 {
                let slope = (moved[at][i] - before[at][i]) / step(fit);
                let missing = target[i] - before[at][i];
                // A component at its limit says only how large a number must be at least.
                if slope.abs() > 1e-9 && missing.abs() > 1e-6 && (1e-6..1.0 - 1e-6).contains(&target[i]) {
                    components.push(((missing / slope).abs(), at, i));
                }
            }
        }
        components.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let places = [components.len() / 2, 0];
        for &(_, probe, component) in places
            .iter()
            .filter_map(|&at| components.get(at))
            .take(MAX_STARTS)
        {
            let error =
                |colors: &[[f64; 3]]| colors[probe][component] - probes.all[probe].target()[component];
            searches.push(Secant {
                fit: number,
                error: ErrorOf::Component { probe, component },
                at: [fit.start, fit.start + step(fit)],
                errors: [error(before), error(&moved)],
            });
        }
    }
    searches
}

/// Searches for numbers that remove the bias of a stochastic shader.
fn starts_of_means(probes: &Probes, group: &mut Group, fits: &[Fit]) -> Vec<Secant> {
    let error = ErrorOf::Mean;
    let ends = |fit: &Fit| [fit.start, fit.start + 0.05 * fit.start.abs().max(0.1)];
    let runs: Vec<Run> = fits
        .iter()
        .flat_map(|fit| ends(fit).map(|number| fit.run(number, error.probes(probes))))
        .collect();
    let errors: Vec<Option<f64>> = group
        .colors(probes, &runs)
        .into_iter()
        .map(|colors| error.of(probes, &colors?))
        .collect();
    let search = |(number, (fit, errors)): (usize, (&Fit, &[Option<f64>]))| match errors {
        &[Some(first), Some(second)] => Some(Secant {
            fit: number,
            error,
            at: ends(fit),
            errors: [first, second],
        }),
        _ => None,
    };
    fits.iter()
        .zip(errors.chunks(2))
        .enumerate()
        .filter_map(search)
        .collect()
}

/// Returns colors that make some wrong pixel right, one fitted number for each of its components, the
/// shortest decimals first.
pub(super) fn fitted_colors(
    probes: &Probes,
    group: &mut Group,
    candidate: usize,
    start: &Numbers,
    before: &[[f64; 3]],
) -> Vec<Numbers> {
    if probes.are_means() {
        return Vec::new();
    }
    let count = probes.all.len().min(PROBES);
    let mut colors = |numbers: &Numbers| {
        let run = Run {
            candidate: Some(candidate),
            numbers: *numbers,
            probes: 0..count,
        };
        group.run(probes, run)
    };
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

/// The short decimals next to a fitted number, the shortest first. A number that was fitted to means is known
/// less exactly.
pub(super) fn roundings(number: f64, is_of_means: bool) -> Vec<f64> {
    let (digits, tolerance) = if is_of_means {
        (DIGITS_OF_MEANS, 0.5)
    } else {
        (DIGITS, 2e-3)
    };
    let mut all: Vec<f64> = Vec::new();
    for digits in 1..digits {
        let rounded = rounded(number, digits);
        let is_near = (rounded - number).abs() <= tolerance * number.abs();
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

    fn zero(function: impl Fn(f64) -> f64, at: [f64; 2]) -> Option<f64> {
        let mut search = Secant {
            fit: 0,
            error: ErrorOf::Mean,
            at,
            errors: at.map(&function),
        };
        for _ in 0..MAX_STEPS {
            let Some(number) = search.next() else { break };
            search.step(number, function(number));
        }
        search.zero()
    }

    #[test]
    fn a_zero_is_found_and_rounded_as_an_author_would_write_it() {
        let zero = zero(|x| x * x - 0.49, [1.0, 1.001]).unwrap();
        assert!((zero - 0.7).abs() < 1e-9);
        assert_eq!(roundings(zero, false), [0.7]);
        assert_eq!(roundings(1.0 / 3.0, false).last(), Some(&0.333_333_3));
        assert_eq!(roundings(0.47, true), [0.5, 0.47]);
        assert_eq!(rounded(0.1 + 0.2, 12), 0.3);
    }

    #[test]
    fn a_function_without_a_zero_has_none() {
        assert_eq!(zero(|_| 1.0, [0.0, 1.0]), None);
        assert_eq!(zero(|x| x * x + 1.0, [1.0, 2.0]), None);
        assert_eq!(zero(|x| if x == 0.0 { 1.0 } else { f64::NAN }, [0.0, 1.0]), None);
    }
}
