use std::{fs, io};

use toyproof_diagnostic::Files;

use super::read::{decode, read_limited};
use super::*;

#[test]
fn folders_yield_their_shaders_in_order_with_relative_paths() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("b")).unwrap();
    for name in ["z.frag", "a.glsl", "b/c.fs", "notes.txt"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let relative: Vec<_> = find(folder.path())
        .inputs
        .into_iter()
        .map(|found| found.unwrap().relative)
        .collect();
    assert_eq!(relative, ["a.glsl", "b/c.fs", "z.frag"].map(PathBuf::from));
}

#[test]
fn hidden_files_are_found_only_by_name() {
    let folder = tempfile::tempdir().unwrap();
    for below in [".git", "__MACOSX", "a"] {
        fs::create_dir(folder.path().join(below)).unwrap();
    }
    for name in [".git/x.glsl", ".h.glsl", "__MACOSX/._a.glsl", "a/b.glsl"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let relative = |argument: &Path| -> Vec<PathBuf> {
        let found = find(argument).inputs.into_iter();
        found.map(|found| found.unwrap().relative).collect()
    };
    assert_eq!(relative(folder.path()), [Path::new("a/b.glsl")]);
    assert_eq!(relative(&folder.path().join(".git")), [Path::new("x.glsl")]);
    assert_eq!(relative(&folder.path().join(".h.glsl")), [Path::new(".h.glsl")]);
}

#[test]
fn endless_files_are_too_large_and_not_read_completely() {
    let endless = read_limited(Ok(io::repeat(b' ')), Path::new("x"), MAX_BYTES).unwrap();
    assert_eq!(endless.len() as u64, MAX_BYTES + 1);
    let endless = decode(endless, "x".to_owned(), MAX_BYTES);
    assert!(matches!(endless, Err(ReadError::TooLarge { .. })));
}

#[test]
fn invalid_utf8_is_reported_by_line_and_column() {
    let error = decode(b"ok\nab\xffc".to_vec(), "x".to_owned(), MAX_BYTES).unwrap_err();
    assert_eq!(
        error.to_string(),
        "x:2:3: this is not UTF-8 text; save the file as UTF-8"
    );
}

#[test]
fn a_byte_order_mark_is_not_part_of_the_text() {
    let file = decode("\u{feff}void".into(), "x".to_owned(), MAX_BYTES).unwrap();
    assert_eq!(file.text(), "void");
}

#[test]
fn invalid_utf8_is_shown_as_a_replacement_character() {
    let mut files = Files::default();
    let error = ReadError::NotUtf8 {
        file: File::new("x", "ok\nab\u{fffd}c"),
        at: 5,
    };
    let diagnostic = content_diagnostic(error, &mut files).unwrap();
    assert_eq!(files.text(diagnostic.span.unwrap()), "\u{fffd}");
    assert!(content_diagnostic(ReadError::missing(Path::new("y")), &mut files).is_err());
}

#[cfg(unix)]
mod links {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    /// Creates a folder `in` with two visible shaders and a hidden one, and a shader outside of it.
    fn folder() -> (tempfile::TempDir, PathBuf) {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("in");
        fs::create_dir_all(folder.join("ann")).unwrap();
        fs::create_dir_all(folder.join(".kept/new")).unwrap();
        for name in ["in/ann/a.glsl", "in/b.glsl", "in/.kept/new/c.glsl", "secret.glsl"] {
            fs::write(outer.path().join(name), "").unwrap();
        }
        (outer, folder)
    }

    fn relative(search: &Search) -> Vec<&Path> {
        let found = search.inputs.iter();
        found
            .map(|found| found.as_ref().unwrap().relative.as_path())
            .collect()
    }

    #[test]
    fn links_out_of_the_folder_are_skipped_and_reported() {
        let (outer, folder) = folder();
        symlink("/", folder.join("root")).unwrap();
        symlink(outer.path(), folder.join("ann/up")).unwrap();
        symlink(outer.path().join("secret.glsl"), folder.join("leak.glsl")).unwrap();
        symlink(outer.path().join("secret.glsl"), folder.join("notes.txt")).unwrap();
        let search = search(&folder);
        assert_eq!(relative(&search), ["ann/a.glsl", "b.glsl"].map(Path::new));
        let links: Vec<_> = search
            .skipped
            .iter()
            .map(|skipped| skipped.link.as_path())
            .collect();
        let wanted = ["ann/up", "leak.glsl", "root"].map(|name| folder.join(name));
        assert_eq!(links, wanted);
        let root = search.skipped[2].to_string();
        assert!(root.contains("root`: it links to `/`, outside `"), "{root}");
    }

    #[test]
    fn link_cycles_end_and_each_folder_is_searched_once() {
        let (_outer, folder) = folder();
        symlink("..", folder.join("ann/loop")).unwrap();
        symlink("ann", folder.join("again")).unwrap();
        symlink("../again", folder.join("ann/again")).unwrap();
        symlink("here", folder.join("here")).unwrap();
        symlink(".kept/new", folder.join("newest")).unwrap();
        symlink(".kept/new", folder.join("latest")).unwrap();
        symlink("b.glsl", folder.join("link.glsl")).unwrap();
        let mut search = search(&folder);
        assert!(search.skipped.is_empty(), "{:?}", search.skipped);
        // A link to itself leads nowhere.
        let nothing = search.inputs.iter().position(Result::is_err).unwrap();
        let error = search.inputs.remove(nothing).unwrap_err().to_string();
        assert!(error.contains("here: cannot be read"), "{error}");
        let wanted = ["ann/a.glsl", "b.glsl", "latest/c.glsl", "link.glsl"];
        assert_eq!(relative(&search), wanted.map(Path::new));
    }

    #[test]
    fn a_folder_is_searched_once_if_one_link_leads_to_it_and_another_to_its_parent() {
        let (_outer, folder) = folder();
        symlink(".kept/new", folder.join("latest")).unwrap();
        symlink(".kept", folder.join("whole")).unwrap();
        fs::write(folder.join(".kept/d.glsl"), "").unwrap();
        let wanted = ["ann/a.glsl", "b.glsl", "latest/c.glsl", "whole/d.glsl"];
        assert_eq!(relative(&search(&folder)), wanted.map(Path::new));
    }

    #[test]
    fn a_linked_folder_is_searched() {
        let (outer, folder) = folder();
        let link = outer.path().join("link");
        symlink(&folder, &link).unwrap();
        let search = search(&link);
        assert_eq!(relative(&search), ["ann/a.glsl", "b.glsl"].map(Path::new));
        assert!(search.skipped.is_empty());
    }
}
