//! The course's shaders as `toyproof convert` writes them, in `tests/snapshots/LANGUAGE`, so that a change of
//! the generated code is seen where the change is reviewed. `UPDATE_EXPECT=1 cargo test --test suite snapshots`
//! writes them anew.

use std::fs;
use std::path::Path;

use expect_test::expect_file;

use crate::program::toyproof;

/// Languages of text, and the extension of their files.
const LANGUAGES: [(&str, &str); 4] = [
    ("wgsl", "wgsl"),
    ("metal", "metal"),
    ("hlsl", "hlsl"),
    ("glsl", "frag"),
];

#[test]
fn the_course_is_converted_to_what_was_reviewed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (language, extension) in LANGUAGES {
        let out = tempfile::tempdir().unwrap();
        let to = out.path().to_str().unwrap();
        let run = toyproof(folder, &["convert", "glsl", "--to", language, "-o", to]);
        assert_eq!(run.code, 0, "{run:?}");
        let mut count = 0;
        for entry in fs::read_dir(folder.join("glsl")).unwrap() {
            let shader = entry.unwrap().path();
            if shader.extension().is_none_or(|found| found != "glsl") {
                continue;
            }
            let name = Path::new(shader.file_name().unwrap()).with_extension(extension);
            let written = fs::read_to_string(out.path().join(&name)).unwrap();
            expect_file![folder.join("tests/snapshots").join(language).join(name)].assert_eq(&written);
            count += 1;
        }
        assert_eq!(count, 15);
    }
}
