//! `toyproof export`

use std::iter;
use std::path::PathBuf;

use toyproof_diagnostic::path_name;
use toyproof_scene::export;

use super::inputs::may_write;
use super::render::load;
use super::{Exit, Terminal};

/// Write the shader that paints a scene
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  toyproof export glsl/04-many-objects.toml -o mine.glsl\n  \
                        toyproof check mine.glsl --scene glsl/04-many-objects.toml\n\n\
                        Exit code: 0, or 2 if the scene uses what cannot be exported yet."
)]
pub(super) struct Args {
    /// The scene, in TOML
    scene: PathBuf,
    /// The shader (.glsl, or - for standard output)
    #[arg(short, long, value_name = "SHADER")]
    output: PathBuf,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    if !may_write(&args.output, &iter::once(&*args.scene).collect(), terminal) {
        return Exit::Trouble;
    }
    let Some(scene) = load(&args.scene, terminal) else {
        return Exit::Trouble;
    };
    match export::shader(&scene) {
        Ok(text) if terminal.write(&args.output, text.as_bytes()) => Exit::Good,
        Ok(_) => Exit::Trouble,
        Err(what) => {
            terminal.error(format_args!(
                "{}: {what} cannot be exported yet",
                path_name(&args.scene)
            ));
            Exit::Trouble
        }
    }
}
