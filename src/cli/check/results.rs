//! `results.jsonl`: the record of each shader as soon as it is there, so that a run that was stopped goes on where it was.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::output;
use crate::report::Record;
use crate::source::path_name;

/// The name of the file.
pub(super) const NAME: &str = "results.jsonl";

/// One line.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    /// What the record depends on, as a hash.
    key: String,
    record: Record,
}

/// The file, while a run appends to it.
#[derive(Debug)]
pub(super) struct Results {
    path: PathBuf,
    file: File,
    /// What an earlier run found.
    known: HashMap<String, Record>,
}

impl Results {
    /// Begins the file; with `resume` it goes on with what is there. A line that was being written when a run was killed is dropped.
    pub(super) fn open(folder: &Path, resume: bool) -> io::Result<Self> {
        let path = folder.join(NAME);
        let before = match std::fs::read_to_string(&path) {
            Ok(text) if resume => text,
            Err(error) if resume && error.kind() != io::ErrorKind::NotFound => {
                return Err(named(&path, &error));
            }
            _ => String::new(),
        };
        let mut kept = String::new();
        let mut known = HashMap::new();
        for line in before.split_inclusive('\n').filter(|line| line.ends_with('\n')) {
            if let Ok(Line { key, record }) = serde_json::from_str(line) {
                known.insert(key, record);
                kept.push_str(line);
            }
        }
        output::write_inside(folder, &path, kept.as_bytes())?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|error| named(&path, &error))?;
        Ok(Self { path, file, known })
    }

    /// What is known of a shader.
    pub(super) fn known(&mut self, key: &str) -> Option<Record> {
        self.known.remove(key)
    }

    /// Adds a record: whole, in one write.
    pub(super) fn add(&mut self, key: &str, record: &Record) -> io::Result<()> {
        #[derive(Serialize)]
        struct Borrowed<'a> {
            key: &'a str,
            record: &'a Record,
        }
        let mut line = serde_json::to_vec(&Borrowed { key, record }).map_err(io::Error::other)?;
        line.push(b'\n');
        self.file
            .write_all(&line)
            .map_err(|error| named(&self.path, &error))
    }
}

fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path_name(path)))
}
