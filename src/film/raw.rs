//! Uncompressed frames, which other programs read from a pipe: `YUV4MPEG2`, and RGBA without a header.

use std::io::{self, Write};

use crate::frame::DisplayFrame;
use crate::settings::{FilmSettings, Format};
use crate::yuv::planes;

/// Uncompressed frames in progress.
pub(crate) struct RawEncoder<W: Write> {
    out: W,
    settings: FilmSettings,
}

impl<W: Write> RawEncoder<W> {
    /// Starts a film in [`Format::Y4m`]; others are RGBA.
    pub(crate) fn new(mut out: W, settings: &FilmSettings) -> io::Result<Self> {
        if settings.format == Format::Y4m {
            out.write_all(header(settings).as_bytes())?;
        }
        Ok(Self {
            out,
            settings: settings.clone(),
        })
    }

    pub(crate) fn add(&mut self, frame: &DisplayFrame) -> io::Result<()> {
        if self.settings.format == Format::Y4m {
            self.out.write_all(b"FRAME\n")?;
            return self.out.write_all(&planes(frame, frame.size, false));
        }
        self.out.write_all(frame.pixels.as_flattened())
    }

    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// The header of `YUV4MPEG2`: progressive, square pixels, 4:2:0 with chroma at the left luma samples, and the
/// limited range as ffmpeg's extension states it. The format cannot state the matrix.
fn header(settings: &FilmSettings) -> String {
    let [width, height] = settings.size;
    let rate = settings.rate;
    format!(
        "YUV4MPEG2 W{width} H{height} F{}:{} Ip A1:1 C420mpeg2 XCOLORRANGE=LIMITED\n",
        rate.numerator, rate.denominator
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::FrameRate;

    fn encode(format: Format) -> Vec<u8> {
        let settings = FilmSettings::new(format, [3, 1], FrameRate::nearest(12.5), 2);
        let mut bytes = Vec::new();
        let mut film = RawEncoder::new(&mut bytes, &settings).unwrap();
        for level in [0, 255] {
            let pixels = vec![[level, level, level, 255]; 3];
            film.add(&DisplayFrame { size: [3, 1], pixels }).unwrap();
        }
        film.finish().unwrap();
        bytes
    }

    #[test]
    fn y4m_has_a_header_and_planes() {
        let expected = b"YUV4MPEG2 W3 H1 F25:2 Ip A1:1 C420mpeg2 XCOLORRANGE=LIMITED\n\
            FRAME\n\x10\x10\x10\x80\x80\x80\x80FRAME\n\xeb\xeb\xeb\x80\x80\x80\x80";
        assert_eq!(encode(Format::Y4m), expected);
    }

    #[test]
    fn rgba_has_pixels_only() {
        let bytes = encode(Format::Rgba);
        assert_eq!(bytes.len(), 24);
        assert_eq!(bytes[..4], [0, 0, 0, 255]);
        assert_eq!(bytes[12..16], [255; 4]);
    }
}
