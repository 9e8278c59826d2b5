//! The flags of `run` and `render` that select frames, and what becomes of them.

use std::path::Path;
use std::str::FromStr;

use clap::ValueEnum;
use toyproof_film::{FilmSettings, Format, FrameRate, Plays};
use toyproof_image as image;

use super::{Frames, parse_frames};
use crate::cli::CliError;
use crate::cli::inputs::parse_number;

/// The longest film, in seconds.
const MAX_DURATION: f64 = 24.0 * 60.0 * 60.0;

/// Frames over time.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Films and sequences")]
pub(in crate::cli) struct SequenceArgs {
    /// Render a film of this length, in seconds
    ///
    /// The film is a .gif, .png or .apng (both animated PNG), .mp4, .webm or .y4m, or of the format that --to
    /// names; .exr are numbered files. `--time` is the time of its first frame. The same command resumes an
    /// interrupted film, whose frames are kept in FILM.frames.
    #[arg(long, value_name = "S", value_parser = parse_duration, conflicts_with_all = ["frames", "frame"], allow_negative_numbers = true)]
    duration: Option<f64>,
    /// Render frames A to B, at the rate of `--fps`, into numbered files or a film
    ///
    /// For .png and .exr, the number is inserted before the extension. `--time` is then the time of frame 0.
    /// The same command resumes an interrupted sequence.
    #[arg(long, value_name = "A..B", value_parser = parse_frames, conflicts_with = "frame")]
    frames: Option<Frames>,
    /// The frames in a second: they determine the times of frames, `iTimeDelta` and `iFrameRate`
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = parse_rate, hide_short_help = true)]
    pub(in crate::cli) fps: f64,
    /// How often a film is played: a number, or `forever` [default: forever in GIF and APNG, else 1]
    ///
    /// Formats without such a number contain the frames this often; `forever` leaves it to the player. If a
    /// film is repeated, its last frame is compared with its first.
    #[arg(long = "loop", value_name = "N|forever", value_parser = parse_plays, hide_short_help = true)]
    plays: Option<Plays>,
    /// The format of a film, whatever the extension; y4m and rgba also on standard output (`-o -`)
    #[arg(long, value_enum, value_name = "FORMAT", hide_short_help = true)]
    to: Option<FilmFormat>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FilmFormat {
    Gif,
    Apng,
    Mp4,
    Webm,
    Y4m,
    Rgba,
}

impl From<FilmFormat> for Format {
    fn from(format: FilmFormat) -> Self {
        match format {
            FilmFormat::Gif => Self::Gif,
            FilmFormat::Apng => Self::Apng,
            FilmFormat::Mp4 => Self::Mp4,
            FilmFormat::Webm => Self::Webm,
            FilmFormat::Y4m => Self::Y4m,
            FilmFormat::Rgba => Self::Rgba,
        }
    }
}

/// What a command writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cli) enum Output {
    /// One image.
    Image,
    /// Numbered images.
    Files(Frames),
    /// A film.
    Film(Frames, Format),
    /// Frames on standard output.
    Stream(Frames, Format),
    /// The sound, of this length in seconds if it is given.
    Sound(Option<f64>),
}

impl SequenceArgs {
    /// The frames, if there are several.
    pub(in crate::cli) fn frames(&self) -> Result<Option<Frames>, CliError> {
        let Some(duration) = self.duration else {
            return Ok(self.frames);
        };
        let count = (duration * self.fps).round().max(1.0);
        if count > f64::from(i32::MAX) {
            return Err(CliError::new(format_args!(
                "{duration} s at {} frames per second are too many frames",
                self.fps
            )));
        }
        Ok(Some(Frames {
            first: 0,
            last: count as i32 - 1,
        }))
    }

    /// The extension of outputs whose names are not given.
    pub(in crate::cli) fn extension(&self) -> &'static str {
        self.to.map_or("png", |format| Format::from(format).extension())
    }

    /// What is written to an output.
    pub(in crate::cli) fn output(&self, path: &Path) -> Result<Output, CliError> {
        let is_standard = path == Path::new("-");
        let is_sound = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("wav"));
        if is_sound && self.to.is_none() {
            if self.frames.is_some() || self.plays.is_some() {
                let error = CliError::new("a sound has no frames, and is not repeated");
                return Err(error.with_help("--duration 60 computes a minute"));
            }
            return Ok(Output::Sound(self.duration));
        }
        let format = self.to.map(Format::from).or_else(|| Format::from_path(path));
        let Some(frames) = self.frames()? else {
            if let Some(format) = format {
                let error = CliError::new(format_args!("{format} is a film, which needs several frames"));
                return Err(error.with_help("--duration 4 renders four seconds, --frames 0..59 these frames"));
            }
            if self.plays.is_some() {
                let error = CliError::new("--loop is for films");
                return Err(
                    error.with_help("add --duration S, and name a .gif, .apng, .mp4 or .webm with -o")
                );
            }
            check_image_extension(path)?;
            return Ok(Output::Image);
        };
        let is_png = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        let output = match format {
            Some(format) if is_standard && format.is_stream() => {
                if !matches!(self.plays, None | Some(Plays::Endless | Plays::Count(1))) {
                    return Err(CliError::new(
                        "standard output takes each frame once, without --loop",
                    ));
                }
                Output::Stream(frames, format)
            }
            _ if is_standard => {
                let error =
                    CliError::new("standard output takes a single image, or frames as --to y4m or rgba");
                return Err(error.with_help("name a file with -o"));
            }
            Some(format) => Output::Film(frames, format),
            None if is_png && self.duration.is_some() => Output::Film(frames, Format::Apng),
            None => {
                check_image_extension(path)?;
                Output::Files(frames)
            }
        };
        let is_endless = self.plays == Some(Plays::Endless);
        match output {
            Output::Files(_) if self.plays.is_some() => {
                let error = CliError::new("--loop is for films, not for numbered files");
                Err(error.with_help("name a .gif, .apng, .mp4 or .webm with -o"))
            }
            Output::Film(_, Format::Rgba) if is_endless => {
                Err(CliError::new("raw frames cannot be repeated forever"))
            }
            output => Ok(output),
        }
    }

    /// The settings of a film.
    pub(in crate::cli) fn film(&self, frames: Frames, format: Format, size: [u32; 2]) -> FilmSettings {
        let count = u32::try_from(frames.count()).unwrap_or(u32::MAX);
        let mut settings = FilmSettings::new(format, size, FrameRate::nearest(self.fps), count);
        if let Some(plays) = self.plays {
            settings.plays = plays;
        }
        settings
    }

    /// Whether the user wants a film to be repeated.
    pub(in crate::cli) fn is_repeated(&self) -> bool {
        self.plays.is_some_and(|plays| plays != Plays::Count(1))
    }
}

/// Checks that images can be written to a file of this name.
fn check_image_extension(path: &Path) -> Result<(), CliError> {
    if path == Path::new("-") {
        return Ok(());
    }
    image::check_extension(path).map_err(CliError::new)
}

/// Parses a number of frames in a second.
pub(in crate::cli) fn parse_rate(text: &str) -> Result<f64, String> {
    parse_number(text, 0.001..=1e6, "a number from 0.001 to 1000000")
}

fn parse_duration(text: &str) -> Result<f64, String> {
    let expected = "seconds, above 0 and at most 86400";
    parse_number(text, f64::MIN_POSITIVE..=MAX_DURATION, expected)
}

fn parse_plays(text: &str) -> Result<Plays, String> {
    if text == "forever" {
        return Ok(Plays::Endless);
    }
    match u16::from_str(text) {
        Ok(count @ 1..) => Ok(Plays::Count(count)),
        _ => Err("expected `forever`, or a number from 1 to 65535".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Flags {
        #[command(flatten)]
        sequence: SequenceArgs,
        #[arg(long)]
        frame: Option<i32>,
    }

    fn output(path: &str, flags: &[&str]) -> Result<Output, String> {
        let flags = Flags::try_parse_from(["x"].iter().chain(flags)).unwrap();
        let output = flags.sequence.output(Path::new(path));
        output.map_err(|error| error.message.unwrap())
    }

    #[test]
    fn outputs_follow_from_extensions_and_flags() {
        let frames = |last| Frames { first: 0, last };
        let two = ["--frames", "0..1"];
        let second = ["--duration", "1", "--fps", "25"];
        assert_eq!(output("a.png", &[]), Ok(Output::Image));
        assert_eq!(output("a.png", &two), Ok(Output::Files(frames(1))));
        assert_eq!(output("a.exr", &second), Ok(Output::Files(frames(24))));
        for (path, format) in [
            ("a.PNG", Format::Apng),
            ("a.apng", Format::Apng),
            ("a.gif", Format::Gif),
            ("a.mp4", Format::Mp4),
        ] {
            assert_eq!(
                output(path, &second),
                Ok(Output::Film(frames(24), format)),
                "{path}"
            );
        }
        assert_eq!(
            output("a.png", &[&two[..], &["--to", "webm"]].concat()),
            Ok(Output::Film(frames(1), Format::Webm))
        );
        assert_eq!(
            output("-", &[&two[..], &["--to", "y4m"]].concat()),
            Ok(Output::Stream(frames(1), Format::Y4m))
        );
        assert_eq!(output("-", &[]), Ok(Output::Image));
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        for (path, flags, reason) in [
            ("a.gif", vec![], "GIF is a film"),
            ("a.jpg", vec![], "unsupported image format"),
            ("a.jpg", vec!["--duration", "1"], "unsupported image format"),
            (
                "-",
                vec!["--duration", "1"],
                "standard output takes a single image",
            ),
            (
                "-",
                vec!["--duration", "1", "--to", "gif"],
                "standard output takes",
            ),
            ("a.png", vec!["--loop", "2"], "--loop is for films"),
            (
                "a.png",
                vec!["--frames", "0..1", "--loop", "2"],
                "not for numbered files",
            ),
            (
                "a.mp4",
                vec!["--duration", "86400", "--fps", "1000000"],
                "too many frames",
            ),
        ] {
            let error = output(path, &flags).unwrap_err();
            assert!(error.contains(reason), "{path} {flags:?}: {error}");
        }
    }

    #[test]
    fn durations_are_rounded_to_frames() {
        let count = |duration: &str, fps: &str| {
            let flags = Flags::try_parse_from(["x", "--duration", duration, "--fps", fps]).unwrap();
            flags.sequence.frames().unwrap().unwrap().count()
        };
        assert_eq!(count("2.5", "30"), 75);
        assert_eq!(count("0.001", "30"), 1);
        assert_eq!(count("10", "29.97"), 300);
    }
}
