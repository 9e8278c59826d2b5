//! `results.jsonl`: holds the record of each shader as soon as it is complete, so that an interrupted run can
//! resume, and shards can be merged.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
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

impl Line {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut line = serde_json::to_vec(self)?;
        line.push(b'\n');
        out.write_all(&line)
    }
}

/// Reads the complete lines of a file, and counts those that cannot be parsed. A killed run leaves an
/// incomplete last line. A file that does not exist has no lines.
pub(super) fn read_lines(path: &Path) -> io::Result<(Vec<Line>, u64)> {
    let mut file = match input::open(path) {
        Ok(file) => BufReader::new(file),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok((Vec::new(), 0)),
        Err(error) => return Err(with_path(path, &error)),
    };
    let (mut lines, mut broken) = (Vec::new(), 0);
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = file.read_until(b'\n', &mut line);
        read.map_err(|error| with_path(path, &error))?;
        if !line.ends_with(b"\n") {
            return Ok((lines, broken));
        }
        match serde_json::from_slice(&line) {
            Ok(line) => lines.push(line),
            Err(_) => broken += 1,
        }
    }
}

/// The file of records, open for appending.
#[derive(Debug)]
pub(super) struct Results {
    path: PathBuf,
    file: File,
    /// The results of an earlier run, by key.
    known: HashMap<String, Line>,
}

impl Results {
    /// Creates the file with the results of an earlier run.
    pub(super) fn create(folder: &Path, lines: Vec<Line>) -> io::Result<Self> {
        let path = folder.join(RESULTS_NAME);
        output::stream_inside(folder, &path, |out| {
            lines.iter().try_for_each(|line| line.write(out))
        })?;
        let file = OpenOptions::new().append(true).open(&path);
        Ok(Self {
            file: file.map_err(|error| with_path(&path, &error))?,
            path,
            known: lines.into_iter().map(|line| (line.key.clone(), line)).collect(),
        })
    }

    /// Checks that the file still exists: writes to a removed file are lost.
    pub(super) fn check_place(&self) -> io::Result<()> {
        match self.path.metadata() {
            Ok(_) => Ok(()),
            Err(error) => Err(with_path(&self.path, &error)),
        }
    }

    /// The result of an earlier run, if there is one.
    pub(super) fn known(&self, key: &str) -> Option<&Line> {
        self.known.get(key)
    }

    /// Appends a result in a single write.
    pub(super) fn add(&mut self, line: &Line) -> io::Result<()> {
        let written = line.write(&mut self.file);
        written.map_err(|error| with_path(&self.path, &error))
    }
}

fn with_path(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path_name(path)))
}
