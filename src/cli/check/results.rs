//! `results.jsonl`: holds the record of each shader as soon as it is complete, so that an interrupted run can
//! resume, and shards can be merged. Of earlier results, only their places in the file are in memory.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::path_name;
use toyproof_image::{input, output};
use toyproof_report::Record;

/// The name of the file.
pub(super) const RESULTS_NAME: &str = "results.jsonl";

/// A line of the file: the result of a shader.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Line {
    /// A hash of everything that the record depends on.
    pub(super) key: String,
    pub(super) record: Record,
    /// The adapter that rendered it, if any did.
    #[serde(default)]
    pub(super) device: Option<String>,
}

/// A line's place in a file, with its end, in bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    start: u64,
    length: usize,
}

/// Calls `on_line` for each complete line of a file, with its place, its bytes, and its result unless it
/// cannot be parsed. A killed run leaves an incomplete last line. A file that does not exist has no lines.
pub(super) fn for_each_line(
    path: &Path,
    mut on_line: impl FnMut(Span, &[u8], Option<Line>) -> io::Result<()>,
) -> io::Result<()> {
    let mut file = match input::open(path) {
        Ok(file) => BufReader::new(file),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(with_path(path, &error)),
    };
    let mut line = Vec::new();
    let mut start = 0;
    loop {
        line.clear();
        let length = file.read_until(b'\n', &mut line);
        let length = length.map_err(|error| with_path(path, &error))?;
        if !line.ends_with(b"\n") {
            return Ok(());
        }
        on_line(Span { start, length }, &line, serde_json::from_slice(&line).ok())?;
        start += length as u64;
    }
}

/// Reads the line at a place of a file.
pub(super) fn read_span(file: &mut File, Span { start, length }: Span) -> io::Result<Vec<u8>> {
    let mut line = vec![0; length];
    file.seek(SeekFrom::Start(start))?;
    file.read_exact(&mut line)?;
    Ok(line)
}

/// The file of records, open for appending.
#[derive(Debug)]
pub(super) struct Results {
    path: PathBuf,
    file: File,
    /// The places of the results of an earlier run, by key.
    known: HashMap<String, Span>,
    /// The file that these places are in.
    earlier: File,
    /// The number of lines of an earlier run that could not be read.
    pub(super) broken: usize,
}

impl Results {
    /// Creates the file; with `resume`, keeps the results that it has, except an incomplete last line.
    pub(super) fn open(folder: &Path, resume: bool) -> io::Result<Self> {
        let mut broken = 0;
        let results = Self::create(folder, |add| {
            if !resume {
                return Ok(());
            }
            for_each_line(&folder.join(RESULTS_NAME), |_, line, parsed| {
                if let Some(result) = parsed {
                    return add(line, result.key);
                }
                broken += 1;
                Ok(())
            })
        })?;
        Ok(Self { broken, ..results })
    }

    /// Creates the file with the lines of other runs, and their keys.
    pub(super) fn merged(
        folder: &Path,
        lines: impl Iterator<Item = io::Result<(Vec<u8>, String)>>,
    ) -> io::Result<Self> {
        Self::create(folder, |add| {
            for line in lines {
                let (line, key) = line?;
                add(&line, key)?;
            }
            Ok(())
        })
    }

    /// Creates the file with the lines that `fill` adds, each with its key.
    fn create(
        folder: &Path,
        fill: impl FnOnce(&mut dyn FnMut(&[u8], String) -> io::Result<()>) -> io::Result<()>,
    ) -> io::Result<Self> {
        let path = folder.join(RESULTS_NAME);
        let mut known = HashMap::new();
        let mut start = 0;
        output::stream_inside(folder, &path, |out| {
            fill(&mut |line, key| {
                out.write_all(line)?;
                let length = line.len();
                known.insert(key, Span { start, length });
                start += length as u64;
                Ok(())
            })
        })?;
        let open = |options: &mut OpenOptions| {
            let opened = options.open(&path);
            opened.map_err(|error| with_path(&path, &error))
        };
        Ok(Self {
            file: open(OpenOptions::new().append(true))?,
            earlier: open(OpenOptions::new().read(true))?,
            path,
            known,
            broken: 0,
        })
    }

    /// Checks that the file still exists: writes to a removed file are lost.
    pub(super) fn check_place(&self) -> io::Result<()> {
        match self.path.metadata() {
            Ok(_) => Ok(()),
            Err(error) => Err(with_path(&self.path, &error)),
        }
    }

    /// Whether there is a result of an earlier run.
    pub(super) fn is_known(&self, key: &str) -> bool {
        self.known.contains_key(key)
    }

    /// Reads the result of an earlier run, which is known.
    pub(super) fn known(&mut self, key: &str) -> io::Result<Line> {
        let span = self.known.get(key).ok_or(io::ErrorKind::NotFound)?;
        let line = read_span(&mut self.earlier, *span);
        let line = line.and_then(|line| Ok(serde_json::from_slice(&line)?));
        line.map_err(|error| with_path(&self.path, &error))
    }

    /// Appends a result in a single write.
    pub(super) fn add(&mut self, key: &str, record: &Record, device: Option<&str>) -> io::Result<()> {
        #[derive(Serialize)]
        struct Borrowed<'a> {
            key: &'a str,
            record: &'a Record,
            device: Option<&'a str>,
        }
        let mut line = serde_json::to_vec(&Borrowed { key, record, device }).map_err(io::Error::other)?;
        line.push(b'\n');
        self.file
            .write_all(&line)
            .map_err(|error| with_path(&self.path, &error))
    }
}

fn with_path(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path_name(path)))
}
