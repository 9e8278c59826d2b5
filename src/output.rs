//! Files that appear whole or not at all; a device or a pipe is written to, never replaced.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes a file under a temporary name beside its place and renames it, so that neither a crash nor a
/// reader ever sees half of it. Missing folders are made. A link is followed, and what is there but is no file
/// (`/dev/null`, `/dev/stdout`, a named pipe) is written into: a rename would put a file in its place.
///
/// # Errors
/// The system's, with the path in its words.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
    // What does not exist yet, or cannot be looked at, is for the steps below to make or to name.
    let followed = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let kind = fs::metadata(&followed).map(|found| found.file_type());
    if kind.is_ok_and(|kind| !kind.is_file() && !kind.is_dir()) {
        return fs::OpenOptions::new()
            .write(true)
            .open(&followed)
            .and_then(|mut stream| stream.write_all(bytes))
            .map_err(named);
    }
    let folder = match followed.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder).map_err(named)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".toyproof-");
    #[cfg(unix)]
    {
        // As an ordinary new file: the umask takes what it takes.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(named)?;
    file.write_all(bytes).map_err(named)?;
    file.persist(&followed).map_err(|error| named(error.error))?;
    Ok(())
}

/// Files that must not be lost, by whatever way one comes to them.
#[derive(Debug, Default)]
pub struct Originals(HashSet<PathBuf>);

impl<'a> FromIterator<&'a Path> for Originals {
    fn from_iter<T: IntoIterator<Item = &'a Path>>(paths: T) -> Self {
        let places = paths.into_iter().filter_map(|path| path.canonicalize().ok());
        Self(places.collect())
    }
}

impl Originals {
    /// Whether a file that is written there would replace one of them.
    #[must_use]
    pub fn would_lose(&self, path: &Path) -> bool {
        path.canonicalize()
            .is_ok_and(|place| place.is_file() && self.0.contains(&place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_whole_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/a.txt");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_is_the_same_by_whatever_way() {
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

    #[test]
    fn an_error_names_the_path_and_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("taken");
        fs::create_dir_all(target.join("child")).unwrap();
        let error = write(&target, b"x").unwrap_err();
        assert!(error.to_string().contains("taken"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
