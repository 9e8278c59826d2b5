//! How much two images differ, as one number and as a map of the image: RMSE, PSNR, SSIM, and FLIP for images
//! as displayed and for images of high dynamic range.
//!
//! Except for HDR-FLIP, colors are those that ShaderToy displays: components clamped to [0, 1], without a
//! transfer function, where NaN is black. Alpha is ignored. Results depend neither on the number of threads
//! nor on their order.
//!
//! ```
//! use toyproof_image::Image;
//! use toyproof_metrics::{Metric, measure};
//!
//! let gray = |value: f32| Image::new(16, 16, vec![[value, value, value, 1.0]; 256]);
//! let measured = measure(Metric::Psnr, &gray(0.5), &gray(0.6)).unwrap();
//! assert!((measured.value - 20.0).abs() < 1e-5);
//! assert!(Metric::Psnr.accepts(measured.value, 19.0));
//! ```
//!
//! # Parts
//!
//! - `metric`: [`Metric`], and what its value means.
//! - `squared_error`: RMSE and PSNR; `ssim`; `flip`, with its color spaces in `flip/color`.
//! - `band`: separable filters of bands of rows, in parallel.
//! - `map`: a number for each pixel, and its image in colors.

mod band;
mod flip;
mod map;
mod metric;
mod squared_error;
mod ssim;
#[cfg(test)]
mod test_images;

pub use flip::PIXELS_PER_DEGREE;
pub use map::ErrorMap;
pub use metric::{Measurement, Metric, MetricError, measure};
