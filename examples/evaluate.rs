//! Evaluates a shader on the CPU in double precision: `cargo run --example evaluate -- glsl/02-sphere.glsl exact.exr`

use std::error::Error;

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::{Options, check};
use toyproof::image::{Frame, encode, output};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(shader), Some(image)) = (arguments.next(), arguments.next()) else {
        return Err("usage: evaluate SHADER.glsl IMAGE.exr|IMAGE.png".into());
    };
    let mut files = Files::default();
    let file = files.add(File::new(&shader, std::fs::read_to_string(&shader)?));
    let checked = check(&files, file, &Options::default())?;

    let frame = Frame {
        size: [320, 180],
        time: 1.5,
        ..Frame::default()
    };
    let rendered = Program::new(&checked)?.render(&frame, &Settings::<f64>::default())?;
    let path = image.as_ref();
    output::write(path, &encode(&rendered.framebuffer.image(), path)?)?;
    Ok(())
}
