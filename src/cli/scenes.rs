//! `toyproof scenes`

use std::fs;
use std::path::PathBuf;

use toyproof_diagnostic::{File, Files, path_name};
use toyproof_scene as scene;

use super::{Exit, Terminal, course};

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
        for (name, text) in course::files() {
            if let Some(stem) = name.strip_suffix(".toml") {
                terminal.result(&format!("{stem:<24} {}", title(name, text)));
            }
        }
        terminal.say("`toyproof scenes --write DIR` writes their shaders (.glsl) and scenes (.toml)");
        return Exit::Good;
    };
    let differs = |name: &str, text: &str| {
        let path = folder.join(name);
        path.exists() && fs::read(&path).ok().as_deref() != Some(text.as_bytes())
    };
    if let Some((name, _)) = course::files().find(|(name, text)| differs(name, text)) {
        terminal.error(format_args!(
            "{} is there already and is not the course's; nothing was written, name another folder",
            path_name(&folder.join(name))
        ));
        return Exit::Trouble;
    }
    for (name, text) in course::files() {
        if !terminal.write(&folder.join(name), text.as_bytes()) {
            return Exit::Trouble;
        }
    }
    terminal.say(&format!(
        "wrote {} files to {}",
        course::files().count(),
        path_name(folder)
    ));
    Exit::Good
}

fn title(name: &str, text: &str) -> String {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    scene::parse(&files, file)
        .map(|scene| scene.title)
        .unwrap_or_default()
}
