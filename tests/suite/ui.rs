//! Compiler messages: `tests/ui/*.glsl` holds typical mistakes of students, and beside each the whole text
//! that a terminal shows. `UPDATE_EXPECT=1 cargo test --test suite ui` writes the texts anew; read them
//! before you keep them.

use std::fs;
use std::path::{Path, PathBuf};

use expect_test::expect_file;
use toyproof::diagnostic::{File, Files, human};
use toyproof::glsl::{Dialect, Options, check, with_single_edit};

/// Everything that is reported of a shader, as a terminal shows it.
fn messages(path: &Path) -> String {
    let mut files = Files::default();
    let name = path.file_name().unwrap().to_str().unwrap();
    let file = files.add(File::new(name, fs::read_to_string(path).unwrap()));
    let options = Options {
        dialect: Some(Dialect::ShaderToy),
        ..Options::default()
    };
    match check(&files, file, &options) {
        Ok(checked) => panic!("{name} is accepted, with {:?}", checked.warnings),
        Err(errors) => with_single_edit(&files, file, errors, &options)
            .iter()
            .map(|error| human(error, &files, None, false))
            .collect(),
    }
}

fn cases(extension: &str) -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/ui");
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    paths.sort();
    paths
}

#[test]
fn every_mistake_has_its_message() {
    let shaders = cases("glsl");
    assert!(shaders.len() >= 46, "{}", shaders.len());
    for shader in &shaders {
        expect_file![shader.with_extension("stderr")].assert_eq(&messages(shader));
    }
}

#[test]
fn every_message_has_its_mistake() {
    for message in cases("stderr") {
        assert!(message.with_extension("glsl").is_file(), "{message:?}");
    }
}
