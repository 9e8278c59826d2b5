//! Whole images, rendered in parallel.

use std::ops::Range;

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::{FrameTime, Scene};

use crate::adaptive::{ADAPTIVE_TILE_SIDE, AdaptiveTile, SamplingCost};
use crate::lanes::Level;
use crate::layers::PixelLayers;
use crate::real::Real;
use crate::spheres::Spheres;
use crate::tile::TILE_SIDE;
use crate::tracer::Tracer;

/// The number types that the tracer is compiled for. Its inner loops are instantiated in this crate once, not
/// in each crate that renders.
pub trait Backend: Real {
    /// Creates a tracer, which may reuse the topology of the sphere tree of another moment.
    #[doc(hidden)]
    fn create(
        scene: &Scene,
        frame_time: FrameTime,
        level: Level,
        previous: Option<Spheres<Self>>,
    ) -> Tracer<Self>;

    /// Renders the row of tiles whose lowest row of pixels is `bottom`.
    #[doc(hidden)]
    fn band(tracer: &Tracer<Self>, bottom: u32, pixels: &mut [[f32; 4]]);

    /// Renders a pixel.
    #[doc(hidden)]
    fn pixel(tracer: &Tracer<Self>, pixel: [u32; 2]) -> [Self; 3];

    /// Renders a pixel with its layers.
    #[doc(hidden)]
    fn layers(tracer: &Tracer<Self>, pixel: [u32; 2]) -> PixelLayers;

    /// Renders a tile with enough samples.
    #[doc(hidden)]
    fn adaptive_tile(tracer: &Tracer<Self>, corner: [u32; 2], max_error: f64) -> AdaptiveTile;
}

macro_rules! backends {
    ($($number:ty),*) => {$(
        impl Backend for $number {
            fn create(
                scene: &Scene,
                frame_time: FrameTime,
                level: Level,
                previous: Option<Spheres<Self>>,
            ) -> Tracer<Self> {
                Tracer::with_level(scene, frame_time, level, previous)
            }

            fn band(tracer: &Tracer<Self>, bottom: u32, pixels: &mut [[f32; 4]]) {
                tracer.band(bottom, pixels);
            }

            fn pixel(tracer: &Tracer<Self>, pixel: [u32; 2]) -> [Self; 3] {
                tracer.pixel_color(pixel)
            }

            fn layers(tracer: &Tracer<Self>, pixel: [u32; 2]) -> PixelLayers {
                tracer.pixel_layers(pixel)
            }

            fn adaptive_tile(tracer: &Tracer<Self>, corner: [u32; 2], max_error: f64) -> AdaptiveTile {
                tracer.adaptive_tile(corner, max_error)
            }
        }
    )*};
}
backends!(f32, f64);

impl<T: Backend> Tracer<T> {
    /// Creates a tracer for the first moment of `scene`. All numbers are rounded to `T` once, here.
    pub fn new(scene: &Scene) -> Self {
        Self::at(scene, FrameTime::default())
    }

    /// Creates a tracer for the given moment of `scene`.
    pub fn at(scene: &Scene, frame_time: FrameTime) -> Self {
        T::create(scene, frame_time, Level::best(), None)
    }

    /// Creates a tracer for a different moment of the same scene and reuses the topology of the sphere tree.
    #[must_use]
    pub fn moved(self, scene: &Scene, frame_time: FrameTime) -> Self {
        T::create(scene, frame_time, self.level, Some(self.world.into_spheres()))
    }

    /// Renders the whole image, unclamped. `row_done` is called once per row, from any thread.
    pub fn render(&self, row_done: impl Fn() + Sync) -> Image {
        self.rows(0..self.film.size[1], row_done)
    }

    /// Renders the given rows, with `row_done` as in [`Tracer::render`].
    pub fn rows(&self, rows: Range<u32>, row_done: impl Fn() + Sync) -> Image {
        let (width, height) = (self.film.size[0], rows.len() as u32);
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let bands = pixels
            .par_chunks_mut(width as usize * TILE_SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, pixels)| {
            T::band(self, rows.start + band as u32 * TILE_SIDE, pixels);
            (0..pixels.len() / width as usize).for_each(|_| row_done());
        });
        Image::new(width, height, pixels)
    }

    /// Renders the pixel at (x, y), where y points up: the tone-mapped mean of its samples.
    pub fn pixel(&self, x: u32, y: u32) -> [T; 3] {
        T::pixel(self, [x, y])
    }

    /// Renders the image with enough samples in each tile of 16×16 pixels to bring its estimated error below
    /// `max_error`, up to 65,536 per pixel. The error is the root mean square, over the pixels and components
    /// of the tile, of half the difference of two independent sets of samples, both tone-mapped and clamped
    /// to [0, 1]. The number of samples of the scene's film is ignored. Its sampler must be stochastic.
    ///
    /// `row_done` is called once per row of the image.
    pub fn render_adaptive(&self, max_error: f64, row_done: impl Fn() + Sync) -> (Image, SamplingCost) {
        let [width, height] = self.film.size;
        let bands: Vec<Vec<AdaptiveTile>> = (0..height.div_ceil(ADAPTIVE_TILE_SIDE))
            .into_par_iter()
            .map(|band| {
                let tiles = (0..width.div_ceil(ADAPTIVE_TILE_SIDE))
                    .map(|column| {
                        let corner = [column * ADAPTIVE_TILE_SIDE, band * ADAPTIVE_TILE_SIDE];
                        T::adaptive_tile(self, corner, max_error)
                    })
                    .collect();
                (0..ADAPTIVE_TILE_SIDE.min(height - band * ADAPTIVE_TILE_SIDE)).for_each(|_| row_done());
                tiles
            })
            .collect();
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let mut total = SamplingCost {
            samples: 0,
            per_pixel: [0, u32::MAX],
            error: 0.0,
        };
        for tile in bands.into_iter().flatten() {
            let ([left, bottom], [across, _], cost) = (tile.corner, tile.size, tile.cost);
            for (at, color) in (0..).zip(tile.colors) {
                let (x, y) = (left + at % across, bottom + at / across);
                let [r, g, b] = color.map(|c| c as f32);
                pixels[(y * width + x) as usize] = [r, g, b, 1.0];
            }
            total.samples += cost.samples;
            total.per_pixel[0] = total.per_pixel[0].max(cost.per_pixel[0]);
            total.per_pixel[1] = total.per_pixel[1].min(cost.per_pixel[1]);
            total.error = total.error.max(cost.error);
        }
        (Image::new(width, height, pixels), total)
    }
}

impl Tracer<f64> {
    /// Renders an image of the pixels in these columns and rows only.
    pub fn sampled(&self, columns: &[u32], rows: &[u32]) -> Image {
        let width = columns.len();
        let pixels = (0..width * rows.len()).into_par_iter().map(|at| {
            let [r, g, b] = self.pixel(columns[at % width], rows[at / width]);
            [r as f32, g as f32, b as f32, 1.0]
        });
        Image::new(width as u32, rows.len() as u32, pixels.collect())
    }
}
