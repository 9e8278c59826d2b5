//! What a film is made with.

use std::fmt;
use std::path::{Path, PathBuf};

/// The format of a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Animated GIF: 255 colors, times in 1/100 s.
    Gif,
    /// Animated PNG: lossless.
    Apng,
    /// H.264 and AAC in MP4, by ffmpeg.
    Mp4,
    /// VP9 and Opus in `WebM`, by ffmpeg.
    Webm,
    /// `YUV4MPEG2`: uncompressed `Y'CbCr` 4:2:0, which encoders read from a pipe.
    Y4m,
    /// Uncompressed RGBA without a header.
    Rgba,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 6] = [
        Self::Gif,
        Self::Apng,
        Self::Mp4,
        Self::Webm,
        Self::Y4m,
        Self::Rgba,
    ];

    /// The extension of the format's files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::Mp4 => "mp4",
            Self::Webm => "webm",
            Self::Y4m => "y4m",
            Self::Rgba => "rgba",
        }
    }

    /// The format with this extension, in any case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL
            .into_iter()
            .find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// Whether frames can be written to a pipe one after the other.
    pub fn is_stream(self) -> bool {
        matches!(self, Self::Y4m | Self::Rgba)
    }

    /// Whether files store how often they are played.
    pub fn counts_plays(self) -> bool {
        matches!(self, Self::Gif | Self::Apng)
    }

    /// Whether alpha is kept.
    pub fn has_alpha(self) -> bool {
        matches!(self, Self::Apng | Self::Webm | Self::Rgba)
    }

    /// Whether a film can have sound.
    pub fn has_sound(self) -> bool {
        matches!(self, Self::Mp4 | Self::Webm)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gif => "GIF",
            Self::Apng => "APNG",
            Self::Mp4 => "MP4",
            Self::Webm => "WebM",
            Self::Y4m => "Y4M",
            Self::Rgba => "raw RGBA",
        })
    }
}

/// How often a film is played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plays {
    /// Endlessly, as far as the format can express it: the players of MP4 and `WebM` decide themselves.
    Endless,
    /// This often, at least once. Formats without a count have the frames this often.
    Count(u16),
}

/// Frames in a second, as a fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRate {
    /// At most 65,535, as in the frame delays of APNG.
    pub numerator: u16,
    /// From 1 to 65,535.
    pub denominator: u16,
}

impl FrameRate {
    /// The fraction of two numbers up to 65,535 that approximates `rate`, in frames per second, to a relative
    /// error of 10⁻⁹ or as well as its continued fraction does. Rates outside of 1/65,535 to 65,535 become
    /// these.
    pub fn nearest(rate: f64) -> Self {
        let limit = f64::from(u16::MAX);
        let rate = rate.clamp(1.0 / limit, limit);
        let ([mut before, mut last], mut rest) = ([[0.0, 1.0], [1.0, 0.0]], rate);
        loop {
            let whole = rest.floor();
            let next = [0, 1].map(|at| whole * last[at] + before[at]);
            if next.iter().any(|&part| part > limit) {
                break;
            }
            (before, last) = (last, next);
            let fraction = rest - whole;
            if (last[0] / last[1] - rate).abs() <= 1e-9 * rate || fraction <= 0.0 {
                break;
            }
            rest = 1.0 / fraction;
        }
        Self {
            numerator: last[0] as u16,
            denominator: last[1] as u16,
        }
    }

    /// When a frame begins, in 1/100 s from the start of the film, rounded. The delays between such times add
    /// up to the exact duration, while rounded delays drift.
    pub(crate) fn hundredths(self, frame: u32) -> u64 {
        let (numerator, denominator) = (u64::from(self.numerator), u64::from(self.denominator));
        (200 * u64::from(frame) * denominator + numerator) / (2 * numerator)
    }

    /// The duration of a number of frames, in seconds.
    pub fn seconds(self, frames: u32) -> f64 {
        f64::from(frames) * f64::from(self.denominator) / f64::from(self.numerator)
    }
}

impl fmt::Display for FrameRate {
    /// As ffmpeg takes it: `60/1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.numerator, self.denominator)
    }
}

/// What a film is made with.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmSettings {
    /// The format.
    pub format: Format,
    /// Width and height of all frames, in pixels.
    pub size: [u32; 2],
    /// Frames in a second.
    pub rate: FrameRate,
    /// The number of frames.
    pub frames: u32,
    /// How often the film is played.
    pub plays: Plays,
    /// Whether the alpha of frames is kept; otherwise films are opaque.
    pub keeps_alpha: bool,
    /// A WAV file for the sound, which is cut at the end of the film.
    pub sound: Option<PathBuf>,
}

impl FilmSettings {
    /// An opaque film without sound, which is played endlessly if the format can express it.
    pub fn new(format: Format, size: [u32; 2], rate: FrameRate, frames: u32) -> Self {
        let plays = if format.counts_plays() {
            Plays::Endless
        } else {
            Plays::Count(1)
        };
        Self {
            format,
            size,
            rate,
            frames,
            plays,
            keeps_alpha: false,
            sound: None,
        }
    }

    /// How often the frames are written one after the other.
    pub(crate) fn repetitions(&self) -> u32 {
        match self.plays {
            Plays::Count(count) if !self.format.counts_plays() => u32::from(count.max(1)),
            Plays::Count(_) | Plays::Endless => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_fractions_that_users_mean() {
        for (rate, fraction) in [
            (60.0, "60/1"),
            (29.97, "2997/100"),
            (24_000.0 / 1001.0, "24000/1001"),
            (0.001, "1/1000"),
            (12.5, "25/2"),
            (1e6, "65535/1"),
        ] {
            assert_eq!(FrameRate::nearest(rate).to_string(), fraction);
        }
        // The next fraction is 103993/33102.
        assert_eq!(FrameRate::nearest(std::f64::consts::PI).to_string(), "355/113");
    }

    #[test]
    fn hundredths_do_not_drift() {
        let rate = FrameRate::nearest(30.0);
        let delays: Vec<_> = (0..6)
            .map(|frame| rate.hundredths(frame + 1) - rate.hundredths(frame))
            .collect();
        assert_eq!(delays, [3, 4, 3, 3, 4, 3]);
        assert_eq!(rate.hundredths(30 * 3600), 360_000);
    }

    #[test]
    fn extensions_are_those_of_formats_in_any_case() {
        assert_eq!(Format::from_path(Path::new("a/B.WebM")), Some(Format::Webm));
        assert_eq!(Format::from_path(Path::new("a.png")), None);
        assert_eq!(Format::from_path(Path::new("gif")), None);
    }
}
