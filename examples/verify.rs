//! Compares a shader with its scene, without a GPU:
//! `cargo run --example verify -- glsl/02-sphere.glsl glsl/02-sphere.toml`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;

use toyproof::diagnostic::{Deadline, File, Files};
use toyproof::explain::{Options, check};
use toyproof::glsl;
use toyproof::image::Frame;
use toyproof::lint::lint;
use toyproof::report::state;
use toyproof::scene;
use toyproof::verify::{Case, Expected};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(shader), Some(scene)) = (arguments.next(), arguments.next()) else {
        return Err("usage: verify SHADER.glsl SCENE.toml".into());
    };
    let mut files = Files::default();
    let shader = files.add(File::new(&shader, std::fs::read_to_string(&shader)?));
    let scene = files.add(File::new(&scene, std::fs::read_to_string(&scene)?));
    let checked = glsl::check(&files, shader, &glsl::Options::default())?;
    let lints = lint(&files, &checked, &Deadline::default());
    let scene = scene::parse(&files, scene)?;

    let frame = Frame {
        size: scene.film.size,
        ..Frame::default()
    };
    let expected = Expected::from_scene(scene, &frame);
    let case = Case::new(&checked, &lints, &frame).with_expected(&expected);
    // The first argument would be a `gpu::Worker`; without one the toolchain check is left out.
    let findings = check(None, &case, &Options::default())?;
    println!("{}: {}", findings.verdict, state(&findings, &files).reason);
    Ok(())
}
