//! Stepping: moving from a stop to another one, forward or back.

use crate::recording::{Point, Recording, Stop};

/// How far a step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepKind {
    /// To the next line of the function, or of its caller; over calls.
    Next,
    /// To the next line, also in a function that is called.
    Into,
    /// To the caller.
    Out,
    /// To the previous line of the function, or to the call of it; over calls.
    Back,
}

impl Recording {
    /// The point that a step leads to: the end, or `None` if there is none before the first stop.
    #[must_use]
    pub fn step(&self, from: Point, kind: StepKind) -> Option<Point> {
        let Some(stop) = self.stop(from) else {
            return match kind {
                // From the end, the last line of the outermost function.
                StepKind::Back => self.last(|stop| !stop.is_return && self.depth(stop) == 0, from),
                _ => Some(from),
            };
        };
        let depth = self.depth(stop);
        let is_line = |other: &Stop| !other.is_return;
        match kind {
            StepKind::Next => Some(self.first(from, |other| {
                self.depth(other) < depth || other.invocation == stop.invocation && is_line(other)
            })),
            StepKind::Into => Some(self.first(from, |other| self.depth(other) < depth || is_line(other))),
            StepKind::Out => Some(self.first(from, |other| self.depth(other) < depth)),
            StepKind::Back => {
                let is_before = |other: &Stop| {
                    is_line(other) && (other.invocation == stop.invocation || self.depth(other) < depth)
                };
                self.last(is_before, from)
            }
        }
    }

    fn depth(&self, stop: &Stop) -> u32 {
        self.invocation(stop.invocation).depth
    }

    /// The first stop after a point for which a condition holds, or the end.
    fn first(&self, from: Point, is_one: impl Fn(&Stop) -> bool) -> Point {
        let after = &self.stops()[(from.0 + 1).min(self.len())..];
        let found = after.iter().position(is_one);
        found.map_or(self.end(), |at| Point(from.0 + 1 + at))
    }

    /// The last stop before a point for which a condition holds.
    fn last(&self, is_one: impl Fn(&Stop) -> bool, before: Point) -> Option<Point> {
        let found = self.stops()[..before.0].iter().rposition(is_one);
        found.map(Point)
    }
}
