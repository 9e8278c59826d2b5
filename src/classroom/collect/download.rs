//! The files of a download: a folder or an archive, with archives in it. Limits hold for each student, so
//! that one submission does not use up the limits of others.

use std::collections::HashMap;
use std::fs;
use std::io::{self, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use toyproof_diagnostic::grouped;
use toyproof_image::input;
use toyproof_project::archive::{self as zip, Archive, FileTime};
use toyproof_project::files::{MAX_BYTES, is_hidden};
use walkdir::WalkDir;

use super::naming::{Student, is_archive, is_of_system, submission_path};
use super::text::{Content, content};

/// The deepest archive in archives.
const MAX_DEPTH: usize = 4;
/// The largest archive in an archive, in bytes.
const MAX_NESTED_BYTES: u64 = 64 << 20;
/// The largest number of files and folders of a download, without those in archives in it.
const MAX_ENTRIES: usize = 1_000_000;
/// The largest size of all texts of a download, in bytes.
const MAX_TEXT_BYTES: usize = 1 << 30;

/// The largest number of files of a student.
const MAX_STUDENT_FILES: usize = 1000;
/// The largest number of files and folders in all archives of a student, with hidden ones.
const MAX_STUDENT_ENTRIES: usize = 10_000;
/// The largest size of all texts of a student, in bytes: a project of ShaderToy has eight of at most 1 MiB.
const MAX_STUDENT_TEXT_BYTES: usize = 8 << 20;
/// The largest size of all that is read or unpacked of a student, in bytes.
const MAX_STUDENT_BYTES: u64 = 256 << 20;
/// The longest path in a download, in bytes.
const MAX_PATH_BYTES: usize = 1000;

/// A file of a download.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DownloadFile {
    /// The path in the download; archives in it are components that end with `.zip`. The last component of an
    /// empty folder is empty.
    pub path: Vec<String>,
    /// The content, or why it cannot be read.
    pub content: Result<Content, String>,
    /// When it was last changed; for a file in an archive of the student, when the archive was.
    pub time: Option<FileTime>,
}

/// Reads all files of a download, without hidden ones and those that macOS adds. A folder that has the
/// folders of several students, as in an archive of a folder, is not part of their paths.
///
/// # Errors
/// It cannot be read, or has too many files.
pub(super) fn read(download: &Path) -> io::Result<Vec<DownloadFile>> {
    let mut tree = if download.is_dir() {
        Tree::from_folder(download)?
    } else {
        Tree::from_archive(Box::new(BufReader::new(input::open(download)?)), MAX_ENTRIES)?
    };
    if tree.archive.as_ref().is_some_and(Archive::is_cut) {
        return Err(too_many());
    }
    loop {
        tree.remove_common_folders();
        let Some(inner) = tree.download_in_archive() else {
            break;
        };
        tree = inner;
    }
    // Archives come last: their contents may reach the limits.
    tree.items
        .sort_by(|a, b| (a.is_archive(), &a.path).cmp(&(b.is_archive(), &b.path)));
    let mut reader = Reader::default();
    for item in std::mem::take(&mut tree.items) {
        reader.item(&mut tree, item)?;
    }
    reader.found.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(reader.found)
}

/// The source of an archive.
trait Input: Read + Seek {}

impl<T: Read + Seek> Input for T {}

/// The names in a folder or an archive.
struct Tree {
    items: Vec<Item>,
    /// The archive; `None` for a folder.
    archive: Option<Archive<Box<dyn Input>>>,
}

/// A name in a folder or an archive.
struct Item {
    path: Vec<String>,
    place: Place,
}

/// The place of the content of a name.
enum Place {
    File(PathBuf, Option<FileTime>),
    Entry(zip::Entry),
    /// Nowhere, and why.
    None(String),
}

impl Item {
    fn is_archive(&self) -> bool {
        self.path.last().is_some_and(is_archive)
    }
}

impl Tree {
    /// Lists a folder with its subfolders.
    fn from_folder(folder: &Path) -> io::Result<Self> {
        fs::read_dir(folder)?;
        let mut items = Vec::new();
        let entries = WalkDir::new(folder).follow_root_links(true);
        let visible = |entry: &walkdir::DirEntry| entry.depth() == 0 || !is_hidden(entry.file_name());
        for entry in entries.into_iter().filter_entry(visible) {
            let path_of = |path: &Path| -> Vec<String> {
                let inside = path.strip_prefix(folder).unwrap_or(path).iter();
                inside.map(|part| part.to_string_lossy().into_owned()).collect()
            };
            let (path, place) = match entry {
                Ok(entry) if entry.depth() == 0 => continue,
                Ok(entry) => {
                    let mut path = path_of(entry.path());
                    let kind = entry.file_type();
                    let place = if kind.is_dir() {
                        match fs::read_dir(entry.path()).map(|mut inside| inside.next().is_none()) {
                            Ok(true) => {}
                            // The entries of others, and their errors, follow.
                            Ok(false) | Err(_) => continue,
                        }
                        path.push(String::new());
                        Place::None("it is empty".to_owned())
                    } else if entry.path_is_symlink() {
                        Place::None("it is a link".to_owned())
                    } else {
                        let metadata = entry.metadata().ok();
                        let modified = metadata.and_then(|metadata| metadata.modified().ok());
                        let since = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                        let time = since.map(|since| FileTime::Utc(since.as_secs() as i64));
                        Place::File(entry.into_path(), time)
                    };
                    (path, place)
                }
                Err(error) => {
                    let path = error.path().map(path_of).unwrap_or_default();
                    (path, Place::None(unreadable(&error.into())))
                }
            };
            if items.len() == MAX_ENTRIES {
                return Err(too_many());
            }
            items.extend((!path.is_empty()).then_some(Item { path, place }));
        }
        Ok(Self { items, archive: None })
    }

    /// Lists an archive with at most this many files and folders.
    fn from_archive(input: Box<dyn Input>, max_entries: usize) -> io::Result<Self> {
        let mut archive = Archive::open(input, max_entries)?;
        let items = archive.take_entries().into_iter().filter_map(|entry| {
            let parts = entry
                .name
                .split('/')
                .filter(|part| !part.is_empty() && *part != ".");
            let path: Vec<String> = parts.map(str::to_owned).collect();
            let is_visible = |part: &String| !is_hidden(part.as_ref()) || part == "..";
            if path.is_empty() || !path.iter().all(is_visible) {
                return None;
            }
            let place = if path.iter().any(|part| part == "..") {
                Place::None("its path leads out of the archive".to_owned())
            } else {
                Place::Entry(entry)
            };
            Some(Item { path, place })
        });
        Ok(Self {
            items: items.collect(),
            archive: Some(archive),
        })
    }

    /// Whether the first components of all paths are one folder that has the folders or archives of several
    /// students, and was not named by a system.
    fn has_common_folder(&self) -> bool {
        let Some(first) = self.items.first().map(|item| &item.path) else {
            return false;
        };
        let is_inside = |item: &Item| {
            let names_student =
                |second: &String| item.path.len() > 2 || is_archive(second) || is_of_system(second);
            item.path[0] == first[0] && item.path.get(1).is_some_and(names_student)
        };
        let has_several = self.items.iter().any(|item| item.path.get(1) != first.get(1));
        has_several && self.items.iter().all(is_inside) && !is_of_system(&first[0])
    }

    fn remove_common_folders(&mut self) {
        while self.has_common_folder() {
            for item in &mut self.items {
                item.path.remove(0);
            }
        }
    }

    /// The only file, if it is an archive that has the folders of several students.
    fn download_in_archive(&mut self) -> Option<Self> {
        let [only] = &self.items[..] else {
            return None;
        };
        let name = only
            .path
            .last()
            .filter(|name| is_archive(name) && !is_of_system(name))?
            .clone();
        let bytes = match &only.place {
            Place::File(path, _) => read_file(path, MAX_NESTED_BYTES),
            Place::Entry(entry) => self.archive.as_mut()?.read(entry, MAX_NESTED_BYTES),
            Place::None(_) => return None,
        };
        let bytes = bytes
            .ok()
            .filter(|bytes| bytes.len() as u64 <= MAX_NESTED_BYTES)?;
        let mut inner = Self::from_archive(Box::new(Cursor::new(bytes)), MAX_ENTRIES).ok()?;
        for item in &mut inner.items {
            item.path.insert(0, name.clone());
        }
        inner.has_common_folder().then_some(inner)
    }
}

fn read_file(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    input::open(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn too_many() -> io::Error {
    io::Error::other(format!("it has more than {} files", grouped(MAX_ENTRIES as u64)))
}

fn unreadable(error: &io::Error) -> String {
    format!("it cannot be read: {error}")
}

/// The files of a student that have been read.
#[derive(Debug, Default)]
struct Usage {
    files: usize,
    entries: usize,
    text_bytes: usize,
    bytes: u64,
    /// Whether files are left out, which one of them states.
    is_full: bool,
}

#[derive(Debug, Default)]
struct Reader {
    found: Vec<DownloadFile>,
    text_bytes: usize,
    students: HashMap<Student, Usage>,
}

impl Reader {
    /// Reads the content of a name of the download.
    fn item(&mut self, tree: &mut Tree, item: Item) -> io::Result<()> {
        let student = submission_path(&item.path).student;
        let mut used = self.students.remove(&student).unwrap_or_default();
        let mut submission = Submission {
            used: &mut used,
            found: &mut self.found,
        };
        let before = submission.used.text_bytes;
        submission.item(tree.archive.as_mut(), item, None);
        self.text_bytes += submission.used.text_bytes - before;
        self.students.insert(student, used);
        if self.text_bytes > MAX_TEXT_BYTES {
            return Err(io::Error::other("it has more than 1 GiB of text"));
        }
        Ok(())
    }
}

/// The submission of a student, which grows up to the limits.
struct Submission<'a> {
    used: &'a mut Usage,
    found: &'a mut Vec<DownloadFile>,
}

impl Submission<'_> {
    /// Reads a file, which was changed at `time` if it is given.
    fn item(&mut self, archive: Option<&mut Archive<Box<dyn Input>>>, item: Item, time: Option<FileTime>) {
        let Item { path, place } = item;
        if self.used.is_full {
            return;
        }
        if self.used.files == MAX_STUDENT_FILES {
            return self.fill(
                path,
                &format!(
                    "the submission has more than {} files",
                    grouped(MAX_STUDENT_FILES as u64)
                ),
            );
        }
        let length = path.iter().map(String::len).sum::<usize>() + path.len() - 1;
        if length > MAX_PATH_BYTES {
            let reason = format!("its path is longer than {} bytes", grouped(MAX_PATH_BYTES as u64));
            return self.add(shortened(path), Err(reason), time);
        }
        let limit = if is_archive(&path[path.len() - 1]) {
            MAX_NESTED_BYTES
        } else {
            MAX_BYTES
        };
        let (read, time) = match (place, archive) {
            (Place::None(reason), _) => return self.add(path, Err(reason), time),
            (Place::File(file, modified), _) => (read_file(&file, limit), time.or(modified)),
            (Place::Entry(entry), Some(archive)) => (archive.read(&entry, limit), time.or(entry.modified)),
            (Place::Entry(_), None) => unreachable!("an entry is one of an archive"),
        };
        match read {
            Ok(bytes) => self.file(path, bytes, time),
            Err(error) => self.add(path, Err(unreadable(&error)), time),
        }
    }

    fn file(&mut self, path: Vec<String>, bytes: Vec<u8>, time: Option<FileTime>) {
        self.used.bytes += bytes.len() as u64;
        if self.used.bytes > MAX_STUDENT_BYTES {
            return self.fill(path, "the files of the submission are larger than 256 MiB");
        }
        let name = &path[path.len() - 1];
        if is_archive(name) {
            return self.archive(path, bytes, time);
        }
        let content = match content(name, &bytes) {
            Content::Text { text, .. } if self.used.text_bytes + text.len() > MAX_STUDENT_TEXT_BYTES => {
                Err("the texts of the submission are larger than 8 MiB".to_owned())
            }
            content => Ok(content),
        };
        if let Ok(Content::Text { text, .. }) = &content {
            self.used.text_bytes += text.len();
        }
        self.add(path, content, time);
    }

    /// Reads an archive in a download, in an archive or in a folder.
    fn archive(&mut self, path: Vec<String>, bytes: Vec<u8>, time: Option<FileTime>) {
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
        let max_entries = MAX_STUDENT_ENTRIES - self.used.entries;
        let mut tree = match Tree::from_archive(Box::new(Cursor::new(bytes)), max_entries) {
            Ok(tree) => tree,
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                return self.add(path, Err(format!("it is {error}")), time);
            }
            Err(error) => return self.add(path, Err(unreadable(&error)), time),
        };
        let archive = tree.archive.as_ref();
        self.used.entries += archive.map_or(0, Archive::count);
        let is_cut = archive.is_some_and(Archive::is_cut);
        if tree.items.is_empty() && !is_cut {
            return self.add(path, Err("it has no files".to_owned()), time);
        }
        tree.items.sort_by_key(Item::is_archive);
        for mut item in std::mem::take(&mut tree.items) {
            item.path.splice(0..0, path.iter().cloned());
            self.item(tree.archive.as_mut(), item, time);
        }
        if is_cut {
            let reason = format!(
                "its archives have more than {} files and folders",
                grouped(MAX_STUDENT_ENTRIES as u64)
            );
            self.fill(path, &reason);
        }
    }

    fn add(&mut self, path: Vec<String>, content: Result<Content, String>, time: Option<FileTime>) {
        self.used.files += 1;
        self.found.push(DownloadFile { path, content, time });
    }

    /// Leaves out this file and the following ones.
    fn fill(&mut self, path: Vec<String>, reason: &str) {
        if !std::mem::replace(&mut self.used.is_full, true) {
            let content = Err(format!("{reason}; the others were left out"));
            let path = shortened(path);
            self.found.push(DownloadFile {
                path,
                content,
                time: None,
            });
        }
    }
}

/// A path without the middle of names that are too long: its first component names the student.
fn shortened(path: Vec<String>) -> Vec<String> {
    const MAX_BYTES: usize = 100;
    let cut = |text: String| match text.char_indices().nth(MAX_BYTES) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text,
    };
    let length = path.iter().map(String::len).sum::<usize>();
    if length <= MAX_PATH_BYTES {
        return path;
    }
    let mut parts = path.into_iter();
    let first = parts.next();
    let rest: Vec<_> = parts.map(cut).collect();
    let rest = match &rest[..] {
        [folder, _, .., file] => vec![folder.clone(), "…".to_owned(), file.clone()],
        _ => rest,
    };
    first.into_iter().chain(rest).collect()
}
