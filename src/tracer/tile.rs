//! Rendering in tiles of 8×8 pixels, whose camera rays form one packet.

use rayon::prelude::*;
use toyproof_scene::Sampler;

use crate::camera::topmost_figure;
use crate::real::{Real, Vector};
use crate::sampler::{Sample, SampleStream, Strata, centered};
use crate::spheres::{NO_SURFACE, PACKET_RAYS, Packet, PacketHits};
use crate::transfer::tone_map_all;
use crate::world::{Samples, each_slice};
use crate::{Kernel, Tracer};

/// Side of a tile in pixels.
pub(super) const TILE_SIDE: u32 = 8;

/// A tile of up to 8×8 pixels of the image.
#[derive(Debug, Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    /// Calls `with` for each pixel of the tile inside the image, with its index in the packet and its index
    /// in a band that is `width` pixels wide.
    #[inline]
    fn for_each_pixel(&self, width: u32, mut with: impl FnMut(usize, usize)) {
        for row in 0..self.size[1] {
            for column in 0..self.size[0] {
                let in_band = row * width + self.corner[0] + column;
                with((row * TILE_SIDE + column) as usize, in_band as usize);
            }
        }
    }

    /// Returns the pixel at an index in row order. Indices beyond the edge of the image repeat the pixels at
    /// the edge, so that every ray of a packet belongs to a pixel.
    #[inline]
    fn pixel(&self, at: usize) -> [u32; 2] {
        let within = [at as u32 % TILE_SIDE, at as u32 / TILE_SIDE];
        [0, 1].map(|axis| self.corner[axis] + within[axis].min(self.size[axis] - 1))
    }
}

impl<T: Real> Tracer<T> {
    /// Iterates over the tiles of a band, which has as many rows as a tile or as remain in the image.
    fn tiles(&self, bottom: u32) -> impl Iterator<Item = Tile> {
        let [width, height] = self.film.size;
        (0..width).step_by(TILE_SIDE as usize).map(move |left| Tile {
            corner: [left, bottom],
            size: [TILE_SIDE.min(width - left), TILE_SIDE.min(height - bottom)],
        })
    }

    /// Renders a band.
    pub(super) fn band(&self, bottom: u32, pixels: &mut [[f32; 4]]) {
        let count = T::from_f64(f64::from(self.film.samples));
        for tile in self.tiles(bottom) {
            let sums = self.sums(tile, self.film.sampler, 0);
            let mut components: [T; 3 * PACKET_RAYS] =
                std::array::from_fn(|at| sums[at / PACKET_RAYS][at % PACKET_RAYS] / count);
            tone_map_all(&self.film, self.level, &mut components);
            tile.for_each_pixel(self.film.size[0], |at, in_band| {
                let [r, g, b] = [0, 1, 2].map(|axis| components[axis * PACKET_RAYS + at].to_f64() as f32);
                pixels[in_band] = [r, g, b, 1.0];
            });
        }
    }

    /// Computes, in row order, the mean of each pixel of a band over one set of samples of the given sampler.
    /// The means are not tone-mapped.
    pub(super) fn means(&self, bottom: u32, sampler: Sampler, set: u32) -> Vec<T::Vec3> {
        let [width, height] = self.film.size;
        let count = T::from_f64(f64::from(self.film.samples));
        let mut means = vec![T::Vec3::ZERO; (TILE_SIDE.min(height - bottom) * width) as usize];
        for tile in self.tiles(bottom) {
            let sums = self.sums(tile, sampler, set);
            tile.for_each_pixel(width, |at, in_band| {
                means[in_band] = T::Vec3::from_array([0, 1, 2].map(|axis| sums[axis][at])) / count;
            });
        }
        means
    }

    /// Sums the radiance of one set of samples for each pixel of a tile.
    fn sums(&self, tile: Tile, sampler: Sampler, set: u32) -> [[T; PACKET_RAYS]; 3] {
        let mut sums = [[T::zero(); PACKET_RAYS]; 3];
        let count = self.film.samples;
        for index in 0..count {
            let mut stream = [const { SampleStream::Center }; PACKET_RAYS];
            let screen = match sampler {
                Sampler::Center => self.pixel_centers(tile),
                Sampler::Stratified => {
                    let pixels = [0, 1].map(|axis| std::array::from_fn(|at| tile.pixel(at)[axis]));
                    let (strata, pairs) = Strata::first_pairs(self.level, [index, count, set], &pixels);
                    stream = strata.map(SampleStream::Stratified);
                    self.screen_positions(|at| {
                        Self::sample_position(tile.pixel(at), centered([pairs[0][at], pairs[1][at]]))
                    })
                }
                _ => self.screen_positions(|at| {
                    let sample = Sample {
                        pixel: tile.pixel(at),
                        index,
                        count,
                        set,
                    };
                    stream[at] = SampleStream::new(sampler, sample);
                    Self::sample_position(sample.pixel, stream[at].jitter())
                }),
            };
            let packet = self.camera.packet(&screen, self.level);
            let found = self.nearest_of_packet(&packet);
            let mut active = 0;
            tile.for_each_pixel(self.film.size[0], |at, _| {
                match topmost_figure(&self.figures, [screen[0][at], screen[1][at]]) {
                    Some(figure) => {
                        for (sum, more) in sums.iter_mut().zip(self.figures[figure].color.to_array()) {
                            sum[at] = sum[at] + more;
                        }
                    }
                    None => active |= 1 << at,
                }
            });
            let origins = packet.all_origins();
            let samples = Samples {
                origins: each_slice(&origins),
                directions: each_slice(&packet.directions),
                t: found.t(),
                surfaces: found.surfaces(),
                active,
                streams: &mut stream,
                sums: sums.each_mut().map(|sum| &mut sum[..]),
            };
            match &self.kernel {
                Kernel::Spheres(world) => world.trace(samples),
                Kernel::Shapes(world) => world.trace(samples),
            }
        }
        sums
    }

    /// Maps the pixel centers of a tile to the screen. The pixels of a column share x, those of a row share
    /// y.
    fn pixel_centers(&self, tile: Tile) -> [[T; PACKET_RAYS]; 2] {
        const SIDES: usize = TILE_SIDE as usize;
        let half = T::from_f64(0.5);
        let center = |axis: usize, at: usize| {
            let along = tile.pixel(at * (SIDES + 1))[axis];
            T::from_f64(f64::from(along)) + half
        };
        let x: [T; SIDES] = std::array::from_fn(|at| self.camera.screen_x(center(0, at)));
        let y: [T; SIDES] = std::array::from_fn(|at| self.camera.screen_y(center(1, at)));
        [
            std::array::from_fn(|at| x[at % SIDES]),
            std::array::from_fn(|at| y[at / SIDES]),
        ]
    }

    /// Maps positions in the image to the screen.
    fn screen_positions(&self, mut position: impl FnMut(usize) -> [T; 2]) -> [[T; PACKET_RAYS]; 2] {
        let [mut xs, mut ys] = [[T::zero(); PACKET_RAYS]; 2];
        for (at, (x, y)) in xs.iter_mut().zip(&mut ys).enumerate() {
            [*x, *y] = self.camera.screen(position(at));
        }
        [xs, ys]
    }

    /// Finds the first hits of a packet of camera rays.
    fn nearest_of_packet(&self, packet: &Packet<T>) -> PacketHits<T> {
        match &self.kernel {
            Kernel::Spheres(world) => world.nearest_of_packet(packet),
            Kernel::Shapes(world) => world.nearest_of_packet(packet),
        }
    }

    /// Returns the index of the surface behind the center of each pixel, bottom row first, or [`u32::MAX`]
    /// for the background.
    #[must_use]
    pub fn surfaces(&self) -> Vec<u32> {
        let [width, height] = self.film.size;
        let mut surfaces = vec![NO_SURFACE; width as usize * height as usize];
        let bands = surfaces
            .par_chunks_mut(width as usize * TILE_SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, surfaces)| {
            for tile in self.tiles(band as u32 * TILE_SIDE) {
                let packet = self.camera.packet(&self.pixel_centers(tile), self.level);
                let found = self.nearest_of_packet(&packet);
                tile.for_each_pixel(width, |at, in_band| {
                    if let Some((_, surface)) = found.get(at).get() {
                        surfaces[in_band] = surface as u32;
                    }
                });
            }
        });
        surfaces
    }
}
