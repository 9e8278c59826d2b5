//! URIs of the protocol, and paths of files.

use std::path::{Path, PathBuf};

use lsp_types::Uri;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// The characters that a path keeps in a URI.
const KEPT: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'/')
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~');

/// The path that a URI names; `None` if it does not name a file of this machine.
pub(crate) fn path_of(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.0.strip_prefix("file://")?;
    let rest = rest.strip_prefix("localhost").unwrap_or(rest);
    let path = percent_decode_str(rest).decode_utf8().ok()?;
    // `/c:/shader.glsl` is a path with a drive of Windows.
    let is_drive = cfg!(windows) && path.as_bytes().get(2) == Some(&b':');
    let path = if is_drive { &path[1..] } else { &path[..] };
    path.starts_with('/').then_some(()).or(is_drive.then_some(()))?;
    Some(PathBuf::from(path))
}

/// The URI of a file; `None` for a relative path, and one that is not Unicode.
pub(crate) fn uri_of(path: &Path) -> Option<Uri> {
    let text = path.to_str().filter(|_| path.is_absolute())?.replace('\\', "/");
    let slash = if text.starts_with('/') { "" } else { "/" };
    let encoded = utf8_percent_encode(&text, KEPT);
    Some(Uri(format!("file://{slash}{encoded}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn paths_and_uris_are_inverse() {
        let uri = uri_of(Path::new("/shaders/my wave (é).glsl")).unwrap();
        assert_eq!(uri.0, "file:///shaders/my%20wave%20%28%C3%A9%29.glsl");
        assert_eq!(path_of(&uri).unwrap(), Path::new("/shaders/my wave (é).glsl"));
        for (text, path) in [
            ("file:///a%3Ab.glsl", Some("/a:b.glsl")),
            ("file://localhost/a", Some("/a")),
            ("untitled:Untitled-1", None),
            ("file://server/a", None),
            ("file:///%ff", None),
        ] {
            let found = path_of(&Uri(text.to_owned()));
            assert_eq!(found.as_deref(), path.map(Path::new), "{text}");
        }
        assert_eq!(uri_of(Path::new("a.glsl")), None);
    }
}
