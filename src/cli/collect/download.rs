//! The files of a download: a folder or an archive, with archives in it.

use std::fs::{self, File};
use std::io::{self, BufReader, Cursor, Read, Seek};
use std::path::Path;
use std::time::UNIX_EPOCH;

use toyproof_diagnostic::path_name;
use walkdir::WalkDir;

use super::text::{Content, content};
use crate::cli::files::{MAX_BYTES, is_hidden};
use crate::cli::zip::{Archive, FileTime};

/// The deepest archive in archives.
const MAX_DEPTH: usize = 4;
/// The largest archive in an archive, in bytes.
const MAX_NESTED_BYTES: u64 = 64 << 20;
/// The largest number of files.
const MAX_FILES: usize = 100_000;
/// The largest size of all texts, in bytes.
const MAX_TEXT_BYTES: usize = 1 << 30;

/// A file of a download.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Found {
    /// Its path in the download; archives in it are components that end with `.zip`. The last component of an
    /// empty folder is empty.
    pub(super) path: Vec<String>,
    /// What it is, or why it cannot be read.
    pub(super) content: Result<Content, String>,
    /// When it was last changed; of a file in an archive of the student, when that was.
    pub(super) time: Option<FileTime>,
}

/// Whether a name is that of an archive.
pub(super) fn is_archive(name: &str) -> bool {
    let extension = Path::new(name).extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("zip"))
}

/// Reads all files of a download, without hidden ones and those that macOS adds.
///
/// # Errors
/// It cannot be read, or has too many files.
pub(super) fn read(download: &Path) -> io::Result<Vec<Found>> {
    let mut reader = Reader::default();
    if download.is_dir() {
        reader.folder(download)?;
    } else {
        let file = BufReader::new(File::open(download)?);
        reader.archive(file, &[], None)?;
    }
    reader.found.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(reader.found)
}

#[derive(Debug, Default)]
struct Reader {
    found: Vec<Found>,
    bytes: usize,
}

impl Reader {
    fn folder(&mut self, folder: &Path) -> io::Result<()> {
        let entries = WalkDir::new(folder).follow_root_links(true).sort_by_file_name();
        let visible = |entry: &walkdir::DirEntry| entry.depth() == 0 || !is_hidden(entry.file_name());
        for entry in entries.into_iter().filter_entry(visible) {
            let entry = entry?;
            let inside = entry.path().strip_prefix(folder).unwrap_or(entry.path());
            let mut path: Vec<String> = inside
                .iter()
                .map(|part| part.to_string_lossy().into_owned())
                .collect();
            if entry.file_type().is_dir() {
                if entry.depth() > 0 && fs::read_dir(entry.path())?.next().is_none() {
                    path.push(String::new());
                    self.add(path, Err("it is empty".to_owned()), None)?;
                }
                continue;
            }
            if entry.path_is_symlink() {
                self.add(path, Err("it is a link".to_owned()), None)?;
                continue;
            }
            let limit = limit(&path);
            let read = File::open(entry.path()).and_then(|file| {
                let mut bytes = Vec::new();
                file.take(limit + 1).read_to_end(&mut bytes)?;
                Ok(bytes)
            });
            let modified = entry
                .metadata()
                .ok()
                .and_then(|metadata| metadata.modified().ok());
            let since = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
            let time = since.map(|since| FileTime::Utc(since.as_secs() as i64));
            self.file(path, read, time)?;
        }
        Ok(())
    }

    /// Reads an archive, whose files are below `parent`, and were changed at `time` if it is given.
    fn archive(
        &mut self,
        input: impl Read + Seek,
        parent: &[String],
        time: Option<FileTime>,
    ) -> io::Result<()> {
        let mut archive = Archive::open(input)?;
        for entry in archive.entries().to_vec() {
            let parts = entry
                .name
                .split('/')
                .filter(|part| !part.is_empty() && *part != ".");
            let inside: Vec<String> = parts.map(str::to_owned).collect();
            if inside.is_empty() || inside.iter().any(|part| is_hidden(part.as_ref()) && part != "..") {
                continue;
            }
            let is_outside = inside.iter().any(|part| part == "..");
            let path: Vec<String> = parent.iter().cloned().chain(inside).collect();
            if is_outside {
                self.add(path, Err("its path leads out of the archive".to_owned()), None)?;
                continue;
            }
            let read = archive.read(&entry, limit(&path));
            self.file(path, read, time.or(entry.modified))?;
        }
        Ok(())
    }

    fn file(
        &mut self,
        path: Vec<String>,
        read: io::Result<Vec<u8>>,
        time: Option<FileTime>,
    ) -> io::Result<()> {
        let name = path.last().cloned().unwrap_or_default();
        let bytes = match read {
            Ok(bytes) => bytes,
            Err(error) => return self.add(path, Err(format!("it cannot be read: {error}")), time),
        };
        if !is_archive(&name) {
            return self.add(path, Ok(content(&name, &bytes)), time);
        }
        let depth = path.iter().filter(|part| is_archive(part)).count();
        if depth > MAX_DEPTH {
            return self.add(
                path,
                Err(format!("more than {MAX_DEPTH} archives are in each other")),
                time,
            );
        }
        if bytes.len() as u64 > MAX_NESTED_BYTES {
            return self.add(path, Err("it is larger than 64 MiB".to_owned()), time);
        }
        match self.archive(Cursor::new(bytes), &path, time) {
            // What concerns all files is not this archive's fault.
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                self.add(path, Err(format!("it is {error}")), time)
            }
            result => result,
        }
    }

    fn add(
        &mut self,
        path: Vec<String>,
        content: Result<Content, String>,
        time: Option<FileTime>,
    ) -> io::Result<()> {
        if let Ok(Content::Text { text, .. }) = &content {
            self.bytes += text.len();
        }
        self.found.push(Found { path, content, time });
        if self.found.len() > MAX_FILES || self.bytes > MAX_TEXT_BYTES {
            return Err(io::Error::other(format!(
                "it has more than {MAX_FILES} files, or more than 1 GiB of text"
            )));
        }
        Ok(())
    }
}

/// The number of bytes of a file that are read.
fn limit(path: &[String]) -> u64 {
    match path.last() {
        Some(name) if is_archive(name) => MAX_NESTED_BYTES,
        _ => MAX_BYTES,
    }
}

/// Removes the folder that has the folders of several students, as in an archive of a folder, unless Moodle
/// or Canvas named it.
pub(super) fn without_common_folder(
    mut found: Vec<Found>,
    is_of_system: impl Fn(&str) -> bool,
) -> Vec<Found> {
    loop {
        let Some(first) = found.first().and_then(|found| found.path.first()).cloned() else {
            return found;
        };
        let is_common = found
            .iter()
            .all(|found| found.path.len() > 2 && found.path[0] == first);
        let has_several = found
            .iter()
            .any(|other| other.path.get(1) != found[0].path.get(1));
        if !is_common || !has_several || is_of_system(&first) {
            return found;
        }
        for found in &mut found {
            found.path.remove(0);
        }
    }
}

/// Checks that a folder can be written: it does not exist or is empty.
///
/// # Errors
/// Why not.
pub(super) fn check_empty(folder: &Path) -> Result<(), String> {
    match fs::read_dir(folder).map(|mut entries| entries.next().is_none()) {
        Ok(true) => Ok(()),
        Ok(false) => Err(format!(
            "{} already has files; nothing was written",
            path_name(folder)
        )),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(format!("{}: {error}", path_name(folder))),
    }
}
