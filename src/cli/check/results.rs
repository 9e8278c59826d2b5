//! `results.jsonl`: the record of each shader as soon as it is there, so that a run that was stopped goes on where it was.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::path_name;
use toyproof_image::output;

use crate::report::Record;

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
    /// How many lines of an earlier run could not be read.
    pub(super) broken: usize,
}

impl Results {
    /// Begins the file; with `resume` it goes on with what is there. A line that was being written when a run was killed is dropped.
    pub(super) fn open(folder: &Path, resume: bool) -> io::Result<Self> {
        let path = folder.join(NAME);
        let before = match std::fs::read(&path) {
            Ok(bytes) if resume => bytes,
            Err(error) if resume && error.kind() != io::ErrorKind::NotFound => {
                return Err(named(&path, &error));
            }
            _ => Vec::new(),
        };
        let mut kept = Vec::new();
        let mut known = HashMap::new();
        let mut broken = 0;
        for line in before
            .split_inclusive(|&byte| byte == b'\n')
            .filter(|line| line.ends_with(b"\n"))
        {
            match serde_json::from_slice(line) {
                Ok(Line { key, record }) => {
                    known.insert(key, record);
                    kept.extend_from_slice(line);
                }
                Err(_) => broken += 1,
            }
        }
        output::write_inside(folder, &path, &kept)?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|error| named(&path, &error))?;
        Ok(Self {
            path,
            file,
            known,
            broken,
        })
    }

    /// Whether the file is still where it was: what is written to one that was removed is lost.
    pub(super) fn check_place(&self) -> io::Result<()> {
        match self.path.metadata() {
            Ok(_) => Ok(()),
            Err(error) => Err(named(&self.path, &error)),
        }
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
