//! The records of a run, in order. The first are held in memory, all others in a temporary file, so that the
//! memory of a large batch grows only by some bytes for each shader.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use toyproof_verify::Verdict;

use super::html::common_folder;
use super::{Hints, MAX_PAGE_SHADERS, Record, Tally};

/// The number of records that are kept in memory: those of a report with one page.
const MAX_IN_MEMORY: usize = MAX_PAGE_SHADERS;

/// The records of a run, in order.
#[derive(Debug, Default)]
pub struct Records {
    entries: Vec<Entry>,
    /// The folder that all shaders are in, with its final separator; `None` before the first.
    folder: Option<String>,
    /// The folder of the temporary file; `None` for the system's.
    temporary: Option<PathBuf>,
    /// The file, once there are more records than fit in memory.
    spill: Option<Mutex<File>>,
    /// The length of the file in bytes.
    length: u64,
    /// Whether the file cannot be written, so that further records are kept in memory.
    has_failed: bool,
}

/// A record, and the parts of it that are needed without reading it.
#[derive(Debug)]
struct Entry {
    verdict: Verdict,
    is_passed: bool,
    place: Place,
}

/// The place of a record.
#[derive(Debug)]
enum Place {
    Memory(Box<Record>),
    /// A range of the file, in bytes.
    File {
        start: u64,
        length: u32,
    },
}

impl From<Vec<Record>> for Records {
    fn from(records: Vec<Record>) -> Self {
        records.into_iter().collect()
    }
}

impl FromIterator<Record> for Records {
    fn from_iter<T: IntoIterator<Item = Record>>(records: T) -> Self {
        let mut all = Self::default();
        for record in records {
            all.push(record);
        }
        all
    }
}

impl Records {
    /// Creates a sequence whose temporary file is in that folder, which exists once the file is needed. The
    /// file has no name where the system permits it, and does not outlive the sequence.
    #[must_use]
    pub fn stored_in(folder: PathBuf) -> Self {
        Self {
            temporary: Some(folder),
            ..Self::default()
        }
    }

    /// The number of records.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are no records.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Appends a record.
    pub fn push(&mut self, record: Record) {
        match &self.folder {
            Some(folder) if record.shader.starts_with(folder) => {}
            folder => self.folder = Some(common_folder(folder.as_deref(), &record.shader)),
        }
        let entry = self.store(record, self.entries.len() < MAX_IN_MEMORY);
        self.entries.push(entry);
    }

    /// Replaces the record at an index below the length with one of the same shader.
    pub fn replace(&mut self, index: usize, record: Record) {
        let is_in_memory = matches!(self.entries[index].place, Place::Memory(_));
        self.entries[index] = self.store(record, is_in_memory);
    }

    /// The folder that all shaders are in, with its final separator; empty if there is none.
    pub(super) fn folder(&self) -> &str {
        self.folder.as_deref().unwrap_or_default()
    }

    /// The verdicts, in order.
    pub fn verdicts(&self) -> impl Iterator<Item = Verdict> + '_ {
        self.entries.iter().map(|entry| entry.verdict)
    }

    /// The number of shaders for each verdict.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.verdicts().collect()
    }

    /// Whether all shaders pass.
    #[must_use]
    pub fn are_passed(&self) -> bool {
        self.entries.iter().all(|entry| entry.is_passed)
    }

    /// Returns the record at an index below the length.
    ///
    /// # Errors
    /// The temporary file cannot be read.
    pub fn get(&self, index: usize) -> io::Result<Cow<'_, Record>> {
        match &self.entries[index].place {
            Place::Memory(record) => Ok(Cow::Borrowed(record)),
            Place::File { start, length } => {
                let read = self.read(*start, *length);
                let read = read.and_then(|bytes| Ok(serde_json::from_slice(&bytes)?));
                read.map(Cow::Owned).map_err(|error| {
                    let message = format!("a temporary file cannot be read: {error}");
                    io::Error::new(error.kind(), message)
                })
            }
        }
    }

    /// Returns the records of a range of indices, in order; an error where the temporary file cannot be read.
    pub fn range(&self, range: Range<usize>) -> impl Iterator<Item = io::Result<Cow<'_, Record>>> + '_ {
        range.map(|index| self.get(index))
    }

    /// Returns all records, in order; an error where the temporary file cannot be read.
    pub fn iter(&self) -> impl Iterator<Item = io::Result<Cow<'_, Record>>> + '_ {
        self.range(0..self.len())
    }

    /// Returns all records as students see them.
    pub(super) fn redacted(&self, hints: Hints) -> impl Iterator<Item = io::Result<Record>> + '_ {
        self.iter()
            .map(move |record| Ok(record?.into_owned().redacted(hints)))
    }

    fn store(&mut self, record: Record, in_memory: bool) -> Entry {
        let (verdict, is_passed) = (record.verdict, record.is_passed());
        let place = if in_memory || self.has_failed {
            None
        } else {
            self.spill(&record)
        };
        Entry {
            verdict,
            is_passed,
            place: place.unwrap_or_else(|| Place::Memory(Box::new(record))),
        }
    }

    /// Writes a record to the end of the file. Without a file, for example on a full disk, `None`: a record
    /// is never lost.
    fn spill(&mut self, record: &Record) -> Option<Place> {
        let place = self.try_spill(record);
        self.has_failed = place.is_err();
        place.ok()
    }

    fn try_spill(&mut self, record: &Record) -> io::Result<Place> {
        let bytes = serde_json::to_vec(record)?;
        let length = u32::try_from(bytes.len()).map_err(io::Error::other)?;
        if self.spill.is_none() {
            let file = match &self.temporary {
                Some(folder) => tempfile::tempfile_in(folder)?,
                None => tempfile::tempfile()?,
            };
            self.spill = Some(Mutex::new(file));
        }
        if let Some(file) = &mut self.spill {
            let file = file.get_mut().unwrap_or_else(PoisonError::into_inner);
            // After a write that failed in the middle, the file is longer than its used part.
            file.seek(SeekFrom::Start(self.length))?;
            file.write_all(&bytes)?;
        }
        let start = self.length;
        self.length += u64::from(length);
        Ok(Place::File { start, length })
    }

    fn read(&self, start: u64, length: u32) -> io::Result<Vec<u8>> {
        let file = self.spill.as_ref().ok_or(io::ErrorKind::NotFound)?;
        let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
        let mut bytes = vec![0; length as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples::{correct, invalid, record};
    use crate::repair::samples::repaired;

    fn named(index: usize) -> Record {
        Record {
            shader: index.to_string(),
            ..if index.is_multiple_of(2) {
                repaired()
            } else {
                invalid()
            }
        }
    }

    fn text(record: &Record) -> String {
        serde_json::to_string(record).unwrap()
    }

    #[test]
    fn records_keep_their_order_and_contents_in_memory_and_in_the_file() {
        const COUNT: usize = MAX_IN_MEMORY + 20;
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::stored_in(folder.path().to_owned());
        for index in 0..COUNT {
            records.push(named(index));
        }
        let held = |records: &Records| {
            let entries = records.entries.iter();
            entries
                .filter(|entry| matches!(entry.place, Place::Memory(_)))
                .count()
        };
        assert_eq!((records.len(), held(&records)), (COUNT, MAX_IN_MEMORY));
        for (index, record) in records.iter().enumerate() {
            assert_eq!(text(&record.unwrap()), text(&named(index)), "{index}");
        }
        for index in [3, MAX_IN_MEMORY + 3] {
            records.replace(index, correct());
            assert_eq!(text(&records.get(index).unwrap()), text(&correct()));
            assert_eq!(records.get(index + 1).unwrap().shader, (index + 1).to_string());
        }
        assert_eq!(held(&records), MAX_IN_MEMORY);
        let tally: Tally = records.iter().map(|record| record.unwrap().verdict).collect();
        assert_eq!(records.tally().to_string(), tally.to_string());
        assert!(!records.are_passed());
    }

    #[test]
    fn without_a_file_records_are_held_in_memory() {
        let gone = tempfile::tempdir().unwrap().path().join("gone");
        let mut records = Records::stored_in(gone);
        for index in 0..MAX_IN_MEMORY + 2 {
            records.push(named(index));
        }
        let last = records.iter().last().unwrap().unwrap();
        assert_eq!(text(&last), text(&named(MAX_IN_MEMORY + 1)));
    }

    #[test]
    fn a_passed_record_is_one_without_faults() {
        assert!(Records::from(vec![correct(), record(Verdict::Ok)]).are_passed());
        assert!(Records::default().is_empty() && Records::default().are_passed());
        assert!(!Records::from(vec![correct(), invalid()]).are_passed());
    }
}
