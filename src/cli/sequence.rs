//! Pictures of several frames: their numbers, their files, and which of them are still to be made.

use std::path::{Path, PathBuf};

use toyproof_image::FRAME_RATE;
use toyproof_verify::compare::grouped;

use super::Terminal;

/// The numbers of the frames of a sequence, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Frames {
    first: i32,
    last: i32,
}

/// Why standard output takes no sequence.
pub(super) const NO_FILE: &str = "a sequence needs a file to go to, whose name the numbers are added to";

/// Reads A..B.
pub(super) fn frames(text: &str) -> Result<Frames, String> {
    let expected = "expected the first and the last frame as A..B, with 0 ≤ A ≤ B";
    let (first, last) = text.split_once("..").ok_or(expected)?;
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if 0 <= first && first <= last => Ok(Frames { first, last }),
        _ => Err(expected.to_owned()),
    }
}

/// One frame of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbered {
    pub(super) frame: i32,
    /// In seconds, at `ShaderToy`'s 60 frames a second.
    pub(super) time: f64,
    pub(super) path: PathBuf,
}

impl Frames {
    fn count(self) -> u64 {
        u64::from(self.last.abs_diff(self.first)) + 1
    }

    /// All frames, each to go to `output` with its number before the extension.
    fn numbered(self, output: &Path) -> impl Iterator<Item = Numbered> {
        let digits = self.last.to_string().len().max(4);
        (self.first..=self.last).map(move |frame| {
            let stem = output.file_stem().unwrap_or_default().to_string_lossy();
            let extension = output.extension().unwrap_or_default().to_string_lossy();
            Numbered {
                frame,
                time: f64::from(frame) / f64::from(FRAME_RATE),
                path: output.with_file_name(format!("{stem}-{frame:0digits$}.{extension}")),
            }
        })
    }
}

/// A sequence that is being made. A record beside the pictures tells which come next, as long as some are missing.
#[derive(Debug)]
pub(super) struct Sequence {
    record: PathBuf,
    /// Scene and settings: a record of others does not count.
    what: String,
    frames: Frames,
    output: PathBuf,
    /// Frames from this one on have not been made; those before may have gone since.
    next: i64,
    /// How many are there.
    kept: u64,
}

impl Sequence {
    /// The frames that are still to be made, in their order.
    pub(super) fn resume(frames: Frames, output: &Path, what: &str, terminal: &Terminal) -> Self {
        let record = output.with_extension("sequence");
        let next = std::fs::read_to_string(&record)
            .ok()
            .and_then(|before| before.strip_prefix(what)?.trim().parse().ok())
            .unwrap_or(0);
        let made = frames
            .numbered(output)
            .take_while(|one| i64::from(one.frame) < next);
        let kept = made.filter(|one| one.path.is_file()).count() as u64;
        if kept > 0 {
            let (kept, count) = (grouped(kept), grouped(frames.count()));
            terminal.say(&format!("{kept} of {count} frames are there already"));
        }
        Self {
            record,
            what: what.to_owned(),
            frames,
            output: output.to_owned(),
            next,
            kept,
        }
    }

    /// Makes one frame after the other, until one fails; tells whether none did.
    pub(super) fn make(self, terminal: &Terminal, mut frame: impl FnMut(&Numbered) -> bool) -> bool {
        let bar = terminal.bar(self.frames.count() - self.kept, "frames");
        let is_missing = |one: &Numbered| i64::from(one.frame) >= self.next || !one.path.is_file();
        for one in self.frames.numbered(&self.output).filter(is_missing) {
            if !frame(&one) {
                return false;
            }
            let record = format!("{}\n{}\n", self.what, i64::from(one.frame) + 1);
            if !terminal.write(&self.record, record.as_bytes()) {
                return false;
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        // All are there: nothing is left to tell.
        let _ = std::fs::remove_file(&self.record);
        true
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::path_name;

    use super::*;

    #[test]
    fn a_range_has_both_ends_and_its_files_sort_by_number() {
        let sequence = frames("8..11").unwrap();
        let names: Vec<_> = sequence
            .numbered(Path::new("a/b.png"))
            .map(|one| path_name(&one.path))
            .collect();
        assert_eq!(
            names,
            ["a/b-0008.png", "a/b-0009.png", "a/b-0010.png", "a/b-0011.png"]
        );
        for wrong in ["", "3", "3..", "..3", "4..3", "-1..3", "1..x", "1..2..3"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_was_stopped_continues_unless_something_else_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("x.png");
        let terminal = Terminal::new(true, false);
        // Far too many to be listed.
        let far = Sequence::resume(frames("0..2147483647").unwrap(), &output, "far", &terminal);
        let mut first = Vec::new();
        far.make(&terminal, |one| {
            first.push(one.frame);
            first.len() < 3
        });
        assert_eq!(first, [0, 1, 2]);
        let make = |what: &str, most: usize| {
            let mut made = Vec::new();
            let sequence = Sequence::resume(frames("0..3").unwrap(), &output, what, &terminal);
            let whole = sequence.make(&terminal, |one| {
                made.push(one.frame);
                std::fs::write(&one.path, "").unwrap();
                made.len() <= most
            });
            (made, whole)
        };
        assert_eq!(make("a", 2), (vec![0, 1, 2], false), "the third fails");
        assert_eq!(make("a", 0), (vec![2], false), "what was made is kept");
        assert_eq!(make("b", 1), (vec![0, 1], false), "other settings start over");
        assert_eq!(make("a", 2), (vec![0, 1, 2], false));
        std::fs::remove_file(folder.path().join("x-0001.png")).unwrap();
        assert_eq!(
            make("a", 9),
            (vec![1, 2, 3], true),
            "what is missing is made again"
        );
        assert!(!folder.path().join("x.sequence").exists());
        assert_eq!(make("a", 9).0, [0, 1, 2, 3], "what is whole is made anew");
    }
}
