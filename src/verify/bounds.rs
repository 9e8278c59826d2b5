//! The bounds of the search for an explanation: loop iterations are counted, so that the result does not
//! depend on the load of the machine; only a hang exceeds the deadline.

use std::time::{Duration, Instant};

/// The evaluator's time limit as a multiple of the GPU's: a slow evaluator is not the shader's fault.
pub const EVALUATOR_TIME_FACTOR: u32 = 4;

/// The factor by which a pixel of an edited shader, or of a shader in another frame, may run more loop
/// iterations than the shader's pixels do.
const ITERATION_FACTOR: u32 = 8;

/// The number of loop iterations of a pixel that an image may always have: twice what Mesa before version 23
/// allows. A pixel that reaches the limit takes milliseconds.
pub const MIN_IMAGE_ITERATIONS: u32 = 1 << 17;

/// The number of loop iterations after which a pixel of a mutant, of a variant of a reference or of a shader
/// with other random numbers is not evaluated further: so many take seconds.
pub const MAX_ITERATIONS: u32 = 1 << 22;

/// The number of loop iterations after which a pixel is not traced: recording its values takes seconds.
pub const MAX_TRACED_ITERATIONS: u32 = 1 << 18;

/// The time limit for explaining a difference, which only a hang reaches.
pub const EXPLANATION_TIMEOUT: Duration = Duration::from_secs(600);

/// The time limit for each unit of a search's budget, in seconds. A unit takes a second on an idle core, and
/// machines are seldom fifty times slower.
const TIMEOUT_PER_UNIT: f64 = 60.0;

/// The largest time for a search: three years.
const MAX_SEARCH_SECONDS: f64 = 1e8;

/// The largest number of loop iterations of a pixel of an edited shader that is evaluated at few pixels, by
/// the number of the shader's iterations.
#[must_use]
pub fn iterations_of_edited(iterations: u32, least: u32) -> u32 {
    iterations.saturating_mul(ITERATION_FACTOR).max(least)
}

/// The largest number of loop iterations of a pixel of an edited shader whose whole image is evaluated:
/// pixels that were not tried may need more.
#[must_use]
pub fn iterations_of_image(iterations: u32) -> u32 {
    iterations_of_edited(iterations, MIN_IMAGE_ITERATIONS)
}

/// The deadline of an explanation with a search of this budget.
#[must_use]
pub fn explanation_deadline(budget: f64) -> Instant {
    // A budget from the command line may be any number.
    let search = (TIMEOUT_PER_UNIT * budget).clamp(0.0, MAX_SEARCH_SECONDS);
    let search = Duration::try_from_secs_f64(search).unwrap_or(Duration::ZERO);
    Instant::now() + EXPLANATION_TIMEOUT + search
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edited_shaders_may_run_longer_than_the_shader_but_not_for_ever() {
        assert_eq!(iterations_of_edited(1000, 2000), 8000);
        assert_eq!(iterations_of_edited(10, 2000), 2000);
        assert_eq!(iterations_of_edited(u32::MAX / 2, 2000), u32::MAX);
        assert_eq!(iterations_of_image(10), 131_072);
    }

    #[test]
    fn a_larger_budget_has_a_later_deadline_whatever_it_is() {
        let left = |budget| explanation_deadline(budget) - Instant::now();
        assert!(left(0.0) <= EXPLANATION_TIMEOUT && left(5.0) > EXPLANATION_TIMEOUT);
        assert!(left(1e300) > left(1e5));
        assert!(left(f64::NAN) <= EXPLANATION_TIMEOUT);
    }
}
