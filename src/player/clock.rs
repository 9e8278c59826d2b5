//! The inputs of each frame: times follow from the number of the frame.

use toyproof_image::Frame;

/// The inputs of the frames of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Clock {
    /// The size and the date of all frames, and their mouse and keyboard or the script for those.
    pub inputs: Frame,
    /// The frames in a second.
    pub rate: f64,
    /// The time of frame 0, in seconds.
    pub start: f64,
}

impl Clock {
    /// The inputs of a frame. Its time is computed, not summed up: a sum of 1/60 in f32 is wrong by seconds
    /// after an hour.
    pub fn frame(&self, number: i32) -> Frame {
        let time = self.start + f64::from(number) / self.rate;
        let inputs = Frame {
            time_delta: (1.0 / self.rate) as f32,
            frame_rate: self.rate as f32,
            ..self.inputs.clone()
        };
        inputs.at(number, time as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_multiples_of_the_interval() {
        let mut clock = Clock {
            inputs: Frame::default(),
            rate: 60.0,
            start: 0.0,
        };
        let frame = clock.frame(216_000);
        assert_eq!(
            (frame.time, frame.time_delta, frame.frame_rate),
            (3600.0, 1.0 / 60.0, 60.0)
        );
        clock.start = 1.25 - 75.0 / 60.0;
        assert_eq!(clock.frame(75).time, 1.25);
    }
}
