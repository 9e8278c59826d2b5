//! `toyproof scenes`, and the course built into the program.

use std::path::{Path, PathBuf};

use include_dir::{Dir, include_dir};
use toyproof_diagnostic::{File, Files, nearest, path_name};
use toyproof_image::input;
use toyproof_project::files::{self, ReadError};
use toyproof_scene::{self as scene, Scene};

use super::{CliError, Exit, Terminal};

/// List the built-in scenes, or write them and their shaders to a folder
///
/// The name of a built-in scene can be used wherever a scene file is expected.
#[derive(Debug, clap::Args)]
#[command(
    after_long_help = "Examples:\n  toyproof scenes\n  toyproof render 02-sphere -o sphere.png\n  \
                        toyproof scenes --write course\n  toyproof check course --out report"
)]
pub(super) struct Args {
    /// Write every scene and its shader to this folder
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let Some(folder) = &args.write else {
        for (name, scene) in builtin_scenes() {
            terminal.result(&format!("{name:<24} {}", scene.title));
        }
        terminal.note("`toyproof scenes --write DIR` writes their shaders (.glsl) and scenes (.toml)");
        return Ok(Exit::Success);
    };
    let differs = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        path.exists() && input::read(&path).ok().as_deref() != Some(content)
    };
    if let Some((name, _)) = course_files().find(|(name, content)| differs(name, content)) {
        return Err(CliError::new(format_args!(
            "{} already exists with other contents; nothing was written, choose another folder",
            path_name(&folder.join(name))
        )));
    }
    for (name, content) in course_files() {
        terminal.write(&folder.join(name), content)?;
    }
    terminal.note(&format!(
        "wrote {} files to {}",
        course_files().count(),
        path_name(folder)
    ));
    Ok(Exit::Success)
}

// Scenes by file or by name.

/// The built-in scenes by their names.
pub(super) fn builtin_scenes() -> impl Iterator<Item = (String, Scene)> {
    course_scenes()
        .filter_map(|(stem, text)| Some((stem.to_owned(), parse_scene(File::new(stem, text)).ok()?)))
}

/// Parses the text of a scene.
pub(super) fn parse_scene(text: File) -> Result<Scene, CliError> {
    let mut files = Files::default();
    let file = files.add(text);
    scene::parse(&files, file).map_err(|errors| CliError::diagnostics(errors, &files))
}

/// Reads the text of a scene: that of the file, else that of the built-in scene of this name, with or without
/// `.toml`.
///
/// # Errors
/// A message for the user, if the file cannot be read or there is neither.
pub(super) fn read_scene(path: &Path) -> Result<File, String> {
    match files::read_named(path) {
        Err(ReadError::Missing { .. }) => builtin_scene(path),
        text => text.map_err(|error| error.to_string()),
    }
}

/// The error, with a hint if a path that does not exist names a built-in scene.
pub(super) fn with_builtin_hint(error: ReadError) -> ReadError {
    match error {
        ReadError::Missing { path, .. } => {
            let hint = builtin_name(&path).map_or_else(String::new, |name| {
            format!(
                "; `{name}` is a built-in scene (to render it: `toyproof render {name}`; to compare a shader with it: \
                 `toyproof check SHADER --scene {name}`)"
            )
        });
            ReadError::Missing { path, hint }
        }
        other => other,
    }
}

/// The name of the built-in scene that a path is, with or without `.toml`.
fn builtin_name(path: &Path) -> Option<&'static str> {
    let path = path.to_str()?;
    let stem = path.strip_suffix(".toml").unwrap_or(path);
    course_scenes().map(|(name, _)| name).find(|name| *name == stem)
}

fn builtin_scene(path: &Path) -> Result<File, String> {
    let name = path_name(path);
    let stem = name.strip_suffix(".toml").unwrap_or(&name);
    if let Some((stem, text)) = course_scenes().find(|(known, _)| *known == stem) {
        return Ok(File::new(format!("{stem}.toml"), text));
    }
    let is_near = |known: &str| {
        // The number of a scene, or its name without the number, is enough for a suggestion.
        let (number, title) = known.split_once('-').unwrap_or(("", known));
        stem == number || stem == title
    };
    let known = || course_scenes().map(|(known, _)| known);
    let near = known().find(|known| is_near(known));
    let help = match near.or_else(|| nearest(stem, known())) {
        Some(near) => format!("did you mean the built-in scene `{near}`?"),
        None => "`toyproof scenes` lists the built-in scenes".to_owned(),
    };
    Err(format!("no such file or built-in scene: {name}\nhelp: {help}"))
}

// The shaders and scenes of the course, which are embedded in the program.

static COURSE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/glsl");

/// The scenes of the course by their names, in order.
fn course_scenes() -> impl Iterator<Item = (&'static str, &'static str)> {
    // The other TOML files are those of projects and of exercises in folders, and the tests of functions.
    let is_scene = |stem: &&str| !stem.contains('/') && stem.strip_suffix(".test").is_none();
    course_files().filter_map(move |(name, content)| {
        let stem = name.strip_suffix(".toml").filter(is_scene)?;
        Some((stem, str::from_utf8(content).ok()?))
    })
}

/// All files of the course, sorted by name: shaders (`NN-name.glsl`, or the files of a project in the folder
/// `NN-name`), their scenes or assignments (`NN-name.toml`), the tests of their functions (`NN-name.test.toml`),
/// and what assignments refer to.
fn course_files() -> impl Iterator<Item = (&'static str, &'static [u8])> {
    let mut files = Vec::new();
    let mut folders = vec![&COURSE];
    while let Some(folder) = folders.pop() {
        folders.extend(folder.dirs());
        let named = folder
            .files()
            .filter_map(|file| Some((file.path().to_str()?, file.contents())));
        files.extend(named);
    }
    files.sort_unstable();
    files.into_iter()
}
