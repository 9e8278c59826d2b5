//! Atomic file output: a file appears completely or not at all; a device or a pipe is written to, never
//! replaced.

use std::collections::HashSet;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;
use toyproof_diagnostic::path_name;

/// Writes a file that the user named: under a temporary name in the same folder, then renames it, so that
/// a crash leaves no partial file, and a reader never sees one. Missing folders are created. Symbolic links
/// are followed. A special file (`/dev/null`, `/dev/stdout`, a named pipe) is written to, since a rename
/// would replace it.
///
/// # Errors
/// The system's error, prefixed with the path.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // If the path does not exist or cannot be accessed, the steps below create it or report the error.
    let followed = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if is_special(&followed) {
        return fs::OpenOptions::new()
            .write(true)
            .open(&followed)
            .and_then(|mut stream| stream.write_all(bytes))
            .map_err(|error| with_path(path, &error));
    }
    replace(&followed, |file| file.write_all(bytes)).map_err(|error| with_path(path, &error))
}

/// Writes a file into an output folder with untrusted content: a symbolic link at the file's path is
/// replaced, not followed, and no link below the folder is followed. `path` begins with `folder`, which may
/// be a link itself.
///
/// # Errors
/// The system's error, prefixed with the path, or that a folder between `folder` and the file is a symbolic
/// link.
pub fn write_inside(folder: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    stream_inside(folder, path, |file| file.write_all(bytes))
}

/// Writes a file into an output folder as [`write_inside`] does, with the bytes that a function writes, so
/// that a large file is never completely in memory. If the function fails, the file is not replaced.
///
/// # Errors
/// As for [`write_inside`], and those of the function.
pub fn stream_inside(
    folder: &Path,
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    check_no_symlink_between(folder, path)
        .and_then(|()| replace(path, write))
        .map_err(|error| with_path(path, &error))
}

/// Removes a file of an earlier run from an output folder, if it exists.
///
/// # Errors
/// As for [`write_inside`].
pub fn remove_inside(folder: &Path, path: &Path) -> io::Result<()> {
    let removed = check_no_symlink_between(folder, path).and_then(|()| fs::remove_file(path));
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed.map_err(|error| with_path(path, &error)),
    }
}

fn check_no_symlink_between(folder: &Path, path: &Path) -> io::Result<()> {
    let below = path
        .ancestors()
        .skip(1)
        .take_while(|ancestor| *ancestor != folder);
    for ancestor in below {
        if fs::symlink_metadata(ancestor).is_ok_and(|found| found.is_symlink()) {
            let reason = format!(
                "`{}` is a symbolic link; outputs are not written through links",
                path_name(ancestor)
            );
            return Err(io::Error::other(reason));
        }
    }
    Ok(())
}

fn with_path(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {}", path_name(path), reason(error)))
}

/// The system's message, without the number of the error and the temporary name that follow it.
fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    match text.split_once(" (os error ") {
        Some((message, _)) => message.to_owned(),
        None => text,
    }
}

/// Writes a file at a path atomically, replacing an existing one.
fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut file = temporary(path)?;
    let mut buffered = BufWriter::new(&mut file);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes an empty temporary file in the folder of a path, which it can replace. Missing folders are created.
fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => io::Error::new(
            io::ErrorKind::NotADirectory,
            format!("`{}` is not a folder", path_name(folder)),
        ),
        _ => error,
    })?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".toyproof-");
    #[cfg(unix)]
    {
        // The permissions of an ordinary new file, subject to the umask.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Why [`make`] wrote no file.
#[derive(Debug)]
pub enum MakeError<E> {
    /// The file cannot be written: the system's error, prefixed with the path.
    Output(io::Error),
    /// The function failed.
    Content(E),
}

/// Writes a file as [`write()`] does, or as [`write_inside`] does if a folder is given. `make` fills an
/// existing empty file, or a special one; it may be another program that does so. If it fails, nothing is
/// replaced.
///
/// # Errors
/// As for the two functions, and those of `make`.
pub fn make<E>(
    folder: Option<&Path>,
    path: &Path,
    make: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), MakeError<E>> {
    let failed = |error: io::Error| MakeError::Output(with_path(path, &error));
    let target = match folder {
        Some(folder) => {
            check_no_symlink_between(folder, path).map_err(failed)?;
            path.to_owned()
        }
        None => path.canonicalize().unwrap_or_else(|_| path.to_owned()),
    };
    if folder.is_none() && is_special(&target) {
        return make(&target).map_err(MakeError::Content);
    }
    let file = temporary(&target).map_err(failed)?.into_temp_path();
    make(&file).map_err(MakeError::Content)?;
    file.persist(&target).map_err(|error| failed(error.error))
}

/// Whether a path is that of a device or a pipe, which is written to, and not replaced.
fn is_special(path: &Path) -> bool {
    let kind = fs::metadata(path).map(|found| found.file_type());
    kind.is_ok_and(|kind| !kind.is_file() && !kind.is_dir())
}

/// Files that must not be overwritten, identified by their canonical paths.
#[derive(Debug, Default)]
pub struct Originals(HashSet<PathBuf>);

impl<'a> FromIterator<&'a Path> for Originals {
    fn from_iter<T: IntoIterator<Item = &'a Path>>(paths: T) -> Self {
        let places = paths.into_iter().filter_map(|path| path.canonicalize().ok());
        Self(places.collect())
    }
}

impl Originals {
    /// Whether writing to `path` would replace one of them.
    pub fn would_lose(&self, path: &Path) -> bool {
        path.canonicalize()
            .is_ok_and(|place| place.is_file() && self.0.contains(&place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_no_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/a.txt");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_function_that_fails_replaces_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, b"old").unwrap();
        let fails = |file: &mut dyn Write| {
            file.write_all(&vec![b'x'; 100_000])?;
            Err(io::Error::other("no"))
        };
        let error = stream_inside(folder.path(), &path, fails).unwrap_err();
        assert!(error.to_string().ends_with("a.txt: no"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_made_file_appears_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/a.txt");
        for inside in [None, Some(folder.path())] {
            let made = make(inside, &path, |file| {
                fs::write(file, b"one")?;
                assert!(!path.exists());
                io::Result::Ok(())
            });
            assert!(made.is_ok());
            let failed = make(inside, &path, |file| {
                fs::write(file, b"two")?;
                Err(io::Error::other("no"))
            });
            assert!(matches!(failed, Err(MakeError::Content(_))));
            assert_eq!(fs::read(&path).unwrap(), b"one");
            assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
            fs::remove_file(&path).unwrap();
        }
        let error = make(None, &folder.path().join("new"), |_| io::Result::Ok(()));
        assert!(matches!(error, Err(MakeError::Output(_))));
    }

    #[cfg(unix)]
    #[test]
    fn a_file_is_recognized_through_links() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link, other] = ["file", "link", "other"].map(|name| folder.path().join(name));
        fs::write(&file, b"").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let null = Path::new("/dev/null");
        let originals: Originals = [&*other, &*file, null].into_iter().collect();
        assert!(originals.would_lose(&link));
        assert!(!originals.would_lose(&other), "there is none yet");
        assert!(!originals.would_lose(null), "nothing is replaced there");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_a_pipe_is_written_into() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().file_type().is_symlink());

        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).unwrap()
        });
        write(&pipe, b"through").unwrap();
        assert_eq!(reader.join().unwrap(), b"through");
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    }

    #[cfg(unix)]
    #[test]
    fn no_link_leads_out_of_an_output_folder() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let [victim, away, out] = ["victim", "away", "out"].map(|name| folder.path().join(name));
        fs::write(&victim, b"mine").unwrap();
        fs::create_dir(&away).unwrap();
        fs::create_dir(&out).unwrap();
        let [report, below, linked] = ["report.csv", "below", "linked"].map(|name| out.join(name));
        symlink(&victim, &report).unwrap();
        symlink(&away, &below).unwrap();
        symlink(&out, folder.path().join("link")).unwrap();

        write_inside(&out, &report, b"marks").unwrap();
        assert_eq!(fs::read(&report).unwrap(), b"marks");
        assert!(!fs::symlink_metadata(&report).unwrap().is_symlink());
        assert_eq!(fs::read(&victim).unwrap(), b"mine");

        let error = write_inside(&out, &below.join("deeper/a.png"), b"x").unwrap_err();
        assert!(error.to_string().contains("is a symbolic link"), "{error}");
        assert_eq!(fs::read_dir(&away).unwrap().count(), 0);

        fs::write(away.join("a.png"), b"x").unwrap();
        assert!(remove_inside(&out, &below.join("a.png")).is_err());
        assert!(away.join("a.png").exists());
        symlink(&victim, &linked).unwrap();
        remove_inside(&out, &linked).unwrap();
        remove_inside(&out, &linked).unwrap();
        assert!(victim.exists() && !linked.exists());

        // The folder named by the user may be a link.
        let link = folder.path().join("link");
        write_inside(&link, &link.join("b.png"), b"x").unwrap();
        assert!(out.join("b.png").exists());
    }

    #[test]
    fn errors_name_the_path_and_leave_no_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("taken");
        fs::create_dir_all(target.join("child")).unwrap();
        let error = write(&target, b"x").unwrap_err();
        let path = path_name(&target);
        assert_eq!(error.to_string(), format!("{path}: Is a directory"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        let error = write(&file.join("a"), b"x").unwrap_err();
        let [inside, file] = [file.join("a"), file].map(|path| path_name(&path));
        assert_eq!(error.to_string(), format!("{inside}: `{file}` is not a folder"));
        if cfg!(target_os = "linux") {
            // The temporary file cannot be created.
            let error = write(Path::new("/proc/a"), b"x").unwrap_err();
            assert_eq!(error.to_string(), "/proc/a: No such file or directory");
        }
    }
}
