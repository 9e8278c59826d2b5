//! Whether the end of a film leads into its start.

use crate::frame::DisplayFrame;

/// How the last frame of a film leads into the first: root mean squares of the differences of red, green and
/// blue, in levels of 8 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seam {
    /// The difference between the last frame and the first.
    pub jump: f64,
    /// The largest difference between frames that follow each other.
    pub largest_step: f64,
}

impl Seam {
    /// Whether a viewer notices the repetition: the last frame differs from the first by half more than any
    /// frame from its successor. The step of a periodic motion at its seam is like the steps next to it, and
    /// half more allows for their unevenness. Half a level is what rounding to 8 bits contributes.
    pub fn is_visible(self) -> bool {
        self.jump > 1.5 * self.largest_step + 0.5
    }
}

/// Measures the seam of frames, one after the other.
#[derive(Debug, Default)]
pub(crate) struct SeamMeter {
    first: Option<DisplayFrame>,
    previous: Option<DisplayFrame>,
    largest_step: f64,
}

impl SeamMeter {
    pub(crate) fn add(&mut self, frame: &DisplayFrame) {
        if let Some(previous) = &self.previous {
            self.largest_step = self.largest_step.max(difference(previous, frame));
        }
        self.first.get_or_insert_with(|| frame.clone());
        self.previous = Some(frame.clone());
    }

    /// The seam of the frames so far; `None` of fewer than three, which show no motion.
    pub(crate) fn seam(&self, frames: u32) -> Option<Seam> {
        let (first, last) = (self.first.as_ref()?, self.previous.as_ref()?);
        (frames >= 3).then(|| Seam {
            jump: difference(last, first),
            largest_step: self.largest_step,
        })
    }
}

/// The root mean square of the differences of red, green and blue.
fn difference(one: &DisplayFrame, other: &DisplayFrame) -> f64 {
    let squares = one.pixels.iter().zip(&other.pixels).map(|(one, other)| {
        let square = |at: usize| u64::from(one[at].abs_diff(other[at])).pow(2);
        square(0) + square(1) + square(2)
    });
    let count = 3 * one.pixels.len().max(1);
    (squares.sum::<u64>() as f64 / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar that moves around a ring of 64 pixels, at this position.
    fn frame(position: f64) -> DisplayFrame {
        let level = |at: u32| {
            let angle = std::f64::consts::TAU * (f64::from(at) / 64.0 - position);
            (127.5 + 127.5 * angle.cos()) as u8
        };
        DisplayFrame {
            size: [64, 1],
            pixels: (0..64).map(|at| [level(at), 0, 0, 255]).collect(),
        }
    }

    fn seam(positions: impl Iterator<Item = f64>) -> Seam {
        let (mut meter, mut count) = (SeamMeter::default(), 0);
        for position in positions {
            meter.add(&frame(position));
            count += 1;
        }
        meter.seam(count).unwrap()
    }

    #[test]
    fn a_whole_period_has_no_visible_seam() {
        assert!(!seam((0..48).map(|at| f64::from(at) / 48.0)).is_visible());
        assert!(!seam((0..48).map(|_| 0.25)).is_visible(), "nothing moves");
        let uneven = (0..48).map(|at| (f64::from(at) / 48.0 * std::f64::consts::TAU).sin() * 0.2);
        assert!(!seam(uneven).is_visible());
    }

    #[test]
    fn part_of_a_period_has_one() {
        assert!(seam((0..48).map(|at| f64::from(at) / 96.0)).is_visible());
        // Four frames too many, and two too few: three steps at once, back and forth.
        assert!(seam((0..52).map(|at| f64::from(at) / 48.0)).is_visible());
        assert!(seam((0..46).map(|at| f64::from(at) / 48.0)).is_visible());
    }
}
