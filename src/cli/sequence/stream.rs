//! Frames on standard output, which another program reads.

use std::io::{self, Write};
use std::sync::atomic::AtomicBool;

use toyproof_film::{FilmSettings, StreamWriter};
use toyproof_image::Image;

use super::{Destination, FrameEnd, FrameSink, Frames, render_each};
use crate::cli::{CliError, Terminal};

/// A stream in progress.
#[derive(Debug)]
pub(in crate::cli) struct FrameStream<'a> {
    frames: Frames,
    writer: StreamWriter<StandardOutput<'a>>,
}

/// Standard output, as the terminal writes it.
#[derive(Debug)]
pub(in crate::cli) struct StandardOutput<'a>(pub(in crate::cli) &'a Terminal);

impl Write for StandardOutput<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // The terminal has reported the error.
        self.0.bytes(bytes).map_err(|_| io::ErrorKind::Other)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl FrameSink for StreamWriter<StandardOutput<'_>> {
    fn add(&mut self, image: &Image) -> Result<(), CliError> {
        StreamWriter::add(self, image).map_err(|_| CliError::silent())
    }
}

impl<'a> FrameStream<'a> {
    pub(in crate::cli) fn new(
        frames: Frames,
        settings: FilmSettings,
        terminal: &'a Terminal,
    ) -> Result<Self, CliError> {
        let writer = StreamWriter::new(StandardOutput(terminal), settings);
        Ok(Self {
            frames,
            writer: writer.map_err(|_| CliError::silent())?,
        })
    }

    pub(super) fn frames(&self) -> Frames {
        self.frames
    }

    pub(super) fn render(
        mut self,
        terminal: &Terminal,
        frame: &mut impl FnMut(i32, Destination, &AtomicBool) -> Result<FrameEnd, CliError>,
    ) -> Result<(), CliError> {
        let all = self.frames.first()..=self.frames.last;
        // The reader may want no more frames.
        let wanted = all.take_while(|_| !terminal.is_closed());
        render_each((self.frames, 0), wanted, terminal, |&number, interrupted| {
            frame(number, Destination::Film(&mut self.writer), interrupted)
        })?;
        self.writer.finish().map_err(|_| CliError::silent())
    }
}
