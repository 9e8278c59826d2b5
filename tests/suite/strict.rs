//! Strict shaders compute the same bits as Rust's f32, operation by operation.

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu::{DrawOutput, Worker};
use toyproof::image::Frame;
use toyproof::translate::{FloatMode, lower};

use crate::requirements::require_worker;

/// Sums and products that drivers tend to rearrange, contract or fold.
const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
    float a = p.x * 0.37, b = p.y * 1.13;
    c = vec4((a * 0.1) * 0.3 + a * b, (a + 0.1) + 0.2, 1.0 / (1.0 / b), 1.0);
    c.x += (a + b) - b;
}";

fn as_written(x: f32, y: f32) -> [f32; 3] {
    let (a, b) = (x * 0.37, y * 1.13);
    [
        (a * 0.1) * 0.3 + a * b + ((a + b) - b),
        (a + 0.1) + 0.2,
        1.0 / (1.0 / b),
    ]
}

fn draw(worker: &mut Worker, float: FloatMode) -> DrawOutput {
    let mut files = Files::default();
    let file = files.add(File::new("s", SHADER));
    let frame = Frame {
        size: [64, 36],
        ..Frame::default()
    };
    let checked = check(&files, file, &Options::default()).unwrap();
    worker.draw(lower(&checked), frame, float).unwrap()
}

fn differing_pixels(drawn: &DrawOutput) -> usize {
    let rendered_image = drawn.clone().image();
    let width = rendered_image.size()[0] as usize;
    let differs = |(index, pixel): (usize, &[f32; 4])| {
        let (x, y) = ((index % width) as f32 + 0.5, (index / width) as f32 + 0.5);
        as_written(x, y).map(f32::to_bits) != [pixel[0], pixel[1], pixel[2]].map(f32::to_bits)
    };
    rendered_image
        .pixels()
        .iter()
        .enumerate()
        .filter(|&pixel| differs(pixel))
        .count()
}

#[test]
fn strict_shaders_compute_the_same_bits_as_rust() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let strict = draw(&mut worker, FloatMode::Strict);
    assert_eq!(differing_pixels(&strict), 0);
    if strict.device.contains("llvmpipe") {
        // Without the decorations, this driver rearranges arithmetic, so the test is meaningful.
        assert!(differing_pixels(&draw(&mut worker, FloatMode::Fast)) > 0);
    }
}
