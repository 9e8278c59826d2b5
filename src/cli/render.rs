//! `toyproof render`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;

use super::{Exit, Terminal, inputs};
use crate::image::{self, Image};
use crate::scene::{self, Scene};
use crate::source::{self, Files};
use crate::trace::{Real, Tracer};

/// Render a scene with the reference tracer
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  toyproof render glsl/02-sphere.toml -o reference.png\n  \
                        toyproof render scene.toml -o reference.exr --size 1920x1080 --samples 64"
)]
pub(super) struct Args {
    /// The scene, in TOML
    scene: PathBuf,
    /// The picture: .png (8 bits) or .exr (floats)
    #[arg(short, long, value_name = "PICTURE")]
    output: PathBuf,
    /// The number type that it is traced in
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    precision: Precision,
    /// Samples in each pixel [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    samples: Option<u32>,
    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = inputs::size)]
    size: Option<[u32; 2]>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Precision {
    F32,
    F64,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let Some(mut scene) = load(&args.scene, terminal) else {
        return Exit::Trouble;
    };
    scene.film.size = args.size.unwrap_or(scene.film.size);
    scene.film.samples = args.samples.unwrap_or(scene.film.samples);
    let start = Instant::now();
    let picture = match args.precision {
        Precision::F32 => trace::<f32>(&scene, terminal),
        Precision::F64 => trace::<f64>(&scene, terminal),
    };
    terminal.detail(&format!("traced in {:.3} s", start.elapsed().as_secs_f64()));
    match image::encode(&picture, &args.output) {
        Ok(bytes) if terminal.write(&args.output, &bytes) => Exit::Good,
        Ok(_) => Exit::Trouble,
        Err(error) => {
            terminal.error(error);
            Exit::Trouble
        }
    }
}

/// A scene from its file; says what is wrong with it.
fn load(path: &Path, terminal: &Terminal) -> Option<Scene> {
    let mut files = Files::default();
    let file = match source::read_text(path) {
        Ok(text) => files.add(text),
        Err(error) => {
            terminal.error(error);
            return None;
        }
    };
    scene::parse(&files, file)
        .map_err(|diagnostics| terminal.diagnostics(&diagnostics, &files))
        .ok()
}

/// The picture, with a bar that shows its rows.
fn trace<T: Real>(scene: &Scene, terminal: &Terminal) -> Image {
    let bar = terminal.bar(u64::from(scene.film.size[1]), "tracing");
    let picture = Tracer::<T>::new(scene).picture(|| bar.inc(1));
    bar.finish_and_clear();
    picture
}
