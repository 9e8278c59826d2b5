//! GIF: one palette for the film, and of each frame only the rectangle that changes.

use std::io::{self, Write};

use gif::{DisposalMethod, EncodingError, Repeat};

use crate::dither::Ditherer;
use crate::frame::{DisplayFrame, Rectangle, changed};
use crate::palette::Histogram;
use crate::settings::{FilmSettings, Plays};

/// The shortest delay that browsers keep, in 1/100 s: they turn shorter ones into 10/100 s.
const MIN_DELAY: u64 = 2;

/// A GIF in progress.
pub(crate) struct GifEncoder<W: Write> {
    encoder: gif::Encoder<W>,
    settings: FilmSettings,
    ditherer: Ditherer,
    /// The index of unchanged pixels.
    unchanged: u8,
    /// The number of frames so far.
    count: u32,
    /// The indices that are shown after the pending frame.
    shown: Vec<u8>,
    /// The last image, whose delay is not known yet.
    pending: Option<Pending>,
    written: u32,
}

/// An image that replaces a part of the one before it.
struct Pending {
    /// When it is shown, in 1/100 s.
    start: u64,
    rectangle: Rectangle,
    indices: Vec<u8>,
}

impl<W: Write> GifEncoder<W> {
    /// Starts a film with the colors of these frames.
    pub(crate) fn new(out: W, settings: &FilmSettings, colors: &Histogram) -> io::Result<Self> {
        let palette = colors.palette();
        let unchanged = palette.len() as u8;
        let bytes: Vec<u8> = palette.iter().flatten().copied().chain([0; 3]).collect();
        let [width, height] = side(settings.size)?;
        let mut encoder = gif::Encoder::new(out, width, height, &bytes).map_err(failed)?;
        // The extension counts the repetitions after the first time; a film without it is played once.
        let repeat = match settings.plays {
            Plays::Endless => Some(Repeat::Infinite),
            Plays::Count(0 | 1) => None,
            Plays::Count(plays) => Some(Repeat::Finite(plays - 1)),
        };
        if let Some(repeat) = repeat {
            encoder.set_repeat(repeat).map_err(failed)?;
        }
        Ok(Self {
            encoder,
            settings: settings.clone(),
            ditherer: Ditherer::new(palette),
            unchanged,
            count: 0,
            shown: Vec::new(),
            pending: None,
            written: 0,
        })
    }

    /// Adds a frame, or leaves it out if it would be shown for less than 1/50 s.
    pub(crate) fn add(&mut self, frame: &DisplayFrame) -> io::Result<()> {
        let start = self.settings.rate.hundredths(self.count);
        self.count += 1;
        let rest = self.end().saturating_sub(start);
        if let Some(pending) = &self.pending
            && (start < pending.start + MIN_DELAY || rest < MIN_DELAY)
        {
            return Ok(());
        }
        let indices = self.ditherer.indices(frame);
        let [width, height] = self.settings.size;
        let rectangle = if self.shown.is_empty() {
            Some(Rectangle {
                columns: 0..width,
                rows: 0..height,
            })
        } else {
            changed(&self.shown, &indices, width)
        };
        self.written += 1;
        // An equal frame is shown by a longer delay.
        let Some(rectangle) = rectangle else {
            return Ok(());
        };
        let mut part = rectangle.part(&indices, width);
        if !self.shown.is_empty() {
            let before = rectangle.part(&self.shown, width);
            for (index, before) in part.iter_mut().zip(before) {
                if *index == before {
                    *index = self.unchanged;
                }
            }
        }
        self.write_pending(start)?;
        self.shown = indices;
        self.pending = Some(Pending {
            start,
            rectangle,
            indices: part,
        });
        Ok(())
    }

    /// When the film ends, in 1/100 s.
    fn end(&self) -> u64 {
        self.settings.rate.hundredths(self.settings.frames)
    }

    /// Writes the pending image, which is shown until `end`.
    fn write_pending(&mut self, end: u64) -> io::Result<()> {
        let Some(pending) = self.pending.take() else {
            return Ok(());
        };
        let Rectangle { columns, rows } = pending.rectangle;
        let mut delay = end.saturating_sub(pending.start).max(1);
        let mut frame = gif::Frame {
            left: columns.start as u16,
            top: rows.start as u16,
            width: columns.len() as u16,
            height: rows.len() as u16,
            dispose: DisposalMethod::Keep,
            transparent: Some(self.unchanged),
            buffer: pending.indices.into(),
            ..gif::Frame::default()
        };
        loop {
            frame.delay = delay.min(u64::from(u16::MAX)) as u16;
            self.encoder.write_frame(&frame).map_err(failed)?;
            delay -= u64::from(frame.delay);
            if delay == 0 {
                return Ok(());
            }
            // A longer delay than one image can have.
            (frame.left, frame.top, frame.width, frame.height) = (0, 0, 1, 1);
            frame.buffer = vec![self.unchanged].into();
        }
    }

    /// Ends the film; returns the number of frames that were not left out.
    pub(crate) fn finish(mut self) -> io::Result<u32> {
        self.write_pending(self.end())?;
        let mut out = self.encoder.into_inner().map_err(failed)?;
        out.flush()?;
        Ok(self.written)
    }
}

/// The size as GIF stores it.
fn side(size: [u32; 2]) -> io::Result<[u16; 2]> {
    match size.map(u16::try_from) {
        [Ok(width), Ok(height)] => Ok([width, height]),
        _ => Err(io::Error::other("GIF has at most 65,535 pixels per side")),
    }
}

fn failed(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        error => io::Error::other(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Format, FrameRate};

    /// A frame as a viewer shows it, and its delay.
    type Shown = (Vec<[u8; 3]>, u16);

    /// The frames, and the number of repetitions.
    fn decode(bytes: &[u8]) -> (Vec<Shown>, Repeat) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let width = decoder.width();
        let mut canvas = vec![[0; 3]; width as usize * decoder.height() as usize];
        let mut frames = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (at, pixel) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
                let (x, y) = (
                    at as u16 % frame.width + frame.left,
                    at as u16 / frame.width + frame.top,
                );
                if pixel[3] > 0 {
                    canvas[usize::from(y) * usize::from(width) + usize::from(x)] =
                        [pixel[0], pixel[1], pixel[2]];
                }
            }
            frames.push((canvas.clone(), frame.delay));
        }
        (frames, decoder.repeat())
    }

    fn encode(frames: &[DisplayFrame], rate: f64, plays: Plays) -> (Vec<u8>, u32) {
        let mut settings = FilmSettings::new(
            Format::Gif,
            frames[0].size,
            FrameRate::nearest(rate),
            frames.len() as u32,
        );
        settings.plays = plays;
        let mut colors = Histogram::new();
        for frame in frames {
            colors.add(frame);
        }
        let mut bytes = Vec::new();
        let mut film = GifEncoder::new(&mut bytes, &settings, &colors).unwrap();
        for frame in frames {
            film.add(frame).unwrap();
        }
        let shown = film.finish().unwrap();
        (bytes, shown)
    }

    /// A dark frame with one pixel of another color, which moves.
    fn dot(at: usize) -> DisplayFrame {
        let mut pixels = vec![[9, 9, 9, 255]; 12];
        pixels[at] = [200, at as u8, 0, 255];
        DisplayFrame { size: [4, 3], pixels }
    }

    fn colors(frame: &DisplayFrame) -> Vec<[u8; 3]> {
        frame.pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect()
    }

    #[test]
    fn few_colors_are_shown_exactly_and_delays_add_up() {
        let frames: Vec<_> = (0..12).map(dot).collect();
        let (bytes, shown) = encode(&frames, 30.0, Plays::Endless);
        let (decoded, repeat) = decode(&bytes);
        assert_eq!((decoded.len(), shown), (12, 12));
        for (frame, (decoded, _)) in frames.iter().zip(&decoded) {
            assert_eq!(*decoded, colors(frame));
        }
        let delays: Vec<_> = decoded.iter().map(|(_, delay)| *delay).collect();
        assert_eq!(delays, [3, 4, 3, 3, 4, 3, 3, 4, 3, 3, 4, 3]);
        assert!(matches!(repeat, Repeat::Infinite));
    }

    #[test]
    fn equal_frames_are_one_image_and_long_delays_several() {
        let frames = [dot(3), dot(3), dot(3), dot(4)];
        let (decoded, _) = decode(&encode(&frames, 10.0, Plays::Count(1)).0);
        let delays: Vec<_> = decoded.iter().map(|(_, delay)| *delay).collect();
        assert_eq!(delays, [30, 10]);
        let (decoded, _) = decode(&encode(&frames, 0.001, Plays::Count(1)).0);
        let total: u64 = decoded.iter().map(|(_, delay)| u64::from(*delay)).sum();
        assert_eq!(total, 400_000);
        assert_eq!(decoded.last().unwrap().0, colors(&frames[3]));
    }

    #[test]
    fn frames_that_browsers_would_slow_down_are_left_out() {
        let frames: Vec<_> = (0..12).map(dot).collect();
        for (rate, total) in [(60.0, 20), (144.0, 8), (50.0, 24)] {
            let (bytes, shown) = encode(&frames, rate, Plays::Count(1));
            let (decoded, _) = decode(&bytes);
            let delays: Vec<_> = decoded.iter().map(|(_, delay)| u64::from(*delay)).collect();
            assert!(
                delays.iter().all(|delay| *delay >= MIN_DELAY),
                "{rate}: {delays:?}"
            );
            assert_eq!(delays.iter().sum::<u64>(), total, "{rate}: {delays:?}");
            assert_eq!(decoded.len() as u32, shown, "{rate}");
        }
    }

    #[test]
    fn plays_are_counted_as_viewers_do() {
        let frames = [dot(0), dot(1)];
        let has = |plays: Plays, text: &[u8]| {
            let (bytes, _) = encode(&frames, 10.0, plays);
            bytes.windows(text.len()).any(|window| window == text)
        };
        assert!(!has(Plays::Count(1), b"NETSCAPE2.0"));
        assert!(has(Plays::Count(3), b"NETSCAPE2.0\x03\x01\x02\x00\x00"));
        assert!(has(Plays::Endless, b"NETSCAPE2.0\x03\x01\x00\x00\x00"));
    }
}
