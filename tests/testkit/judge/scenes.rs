//! A scene file: its errors, or a few pixels of its image and the shader that renders it.

use std::time::Duration;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::scene::{FrameTime, Sampler, Scene, export, parse};
use toyproof::tracer::Tracer;

use super::within;

/// Width and height of the image of which pixels are rendered.
const SIZE: [u32; 2] = [6, 4];
/// The maximum number of path segments of these pixels: glass doubles the rays with each.
const MAX_DEPTH: u32 = 4;

/// Whether a text is a scene.
///
/// # Panics
/// If reading, exporting or rendering it does, or takes more than `allowed` of a processor; if a rejected file has
/// no error; if the exported shader is invalid.
pub fn judge(text: &str, allowed: Duration) -> bool {
    within(allowed, || {
        let mut files = Files::default();
        let file = files.add(File::new("scene.toml", text));
        match parse(&files, file) {
            Err(errors) => {
                assert!(
                    errors.to_string().contains("error["),
                    "rejected without an error: {errors}"
                );
                false
            }
            Ok(scene) => {
                export_and_render(scene);
                true
            }
        }
    })
}

fn export_and_render(mut scene: Scene) {
    if let Ok(shader) = export::shader(&scene) {
        let mut files = Files::default();
        let file = files.add(File::new("exported.glsl", shader));
        if let Err(errors) = check(&files, file, &Options::default()) {
            panic!("the exported shader is invalid: {errors}");
        }
    }
    scene.film.size = SIZE;
    scene.film.samples = 1;
    scene.film.max_depth = scene.film.max_depth.min(MAX_DEPTH);
    let middle = [SIZE[0] / 2, SIZE[1] / 2];
    for frame_time in [FrameTime::default(), FrameTime { frame: 90, time: 1.5 }] {
        let tracer = Tracer::<f64>::at(&scene, frame_time);
        for [x, y] in [[0, 0], middle, [SIZE[0] - 1, SIZE[1] - 1]] {
            let color = tracer.pixel(x, y);
            if scene.film.sampler == Sampler::Center {
                let again = tracer.pixel(x, y);
                assert_eq!(color.map(f64::to_bits), again.map(f64::to_bits), "at {x}, {y}");
            }
        }
        let _ = Tracer::<f32>::at(&scene, frame_time).pixel(middle[0], middle[1]);
    }
}
