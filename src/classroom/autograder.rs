//! Autograders: what a grading platform runs for each submission, made of an assignment and the program.

use std::io;
use std::path::{Component, Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_image::{FrameInputs, input};
use toyproof_project::archive::{self, Mode};
use toyproof_project::{PROJECT_FILE, Tab};
use toyproof_report::platform::{Kit, Platform, PlatformFile, Task};

use crate::assignment::{Assignment, FILE_NAME, Reference};

/// The files of an autograder.
#[derive(Debug)]
pub struct Autograder(Vec<AutograderFile>);

/// A file of an autograder.
#[derive(Debug)]
pub struct AutograderFile {
    /// Its path, with `/` between components.
    pub path: String,
    /// Whether it is a program.
    pub is_executable: bool,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl Autograder {
    /// Makes the autograder of an assignment, whose file is at `path`, with a program for Linux on x86-64.
    ///
    /// # Errors
    /// If the assignment gives no points, or a file cannot be read or is outside the assignment's folder.
    pub fn new(
        platform: &Platform,
        program: &Path,
        path: &Path,
        assignment: &Assignment,
    ) -> Result<Self, String> {
        if assignment.rubric.is_none() {
            return Err(format!(
                "{} gives no points\nhelp: add a table such as [rubric.algorithm] with `points = 6`",
                path_name(path)
            ));
        }
        let program_bytes = read(program)?;
        if !is_for_linux(&program_bytes) {
            return Err(format!(
                "{} is not a program for Linux on x86-64, which autograders run\nhelp: name one with --program",
                path_name(program)
            ));
        }
        let name = assignment_name(path);
        let task = Task {
            name: &name,
            program: &program_bytes,
        };
        let mut files: Vec<_> = platform
            .files(&task)
            .into_iter()
            .map(AutograderFile::from)
            .collect();
        let mut kit: Vec<_> = platform
            .kit_files()
            .into_iter()
            .map(AutograderFile::from)
            .collect();
        kit.extend(assignment_files(path, assignment)?);
        match platform.program {
            Some(path) => files.push(AutograderFile::program(path, program_bytes)),
            None => kit.push(AutograderFile::program("toyproof", program_bytes)),
        }
        match platform.kit {
            Kit::Folder(folder) => files.extend(kit.into_iter().map(|file| file.inside(folder))),
            Kit::Tar(path) => {
                let kit: Vec<_> = kit.into_iter().map(|file| file.inside("toyproof/")).collect();
                let archive = tar(&kit).map_err(|error| error.to_string())?;
                files.push(AutograderFile::plain(path.to_owned(), archive));
            }
            Kit::Zip(path) => files.push(AutograderFile::plain(path.to_owned(), zip(&kit)?)),
        }
        Ok(Self(files))
    }

    /// The files.
    #[must_use]
    pub fn files(&self) -> &[AutograderFile] {
        &self.0
    }

    /// Packs the files as a zip archive.
    ///
    /// # Errors
    /// If a file is too large for the format.
    pub fn zip(&self) -> Result<Vec<u8>, String> {
        zip(&self.0)
    }
}

impl From<PlatformFile> for AutograderFile {
    fn from(file: PlatformFile) -> Self {
        Self {
            path: file.path.to_owned(),
            is_executable: file.is_executable,
            bytes: file.text.into_bytes(),
        }
    }
}

impl AutograderFile {
    fn plain(path: String, bytes: Vec<u8>) -> Self {
        Self {
            path,
            is_executable: false,
            bytes,
        }
    }

    fn program(path: &str, bytes: Vec<u8>) -> Self {
        Self {
            is_executable: true,
            ..Self::plain(path.to_owned(), bytes)
        }
    }

    /// The same file in a folder, whose name is empty or ends with `/`.
    fn inside(self, folder: &str) -> Self {
        Self {
            path: format!("{folder}{}", self.path),
            ..self
        }
    }
}

/// Packs files as a tar archive. The same files give the same bytes, since no times are stored.
fn tar(files: &[AutograderFile]) -> io::Result<Vec<u8>> {
    let mut archive = tar::Builder::new(Vec::new());
    for file in files {
        let mut header = tar::Header::new_gnu();
        header.set_size(file.bytes.len() as u64);
        header.set_mode(if file.is_executable { 0o755 } else { 0o644 });
        archive.append_data(&mut header, &file.path, &file.bytes[..])?;
    }
    archive.into_inner()
}

fn zip(files: &[AutograderFile]) -> Result<Vec<u8>, String> {
    let packed = files.iter().map(|file| {
        let mode = if file.is_executable {
            Mode::Executable
        } else {
            Mode::Plain
        };
        (file.path.as_str(), mode, &file.bytes[..])
    });
    archive::pack(&packed.collect::<Vec<_>>()).map_err(|error| error.to_string())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    input::read(path).map_err(|error: io::Error| format!("{}: {error}", path_name(path)))
}

/// The name of an assignment, whose file is at `path`: that of its folder.
#[must_use]
pub fn assignment_name(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = absolute.parent().and_then(Path::file_name);
    folder.map_or_else(
        || "assignment".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// The file of an assignment at `path`, and the files that it names.
fn assignment_files(path: &Path, assignment: &Assignment) -> Result<Vec<AutograderFile>, String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = vec![AutograderFile::plain(
        format!("assignment/{FILE_NAME}"),
        read(path)?,
    )];
    for named in named_files(assignment) {
        let inside = named.strip_prefix(folder).unwrap_or(&named);
        let is_inside = inside
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !is_inside {
            return Err(format!(
                "{} is not in the folder of the assignment\nhelp: copy it there, and name the copy",
                path_name(&named)
            ));
        }
        let parts: Vec<_> = inside
            .components()
            .filter_map(|part| match part {
                Component::Normal(part) => part.to_str(),
                _ => None,
            })
            .collect();
        let name = format!("assignment/{}", parts.join("/"));
        if !files.iter().any(|other| other.path == name) {
            files.push(AutograderFile::plain(name, read(&named)?));
        }
    }
    Ok(files)
}

/// The files that an assignment names; of a project, the files in its folder.
fn named_files(assignment: &Assignment) -> Vec<PathBuf> {
    let reference = match &assignment.reference {
        Reference::Scene(path) | Reference::Given { path, .. } => path.clone(),
    };
    let names = Tab::ALL
        .into_iter()
        .map(Tab::file_name)
        .chain([PROJECT_FILE.to_owned()]);
    let mut files: Vec<_> = if reference.is_dir() {
        names
            .map(|name| reference.join(name))
            .filter(|path| path.is_file())
            .collect()
    } else {
        vec![reference]
    };
    let channels = assignment.frames.iter().flat_map(FrameInputs::files);
    files.extend(channels.map(Path::to_owned));
    files
}

/// Whether a program is an ELF file of 64 bits for x86-64.
fn is_for_linux(program: &[u8]) -> bool {
    program.starts_with(b"\x7fELF\x02\x01") && program.get(18..20) == Some(&[0x3e, 0])
}
