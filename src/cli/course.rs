//! The course's shaders and scenes, built into the program.

use include_dir::{Dir, include_dir};

static COURSE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/glsl");

/// Every file of the course, by name: its shaders (`NN-name.glsl`) and their scenes (`NN-name.toml`).
pub(super) fn files() -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut files: Vec<_> = COURSE
        .files()
        .filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)))
        .collect();
    files.sort_unstable();
    files.into_iter()
}
