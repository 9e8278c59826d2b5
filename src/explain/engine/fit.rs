//! Fits numbers of hypotheses to the wrong pixels by the secant method (Press et al., Numerical Recipes,
//! §9.2), for hypotheses side by side.

use std::ops::Range;

use super::probes::Probes;
use super::{Colors, Field, Numbers, Run, one};

/// The number of probes from which a fit is started: those that are evaluated first.
const PROBES: usize = 16;

/// The largest number of steps, and the difference of colors at which they end.
const MAX_STEPS: u32 = 12;
const CONVERGED: f64 = 1e-10;

/// The largest number of pixels from which a fit is started.
const MAX_STARTS: usize = 2;

/// How exactly fitted numbers are known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Precision {
    /// The number of decimal digits.
    digits: usize,
    /// The largest relative difference of a shorter number that an author may have written.
    tolerance: f64,
}

impl Precision {
    pub(crate) const EXACT: Self = Self {
        digits: 8,
        tolerance: 2e-3,
    };
    pub(crate) const OF_MEANS: Self = Self {
        digits: 3,
        tolerance: 0.5,
    };

    /// The precision of numbers that are fitted to these probes.
    pub(crate) fn at(probes: &Probes) -> Self {
        if probes.are_means() {
            Self::OF_MEANS
        } else {
            Self::EXACT
        }
    }

    /// The short decimals next to fitted numbers, the shortest first.
    pub(crate) fn shorter(self, numbers: &Numbers) -> Vec<Numbers> {
        let mut all: Vec<Numbers> = Vec::new();
        for digits in 1..self.digits {
            let rounded = numbers.map(|number| rounded(number, digits));
            let is_near =
                |(rounded, number): (&f64, &f64)| (rounded - number).abs() <= self.tolerance * number.abs();
            let is_same = |last: &Numbers| last.map(f64::to_bits) == rounded.map(f64::to_bits);
            if rounded.iter().zip(numbers).all(is_near) && !all.last().is_some_and(is_same) {
                all.push(rounded);
            }
        }
        all
    }
}

/// The multiples of a number of the scene among which the search for its value starts.
const MULTIPLES: [f64; 11] = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.35, 2.0, 4.0, 16.0, 64.0];

/// What is to be fitted.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fit {
    /// A number, near the one with which nothing changes.
    Number(f64),
    /// A number that may be far from this one.
    Multiple(f64),
    /// The components of a color, near these.
    Color(Numbers),
}

/// A search for the zeros of errors, each of which depends on a number of its own.
struct Search {
    /// The index of the fit, and the hypothesis.
    fit: usize,
    hypothesis: usize,
    errors: Vec<ErrorOf>,
    /// The last two vectors of numbers, and their errors.
    at: [Numbers; 2],
    values: [Numbers; 2],
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
    fn probes(self, probes: &Probes) -> Range<usize> {
        match self {
            Self::Component { probe, .. } => probe..probe + 1,
            Self::Mean => 0..probes.screening(),
        }
    }

    /// The error, by the colors of its probes; NaN if there is none.
    fn value(self, probes: &Probes, colors: &[[f64; 3]]) -> f64 {
        let value = match self {
            Self::Component { probe, component } => {
                let target = probes.all[probe].target()[component];
                colors.first().map(|color| color[component] - target)
            }
            Self::Mean => probes.project(colors).map(|projection| projection.amplitude),
        };
        value.unwrap_or(f64::NAN)
    }
}

impl Search {
    /// A search that has ended at these numbers.
    fn at_zero(fit: usize, hypothesis: usize, numbers: Numbers) -> Self {
        Self {
            fit,
            hypothesis,
            errors: vec![ErrorOf::Mean],
            at: [numbers; 2],
            values: [[0.0; 3]; 2],
        }
    }

    fn run(&self, numbers: Numbers, probes: &Probes) -> Run {
        Run {
            hypothesis: Some(self.hypothesis),
            numbers,
            probes: self.errors[0].probes(probes),
        }
    }

    fn values(&self, probes: &Probes, colors: Option<Colors>) -> Numbers {
        let colors = colors.unwrap_or_default();
        let value = |i: usize| {
            self.errors
                .get(i)
                .map_or(0.0, |error| error.value(probes, &colors))
        };
        std::array::from_fn(value)
    }

    /// The numbers to try next; `None` if the search has ended.
    fn next(&self) -> Option<Numbers> {
        let ([a, b], [error_a, error_b]) = (self.at, self.values);
        let next = std::array::from_fn(|i| {
            if error_b[i].abs() < CONVERGED {
                b[i]
            } else {
                b[i] - error_b[i] * (b[i] - a[i]) / (error_b[i] - error_a[i])
            }
        });
        let has_ended = error_b.iter().all(|error| error.abs() < CONVERGED);
        (!has_ended && next.iter().all(|number: &f64| number.is_finite())).then_some(next)
    }

    fn step(&mut self, numbers: Numbers, values: Numbers) {
        self.at = [self.at[1], numbers];
        self.values = [self.values[1], values];
    }

    /// The zero, if the search has found one.
    fn zero(&self) -> Option<Numbers> {
        let is_zero = |error: &f64| error.abs() < 1e3 * CONVERGED;
        self.values[1].iter().all(is_zero).then_some(self.at[1])
    }
}

/// Returns numbers that make some wrong pixel right, each with the index of its fit. The fits are given with
/// their hypotheses.
pub(crate) fn fitted(probes: &Probes, field: &mut dyn Field, fits: &[(usize, Fit)]) -> Vec<(usize, Numbers)> {
    let mut searches = if probes.are_means() {
        starts_of_means(probes, field, fits)
    } else {
        starts(probes, field, fits)
    };
    for _ in 0..MAX_STEPS {
        let next = searches
            .iter_mut()
            .filter_map(|search| search.next().map(|numbers| (search, numbers)));
        let next: Vec<(&mut Search, Numbers)> = next.collect();
        if next.is_empty() {
            break;
        }
        let runs: Vec<Run> = next
            .iter()
            .map(|(search, numbers)| search.run(*numbers, probes))
            .collect();
        for ((search, numbers), colors) in next.into_iter().zip(field.colors(probes, &runs)) {
            // Without a color, the search ends here.
            let values = search.values(probes, colors);
            search.step(numbers, values);
        }
    }
    let Precision { digits, .. } = Precision::at(probes);
    let zeros = searches
        .iter()
        .filter_map(|search| Some((search.fit, search.zero()?.map(|number| rounded(number, digits)))));
    let mut found: Vec<(usize, Numbers)> = zeros.collect();
    found.dedup_by(|a, b| a.0 == b.0 && a.1.map(f64::to_bits) == b.1.map(f64::to_bits));
    found
}

/// The numbers near which each fit starts, and the colors there at the first probes.
fn bases(probes: &Probes, field: &mut dyn Field, fits: &[(usize, Fit)]) -> Vec<(Numbers, Colors)> {
    let count = probes.all.len().min(PROBES);
    let before: Colors = probes.all[..count].iter().map(|probe| probe.before).collect();
    let base = |&(hypothesis, fit): &(usize, Fit)| {
        let Fit::Multiple(number) = fit else {
            return (fit.start(), before.clone());
        };
        let runs = MULTIPLES.map(|multiple| Run {
            hypothesis: Some(hypothesis),
            numbers: one(multiple * number),
            probes: 0..count,
        });
        let colors = field.colors(probes, &runs).into_iter().zip(&runs);
        let remaining = |colors: &[[f64; 3]]| {
            let outcome = probes.outcome(colors);
            outcome.map_or(f64::INFINITY, |outcome| outcome.remaining)
        };
        let all = colors.filter_map(|(colors, run)| Some((run.numbers, colors?)));
        let best = all.min_by(|(_, a), (_, b)| remaining(a).total_cmp(&remaining(b)));
        best.unwrap_or_else(|| (fit.start(), before.clone()))
    };
    fits.iter().map(base).collect()
}

impl Fit {
    fn start(self) -> Numbers {
        match self {
            Self::Number(number) | Self::Multiple(number) => one(number),
            Self::Color(color) => color,
        }
    }

    /// The second numbers of a search that starts at these.
    fn moved(self, start: Numbers, by: f64) -> Numbers {
        let moved = start.map(|number| number + by * number.abs().max(0.1));
        match self {
            Self::Color(_) => moved,
            _ => one(moved[0]),
        }
    }
}

/// Searches from those components of wrong pixels that depend on a number most, relative to the missing
/// difference; of a color, from the first pixel all of whose components depend on it.
fn starts(probes: &Probes, field: &mut dyn Field, fits: &[(usize, Fit)]) -> Vec<Search> {
    let count = probes.all.len().min(PROBES);
    let bases = bases(probes, field, fits);
    let runs = fits
        .iter()
        .zip(&bases)
        .map(|(&(hypothesis, fit), (base, _))| Run {
            hypothesis: Some(hypothesis),
            numbers: fit.moved(*base, 1e-3),
            probes: 0..count,
        });
    let runs: Vec<Run> = runs.collect();
    let mut searches = Vec::new();
    for (number, (moved, run)) in field.colors(probes, &runs).into_iter().zip(&runs).enumerate() {
        let (base, before) = &bases[number];
        let Some(moved) = moved.filter(|moved| moved.iter().flatten().all(|part| part.is_finite())) else {
            continue;
        };
        let (hypothesis, fit) = fits[number];
        if let Fit::Multiple(_) = fit {
            // One of the multiples may be the number: nothing is missing there from which to search.
            searches.push(Search::at_zero(number, hypothesis, *base));
        }
        let mut search = |errors: Vec<(usize, usize)>| {
            let error = |(probe, component)| ErrorOf::Component { probe, component };
            let mut search = Search {
                fit: number,
                hypothesis,
                errors: errors.into_iter().map(error).collect(),
                at: [*base, run.numbers],
                values: [[0.0; 3]; 2],
            };
            let ErrorOf::Component { probe, .. } = search.errors[0] else {
                return;
            };
            search.values = [before, &moved].map(|colors| search.values(probes, Some(vec![colors[probe]])));
            searches.push(search);
        };
        let wrong = (0..count).filter(|&at| probes.all[at].is_wrong);
        let change = |at: usize, i: usize| moved[at][i] - before[at][i];
        if let Fit::Color(_) = fit {
            let depends = |&at: &usize| (0..3).all(|i| change(at, i).abs() > 1e-9);
            if let Some(at) = wrong.into_iter().find(depends) {
                search((0..3).map(|i| (at, i)).collect());
            }
            continue;
        }
        let step = run.numbers[0] - base[0];
        let mut components: Vec<(f64, usize, usize)> = Vec::new();
        for at in wrong {
            let target = probes.all[at].target();
            for i in 0..3 {
                let slope = change(at, i) / step;
                let missing = target[i] - before[at][i];
                // A component at its limit says only how large a number must be at least.
                if slope.abs() > 1e-9 && missing.abs() > 1e-6 && (1e-6..1.0 - 1e-6).contains(&target[i]) {
                    components.push(((missing / slope).abs(), at, i));
                }
            }
        }
        components.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let places = [components.len() / 2, 0]
            .into_iter()
            .filter_map(|at| components.get(at));
        for &(_, probe, component) in places.take(MAX_STARTS) {
            search(vec![(probe, component)]);
        }
    }
    searches
}

/// Searches for numbers that remove the bias of a stochastic shader, whose colors are not fitted.
fn starts_of_means(probes: &Probes, field: &mut dyn Field, fits: &[(usize, Fit)]) -> Vec<Search> {
    let numbers = fits
        .iter()
        .enumerate()
        .filter(|(_, (_, fit))| !matches!(fit, Fit::Color(_)));
    let mut searches: Vec<Search> = numbers
        .map(|(number, &(hypothesis, fit))| Search {
            fit: number,
            hypothesis,
            errors: vec![ErrorOf::Mean],
            at: [fit.start(), fit.moved(fit.start(), 0.05)],
            values: [[f64::NAN; 3]; 2],
        })
        .collect();
    let runs: Vec<Run> = searches
        .iter()
        .flat_map(|search| search.at.map(|numbers| search.run(numbers, probes)))
        .collect();
    let mut colors = field.colors(probes, &runs).into_iter();
    for search in &mut searches {
        search.values = [(); 2].map(|()| search.values(probes, colors.next().flatten()));
    }
    searches
}

/// Rounds a number to some decimal digits.
pub(crate) fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zero(function: impl Fn(f64) -> f64, at: [f64; 2]) -> Option<f64> {
        let mut search = Search {
            fit: 0,
            hypothesis: 0,
            errors: vec![ErrorOf::Mean],
            at: at.map(one),
            values: at.map(|at| one(function(at))),
        };
        for _ in 0..MAX_STEPS {
            let Some(numbers) = search.next() else { break };
            search.step(numbers, one(function(numbers[0])));
        }
        search.zero().map(|[zero, ..]| zero)
    }

    #[test]
    fn a_zero_is_found_and_rounded_as_an_author_would_write_it() {
        let zero = zero(|x| x * x - 0.49, [1.0, 1.001]).unwrap();
        assert!((zero - 0.7).abs() < 1e-9);
        assert_eq!(Precision::EXACT.shorter(&one(zero)), [one(0.7)]);
        assert_eq!(
            Precision::EXACT.shorter(&one(1.0 / 3.0)).last(),
            Some(&one(0.333_333_3))
        );
        assert_eq!(Precision::OF_MEANS.shorter(&one(0.47)), [one(0.5), one(0.47)]);
        assert_eq!(rounded(0.1 + 0.2, 12), 0.3);
    }

    #[test]
    fn a_function_without_a_zero_has_none() {
        assert_eq!(zero(|_| 1.0, [0.0, 1.0]), None);
        assert_eq!(zero(|x| x * x + 1.0, [1.0, 2.0]), None);
        assert_eq!(zero(|x| if x == 0.0 { 1.0 } else { f64::NAN }, [0.0, 1.0]), None);
    }
}
