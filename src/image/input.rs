//! Opening of files that other users may have created.

use std::cell::RefCell;
use std::fs::{File, FileType, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

thread_local! {
    /// The files that [`recorded`] work has opened in this thread.
    static OPENED: RefCell<Option<Vec<PathBuf>>> = const { RefCell::new(None) };
}

/// Does some work; returns its result, and the files that it opened in this thread or tried to open, each once.
/// Recorded work in it is not counted.
pub fn recorded<T>(work: impl FnOnce() -> T) -> (T, Vec<PathBuf>) {
    let outer = OPENED.replace(Some(Vec::new()));
    let result = work();
    let opened = OPENED.replace(outer);
    (result, opened.unwrap_or_default())
}

fn record(path: &Path) {
    OPENED.with_borrow_mut(|opened| {
        if let Some(opened) = opened
            && !opened.iter().any(|known| known == path)
        {
            opened.push(path.to_owned());
        }
    });
}

/// Opens a regular file for reading. It is opened without blocking and then examined, so that it does not
/// wait for a named pipe without a writer, or for one that replaces a file at the wrong moment.
///
/// # Errors
/// The system's error, or the kind of a file that is not a regular one.
pub fn open(path: &Path) -> io::Result<File> {
    record(path);
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
        options.custom_flags(flags.bits() as i32);
    }
    let opened = options.open(path).and_then(|file| {
        let kind = file.metadata()?.file_type();
        Ok((file, kind))
    });
    match opened {
        Ok((file, kind)) if kind.is_file() => Ok(file),
        Ok((_, kind)) => Err(not_a_file(kind)),
        // The system does not open sockets, and Windows no folders.
        Err(error) => match path.metadata() {
            Ok(found) if !found.is_file() => Err(not_a_file(found.file_type())),
            _ => Err(error),
        },
    }
}

/// Reads a whole regular file.
///
/// # Errors
/// As for [`open`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn not_a_file(kind: FileType) -> io::Error {
    let (what, error) = if kind.is_dir() {
        ("a folder", io::ErrorKind::IsADirectory)
    } else {
        (special(kind), io::ErrorKind::InvalidInput)
    };
    io::Error::new(error, format!("it is {what}, not a file"))
}

#[cfg(unix)]
fn special(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a named pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: FileType) -> &'static str {
    "a device"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, "text").unwrap();
        assert_eq!(read(&path).unwrap(), b"text");
        let error = read(folder.path()).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string().as_str()),
            (io::ErrorKind::IsADirectory, "it is a folder, not a file")
        );
        let error = read(&folder.path().join("b")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn opened_files_are_recorded() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
        std::fs::write(&a, "text").unwrap();
        let ((), files) = recorded(|| {
            let _ = (read(&a), read(&b), read(&a));
            assert_eq!(
                recorded(|| read(&a).unwrap()),
                (b"text".to_vec(), vec![a.clone()])
            );
        });
        assert_eq!(files, [a.clone(), b]);
        let _ = read(&a);
        assert_eq!(recorded(|| ()).1, [""; 0].map(PathBuf::from));
    }

    /// Without a writer, a blocking open of the pipe never returns.
    #[cfg(unix)]
    #[test]
    fn pipes_sockets_and_devices_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [pipe, socket, link] = ["pipe", "socket", "link"].map(|name| folder.path().join(name));
        let mode = rustix::fs::Mode::from_raw_mode(0o600);
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, mode, 0).unwrap();
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        for (path, expected) in [
            (pipe.as_path(), "it is a named pipe, not a file"),
            (&link, "it is a named pipe, not a file"),
            (&socket, "it is a socket, not a file"),
            (Path::new("/dev/zero"), "it is a device, not a file"),
        ] {
            assert_eq!(open(path).unwrap_err().to_string(), expected, "{path:?}");
        }
    }
}
