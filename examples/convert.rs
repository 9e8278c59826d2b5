//! Converts a shader to WGSL, and proves that both render the same images, without a GPU:
//! `cargo run --example convert -- glsl/02-sphere.glsl`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::time::Duration;

use toyproof::convert::{Prover, Runner, Source, TargetCode};
use toyproof::diagnostic::{Deadline, File, Files, short};
use toyproof::glsl::{Options, check};
use toyproof::translate::wgsl::{Style, wgsl};

fn main() -> Result<(), Box<dyn Error>> {
    let shader = std::env::args().nth(1).ok_or("usage: convert SHADER.glsl")?;
    let mut files = Files::default();
    let shader = files.add(File::new(&shader, std::fs::read_to_string(&shader)?));
    let checked = check(&files, shader, &Options::default()).map_err(|errors| short(&errors[0], &files))?;
    let text = wgsl(&checked, &files, Style::Plain, &Deadline::default())?;

    // With `Runner::Driver`, a GPU runs the WGSL.
    let mut prover = Prover {
        runner: Runner::Evaluator(None),
        browser: None,
        timeout: Duration::from_secs(10),
        pool: None,
    };
    let source = Source {
        checked: &checked,
        files: &files,
    };
    let proved = prover.prove(source, &TargetCode::Wgsl(text.clone(), Style::Plain))?;
    println!("{text}// {} pixels equal", proved.proof().equal());
    Ok(())
}
