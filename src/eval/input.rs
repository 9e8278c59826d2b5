//! The frame's inputs as numbers.

use toyproof_glsl::tree::Input;
use toyproof_image::{FRAME_RATE, Frame, SAMPLE_RATE};

use super::number::Number;

/// One component of a float input.
pub(crate) fn float<N: Number>(frame: &Frame, input: Input, component: u8) -> N {
    let at = usize::from(component);
    let value = match input {
        Input::Resolution => [frame.size[0] as f32, frame.size[1] as f32, 1.0][at],
        Input::Time => frame.time,
        Input::TimeDelta => 1.0 / FRAME_RATE,
        Input::FrameRate => FRAME_RATE,
        Input::ChannelResolution => match &frame.channels[at / 3] {
            Some(image) => [image.size()[0] as f32, image.size()[1] as f32, 1.0][at % 3],
            None => 0.0,
        },
        Input::Mouse => frame.mouse[at],
        Input::Date => frame.date[at],
        Input::SampleRate => SAMPLE_RATE,
        Input::Frame | Input::ChannelTime | Input::Channel(_) => 0.0,
    };
    // What a GPU reads, it flushes before it computes.
    N::from_f64(f64::from(if value.is_subnormal() { 0.0 } else { value }))
}

/// The one input that is an integer.
pub(crate) fn word(frame: &Frame) -> u32 {
    frame.frame.cast_unsigned()
}
