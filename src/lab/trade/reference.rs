//! The reference image in double precision, and its own error.

use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_diagnostic::grouped;
use toyproof_eval::{self as eval, RandomRounding, Seed};
use toyproof_image::{Frame, Image};
use toyproof_scene::{Requirements, Sampler, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::compare::{self, TOLERANCE};

use super::method::{RenderContext, Shader};

/// An image that others are compared with.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) image: Image,
    /// The error of the image itself: a root mean square, in [0, 1].
    pub(super) error: f64,
    /// The renderer and its samples.
    pub(super) description: String,
    /// How the error was estimated.
    pub(super) error_estimate: &'static str,
}

/// Target errors of tiles, rendered in this order until the time is spent.
const TARGET_ERRORS: [f64; 6] = [0.008, 0.004, 0.002, 0.001, 0.0005, 0.00025];
/// The factor by which halving the error multiplies the time, with Sobol samples.
const HALVED_ERROR_TIME_FACTOR: f64 = 3.0;

impl Reference {
    /// Renders the reference of a scene; a scene that requires samples gets as many as the time allows.
    pub(super) fn from_scene(scene: &Scene, frame: &Frame, time: Duration) -> Self {
        let frame_time = RenderContext::frame_time(frame);
        if !Requirements::new(scene).samples {
            let image = Tracer::<f64>::at(scene, frame_time).render(|| ());
            // The effect of f64 rounding is estimated by moving the eye by a few units in the last place.
            let mut perturbed_scene = scene.clone();
            let size = perturbed_scene
                .camera
                .eye
                .iter()
                .fold(1.0f64, |size, x| size.max(x.abs()));
            perturbed_scene.camera.eye = perturbed_scene.camera.eye.map(|x| x + 4.0 * f64::EPSILON * size);
            let error = rmse(
                &image,
                &Tracer::<f64>::at(&perturbed_scene, frame_time).render(|| ()),
            );
            return Self {
                image,
                error,
                description: "tracer f64, 1 sample at each pixel center".to_owned(),
                error_estimate: "difference after moving the camera by 4 ULP",
            };
        }
        let mut scene = scene.clone();
        scene.film.sampler = Sampler::Sobol;
        let tracer = Tracer::<f64>::at(&scene, frame_time);
        let start = Instant::now();
        let mut best: Option<Self> = None;
        for target in TARGET_ERRORS {
            let before = start.elapsed();
            let (image, spent) = tracer.render_adaptive(target, || ());
            best = Some(Self {
                image,
                error: spent.error,
                description: format!(
                    "tracer f64, {} to {} Sobol samples per pixel",
                    grouped(u64::from(spent.per_pixel[1])),
                    grouped(u64::from(spent.per_pixel[0]))
                ),
                error_estimate: "largest estimate for a tile of 16×16 pixels",
            });
            let took = start.elapsed().saturating_sub(before);
            if start.elapsed() + took.mul_f64(HALVED_ERROR_TIME_FACTOR) > time {
                break;
            }
        }
        // [`TARGET_ERRORS`] is not empty, so `best` is set.
        best.unwrap_or_else(|| Self {
            image: tracer.render(|| ()),
            error: 1.0,
            description: String::new(),
            error_estimate: "",
        })
    }

    /// Renders the reference of a shader alone, in f64.
    pub(super) fn from_shader(shader: &Shader, frame: &Frame, time: Duration) -> Result<Self, eval::Failure> {
        let deadline = Instant::now() + time;
        let image = shader.render::<f64>(frame, (), deadline)?;
        let perturbed = shader.render::<RandomRounding>(frame, Seed::double(1), deadline)?;
        Ok(Self {
            error: rmse(&image, &perturbed),
            image,
            description: "the shader in f64".to_owned(),
            error_estimate: "difference after random rounding of every operation",
        })
    }
}

// Errors of images relative to the reference.

/// The difference of an image from the reference, both clamped to [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorStatistics {
    /// The root mean square over all components, in [0, 1].
    pub rmse: f64,
    /// The maximum absolute difference of a component.
    pub max: f64,
    /// The number of pixels whose 8-bit values differ.
    pub differing_pixels_8bit: u64,
    /// The number of pixels that show the background in only one of the images; `None` if the background is
    /// unknown.
    pub silhouette_flips: Option<u64>,
}

impl ErrorStatistics {
    /// Compares an image with the reference. `background` is the scene's image without objects.
    pub(super) fn new(reference: &Image, image: &Image, background: Option<&Image>) -> Self {
        let (comparison, _) = compare::compare(reference, image);
        Self {
            rmse: rmse(reference, image),
            max: comparison.max_abs,
            differing_pixels_8bit: comparison.differing_8bit,
            silhouette_flips: background.map(|background| {
                let empty = |image: &Image, at: usize| {
                    let pairs = image.pixels()[at].iter().zip(background.pixels()[at]).take(3);
                    pairs
                        .into_iter()
                        .all(|(a, b)| f64::from((a - b).abs()) <= TOLERANCE)
                };
                let pixels = 0..reference.pixels().len();
                pixels
                    .filter(|&at| empty(reference, at) != empty(image, at))
                    .count() as u64
            }),
        }
    }
}

/// The root mean square difference of components clamped to [0, 1]; NaN in one image counts as 1.
pub(super) fn rmse(one: &Image, other: &Image) -> f64 {
    let pairs = one.pixels().iter().zip(other.pixels());
    let squares = pairs.flat_map(|(a, b)| {
        (0..3).map(|i| match (a[i], b[i]) {
            (a, b) if a.is_nan() && b.is_nan() => 0.0,
            (a, b) if a.is_nan() || b.is_nan() => 1.0,
            (a, b) => (f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0)).powi(2),
        })
    });
    let count = 3 * one.pixels().len().max(1);
    (squares.sum::<f64>() / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: [f32; 4]) -> Image {
        Image::new(2, 2, values.map(|v| [v, v, v, 1.0]).to_vec())
    }

    #[test]
    fn errors_match_manual_calculation() {
        let reference = image([0.0, 0.5, 1.0, 0.2]);
        let rendered = image([0.1, 0.5, 7.0, 0.0]);
        let background = image([0.0, 0.0, 0.0, 0.0]);
        let error = ErrorStatistics::new(&reference, &rendered, Some(&background));
        assert!(
            (error.rmse - ((0.01f64 + 0.04) / 4.0).sqrt()).abs() < 1e-8,
            "{error:?}"
        );
        assert!((error.max - 0.2).abs() < 1e-7);
        assert_eq!(
            (error.differing_pixels_8bit, error.silhouette_flips),
            (2, Some(2))
        );
        let same = ErrorStatistics::new(&reference, &reference, None);
        assert_eq!(
            (
                same.rmse,
                same.max,
                same.differing_pixels_8bit,
                same.silhouette_flips
            ),
            (0.0, 0.0, 0, None)
        );
    }
}
