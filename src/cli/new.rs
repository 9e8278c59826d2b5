//! `toyproof new`

use std::path::{Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_scene as scene;

use super::{Exit, Terminal};

/// Create a new file from a template
#[derive(Debug, clap::Args)]
#[command(
    arg_required_else_help = true,
    after_long_help = "Example:\n  toyproof new scene week1"
)]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Create a scene: a camera, a light, a floor and two spheres, with comments on every key
    #[command(
        after_long_help = "Example:\n  toyproof new scene week1\n  toyproof render week1.toml -o week1.png"
    )]
    Scene(SceneArgs),
}

#[derive(Debug, clap::Args)]
struct SceneArgs {
    /// The name of the scene, which becomes its title and its file name
    #[arg(value_parser = parse_name)]
    name: String,
    /// The file to create [default: NAME.toml]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Parses a name that is also the name of a file.
fn parse_name(text: &str) -> Result<String, String> {
    let name = text.strip_suffix(".toml").unwrap_or(text);
    let is_allowed = |c: char| c.is_alphanumeric() || " -_.".contains(c);
    if name.starts_with(char::is_alphanumeric) && name.chars().all(is_allowed) {
        Ok(name.to_owned())
    } else {
        Err("a name consists of letters, digits, `-`, `_`, `.` and spaces, and starts with a letter or digit; \
             use `-o` to choose the folder"
            .to_owned())
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    match &args.what {
        What::Scene(args) => new_scene(args, terminal),
    }
}

fn new_scene(args: &SceneArgs, terminal: &Terminal) -> Exit {
    let path = match &args.output {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.toml", args.name)),
    };
    let name = path_name(&path);
    let is_stream = path == Path::new("-");
    if !is_stream && path.exists() {
        terminal.error(format_args!(
            "{name} already exists; choose another name, or another file with `-o`"
        ));
        return Exit::Error;
    }
    if !terminal.write(&path, scene::template(&args.name).as_bytes()) {
        return Exit::Error;
    }
    if !is_stream {
        let (scene, stem) = (quoted(&name), path_name(&path.with_extension("")));
        terminal.note(&format!("created {name}"));
        terminal.note("next:");
        let (image, shader) = (quoted(&format!("{stem}.png")), quoted(&format!("{stem}.glsl")));
        terminal.note(&format!("  toyproof render {scene} -o {image}"));
        terminal.note(&format!("  toyproof export {scene} -o {shader}"));
        terminal.note(&format!("  toyproof check {shader}"));
    }
    Exit::Success
}

/// Quotes a file name for a shell, if it has spaces.
fn quoted(name: &str) -> String {
    if name.contains(' ') {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    }
}
