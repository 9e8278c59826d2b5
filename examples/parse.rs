//! Parses a shader and lists its functions and what the lints find: `cargo run --example parse -- glsl/02-sphere.glsl`

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "an example prints its result"
)]

use std::error::Error;

use toyproof::diagnostic::{Deadline, File, Files, human};
use toyproof::glsl::{Options, check};
use toyproof::lint::lint;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: parse SHADER.glsl")?;
    let mut files = Files::default();
    let file = files.add(File::new(&path, std::fs::read_to_string(&path)?));
    let checked = check(&files, file, &Options::default())?;
    for (_, function) in checked.tree.functions.iter() {
        println!("{} takes {} parameters", function.name, function.parameters.len());
    }
    for warning in &lint(&files, &checked, &Deadline::default()).warnings {
        eprint!("{}", human(warning, &files, None, false));
    }
    Ok(())
}
