//! Values of a scene file that must lie in a range.

use glam::DVec3;
use toyproof_toml::{Table, Value};

use super::super::{Color, Point};

// The requirements on numbers in messages.
const FINITE: &str = "must be finite";
const POSITIVE: &str = "must be greater than 0";

/// Reads values that must lie in a range; others are reported.
pub(super) trait Checks {
    fn number(&mut self, key: &'static str) -> f64;

    /// Returns a number other than 0, if there is such a key; also a rejected one, which is reported.
    fn nonzero(&mut self, key: &'static str) -> Option<f64>;

    fn positive(&mut self, key: &'static str) -> f64;

    fn positive_or(&mut self, key: &'static str, default: f64) -> f64;

    /// Returns an angle in degrees, of at most one turn.
    fn degrees_or(&mut self, key: &'static str, default: f64) -> f64;

    /// Reads a horizontal angle of view, in degrees. Returns the distance at which a screen of width 2 fills
    /// it; `None` without the key. The distance of a rejected angle is returned, too.
    fn screen_distance(&mut self, key: &'static str) -> Option<f64>;

    /// Returns a number from 0 to 1.
    fn share_or(&mut self, key: &'static str, default: f64) -> f64;

    fn pair(&mut self, key: &'static str) -> [f64; 2];

    fn point(&mut self, key: &'static str) -> Point;

    /// Returns a point, if there is such a key; also a rejected one, which is reported.
    fn optional_point(&mut self, key: &'static str) -> Option<Point>;

    fn point_or(&mut self, key: &'static str, default: Point) -> Point;

    /// Returns the radii or the edges along three axes.
    fn lengths(&mut self, key: &'static str) -> Point;

    /// Returns a direction, normalized; it may have any length but 0.
    fn direction(&mut self, key: &'static str) -> Point;

    /// Like [`Checks::direction`], with a default.
    fn direction_or(&mut self, key: &'static str, default: Point) -> Point;

    fn color(&mut self, key: &'static str) -> Color;

    fn color_or(&mut self, key: &'static str, default: Color) -> Color;
}

impl Checks for Table<'_, '_> {
    fn number(&mut self, key: &'static str) -> f64 {
        checked(self, key, None, |x: &f64| (!x.is_finite()).then_some(FINITE), 1.0)
    }

    fn nonzero(&mut self, key: &'static str) -> Option<f64> {
        let located = self.optional::<f64>(key)?;
        if !(located.value.is_finite() && located.value != 0.0) {
            self.reject_value(key, &located, "must be finite and not 0");
        }
        Some(located.value)
    }

    fn positive(&mut self, key: &'static str) -> f64 {
        checked(self, key, None, |x| not_positive(*x), 1.0)
    }

    fn positive_or(&mut self, key: &'static str, default: f64) -> f64 {
        checked(self, key, Some(default), |x| not_positive(*x), default)
    }

    fn degrees_or(&mut self, key: &'static str, default: f64) -> f64 {
        let problem = |x: &f64| (!(-360.0..=360.0).contains(x)).then_some("must be from -360 to 360 degrees");
        checked(self, key, Some(default), problem, default)
    }

    fn screen_distance(&mut self, key: &'static str) -> Option<f64> {
        let distance = |fov: f64| {
            // libm's sine and cosine: the same bits on every platform.
            let (sine, cosine) = libm::sincos((0.5 * fov).to_radians());
            cosine / sine
        };
        let located = self.optional::<f64>(key)?;
        let fov = located.value;
        if !(fov > 0.0 && fov < 180.0 && distance(fov).is_finite()) {
            self.reject_value(key, &located, "must be greater than 0 and less than 180 degrees");
        }
        Some(distance(fov))
    }

    fn share_or(&mut self, key: &'static str, default: f64) -> f64 {
        let problem = |x: &f64| (!(0.0..=1.0).contains(x)).then_some("must be from 0 to 1");
        checked(self, key, Some(default), problem, default)
    }

    fn pair(&mut self, key: &'static str) -> [f64; 2] {
        checked(self, key, None, |pair| not_finite(pair), [1.0; 2])
    }

    fn point(&mut self, key: &'static str) -> Point {
        checked(self, key, None, |point| not_finite(point), [1.0; 3])
    }

    fn optional_point(&mut self, key: &'static str) -> Option<Point> {
        let located = self.optional::<Point>(key)?;
        if let Some(problem) = not_finite(&located.value) {
            self.reject_value(key, &located, problem);
        }
        Some(located.value)
    }

    fn point_or(&mut self, key: &'static str, default: Point) -> Point {
        checked(self, key, Some(default), |point| not_finite(point), default)
    }

    fn lengths(&mut self, key: &'static str) -> Point {
        let problem = |lengths: &Point| lengths.iter().copied().find_map(not_positive);
        checked(self, key, None, problem, [1.0; 3])
    }

    fn direction(&mut self, key: &'static str) -> Point {
        checked_direction(self, key, None)
    }

    fn direction_or(&mut self, key: &'static str, default: Point) -> Point {
        checked_direction(self, key, Some(default))
    }

    fn color(&mut self, key: &'static str) -> Color {
        checked(self, key, None, not_color, [1.0; 3])
    }

    fn color_or(&mut self, key: &'static str, default: Color) -> Color {
        checked(self, key, Some(default), not_color, default)
    }
}

/// Returns the value of a key: `default` if it is missing; `fallback` if it is rejected, or missing without a
/// default. Either is reported, so `fallback` only has to be valid.
fn checked<T: Value + Copy>(
    table: &mut Table,
    key: &'static str,
    default: Option<T>,
    problem: impl Fn(&T) -> Option<&'static str>,
    fallback: T,
) -> T {
    let located = match default {
        Some(_) => table.optional(key),
        None => table.required(key),
    };
    match located {
        None => default.unwrap_or(fallback),
        Some(located) => match problem(&located.value) {
            None => located.value,
            Some(problem) => {
                table.reject_value(key, &located, problem);
                fallback
            }
        },
    }
}

fn checked_direction(table: &mut Table, key: &'static str, default: Option<Point>) -> Point {
    let problem = |direction: &Point| {
        let is_zero = *direction == [0.0; 3];
        not_finite(direction).or(is_zero.then_some("must not be the zero vector"))
    };
    let vector = DVec3::from_array(checked(table, key, default, problem, [1.0; 3]));
    // Scaled first, so that no square overflows.
    (vector / vector.abs().max_element()).normalize().to_array()
}

fn not_positive(x: f64) -> Option<&'static str> {
    let problem = if x.is_finite() { POSITIVE } else { FINITE };
    (!(x.is_finite() && x > 0.0)).then_some(problem)
}

fn not_finite(numbers: &[f64]) -> Option<&'static str> {
    (!numbers.iter().all(|x| x.is_finite())).then_some(FINITE)
}

fn not_color(color: &Color) -> Option<&'static str> {
    let is_negative = color.iter().any(|x| *x < 0.0);
    not_finite(color).or(is_negative.then_some("must not be negative"))
}
