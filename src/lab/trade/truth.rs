//! The truth, as far as f64 knows it, and how far that is.

use std::time::{Duration, Instant};

use toyproof_eval::{self as eval, Jittered, Seed};
use toyproof_image::{Frame, Image};
use toyproof_scene::{Requirements, Sampler, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::compare::grouped;

use super::error::rmse;
use super::way::{Shader, Workshop};

/// A picture that others are compared with.
#[derive(Debug)]
pub(super) struct Truth {
    pub(super) picture: Image,
    /// Its own error: a root mean square.
    pub(super) error: f64,
    /// How it was made.
    pub(super) says: String,
}

/// Errors of tiles that are asked for, one after the other, as long as there is time.
const ERRORS: [f64; 6] = [0.008, 0.004, 0.002, 0.001, 0.0005, 0.00025];
/// Half of the error costs so many times the time, by Sobol's sequence.
const DEARER: f64 = 3.0;

impl Truth {
    /// Of a scene. Where it is sampled, by as many samples as there is time for.
    pub(super) fn of_scene(scene: &Scene, frame: &Frame, time: Duration) -> Self {
        let moment = Workshop::moment(frame);
        if !Requirements::of(scene).samples {
            let picture = Tracer::<f64>::at(scene, moment).picture(|| ());
            // What rounding does in f64 is what it does to a scene that is elsewhere by some units in the last place.
            let mut moved = scene.clone();
            let size = moved.camera.eye.iter().fold(1.0f64, |size, x| size.max(x.abs()));
            moved.camera.eye = moved.camera.eye.map(|x| x + 4.0 * f64::EPSILON * size);
            let error = rmse(&picture, &Tracer::<f64>::at(&moved, moment).picture(|| ()));
            return Self {
                picture,
                error,
                says: "the tracer in f64, at the centres of pixels; its error is what moving the eye by four units in the last place changes"
                    .to_owned(),
            };
        }
        let mut scene = scene.clone();
        scene.film.sampler = Sampler::Sobol;
        let tracer = Tracer::<f64>::at(&scene, moment);
        let start = Instant::now();
        let mut best: Option<Self> = None;
        for asked in ERRORS {
            let before = start.elapsed();
            let (picture, spent) = tracer.picture_within(asked, || ());
            best = Some(Self {
                picture,
                error: spent.error,
                says: format!(
                    "the tracer in f64 with Sobol's samples, {} to {} in a pixel; its error is the largest that a tile of 16x16 pixels is \
                     estimated to have",
                    grouped(u64::from(spent.per_pixel[1])),
                    grouped(u64::from(spent.per_pixel[0]))
                ),
            });
            let took = start.elapsed().saturating_sub(before);
            if start.elapsed() + took.mul_f64(DEARER) > time {
                break;
            }
        }
        // One was made: there are errors to ask for.
        best.unwrap_or_else(|| Self {
            picture: tracer.picture(|| ()),
            error: 1.0,
            says: String::new(),
        })
    }

    /// Of a shader alone: what it paints in f64.
    pub(super) fn of_shader(shader: &Shader, frame: &Frame, time: Duration) -> Result<Self, eval::Failure> {
        let deadline = Instant::now() + time;
        let picture = shader.paint::<f64>(frame, (), deadline)?;
        let shaken = shader.paint::<Jittered>(frame, Seed(1), deadline)?;
        Ok(Self {
            error: rmse(&picture, &shaken),
            picture,
            says: "the shader in f64; its error is what random rounding of every operation changes"
                .to_owned(),
        })
    }
}
