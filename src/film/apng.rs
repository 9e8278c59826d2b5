//! APNG: lossless, of each frame only the rectangle that changes.

use std::io::{self, Write};

use png::{BlendOp, Compression, DisposeOp};

use crate::frame::{DisplayFrame, Rectangle, changed};
use crate::settings::{FilmSettings, Plays};
use crate::store::{bytes, color_type};

/// An APNG in progress.
pub(crate) struct ApngEncoder<W: Write> {
    writer: png::Writer<W>,
    keeps_alpha: bool,
    shown: Option<DisplayFrame>,
}

impl<W: Write> ApngEncoder<W> {
    pub(crate) fn new(out: W, settings: &FilmSettings) -> io::Result<Self> {
        let [width, height] = settings.size;
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(color_type(settings.keeps_alpha));
        encoder.set_compression(Compression::Balanced);
        let plays = match settings.plays {
            // As the format has it.
            Plays::Endless => 0,
            Plays::Count(plays) => u32::from(plays.max(1)),
        };
        encoder.set_animated(settings.frames, plays)?;
        encoder.set_frame_delay(settings.rate.denominator, settings.rate.numerator)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
        Ok(Self {
            writer: encoder.write_header()?,
            keeps_alpha: settings.keeps_alpha,
            shown: None,
        })
    }

    pub(crate) fn add(&mut self, frame: &DisplayFrame) -> io::Result<()> {
        let [width, height] = frame.size;
        let rectangle = match &self.shown {
            None => Rectangle {
                columns: 0..width,
                rows: 0..height,
            },
            // The number of frames is in the header, so that an equal frame needs a part, too.
            Some(shown) => changed(&shown.pixels, &frame.pixels, width).unwrap_or(Rectangle {
                columns: 0..1,
                rows: 0..1,
            }),
        };
        let (columns, rows) = (&rectangle.columns, &rectangle.rows);
        if self.shown.is_some() {
            // The size is checked against the position.
            self.writer.reset_frame_position()?;
            self.writer
                .set_frame_dimension(columns.len() as u32, rows.len() as u32)?;
            self.writer.set_frame_position(columns.start, rows.start)?;
        }
        let part = rectangle.part(&frame.pixels, width);
        self.writer.write_image_data(&bytes(&part, self.keeps_alpha))?;
        self.shown = Some(frame.clone());
        Ok(())
    }

    pub(crate) fn finish(self) -> io::Result<()> {
        Ok(self.writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Format, FrameRate};

    #[test]
    fn frames_are_kept_without_loss() {
        let frame = |at: u8, alpha: u8| {
            let mut pixels = vec![[at % 2, 100, 200, alpha]; 20];
            pixels[usize::from(at)] = [255, 1, at, alpha];
            DisplayFrame { size: [5, 4], pixels }
        };
        for (keeps_alpha, alpha) in [(false, 255), (true, 77)] {
            // The last two are equal.
            let frames: Vec<_> = [1, 3, 17, 19, 19].iter().map(|&at| frame(at, alpha)).collect();
            let mut settings = FilmSettings::new(Format::Apng, [5, 4], FrameRate::nearest(29.97), 5);
            settings.keeps_alpha = keeps_alpha;
            settings.plays = Plays::Count(3);
            let mut bytes = Vec::new();
            let mut film = ApngEncoder::new(&mut bytes, &settings).unwrap();
            for frame in &frames {
                film.add(frame).unwrap();
            }
            film.finish().unwrap();
            let mut reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
            let control = *reader.info().animation_control().unwrap();
            assert_eq!((control.num_frames, control.num_plays), (5, 3));
            let mut shown = vec![[0; 4]; 20];
            for frame in &frames {
                let mut part = vec![0; reader.output_buffer_size().unwrap()];
                let info = reader.next_frame(&mut part).unwrap();
                let control = *reader.info().frame_control().unwrap();
                assert_eq!((control.delay_num, control.delay_den), (100, 2997));
                let components = if keeps_alpha { 4 } else { 3 };
                for (at, pixel) in part[..info.buffer_size()].chunks(components).enumerate() {
                    let x = at as u32 % control.width + control.x_offset;
                    let y = at as u32 / control.width + control.y_offset;
                    let alpha = pixel.get(3).copied().unwrap_or(255);
                    shown[(y * 5 + x) as usize] = [pixel[0], pixel[1], pixel[2], alpha];
                }
                assert_eq!(shown, frame.pixels);
            }
        }
    }
}
