//! Motions: rotations about axes, which may be nested.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use toyproof_image::Frame;

use super::Point;

/// A time in an animation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrameTime {
    /// `iFrame`, from 0.
    pub frame: i32,
    /// `iTime`, in seconds.
    pub time: f64,
}

impl From<&Frame> for FrameTime {
    fn from(frame: &Frame) -> Self {
        Self {
            frame: frame.frame,
            time: f64::from(frame.time),
        }
    }
}

/// A rotation about an axis through a point, counter-clockwise as seen against the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// A point on the axis.
    pub pivot: Point,
    /// The direction of the axis, of length 1.
    pub axis: Point,
    /// The duration of one turn.
    pub period: Period,
    /// The index of the earlier motion that carries this one; it is applied after this one.
    pub within: Option<usize>,
}

/// The duration of one turn: > 0, or < 0 for clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Period {
    /// In frames.
    Frames(f64),
    /// In seconds.
    Seconds(f64),
}

/// The transform of a motion at a time: p → `rotation · p + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transform {
    rotation: DQuat,
    translation: DVec3,
}

impl Transform {
    fn new(motion: &Motion, frame_time: FrameTime) -> Self {
        let turns = match motion.period {
            Period::Frames(frames) => f64::from(frame_time.frame) / frames,
            Period::Seconds(seconds) => frame_time.time / seconds,
        };
        // libm's sine and cosine: the same bits on every platform.
        let (sine, cosine) = libm::sincos(0.5 * TAU * turns.fract());
        let axis = DVec3::from_array(motion.axis) * sine;
        let rotation = DQuat::from_xyzw(axis.x, axis.y, axis.z, cosine);
        let pivot = DVec3::from_array(motion.pivot);
        Self {
            rotation,
            translation: pivot - rotation * pivot,
        }
    }

    /// Returns the transform that applies `self`, then `next`.
    fn then(self, next: Self) -> Self {
        Self {
            rotation: next.rotation * self.rotation,
            translation: next.rotation * self.translation + next.translation,
        }
    }

    pub(super) fn point(&self, point: Point) -> Point {
        (self.rotation * DVec3::from_array(point) + self.translation).to_array()
    }

    pub(super) fn direction(&self, direction: Point) -> Point {
        (self.rotation * DVec3::from_array(direction)).to_array()
    }
}

/// Returns the transform of each motion, including those that carry it.
pub(super) fn transforms(motions: &[Motion], frame_time: FrameTime) -> Vec<Transform> {
    let mut transforms: Vec<Transform> = Vec::with_capacity(motions.len());
    for motion in motions {
        let own = Transform::new(motion, frame_time);
        transforms.push(motion.within.map_or(own, |outer| own.then(transforms[outer])));
    }
    transforms
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(actual: Point, expected: Point) {
        for (a, e) in actual.iter().zip(expected) {
            assert!((a - e).abs() < 1e-14, "{actual:?} is not {expected:?}");
        }
    }

    fn rotating(pivot: Point, frames: f64, within: Option<usize>) -> Motion {
        Motion {
            pivot,
            axis: [0.0, 1.0, 0.0],
            period: Period::Frames(frames),
            within,
        }
    }

    #[test]
    fn a_quarter_turn_about_y_brings_x_to_minus_z() {
        let frame_time = FrameTime { frame: 60, time: 0.0 };
        let transform = transforms(&[rotating([1.0, 5.0, 0.0], 240.0, None)], frame_time)[0];
        assert_near(transform.point([2.0, 1.0, 0.0]), [1.0, 1.0, -1.0]);
        assert_near(transform.direction([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn nested_motions_are_applied_inner_first() {
        let frame_time = FrameTime { frame: 1, time: 0.0 };
        let motions = [
            rotating([0.0; 3], 4.0, None),
            rotating([1.0, 0.0, 0.0], 4.0, Some(0)),
        ];
        // About (1, 0, 0): to (1, 0, −1); then about the origin: to (−1, 0, −1).
        assert_near(
            transforms(&motions, frame_time)[1].point([2.0, 0.0, 0.0]),
            [-1.0, 0.0, -1.0],
        );
    }

    #[test]
    fn periods_in_seconds_and_whole_turns() {
        let motion = Motion {
            period: Period::Seconds(-2.0),
            ..rotating([0.0; 3], 1.0, None)
        };
        let at = |time: f64| transforms(&[motion], FrameTime { frame: 7, time })[0].point([1.0, 0.0, 0.0]);
        assert_near(at(2_000_000.0), [1.0, 0.0, 0.0]);
        assert_near(at(0.5), [0.0, 0.0, 1.0]);
    }
}
