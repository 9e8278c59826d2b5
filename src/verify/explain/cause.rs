//! What a visible difference between f32 and f64 comes of.
//!
//! Many values part without harm: a random number that is another one, a component near zero. So f64 is made to follow f32 up to a
//! moment, and left alone from there on. Where that makes no more difference, what came of rounding lies before; the last moment from
//! which it still does is found by bisection, and the first value that parts after it is the cause.

use toyproof_eval::{Failure, Lead, Story, Teller};

use super::parting;
use super::step::{self, Moment};
use crate::compare::SEEN;

/// The moment of the cause; none where the colours do not differ visibly.
pub(super) fn find(
    doubles: &Teller<'_, f64>,
    pixel: [u32; 2],
    single: &Story,
    double: &Story,
) -> Result<Option<Moment>, Failure> {
    let whole = distance(single, double);
    if whole <= SEEN {
        return Ok(None);
    }
    let led = |events| {
        doubles.story(
            pixel,
            Some(Lead {
                story: single,
                events,
            }),
        )
    };
    // Led by so many events it still differs by half as much; by so many it does not.
    let (mut differs, mut agrees) = (0, single.happened.len());
    while agrees - differs > 1 {
        let middle = usize::midpoint(differs, agrees);
        if distance(single, &led(middle)?) >= whole.min(1.0) / 2.0 {
            differs = middle;
        } else {
            agrees = middle;
        }
    }
    let steps = step::merge(doubles.plot(), single, &led(differs)?);
    let parting = parting::find(doubles.plot(), &steps, true);
    let step = parting.map(|at| &steps[at]);
    // Without a value that parts, the event that made the difference itself.
    let step = step.or_else(|| steps.iter().filter(|step| step.single.is_some()).nth(differs));
    Ok(step.map(|step| step.moment.clone()))
}

/// How far two colours are apart, in the largest component; infinitely if one is NaN alone or discarded alone.
fn distance(single: &Story, double: &Story) -> f64 {
    match (single.colour, double.colour) {
        (None, None) => 0.0,
        (Some(single), Some(double)) => {
            let pairs = single.into_iter().zip(double);
            pairs
                .map(|(single, double)| step::distance(single, double))
                .fold(0.0, f64::max)
        }
        _ => f64::INFINITY,
    }
}
