//! The folders of collected submissions: one for each student of an assignment.

use std::path::{Component, Path};
use std::{fs, io};

use toyproof_diagnostic::{grouped, path_name, plural, printable};
use toyproof_image::output;

use super::class::ClassAssignment;
use super::collection::{StudentFolder, SubmittedFile};
use super::lateness::Lateness;
use super::naming::{Paths, file_name};
use super::roster::{Entry, FILE_NAME, Roster, SkippedFile};
use super::text::Content;

/// The largest number of skipped files of a student that have sentences of their own.
const MAX_NOTES: usize = 10;

/// Writes the shaders of a student into the student's own folder in `folder`: those of an assignment, if one
/// is given. Returns the student's entry in the roster, and a sentence about each changed or skipped file.
///
/// # Errors
/// A file cannot be written.
///
/// # Panics
/// Never: a file has a name.
pub fn write_student(
    folder: &Path,
    assignment: Option<&ClassAssignment>,
    student_folder: &StudentFolder,
    lateness: Lateness,
) -> Result<(Entry, Vec<String>), String> {
    let files = &student_folder.submission.files;
    let belongs = |file: &&SubmittedFile| {
        file.is_shader() && assignment.is_none_or(|assignment| assignment.has(&file.original_path()))
    };
    let named = files.iter().find(belongs).or(files.first());
    let mut entry = Entry {
        folder: student_folder.name.clone(),
        download: named.map(|file| file.download.clone()),
        time: student_folder.submission.time(assignment),
        name: student_folder.student.name.clone(),
        id: student_folder.student.id.clone(),
        late: match lateness {
            Lateness::Late(late) => Some(late),
            Lateness::OnTime | Lateness::Unknown => None,
        },
        files: Vec::new(),
        skipped: Vec::new(),
    };
    let mut notes = Vec::new();
    let mut paths = Paths::default();
    for handed in files {
        let original = handed.original_path();
        let mut skip = |reason: &str| {
            let (file, reason) = (original.clone(), reason.to_owned());
            entry.skipped.push(SkippedFile { file, reason });
        };
        let belongs = assignment.is_none_or(|assignment| assignment.has(&original));
        match &handed.content {
            Err(reason) => skip(reason),
            Ok(Content::Other(reason)) => skip(reason),
            Ok(Content::Text { .. }) if !belongs => {}
            Ok(Content::Text {
                text,
                encoding,
                is_renamed,
            }) => {
                let (last, parents) = handed.path.split_last().expect("a file has a name");
                let file = paths.file(parents, &output_name(last, *is_renamed));
                let path = folder.join(&student_folder.name).join(&file);
                match output::write_inside(folder, &path, text.as_bytes()) {
                    Ok(()) => {}
                    // The path is invalid; another one may be valid.
                    Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
                        skip("its path is too long for this file system");
                        continue;
                    }
                    Err(error) => {
                        return Err(format!(
                            "cannot write {error}\nhelp: not all submissions were written; collect them again"
                        ));
                    }
                }
                notes
                    .extend(encoding.map(|encoding| format!("{file} was saved as {encoding}, now as UTF-8")));
                notes.extend(is_renamed.then(|| format!("{} is a shader, now {file}", printable(&original))));
                entry.files.push(file);
            }
        }
    }
    let skipped = entry.skipped.iter().map(|skipped| {
        let (file, reason) = (printable(&skipped.file), printable(&skipped.reason));
        format!("skipped {file}: {reason}")
    });
    notes.extend(skipped.take(MAX_NOTES));
    if let Some(more @ 1..) = entry.skipped.len().checked_sub(MAX_NOTES) {
        let files = plural(more as u64, "file", "files");
        notes.push(format!(
            "skipped {} more {files}: see {FILE_NAME}",
            grouped(more as u64)
        ));
    }
    Ok((entry, notes))
}

/// The name of a collected file: harmless on any system, with a shader's extension in lower case.
fn output_name(name: &str, is_renamed: bool) -> String {
    let name = file_name(name);
    let (stem, extension) = name.rsplit_once('.').unwrap_or((&name, ""));
    match is_renamed {
        false => format!("{stem}.{}", extension.to_lowercase()),
        true if stem.to_lowercase().ends_with(".glsl") => stem.to_lowercase(),
        true if stem.is_empty() => format!("{name}.glsl"),
        true => format!("{stem}.glsl"),
    }
}

/// Removes the files that an earlier run collected into the folders of assignments in a folder; other files
/// stay.
///
/// # Errors
/// The folder only has other files, which `collect` did not write.
pub fn remove_earlier(folder: &Path) -> Result<(), String> {
    let with_path = |error| format!("{}: {error}", path_name(folder));
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(with_path(error)),
    };
    let (mut is_collected, mut is_empty) = (false, true);
    for entry in entries {
        is_empty = false;
        let assignment = entry.map_err(with_path)?.path();
        let Ok(Some(roster)) = Roster::read(&assignment) else {
            continue;
        };
        is_collected = true;
        for student in roster.students {
            let folder_of_student = assignment.join(&student.folder);
            let is_inside = |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_)));
            if !is_inside(student.folder.as_ref()) {
                continue;
            }
            for file in student.files.iter().filter(|file| is_inside(file.as_ref())) {
                // A file that cannot be removed is written again, or reported as a shader without a student.
                let _ = fs::remove_file(folder_of_student.join(file));
            }
            let _ = fs::remove_dir(folder_of_student);
        }
        let _ = fs::remove_file(assignment.join(FILE_NAME));
    }
    if is_collected || is_empty {
        return Ok(());
    }
    Err(format!(
        "{} already has files that toyproof did not collect\nhelp: give the report another folder with --out",
        path_name(folder)
    ))
}
