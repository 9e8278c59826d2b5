//! Values of a scene file that must lie in a range.

use glam::DVec3;
use toyproof_diagnostic::grouped;
use toyproof_image::{MAX_PIXELS, MAX_SIDE, check_size};

use super::super::{Color, Point};
use crate::toml_reader::{Located, Table, Value};

/// What a message requires of numbers.
const FINITE: &str = "must be finite";
const POSITIVE: &str = "must be greater than 0";

impl Table<'_, '_> {
    /// Returns the value of a key, or a default if it is missing or rejected, which is reported.
    fn checked<T: Value + Copy>(
        &mut self,
        key: &'static str,
        default: Option<T>,
        problem: impl Fn(&T) -> Option<&'static str>,
        fallback: T,
    ) -> T {
        let located = match default {
            Some(_) => self.optional(key),
            None => self.required(key),
        };
        match located {
            None => default.unwrap_or(fallback),
            Some(located) => match problem(&located.value) {
                None => located.value,
                Some(problem) => {
                    self.reject_value(key, &located, problem);
                    fallback
                }
            },
        }
    }

    /// Rejects a value; `problem` follows the key in the message.
    pub fn reject_value<T>(&self, key: &str, located: &Located<T>, problem: &str) {
        let found = self.excerpt(located.span);
        self.reject(located.span, format!("`{key}` {problem}, found {found}"), "");
    }

    pub(super) fn number(&mut self, key: &'static str) -> f64 {
        self.checked(key, None, |x: &f64| (!x.is_finite()).then_some(FINITE), 1.0)
    }

    /// Returns a number other than 0, if there is such a key.
    pub(super) fn nonzero(&mut self, key: &'static str) -> Option<f64> {
        let located = self.optional::<f64>(key)?;
        if !(located.value.is_finite() && located.value != 0.0) {
            self.reject_value(key, &located, "must be finite and not 0");
        }
        Some(located.value)
    }

    pub(super) fn positive(&mut self, key: &'static str) -> f64 {
        self.checked(key, None, |x| not_positive(*x), 1.0)
    }

    pub(super) fn positive_or(&mut self, key: &'static str, default: f64) -> f64 {
        self.checked(key, Some(default), |x| not_positive(*x), default)
    }

    /// Returns an angle in degrees, of at most one turn.
    pub(super) fn degrees_or(&mut self, key: &'static str, default: f64) -> f64 {
        let problem = |x: &f64| (!(-360.0..=360.0).contains(x)).then_some("must be from -360 to 360 degrees");
        self.checked(key, Some(default), problem, default)
    }

    /// Returns the distance of a screen of width 2 that fills a horizontal angle of view, if there is such a
    /// key, in degrees.
    pub(super) fn field_of_view(&mut self, key: &'static str) -> Option<f64> {
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

    /// Returns a number from 0 to 1.
    pub(super) fn share_or(&mut self, key: &'static str, default: f64) -> f64 {
        let problem = |x: &f64| (!(0.0..=1.0).contains(x)).then_some("must be from 0 to 1");
        self.checked(key, Some(default), problem, default)
    }

    pub(super) fn pair(&mut self, key: &'static str) -> [f64; 2] {
        self.checked(key, None, |pair| not_finite(pair), [1.0; 2])
    }

    pub(super) fn point(&mut self, key: &'static str) -> Point {
        self.checked(key, None, |point| not_finite(point), [1.0; 3])
    }

    /// Returns a point, if there is such a key.
    pub(super) fn optional_point(&mut self, key: &'static str) -> Option<Point> {
        let located = self.optional::<Point>(key)?;
        if let Some(problem) = not_finite(&located.value) {
            self.reject_value(key, &located, problem);
        }
        Some(located.value)
    }

    pub(super) fn point_or(&mut self, key: &'static str, default: Point) -> Point {
        self.checked(key, Some(default), |point| not_finite(point), default)
    }

    /// Returns the radii or the edges along three axes.
    pub(super) fn lengths(&mut self, key: &'static str) -> Point {
        let problem = |lengths: &Point| lengths.iter().copied().find_map(not_positive);
        self.checked(key, None, problem, [1.0; 3])
    }

    /// Returns a direction, normalized; it may have any length but 0.
    pub(super) fn direction(&mut self, key: &'static str) -> Point {
        self.checked_direction(key, None)
    }

    /// Like [`Table::direction`], with a default.
    pub(super) fn direction_or(&mut self, key: &'static str, default: Point) -> Point {
        self.checked_direction(key, Some(default))
    }

    fn checked_direction(&mut self, key: &'static str, default: Option<Point>) -> Point {
        let problem = |direction: &Point| {
            let is_zero = *direction == [0.0; 3];
            not_finite(direction).or(is_zero.then_some("must not be the zero vector"))
        };
        let vector = DVec3::from_array(self.checked(key, default, problem, [1.0; 3]));
        (vector / vector.abs().max_element()).normalize().to_array()
    }

    pub(super) fn color(&mut self, key: &'static str) -> Color {
        self.checked(key, None, not_color, [1.0; 3])
    }

    pub(super) fn color_or(&mut self, key: &'static str, default: Color) -> Color {
        self.checked(key, Some(default), not_color, default)
    }

    /// Returns a whole number in a range.
    pub fn count_or(&mut self, key: &'static str, [min, max]: [u32; 2], default: u32) -> u32 {
        let Some(located) = self.optional::<i64>(key) else {
            return default;
        };
        match u32::try_from(located.value) {
            Ok(count) if (min..=max).contains(&count) => count,
            _ => {
                let max = grouped(u64::from(max));
                self.reject_value(key, &located, &format!("must be from {min} to {max}"));
                default
            }
        }
    }

    /// Returns the size of an image in pixels.
    pub fn size_or(&mut self, key: &'static str, default: [u32; 2]) -> [u32; 2] {
        let Some(located) = self.optional::<[i64; 2]>(key) else {
            return default;
        };
        if located.value.iter().any(|side| *side < 1) {
            self.reject_value(key, &located, "must be at least 1 pixel in each direction");
            return default;
        }
        let [width, height] = located.value.map(|side| side as u64);
        check_size(width, height).unwrap_or_else(|_| {
            let problem = format!(
                "must be at most {} pixels in each direction and {} pixels in all",
                grouped(u64::from(MAX_SIDE)),
                grouped(MAX_PIXELS)
            );
            self.reject_value(key, &located, &problem);
            default
        })
    }
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
