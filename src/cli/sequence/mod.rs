//! Frames in a row: which they are, and whether they become numbered images, a film, or a stream on standard
//! output.
//!
//! # Parts
//!
//! - `args`: the flags of `run` and `render` that select frames.
//! - `files`: numbered images; `film`: films; `stream`: standard output. All are rendered by
//!   [`Sequence::render`].

mod args;
mod files;
mod film;
mod stream;

use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) use args::{Output, SequenceArgs, parse_rate};
pub(super) use files::NumberedFiles;
pub(super) use film::FilmFile;
use indicatif::ProgressBar;
pub(super) use stream::{FrameStream, StandardOutput};
use toyproof_diagnostic::grouped;
use toyproof_image::Image;

use super::{CliError, Terminal};

/// The numbers of the frames of a sequence, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Frames {
    first: i32,
    last: i32,
}

/// Parses A..B.
pub(super) fn parse_frames(text: &str) -> Result<Frames, String> {
    let expected = "expected A..B, the first and the last frame, with 0 ≤ A ≤ B";
    let (first, last) = text.split_once("..").ok_or(expected)?;
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if 0 <= first && first <= last => Ok(Frames { first, last }),
        _ => Err(expected.to_owned()),
    }
}

impl Frames {
    pub(super) fn first(self) -> i32 {
        self.first
    }

    pub(super) fn numbers(self) -> RangeInclusive<i32> {
        self.first..=self.last
    }

    pub(super) fn count(self) -> u64 {
        u64::from(self.last.abs_diff(self.first)) + 1
    }
}

/// How the rendering of a frame ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FrameEnd {
    /// The image is written.
    Written,
    /// The user interrupted the rendering.
    Interrupted,
}

/// What becomes of a rendered frame.
#[derive(Debug)]
pub(super) enum Destination<'a> {
    /// It is written to this file, by the caller.
    File(&'a Path),
    /// It is added to what has the frames before it.
    Film(&'a mut dyn FrameSink),
}

/// What takes frames one after the other.
pub(super) trait FrameSink: std::fmt::Debug {
    /// Adds the next frame.
    fn add(&mut self, image: &Image) -> Result<(), CliError>;
}

/// A sequence in progress.
#[derive(Debug)]
pub(super) enum Sequence<'a> {
    Files(NumberedFiles),
    Film(Box<FilmFile>),
    Stream(FrameStream<'a>),
}

impl Sequence<'_> {
    /// The first frame to render; `None` if all are rendered.
    pub(super) fn first_missing(&self) -> Option<i32> {
        match self {
            Self::Files(files) => files.first_missing(),
            Self::Film(film) => film.first_missing(),
            Self::Stream(stream) => Some(stream.frames().first()),
        }
    }

    /// Renders the missing frames in order until one fails or the user interrupts. A frame may end early when
    /// the user interrupts: it is then among those that are missing.
    pub(super) fn render(
        self,
        terminal: &Terminal,
        mut frame: impl FnMut(i32, Destination, &AtomicBool) -> Result<FrameEnd, CliError>,
    ) -> Result<(), CliError> {
        match self {
            Self::Files(files) => files.render(terminal, |one, interrupted| {
                frame(one.frame, Destination::File(&one.path), interrupted)
            }),
            Self::Film(film) => film.render(terminal, &mut frame),
            Self::Stream(stream) => stream.render(terminal, &mut frame),
        }
    }
}

/// Renders these frames, with a progress bar over all frames of the sequence, of which some exist.
fn render_each<F>(
    (frames, existing): (Frames, u64),
    missing: impl Iterator<Item = F>,
    terminal: &Terminal,
    mut frame: impl FnMut(&F, &AtomicBool) -> Result<FrameEnd, CliError>,
) -> Result<(), CliError> {
    let interrupted = terminal.watch_interrupts("the sequence ends with the frame in progress");
    let bar = terminal.bar(frames.count(), "frames");
    bar.set_position(existing);
    bar.reset_eta();
    let rendered = missing
        .into_iter()
        .try_for_each(|one| render_one(&one, frames, &bar, &interrupted, &mut frame));
    bar.finish_and_clear();
    rendered
}

fn render_one<F>(
    one: &F,
    frames: Frames,
    bar: &ProgressBar,
    interrupted: &AtomicBool,
    frame: &mut impl FnMut(&F, &AtomicBool) -> Result<FrameEnd, CliError>,
) -> Result<(), CliError> {
    if interrupted.load(Ordering::Relaxed) || frame(one, interrupted)? == FrameEnd::Interrupted {
        let error = CliError::new(format_args!(
            "interrupted after {} of {} frames",
            grouped(bar.position()),
            grouped(frames.count())
        ));
        return Err(error.with_help("run the same command again to render the others"));
    }
    bar.inc(1);
    Ok(())
}

/// Reports that frames of an interrupted run are used.
fn report_existing(existing: u64, frames: Frames, terminal: &Terminal) {
    if existing > 0 {
        let (existing, count) = (grouped(existing), grouped(frames.count()));
        terminal.note(&format!("resuming: {existing} of {count} frames exist already"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_both_ends() {
        let frames = parse_frames("8..11").unwrap();
        assert_eq!((frames.first(), frames.count()), (8, 4));
        for wrong in ["", "3", "3..", "..3", "4..3", "-1..3", "1..x", "1..2..3"] {
            assert!(parse_frames(wrong).is_err(), "{wrong}");
        }
    }
}
