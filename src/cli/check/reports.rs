//! The files that `--out` gets beside the images: the reports, and `results.jsonl`.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Files, path_name};
use toyproof_image::output;
use toyproof_verify::contain::{Part, contain};

use super::images::{gallery, gallery_of_sources};
use super::submission::Submission;
use crate::cli::shader::Unusable;
use crate::cli::{Terminal, files};
use crate::report::{
    ClassTable, Hints, MAX_PAGE_SHADERS, MAX_SHADERS_WITH_IMAGES, PARTS, PagePart, Record, Report, Rubric,
    Rubrics, csv, gradescope, html, html_index, junit, part_name, sarif,
};

/// Reads a rubric, if one is named.
///
/// # Errors
/// The rubric is unusable; its errors have been printed.
pub(super) fn rubric(path: Option<&Path>, terminal: &Terminal) -> Result<Option<Rubric>, ()> {
    let Some(path) = path else {
        return Ok(None);
    };
    let mut files = Files::default();
    let rubric = match files::read_text(path) {
        Ok(text) => {
            let file = files.add(text);
            Rubric::parse(&files, file).map_err(|errors| Unusable::Invalid(errors.into()))
        }
        Err(error) => Err(Unusable::of(error, &mut files)),
    };
    rubric
        .map(Some)
        .map_err(|unusable| unusable.print(&files, terminal))
}

/// The file names of the reports, in the order in which they are written: once the last exists, all do.
pub(super) const REPORT_NAMES: [&str; 7] = [
    "report.html",
    "report.csv",
    "class.csv",
    "junit.xml",
    "report.sarif",
    "results.json",
    "verdict.json",
];

/// Writes the reports into the folder; returns false on failure. The submissions are those of the report's
/// records, in the same order. `results.json` is written only with a rubric of all shaders, and `class.csv`
/// only for a class. Students read `junit.xml` and `results.json`, which show the `hints`.
pub(super) fn write(
    report: &Report,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    hints: Hints,
    out: &Path,
    terminal: &Terminal,
) -> bool {
    let records = report.shaders();
    let mut students = records.to_vec();
    for record in &mut students {
        record.redact(hints);
    }
    let date = SystemTime::now();
    let parts_written = write_parts(report, submissions, rubrics, date, out, terminal);
    let texts: [&dyn Fn() -> Option<String>; REPORT_NAMES.len()] = [
        &|| {
            Some(match records.len() {
                0..=MAX_PAGE_SHADERS => html(report, rubrics, &gallery(submissions), date),
                _ => html_index(report, rubrics, date),
            })
        },
        &|| Some(csv(records, rubrics)),
        &|| {
            let mut table = ClassTable::default();
            for record in records {
                table.add(record, rubrics);
            }
            (!table.is_empty()).then(|| table.csv())
        },
        &|| Some(junit(&students)),
        &|| Some(sarif(records)),
        &|| Some(gradescope(&students, rubrics.of_all()?)),
        &|| Some(report.json()),
    ];
    let written = REPORT_NAMES
        .iter()
        .zip(texts)
        .map(|(name, text)| match contain(Part::Report, text) {
            Ok(None) => true,
            Ok(Some(text)) => terminal.write_output(out, &out.join(name), text.as_bytes()),
            Err(panic) => {
                terminal.error(format_args!("cannot write {name}: {panic}"));
                false
            }
        });
    // No short circuit: every report is written.
    written.fold(parts_written, |all, one| all & one)
}

/// Writes the pages of the parts of a large report, and removes those of an earlier, larger one; returns false
/// on failure.
fn write_parts(
    report: &Report,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    date: SystemTime,
    out: &Path,
    terminal: &Terminal,
) -> bool {
    let path = |number: usize| out.join(PARTS).join(part_name(number));
    let gallery = if submissions.len() > MAX_SHADERS_WITH_IMAGES {
        gallery_of_sources
    } else {
        gallery
    };
    let mut last = 0;
    for part in PagePart::all(report) {
        last = part.number();
        let page = contain(Part::Report, || {
            part.html(rubrics, &gallery(&submissions[part.places()]), date)
        });
        match page {
            Ok(page) if terminal.write_output(out, &path(last), page.as_bytes()) => {}
            Ok(_) => return false,
            Err(panic) => {
                terminal.error(format_args!("cannot write {}: {panic}", path_name(&path(last))));
                return false;
            }
        }
    }
    for stale in (last + 1..).map(path).take_while(|path| path.exists()) {
        if let Err(error) = output::remove_inside(out, &stale) {
            terminal.error(format_args!("cannot remove {error}"));
            return false;
        }
    }
    true
}

// `results.jsonl`: holds the record of each shader as soon as it is complete, so that an interrupted run can
// resume.

/// The name of the file of records.
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

/// The complete lines of `results.jsonl`, each with its result unless it cannot be parsed. A killed run
/// leaves an incomplete last line.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (&[u8], Option<Line>)> {
    let lines = bytes.split_inclusive(|&byte| byte == b'\n');
    let complete = lines.filter(|line| line.ends_with(b"\n"));
    complete.map(|line| (line, serde_json::from_slice(line).ok()))
}

/// The file of records, open for appending.
#[derive(Debug)]
pub(super) struct Results {
    path: PathBuf,
    file: File,
    /// The results of an earlier run, by key.
    known: HashMap<String, Line>,
    /// The number of lines of an earlier run that could not be read.
    pub(super) broken: usize,
}

impl Results {
    /// Creates the file; with `resume`, keeps the results that it has, except an incomplete last line.
    pub(super) fn open(folder: &Path, resume: bool) -> io::Result<Self> {
        let path = folder.join(RESULTS_NAME);
        let before = match std::fs::read(&path) {
            Ok(bytes) if resume => bytes,
            Err(error) if resume && error.kind() != io::ErrorKind::NotFound => {
                return Err(with_path(&path, &error));
            }
            _ => Vec::new(),
        };
        let mut kept = Vec::new();
        let mut known = HashMap::new();
        let mut broken = 0;
        for (line, parsed) in lines(&before) {
            match parsed {
                Some(result) => {
                    known.insert(result.key.clone(), result);
                    kept.extend_from_slice(line);
                }
                None => broken += 1,
            }
        }
        let results = Self::create(folder, &kept)?;
        Ok(Self {
            known,
            broken,
            ..results
        })
    }

    /// Creates the file with the results of other runs.
    pub(super) fn merged(folder: &Path, results: Vec<Line>) -> io::Result<Self> {
        let mut kept = Vec::new();
        for result in &results {
            serde_json::to_writer(&mut kept, result)?;
            kept.push(b'\n');
        }
        let known = results.into_iter().map(|result| (result.key.clone(), result));
        Ok(Self {
            known: known.collect(),
            ..Self::create(folder, &kept)?
        })
    }

    fn create(folder: &Path, kept: &[u8]) -> io::Result<Self> {
        let path = folder.join(RESULTS_NAME);
        output::write_inside(folder, &path, kept)?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|error| with_path(&path, &error))?;
        Ok(Self {
            path,
            file,
            known: HashMap::new(),
            broken: 0,
        })
    }

    /// Checks that the file still exists: what is written to a removed file is lost.
    pub(super) fn check_place(&self) -> io::Result<()> {
        match self.path.metadata() {
            Ok(_) => Ok(()),
            Err(error) => Err(with_path(&self.path, &error)),
        }
    }

    /// The result of an earlier run, if there is one.
    pub(super) fn known(&self, key: &str) -> Option<Line> {
        self.known.get(key).cloned()
    }

    /// Drops the results of an earlier run.
    pub(super) fn forget(&mut self) {
        self.known = HashMap::new();
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
