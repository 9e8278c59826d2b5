//! The errors of a function over all arguments.

use std::fmt;

use toyproof::diagnostic::grouped;

use super::arguments::Range;
use super::function::Function;
use super::precision::{Permitted, error, is_rounded};

/// The smallest magnitude of usual operands: next to zero, a small absolute error is one of many units.
const SMALLEST_USUAL: f32 = 1.0 / 1024.0;

/// The maximum number of operands that are listed.
const MAX_LISTED: usize = 2;

/// The errors of a function. Cases whose operands or exact value are not finite floats are left out:
/// infinities and NaN may be assumed not to occur.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Errors {
    /// The cases with a finite exact value.
    pub cases: usize,
    /// Those whose result is not the float next to the exact value.
    pub not_rounded: usize,
    /// The largest error among usual operands, in units in the last place, and the operands.
    pub usual: Option<(f64, Vec<f32>)>,
    /// The largest error among all others.
    pub elsewhere: Option<f64>,
    /// The largest error among usual operands as a share of the permitted one.
    pub share: f64,
    /// The cases in which the result is not permitted.
    pub beyond: usize,
    /// The operands of the first of them, and the result.
    pub first_beyond: Option<(Vec<f32>, f32)>,
}

impl Errors {
    /// Compares the bits of the results with the exact values.
    pub fn new(function: &Function, arguments: &[Vec<f32>], results: &[u32]) -> Self {
        let mut errors = Self::default();
        for (operands, &bits) in arguments.iter().zip(results) {
            errors.add(function, operands, f32::from_bits(bits));
        }
        errors
    }

    /// Whether all results are rounded correctly, as strict runs require.
    pub fn describe_rounding(&self) -> String {
        if self.not_rounded == 0 {
            return format!("all of {} cases", grouped(self.cases as u64));
        }
        let usual = self.usual.as_ref().map_or(0.0, |&(largest, _)| largest);
        format!(
            "**not** in {} of {} cases, at most {}",
            grouped(self.not_rounded as u64),
            grouped(self.cases as u64),
            Ulps(usual.max(self.elsewhere.unwrap_or(0.0)))
        )
    }

    fn add(&mut self, function: &Function, operands: &[f32], result: f32) {
        let is_finite = |exact: &f64| exact.is_finite() && (*exact as f32).is_finite();
        let exact = value(function, operands);
        if operands.iter().any(|operand| !operand.is_finite()) || !is_finite(&exact) {
            return;
        }
        // A denormal operand may also be zero.
        let candidates = flushings(operands)
            .into_iter()
            .map(|operands| value(function, &operands));
        let (finite, other): (Vec<f64>, Vec<f64>) = candidates.partition(is_finite);
        if !other.is_empty() && !result.is_finite() {
            return;
        }
        self.cases += 1;
        self.not_rounded += usize::from(!finite.iter().any(|&exact| is_rounded(result, exact)));
        let ulps = finite
            .iter()
            .map(|&exact| error(result, exact))
            .fold(f64::INFINITY, f64::min);
        let is_usual = |(operand, &(low, high)): (&f32, &Range)| {
            (low..=high).contains(operand) && operand.abs() >= SMALLEST_USUAL
        };
        let is_usual = operands.iter().zip(function.usual).all(is_usual);
        if !is_usual {
            self.elsewhere = Some(self.elsewhere.unwrap_or(0.0).max(ulps));
        } else if self.usual.as_ref().is_none_or(|&(largest, _)| ulps > largest) {
            self.usual = Some((ulps, operands.to_vec()));
        }
        let share = self.check(function, operands, result, &finite);
        if is_usual {
            self.share = self.share.max(share);
        }
    }

    /// Compares a result with the permitted ones of the exact values, of which any may be meant. Returns the
    /// error as a share of the permitted one, or 0 if that is not limited, or if a flushed denormal exceeds
    /// it.
    fn check(&mut self, function: &Function, operands: &[f32], result: f32, exact: &[f64]) -> f64 {
        let limits: Vec<_> = operands.iter().copied().map(Permitted::operand).collect();
        let permitted = (function.permitted)(&limits);
        if !exact
            .iter()
            .any(|&exact| permitted.contains(result, exact, function.is_inherited()))
        {
            self.beyond += 1;
            self.first_beyond
                .get_or_insert_with(|| (operands.to_vec(), result));
            return 0.0;
        }
        let shares = exact
            .iter()
            .map(|&exact| (f64::from(result) - exact).abs() / permitted.largest_error(exact));
        shares.filter(|share| *share <= 1.0).fold(0.0, f64::max)
    }
}

fn value(function: &Function, operands: &[f32]) -> f64 {
    let operands: Vec<f64> = operands.iter().copied().map(f64::from).collect();
    (function.exact)(&operands)
}

/// The operands as they are, with all denormals flushed, and with each one of them flushed.
fn flushings(operands: &[f32]) -> Vec<Vec<f32>> {
    let flush = |value: f32| {
        if value.is_subnormal() {
            0.0_f32.copysign(value)
        } else {
            value
        }
    };
    let mut all = vec![operands.to_vec()];
    let denormals = operands.iter().filter(|operand| operand.is_subnormal()).count();
    if denormals > 0 {
        all.push(operands.iter().copied().map(flush).collect());
    }
    if denormals > 1 {
        all.extend((0..operands.len()).map(|only| {
            let mut one = operands.to_vec();
            one[only] = flush(one[only]);
            one
        }));
    }
    all
}

/// An error in units in the last place, with the digits that matter.
struct Ulps(f64);

impl fmt::Display for Ulps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            error if error.is_infinite() => f.write_str("infinity or NaN"),
            error if error < 100.0 => write!(f, "{error:.2} ULP"),
            error if error < 1e5 => write!(f, "{} ULP", grouped(error as u64)),
            error => write!(f, "{error:.0e} ULP"),
        }
    }
}

/// Numbers as arguments.
struct List<'a>(&'a [f32]);

impl fmt::Display for List<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, value) in self.0.iter().enumerate() {
            write!(f, "{}{value:?}", if index > 0 { ", " } else { "" })?;
        }
        Ok(())
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.not_rounded == 0 {
            f.write_str("all rounded correctly")?;
        } else {
            if let Some((largest, operands)) = &self.usual {
                write!(f, "at most {}", Ulps(*largest))?;
                if operands.len() <= MAX_LISTED {
                    write!(f, " at ({})", List(operands))?;
                }
            }
            if let Some(elsewhere) = self.elsewhere {
                write!(f, ", elsewhere {}", Ulps(elsewhere))?;
            }
            let share = 100.0 * self.not_rounded as f64 / self.cases as f64;
            write!(f, "; {share:.1} % not rounded correctly")?;
        }
        match &self.first_beyond {
            None if self.not_rounded == 0 => f.write_str("; **kept**"),
            None => write!(f, "; **kept**, {:.1} % of it used", 100.0 * self.share),
            Some((operands, result)) => write!(
                f,
                "; **not kept** in {} of {} cases, such as ({}), which gives {result:?}",
                grouped(self.beyond as u64),
                grouped(self.cases as u64),
                List(operands)
            ),
        }
    }
}
