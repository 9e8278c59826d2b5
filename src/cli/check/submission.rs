//! A shader to check, and the hash of everything that its record depends on.

use std::path::PathBuf;
use std::time::SystemTime;

use sha2::{Digest, Sha256};
use toyproof_image::{FrameInputs, input};
use toyproof_project::files::{self, IncludeFolders, Input, ReadError};
use toyproof_report::StudentSubmission;

use super::options::CheckOptions;
use super::plan::Plan;
use super::reference::References;
use crate::cli::names::Names;
use crate::cli::project::image_files;

/// A shader to check.
pub(super) struct Submission {
    pub(super) input: Result<Input, ReadError>,
    pub(super) name: String,
    /// The path of the shader's images without the suffixes of file names; `None` without `--out`.
    pub(super) output_stem: Option<PathBuf>,
    /// A hash of everything that the record depends on; `None` if the shader's files cannot be read, or
    /// without `--out`.
    pub(super) key: Option<String>,
    /// The size of the text in bytes, where there is a key.
    pub(super) bytes: u64,
    /// The seconds of an earlier check, if `--costs` names a report with this shader.
    pub(super) seconds: Option<f64>,
    /// The index of the task.
    pub(super) task: usize,
    /// The student and the assignment, for a class.
    pub(super) submitted: Option<StudentSubmission>,
    /// The path of the student's page in the folder of `--feedback`, if the student is known.
    pub(super) page: Option<String>,
}

impl Submission {
    /// The name in reports, also of a shader that cannot be read.
    pub(super) fn shown_name(&self) -> String {
        match &self.input {
            Ok(found) => found.name(),
            Err(error) => error.name(),
        }
    }

    /// Whether the shader belongs to an assignment of a class.
    pub(super) fn is_assigned(&self) -> bool {
        let assignment = self.submitted.as_ref().map(|one| &one.assignment);
        assignment.is_some_and(Option::is_some)
    }

    /// With the `build` that checks it, the submission has a key.
    pub(super) fn new(
        input: Result<Input, ReadError>,
        options: &CheckOptions,
        plan: &Plan,
        references: &References,
        names: &mut Names,
        build: Option<&str>,
    ) -> Self {
        let found = input.as_ref().ok();
        let identity = found
            .zip(build)
            .and_then(|(found, build)| identity(found, options, plan, references, build));
        let (key, bytes) = identity.map_or((None, 0), |(key, bytes)| (Some(key), bytes));
        let output_stem = match (&options.out, found) {
            (Some(out), Some(found)) => Some(out.join(names.assign(found))),
            _ => None,
        };
        Self {
            name: found.map_or_else(String::new, Input::name),
            key,
            bytes,
            seconds: None,
            output_stem,
            task: 0,
            submitted: None,
            page: None,
            input,
        }
    }
}

/// Identifies this build of the program on this machine: the size of its file, in bytes, and the time of its
/// last change.
pub(super) fn build() -> Option<String> {
    let file = std::env::current_exe().and_then(std::fs::metadata).ok()?;
    let identity: (u64, SystemTime) = (file.len(), file.modified().ok()?);
    Some(format!("{identity:?}"))
}

/// Hashes everything that a record depends on: the build of toyproof, the shader, its reference, the
/// assignment, the flags, and the contents of the files that they name. Also returns the size of the shader
/// in bytes.
fn identity(
    found: &Input,
    options: &CheckOptions,
    plan: &Plan,
    references: &References,
    build: &str,
) -> Option<(String, u64)> {
    let mut hash = Sha256::new();
    let mut bytes = 0;
    let mut add = |part: &[u8]| {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    };
    let inputs: Vec<_> = plan.frames.iter().map(|planned| &planned.inputs).collect();
    let settings = (
        &inputs,
        &options.language,
        &options.driver,
        options.search,
        &plan.permitted,
    );
    add(build.as_bytes());
    let named = (&plan.reference.scene, &plan.reference.reference);
    add(format!("{settings:?} {named:?} {}", found.name()).as_bytes());
    let assignment = plan.assignment.as_ref().map(|(_, text)| text.as_bytes());
    add(assignment.unwrap_or_default());
    let texts = files::read(found).ok()?;
    let includes = IncludeFolders::of(found, options.language.include_folders());
    let included: Vec<_> = texts
        .files()
        .into_iter()
        .flat_map(|file| includes.texts(file))
        .collect();
    for file in texts.files().into_iter().chain(&included) {
        add(file.name().as_bytes());
        add(file.text().as_bytes());
        bytes += file.text().len() as u64;
    }
    for path in image_files(found, texts) {
        add(&input::read(&path).ok()?);
    }
    if let Some(content) = references.content(found) {
        add(&content.ok()?);
    }
    for path in inputs.into_iter().flat_map(FrameInputs::files) {
        add(&input::read(path).ok()?);
    }
    let hash: [u8; 32] = hash.finalize().into();
    let half = hash.first_chunk().copied().map(u128::from_be_bytes);
    half.map(|half| (format!("{half:032x}"), bytes))
}
