//! The reference image in double precision, and its own error.

use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_diagnostic::grouped;
use toyproof_eval::{self as eval, RandomRounding, Seed};
use toyproof_image::{Frame, Image};
use toyproof_metrics::{Metric, measure};
use toyproof_scene::{Requirements, Sampler, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::compare::{self, TOLERANCE, visible_pixels};

use super::method::RenderContext;
use super::source::Shader;

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

    /// Renders the reference of a shader alone, in f64; in f32 if rounding changes what the shader shows, as
    /// in one that takes random numbers from the last digits of a sine.
    pub(super) fn from_shader(shader: &Shader, frame: &Frame, time: Duration) -> Result<Self, eval::Failure> {
        let start = Instant::now();
        let deadline = start + time;
        let (single, took) = shader.evaluate::<f32>(frame, (), deadline)?;
        let settings: Vec<String> = shader.settings.iter().map(ToString::to_string).collect();
        let with = if settings.is_empty() {
            String::new()
        } else {
            format!(" with {}", settings.join(", "))
        };
        let too_slow = |image| Self {
            image,
            error: 0.0,
            description: format!(
                "the shader in f32{with}, since f64 takes longer than a part of the time budget"
            ),
            error_estimate: "none",
        };
        if took.mul_f64(DOUBLE_COST) > time {
            return Ok(too_slow(single));
        }
        let Ok((double, took)) = shader.evaluate::<f64>(frame, (), deadline) else {
            return Ok(too_slow(single));
        };
        let share = visible_pixels(&double, &single) as f64 / double.pixels().len() as f64;
        if share > MAX_ROUNDED_SHARE {
            return Ok(Self {
                error: rmse(&double, &single),
                image: single,
                description: format!(
                    "the shader in f32{with}: f64 has other colors in {:.1} % of the pixels",
                    100.0 * share
                ),
                error_estimate: "difference from f64",
            });
        }
        let is_in_time = start.elapsed() + took.mul_f64(ROUNDING_COST) < time;
        let perturbed =
            is_in_time.then(|| shader.evaluate::<RandomRounding>(frame, Seed::double(1), deadline));
        let (error, error_estimate) = match perturbed {
            Some(Ok((perturbed, _))) => (
                rmse(&double, &perturbed),
                "difference after random rounding of every operation",
            ),
            _ => (rmse(&double, &single), "difference from f32, for lack of time"),
        };
        Ok(Self {
            image: double,
            error,
            description: format!("the shader in f64{with}"),
            error_estimate,
        })
    }
}

/// The times of a frame in f64 relative to f32, and with random rounding relative to f64: rather too long.
const DOUBLE_COST: f64 = 2.5;
const ROUNDING_COST: f64 = 3.0;

/// The share of visible pixels between f32 and f64 from which f64 is not what a shader is to show.
const MAX_ROUNDED_SHARE: f64 = 0.01;

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
    /// The number of pixels whose difference is visible: more than two 8-bit levels.
    pub visible_pixels: u64,
    /// The mean of FLIP, the difference that people perceive, in [0, 1]; `None` for large images.
    pub flip: Option<f64>,
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
            visible_pixels: visible_pixels(reference, image),
            flip: flip(reference, image),
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

/// The number of pixels of an image up to which FLIP takes a fraction of a second.
const MAX_FLIP_PIXELS: usize = 640 * 360;

/// The mean of FLIP of two images, clamped to [0, 1].
fn flip(reference: &Image, image: &Image) -> Option<f64> {
    let is_small = reference.pixels().len() <= MAX_FLIP_PIXELS;
    let measured = is_small.then(|| measure(Metric::Flip, reference, image))?;
    Some(measured.ok()?.value)
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
