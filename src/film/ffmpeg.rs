//! MP4 and `WebM` by the ffmpeg that is installed, which reads `Y'CbCr` from a pipe. It is a program of its
//! own, so that neither its licence nor its faults are those of this one.

use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::JoinHandle;

use crate::FilmError;
use crate::frame::DisplayFrame;
use crate::settings::{FilmSettings, Format};
use crate::yuv::planes;

/// The program.
const PROGRAM: &str = "ffmpeg";

/// The oldest version: it has the flags that are used here.
const MIN_VERSION: u32 = 4;

/// The size of the message that is kept of a failed ffmpeg, in bytes.
const MAX_MESSAGE: u64 = 64 * 1024;

/// The encoder of a format.
fn encoder(format: Format) -> &'static str {
    match format {
        Format::Webm => "libvpx-vp9",
        _ => "libx264",
    }
}

/// The version of the ffmpeg that is installed; `None` if there is none.
pub fn version() -> Option<String> {
    let output = run(&["-version"])?;
    let text = String::from_utf8_lossy(&output.stdout);
    let version = text.strip_prefix("ffmpeg version ").unwrap_or_default();
    Some(version.split_whitespace().next().unwrap_or("unknown").to_owned())
}

/// Runs ffmpeg; `None` if there is none.
fn run(arguments: &[&str]) -> Option<Output> {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).stdin(Stdio::null());
    command.output().ok()
}

/// Checks that an ffmpeg is installed that can write the format.
///
/// # Errors
/// [`FilmError::NoFfmpeg`], [`FilmError::OldFfmpeg`], [`FilmError::NoEncoder`].
pub(crate) fn check(format: Format) -> Result<(), FilmError> {
    let version = version().ok_or(FilmError::NoFfmpeg(format))?;
    if is_older(&version) {
        return Err(FilmError::OldFfmpeg(version, format));
    }
    let name = encoder(format);
    let help = run(&["-hide_banner", "-h", &format!("encoder={name}")]);
    let help = help.ok_or(FilmError::NoFfmpeg(format))?;
    if !help.stdout.starts_with(format!("Encoder {name} ").as_bytes()) {
        return Err(FilmError::NoEncoder {
            encoder: name,
            format,
        });
    }
    Ok(())
}

/// Whether a version is older than [`MIN_VERSION`]: `5.1.9-0+deb12u1`, `n6.0`. Those of development
/// (`N-119000-g…`, `2024-01-01-git-…`) count as new.
fn is_older(version: &str) -> bool {
    let number = version.trim_start_matches('n').split('.').next();
    number
        .and_then(|number| number.parse::<u32>().ok())
        .is_some_and(|number| number < MIN_VERSION)
}

/// A film that ffmpeg writes.
pub(crate) struct FfmpegEncoder {
    process: Child,
    /// Reads what ffmpeg reports, so that it never waits for a reader; absent once it has been read.
    messages: Option<JoinHandle<String>>,
    size: [u32; 2],
    keeps_alpha: bool,
}

impl FfmpegEncoder {
    /// Starts ffmpeg, which writes to this path.
    pub(crate) fn new(path: &Path, settings: &FilmSettings) -> Result<Self, FilmError> {
        let mut command = Command::new(PROGRAM);
        command
            .args(arguments(settings))
            .arg(file(path))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        // An interrupt of the terminal is for this program, which then ends ffmpeg.
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt;
            command.process_group(0);
        }
        let mut process = command
            .spawn()
            .map_err(|_| FilmError::NoFfmpeg(settings.format))?;
        let stderr = process.stderr.take();
        let messages = std::thread::spawn(move || {
            let mut text = Vec::new();
            if let Some(mut stderr) = stderr {
                // What cannot be read is not reported.
                let _ = stderr.by_ref().take(MAX_MESSAGE).read_to_end(&mut text);
                let _ = io::copy(&mut stderr, &mut io::sink());
            }
            String::from_utf8_lossy(&text).into_owned()
        });
        Ok(Self {
            process,
            messages: Some(messages),
            size: coded_size(settings),
            keeps_alpha: settings.keeps_alpha,
        })
    }

    pub(crate) fn add(&mut self, frame: &DisplayFrame) -> Result<(), FilmError> {
        let planes = planes(frame, self.size, self.keeps_alpha);
        let written = self.process.stdin.as_mut().map(|pipe| pipe.write_all(&planes));
        match written {
            Some(Ok(())) => Ok(()),
            // ffmpeg has ended, and its message states why.
            Some(Err(_)) | None => Err(FilmError::Ffmpeg(self.end_message())),
        }
    }

    /// Waits until the film is complete.
    pub(crate) fn finish(mut self) -> Result<(), FilmError> {
        drop(self.process.stdin.take());
        let ended = self.process.wait();
        if ended.is_ok_and(|status| status.success()) {
            return Ok(());
        }
        Err(FilmError::Ffmpeg(self.end_message()))
    }

    /// Ends ffmpeg, and returns the first line of its message.
    fn end_message(&mut self) -> String {
        drop(self.process.stdin.take());
        let _ = self.process.wait();
        let text = self.messages.take().and_then(|messages| messages.join().ok());
        let text = text.unwrap_or_default();
        let line = text.lines().map(str::trim).find(|line| !line.is_empty());
        line.unwrap_or("it ended without a message").to_owned()
    }
}

impl Drop for FfmpegEncoder {
    /// Ends an ffmpeg whose film is given up.
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The size of the coded frames: H.264 with 4:2:0 chroma has even sides.
pub(crate) fn coded_size(settings: &FilmSettings) -> [u32; 2] {
    match settings.format {
        Format::Mp4 => settings.size.map(|side| side.next_multiple_of(2)),
        _ => settings.size,
    }
}

/// The argument for a file, also one whose name begins with `-` or looks like a protocol.
fn file(path: &Path) -> OsString {
    let mut argument = OsString::from("file:");
    argument.push(path);
    argument
}

/// The arguments before the name of the file.
fn arguments(settings: &FilmSettings) -> Vec<OsString> {
    let pixels = if settings.keeps_alpha {
        "yuva420p"
    } else {
        "yuv420p"
    };
    // Shaders' colors are displayed without conversion, as players display BT.709 on the same monitor.
    let colors = "-color_range tv -colorspace bt709 -color_primaries bt709 -color_trc bt709 \
                  -chroma_sample_location left";
    let [width, height] = coded_size(settings);
    let rate = settings.rate;
    let mut arguments = Vec::new();
    let mut add = |text: &str| arguments.extend(text.split_whitespace().map(OsString::from));
    add(&format!(
        "-nostdin -hide_banner -loglevel error -y -f rawvideo -pix_fmt {pixels} -video_size {width}x{height} \
         -framerate {rate} {colors} -i pipe:0"
    ));
    if let Some(sound) = &settings.sound {
        arguments.extend(["-i".into(), file(sound)]);
    }
    let mut add = |text: &str| arguments.extend(text.split_whitespace().map(OsString::from));
    add(&format!(
        "-pix_fmt {pixels} {colors} -c:v {}",
        encoder(settings.format)
    ));
    // Qualities at which the course's films differ from their frames by little more than 4:2:0 chroma does.
    add(match settings.format {
        Format::Webm => "-crf 24 -b:v 0 -deadline good -cpu-used 3 -row-mt 1 -tile-columns 2",
        _ => "-crf 18 -preset medium -movflags +faststart",
    });
    if settings.keeps_alpha {
        // VP9 codes alpha as a second stream, in which alternative references are not supported.
        add("-auto-alt-ref 0 -metadata:s:v:0 alpha_mode=1");
    }
    if settings.sound.is_some() {
        let frames = settings.frames.saturating_mul(settings.repetitions());
        let codec = match settings.format {
            Format::Webm => "libopus -b:a 160k",
            _ => "aac -b:a 192k",
        };
        // The sound is cut at the end of the film; a shorter one ends before.
        add(&format!(
            "-map 0:v -map 1:a -c:a {codec} -t {}",
            rate.seconds(frames)
        ));
    }
    add(match settings.format {
        Format::Webm => "-f webm",
        _ => "-f mp4",
    });
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_their_first_number() {
        for (version, older) in [
            ("5.1.9-0+deb12u1", false),
            ("3.4.8", true),
            ("n4.4", false),
            ("N-119000-gabcdef", false),
            ("2024-01-01-git-abc", false),
        ] {
            assert_eq!(is_older(version), older, "{version}");
        }
    }

    #[test]
    fn sides_of_h264_are_even() {
        let rate = crate::FrameRate::nearest(60.0);
        let size = |format| coded_size(&FilmSettings::new(format, [641, 360], rate, 1));
        assert_eq!(size(Format::Mp4), [642, 360]);
        assert_eq!(size(Format::Webm), [641, 360]);
    }
}
