//! Numbered images: their names, and which are still to be rendered.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_image::{self as image, input};

use super::{FrameEnd, Frames, render_each, report_existing};
use crate::cli::{CliError, Terminal};

/// One frame of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SequenceFrame {
    pub(super) frame: i32,
    pub(super) path: PathBuf,
}

impl Frames {
    /// All frames; the path of each is `output` with the frame's number before the extension.
    fn numbered(self, output: &Path) -> impl Iterator<Item = SequenceFrame> {
        let digits = self.last.to_string().len().max(4);
        (self.first..=self.last).map(move |frame| {
            let stem = output.file_stem().unwrap_or_default().to_string_lossy();
            let extension = output.extension().unwrap_or_default().to_string_lossy();
            SequenceFrame {
                frame,
                path: output.with_file_name(format!("{stem}-{frame:0digits$}.{extension}")),
            }
        })
    }
}

/// A sequence of files in progress. A record next to the images holds the next frame until all frames exist.
#[derive(Debug)]
pub(in crate::cli) struct NumberedFiles {
    record: PathBuf,
    /// Identifies the content and the settings: a record with a different fingerprint is ignored.
    fingerprint: String,
    frames: Frames,
    output: PathBuf,
    /// The first frame that has never been rendered; files of earlier ones may have been deleted since.
    next: i64,
    /// The number of frames whose files exist.
    existing: u64,
}

impl NumberedFiles {
    /// The first frame to render; `None` if the files of all exist.
    pub(super) fn first_missing(&self) -> Option<i32> {
        let mut missing = self.missing();
        missing.next().map(|one| one.frame)
    }

    fn missing(&self) -> impl Iterator<Item = SequenceFrame> {
        let numbered = self.frames.numbered(&self.output);
        numbered.filter(|one| i64::from(one.frame) >= self.next || !one.path.is_file())
    }

    /// Prepares a sequence, reading the record of an interrupted run.
    pub(in crate::cli) fn resume(
        frames: Frames,
        output: &Path,
        fingerprint: &str,
        terminal: &Terminal,
    ) -> Self {
        let record = output.with_extension("sequence");
        let next = input::read(&record)
            .ok()
            .and_then(|before| {
                String::from_utf8(before)
                    .ok()?
                    .strip_prefix(fingerprint)?
                    .trim()
                    .parse()
                    .ok()
            })
            .unwrap_or(0);
        let made = frames
            .numbered(output)
            .take_while(|one| i64::from(one.frame) < next);
        let existing = made.filter(|one| one.path.is_file()).count() as u64;
        report_existing(existing, frames, terminal);
        Self {
            record,
            fingerprint: fingerprint.to_owned(),
            frames,
            output: output.to_owned(),
            next,
            existing,
        }
    }

    /// Renders the missing frames in order until one fails or the user interrupts.
    pub(super) fn render(
        self,
        terminal: &Terminal,
        mut frame: impl FnMut(&SequenceFrame, &AtomicBool) -> Result<FrameEnd, CliError>,
    ) -> Result<(), CliError> {
        let start = Instant::now();
        let progress = (self.frames, self.existing);
        render_each(progress, self.missing(), terminal, |one, interrupted| {
            let end = frame(one, interrupted)?;
            if end == FrameEnd::Written {
                let record = format!("{}\n{}\n", self.fingerprint, i64::from(one.frame) + 1);
                terminal.write(&self.record, record.as_bytes())?;
            }
            Ok(end)
        })?;
        self.finish(terminal, start);
        Ok(())
    }

    /// Removes the record of a complete sequence, and confirms its files.
    fn finish(self, terminal: &Terminal, start: Instant) {
        // The sequence is complete, so no record is needed.
        let _ = std::fs::remove_file(&self.record);
        if let Some(stale) = self.stale_frame() {
            terminal.warn(format_args!(
                "{} is left over from an earlier sequence with another size",
                path_name(&stale)
            ));
            terminal.help("delete the old frames before you encode a video");
        }
        let mut frames = self.frames.numbered(&self.output);
        if let Some(SequenceFrame { path: first, .. }) = frames.next() {
            let last = frames
                .last()
                .map(|last| format!("to {}, ", path_name(&last.path)));
            let facts = format!(
                "{}{} {}, {:.1} s",
                last.unwrap_or_default(),
                grouped(self.frames.count()),
                plural(self.frames.count(), "frame", "frames"),
                start.elapsed().as_secs_f64()
            );
            terminal.confirm(&first, &facts);
        }
    }

    /// Returns the first frame outside of this sequence whose image has another size than its last frame.
    fn stale_frame(&self) -> Option<PathBuf> {
        let size = |path: &Path| image::read(path).ok().map(|image| image.size());
        let last = self.frames.numbered(&self.output).last()?.path;
        let prefix = format!("{}-", self.output.file_stem()?.to_string_lossy());
        let is_frame = |path: &PathBuf| {
            let stem = path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let number = stem.strip_prefix(&prefix).and_then(|number| number.parse().ok());
            let is_other =
                number.is_some_and(|number| !(self.frames.first..=self.frames.last).contains(&number));
            is_other && path.extension() == self.output.extension()
        };
        let folder = self.output.parent().filter(|folder| *folder != Path::new(""));
        let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
        let paths = entries.filter_map(|entry| Some(self.output.with_file_name(entry.ok()?.file_name())));
        let other = paths.filter(is_frame).min()?;
        (size(&other)? != size(&last)?).then_some(other)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use super::*;
    use crate::cli::sequence::parse_frames;

    #[test]
    fn files_sort_by_number() {
        let sequence = parse_frames("8..11").unwrap();
        let names: Vec<_> = sequence
            .numbered(Path::new("a/b.png"))
            .map(|one| path_name(&one.path))
            .collect();
        assert_eq!(
            names,
            ["a/b-0008.png", "a/b-0009.png", "a/b-0010.png", "a/b-0011.png"]
        );
    }

    #[test]
    fn frames_of_another_size_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("x.png");
        let terminal = Terminal::new(true, false);
        let write = |name: &str, width: u32| {
            let image = image::Image::new(width, 1, vec![[0.0; 4]; width as usize]);
            let path = folder.path().join(name);
            std::fs::write(&path, image::encode(&image, &path).unwrap()).unwrap();
        };
        let sequence = || NumberedFiles::resume(parse_frames("0..1").unwrap(), &output, "a", &terminal);
        write("x-0001.png", 2);
        write("x-0002.png", 2);
        write("x-y.png", 3);
        assert_eq!(sequence().stale_frame(), None, "of the same size");
        write("x-0001.png", 3);
        assert_eq!(sequence().stale_frame(), Some(folder.path().join("x-0002.png")));
    }

    #[test]
    fn interrupted_sequences_resume_unless_settings_change() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("x.png");
        let terminal = Terminal::new(true, false);
        // Too many to be collected in memory.
        let far = NumberedFiles::resume(parse_frames("0..2147483647").unwrap(), &output, "far", &terminal);
        let mut first = Vec::new();
        let end = |is_written: bool| {
            if is_written {
                Ok(FrameEnd::Written)
            } else {
                Err(CliError::silent())
            }
        };
        let failed = far.render(&terminal, |one, _| {
            first.push(one.frame);
            end(first.len() < 3)
        });
        assert!(failed.is_err());
        assert_eq!(first, [0, 1, 2]);
        let render = |fingerprint: &str, most: usize| {
            let mut made = Vec::new();
            let sequence =
                NumberedFiles::resume(parse_frames("0..3").unwrap(), &output, fingerprint, &terminal);
            let whole = sequence.render(&terminal, |one, _| {
                made.push(one.frame);
                std::fs::write(&one.path, "").unwrap();
                end(made.len() <= most)
            });
            (made, whole.is_ok())
        };
        assert_eq!(render("a", 2), (vec![0, 1, 2], false), "the third fails");
        assert_eq!(render("a", 0), (vec![2], false), "what was made is kept");
        assert_eq!(render("b", 1), (vec![0, 1], false), "other settings start over");
        assert_eq!(render("a", 2), (vec![0, 1, 2], false));
        std::fs::remove_file(folder.path().join("x-0001.png")).unwrap();
        assert_eq!(
            render("a", 9),
            (vec![1, 2, 3], true),
            "what is missing is made again"
        );
        assert!(!folder.path().join("x.sequence").exists());
        assert_eq!(render("a", 9).0, [0, 1, 2, 3], "what is whole is made anew");
    }

    #[test]
    fn an_interrupt_reaches_the_frame_in_progress_which_then_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("x.png");
        let terminal = Terminal::new(true, false);
        let sequence = || NumberedFiles::resume(parse_frames("5..8").unwrap(), &output, "a", &terminal);
        assert_eq!(sequence().first_missing(), Some(5));
        let whole = sequence().render(&terminal, |one, interrupted| {
            if one.frame == 7 {
                interrupted.store(true, Ordering::Relaxed);
                return Ok(FrameEnd::Interrupted);
            }
            std::fs::write(&one.path, "").unwrap();
            Ok(FrameEnd::Written)
        });
        assert!(whole.is_err());
        assert_eq!(sequence().first_missing(), Some(7));
    }
}
