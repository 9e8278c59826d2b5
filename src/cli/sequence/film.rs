//! A film of the frames of a sequence.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use toyproof_diagnostic::{grouped, path_name};
use toyproof_film::{Film, FilmError, FilmSettings, FilmWriter, Format, Seam};
use toyproof_image::Image;

use super::{Destination, FrameEnd, FrameSink, Frames, SequenceArgs, render_each, report_existing};
use crate::cli::terminal::file_size;
use crate::cli::{CliError, Terminal};

/// A film in progress.
#[derive(Debug)]
pub(in crate::cli) struct FilmFile {
    frames: Frames,
    path: PathBuf,
    settings: FilmSettings,
    /// Whether the user wants it to be repeated.
    is_repeated: bool,
    writer: FilmWriter,
}

impl FrameSink for FilmWriter {
    fn add(&mut self, image: &Image) -> Result<(), CliError> {
        FilmWriter::add(self, image).map_err(film_error)
    }
}

impl FilmFile {
    /// Starts a film, or goes on with an interrupted one with the same fingerprint. `output` is its path, or
    /// the folder that the user named.
    pub(in crate::cli) fn start(
        (args, frames): (&SequenceArgs, Frames),
        settings: FilmSettings,
        (output, path): (&Path, &Path),
        fingerprint: &str,
        terminal: &Terminal,
    ) -> Result<Self, CliError> {
        let fingerprint = format!("{fingerprint} {}", frames.first());
        let writer = if path != output && path.starts_with(output) {
            FilmWriter::open_inside(output, path, settings.clone(), &fingerprint)
        } else {
            FilmWriter::open(path, settings.clone(), &fingerprint)
        };
        let writer = writer.map_err(film_error)?;
        report_existing(u64::from(writer.existing()), frames, terminal);
        Ok(Self {
            frames,
            path: path.to_owned(),
            settings,
            is_repeated: args.is_repeated(),
            writer,
        })
    }

    pub(super) fn first_missing(&self) -> Option<i32> {
        let existing = i64::from(self.writer.existing());
        let next = i64::from(self.frames.first()) + existing;
        (existing < self.frames.count() as i64).then_some(next as i32)
    }

    pub(super) fn render(
        mut self,
        terminal: &Terminal,
        frame: &mut impl FnMut(i32, Destination, &AtomicBool) -> Result<FrameEnd, CliError>,
    ) -> Result<(), CliError> {
        let start = Instant::now();
        let existing = u64::from(self.writer.existing());
        let missing = self.first_missing().unwrap_or(i32::MAX)..=self.frames.last;
        render_each(
            (self.frames, existing),
            missing,
            terminal,
            |&number, interrupted| frame(number, Destination::Film(&mut self.writer), interrupted),
        )?;
        self.finish(terminal, start)
    }

    /// Encodes the frames, and reports what the viewer of the film should know.
    fn finish(self, terminal: &Terminal, start: Instant) -> Result<(), CliError> {
        let interrupted = terminal.watch_interrupts("the film is given up, and its frames are kept");
        let bar = terminal.bar(u64::from(self.writer.steps()), "encoded frames");
        let finished = self.writer.finish(&mut |step| {
            bar.set_position(u64::from(step));
            !interrupted.load(Ordering::Relaxed)
        });
        bar.finish_and_clear();
        let film = finished.map_err(film_error)?;
        let settings = &self.settings;
        let [width, height] = film.size;
        let facts = format!(
            "{}, {width}×{height}, {} frames, {:.2} s, {}, rendered in {:.1} s",
            settings.format,
            grouped(self.frames.count()),
            settings.rate.seconds(settings.frames),
            file_size(film.bytes as usize),
            start.elapsed().as_secs_f64()
        );
        terminal.confirm(&self.path, &facts);
        report(&film, settings, &path_name(&self.path), terminal);
        if let Some(seam) = film.seam.filter(|seam| self.is_repeated && seam.is_visible()) {
            warn_of_seam(seam, &path_name(&self.path), terminal);
        }
        Ok(())
    }
}

/// Reports how a film differs from its frames.
fn report(film: &Film, settings: &FilmSettings, name: &str, terminal: &Terminal) {
    if settings.format == Format::Gif && film.shown < settings.frames {
        terminal.note(&format!(
            "{name} shows {} of the frames: viewers slow down a GIF of more than 50 in a second; --fps 50 renders \
             only what it shows",
            grouped(u64::from(film.shown))
        ));
    }
    if film.size != settings.size {
        terminal.note(&format!(
            "{name}: H.264 needs even sides: the last column or row is repeated"
        ));
    }
}

fn warn_of_seam(seam: Seam, name: &str, terminal: &Terminal) {
    terminal.warn(format_args!(
        "{name}: the last frame does not lead into the first: they differ by {:.1} of 255 levels (root mean \
         square), and frames that follow each other by at most {:.1}",
        seam.jump, seam.largest_step
    ));
    terminal.help("choose a --duration that is a period of the motion");
}

/// Why a film is not written.
pub(super) fn film_error(error: FilmError) -> CliError {
    let help = match error {
        FilmError::Ffmpeg(_) | FilmError::Interrupted => {
            Some("run the same command again: the frames are kept, and only encoded")
        }
        ref error => error.help(),
    };
    let error = CliError::new(error);
    match help {
        Some(help) => error.with_help(help),
        None => error,
    }
}
