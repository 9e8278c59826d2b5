//! `toyproof scenes`, and the course built into the program.

use std::fs;
use std::path::PathBuf;

use include_dir::{Dir, include_dir};
use toyproof_diagnostic::{File, Files, path_name};
use toyproof_scene as scene;

use super::{Exit, Terminal};

/// List the course's scenes and shaders, or write them to a folder
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  toyproof scenes --write course\n  toyproof check course --out pictures")]
pub(super) struct Args {
    /// Write every shader and its scene into this folder
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let Some(folder) = &args.write else {
        for (name, text) in course_files() {
            if let Some(stem) = name.strip_suffix(".toml") {
                terminal.result(&format!("{stem:<24} {}", title(name, text)));
            }
        }
        terminal.note("`toyproof scenes --write DIR` writes their shaders (.glsl) and scenes (.toml)");
        return Exit::Success;
    };
    let differs = |name: &str, text: &str| {
        let path = folder.join(name);
        path.exists() && fs::read(&path).ok().as_deref() != Some(text.as_bytes())
    };
    if let Some((name, _)) = course_files().find(|(name, text)| differs(name, text)) {
        terminal.error(format_args!(
            "{} is there already and is not the course's; nothing was written, name another folder",
            path_name(&folder.join(name))
        ));
        return Exit::Error;
    }
    for (name, text) in course_files() {
        if !terminal.write(&folder.join(name), text.as_bytes()) {
            return Exit::Error;
        }
    }
    terminal.note(&format!(
        "wrote {} files to {}",
        course_files().count(),
        path_name(folder)
    ));
    Exit::Success
}

fn title(name: &str, text: &str) -> String {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    scene::parse(&files, file)
        .map(|scene| scene.title)
        .unwrap_or_default()
}

// The course's shaders and scenes are embedded in the program.

static COURSE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/glsl");

/// All files of the course, sorted by name: shaders (`NN-name.glsl`) and their scenes (`NN-name.toml`).
fn course_files() -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut files: Vec<_> = COURSE
        .files()
        .filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)))
        .collect();
    files.sort_unstable();
    files.into_iter()
}
