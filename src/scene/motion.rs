//! How things move: rotations about axes, one within another.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::Point;

/// A moment of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moment {
    /// `iFrame`, from 0.
    pub frame: i32,
    /// `iTime`, in seconds.
    pub time: f64,
}

/// A rotation about an axis through a point. Counter-clockwise for who looks against the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// A point on the axis.
    pub pivot: Point,
    /// The axis's direction, of length 1.
    pub axis: Point,
    /// How long one turn takes.
    pub period: Period,
    /// Which earlier motion carries this one along: its turn comes after this one's.
    pub within: Option<usize>,
}

/// How long one turn takes; > 0, or < 0 for one clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Period {
    /// In frames.
    Frames(f64),
    /// In seconds.
    Seconds(f64),
}

/// Where a motion has brought things: p → `turn · p + shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    turn: DQuat,
    shift: DVec3,
}

impl Place {
    fn new(motion: &Motion, moment: Moment) -> Self {
        let turns = match motion.period {
            Period::Frames(frames) => f64::from(moment.frame) / frames,
            Period::Seconds(seconds) => moment.time / seconds,
        };
        // libm's sine and cosine: the same bits on every platform.
        let (sine, cosine) = libm::sincos(0.5 * TAU * turns.fract());
        let axis = DVec3::from_array(motion.axis) * sine;
        let turn = DQuat::from_xyzw(axis.x, axis.y, axis.z, cosine);
        let pivot = DVec3::from_array(motion.pivot);
        Self {
            turn,
            shift: pivot - turn * pivot,
        }
    }

    /// First this, then `next`.
    fn then(self, next: Self) -> Self {
        Self {
            turn: next.turn * self.turn,
            shift: next.turn * self.shift + next.shift,
        }
    }

    pub(super) fn point(&self, point: Point) -> Point {
        (self.turn * DVec3::from_array(point) + self.shift).to_array()
    }

    pub(super) fn direction(&self, direction: Point) -> Point {
        (self.turn * DVec3::from_array(direction)).to_array()
    }
}

/// Where each motion has brought its things, those that carry it included.
pub(super) fn places(motions: &[Motion], moment: Moment) -> Vec<Place> {
    let mut places: Vec<Place> = Vec::with_capacity(motions.len());
    for motion in motions {
        let own = Place::new(motion, moment);
        places.push(motion.within.map_or(own, |outer| own.then(places[outer])));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(actual: Point, expected: Point) {
        for (a, e) in actual.iter().zip(expected) {
            assert!((a - e).abs() < 1e-14, "{actual:?} is not {expected:?}");
        }
    }

    fn turn(pivot: Point, frames: f64, within: Option<usize>) -> Motion {
        Motion {
            pivot,
            axis: [0.0, 1.0, 0.0],
            period: Period::Frames(frames),
            within,
        }
    }

    #[test]
    fn a_quarter_turn_about_y_brings_x_to_minus_z() {
        let moment = Moment { frame: 60, time: 0.0 };
        let place = places(&[turn([1.0, 5.0, 0.0], 240.0, None)], moment)[0];
        near(place.point([2.0, 1.0, 0.0]), [1.0, 1.0, -1.0]);
        near(place.direction([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn what_is_within_turns_first_and_is_carried_along() {
        let moment = Moment { frame: 1, time: 0.0 };
        let motions = [turn([0.0; 3], 4.0, None), turn([1.0, 0.0, 0.0], 4.0, Some(0))];
        // About (1, 0, 0): to (1, 0, −1); then about the origin: to (−1, 0, −1).
        near(
            places(&motions, moment)[1].point([2.0, 0.0, 0.0]),
            [-1.0, 0.0, -1.0],
        );
    }

    #[test]
    fn whole_turns_and_seconds_count() {
        let motion = Motion {
            period: Period::Seconds(-2.0),
            ..turn([0.0; 3], 1.0, None)
        };
        let at = |time: f64| places(&[motion], Moment { frame: 7, time })[0].point([1.0, 0.0, 0.0]);
        near(at(2_000_000.0), [1.0, 0.0, 0.0]);
        near(at(0.5), [0.0, 0.0, 1.0]);
    }
}
