//! Rendering in tiles of 8×8 pixels, whose camera rays form one packet.

use std::ops::Range;

use rayon::prelude::*;
use toyproof_scene::Sampler;

use crate::camera::topmost_figure;
use crate::real::{Real, Vector};
use crate::sampler::{Sample, SampleStream, Strata, centered};
use crate::spheres::{NO_SURFACE, PACKET_RAYS};
use crate::tracer::Tracer;
use crate::transfer::tone_map_all;
use crate::world::trace::{Samples, each_slice};

/// Side of a tile in pixels.
pub(super) const TILE_SIDE: u32 = 8;

/// A tile of up to 8×8 pixels of the image.
#[derive(Debug, Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    /// Iterates over the rows of the tile inside the image: their indices in the packet, and those in a band
    /// that is `width` pixels wide.
    #[inline]
    fn rows(&self, width: u32) -> impl Iterator<Item = [Range<usize>; 2]> {
        let Self { corner, size } = *self;
        (0..size[1]).map(move |row| {
            [row * TILE_SIDE, row * width + corner[0]].map(|first| {
                let first = first as usize;
                first..first + size[0] as usize
            })
        })
    }

    /// Returns whether the pixel at an index in row order is inside the image.
    #[inline]
    fn contains(&self, at: usize) -> bool {
        (at as u32 % TILE_SIDE) < self.size[0] && (at as u32 / TILE_SIDE) < self.size[1]
    }

    /// Returns the pixel at an index in row order. Indices beyond the edge of the image repeat the pixels at
    /// the edge, so that every ray of a packet belongs to a pixel.
    #[inline]
    fn pixel(&self, at: usize) -> [u32; 2] {
        let within = [at as u32 % TILE_SIDE, at as u32 / TILE_SIDE];
        [0, 1].map(|axis| self.corner[axis] + within[axis].min(self.size[axis] - 1))
    }
}

/// Number of samples of a pixel that are next to each other in a packet, if the number of samples allows it:
/// rays that differ little take the same branches, so that no lane waits for another.
const ADJACENT_SAMPLES: usize = 8;

/// Which samples the rays of a packet are.
struct PacketSamples {
    /// The pixel of each ray, by its index in the tile.
    pixels: [usize; PACKET_RAYS],
    /// The index of each ray among the samples of its pixel, which increases within the packet.
    indices: [u32; PACKET_RAYS],
    /// Whether ray i belongs to pixel i.
    is_in_order: bool,
}

impl PacketSamples {
    /// Returns the samples of one of the `count` packets in which a tile with `count` samples per pixel is
    /// traced. Those of a pixel are in the order of their indices, over all packets.
    fn new(number: u32, count: u32, sampler: Sampler) -> Self {
        // Rays through the centers are made for a whole tile.
        if sampler == Sampler::Center || !count.is_multiple_of(ADJACENT_SAMPLES as u32) {
            return Self {
                pixels: std::array::from_fn(|at| at),
                indices: [number; PACKET_RAYS],
                is_in_order: true,
            };
        }
        // Blocks of 4×2 pixels, one after the other.
        let groups = count / ADJACENT_SAMPLES as u32;
        let (block, group) = ((number / groups) as usize, number % groups);
        let corner = block / 2 * 2 * TILE_SIDE as usize + block % 2 * 4;
        Self {
            pixels: std::array::from_fn(|at| {
                let pixel = at / ADJACENT_SAMPLES;
                corner + pixel / 4 * TILE_SIDE as usize + pixel % 4
            }),
            indices: std::array::from_fn(|at| {
                group * ADJACENT_SAMPLES as u32 + (at % ADJACENT_SAMPLES) as u32
            }),
            is_in_order: false,
        }
    }

    /// Returns a mask of the rays whose pixels are inside the image.
    fn inside(&self, tile: Tile) -> u64 {
        if tile.size == [TILE_SIDE; 2] {
            return u64::MAX;
        }
        let inside = (0..PACKET_RAYS).filter(|&at| tile.contains(self.pixels[at]));
        inside.fold(0, |mask, at| mask | 1 << at)
    }

    /// Adds the samples to the sums of their pixels, those of a pixel in their order.
    fn add<T: Real>(&self, samples: &[[T; PACKET_RAYS]; 3], sums: &mut [[T; PACKET_RAYS]; 3]) {
        for (sums, samples) in sums.iter_mut().zip(samples) {
            if self.is_in_order {
                for (sum, &sample) in sums.iter_mut().zip(samples) {
                    *sum = *sum + sample;
                }
            } else {
                for (&pixel, &sample) in self.pixels.iter().zip(samples) {
                    sums[pixel] = sums[pixel] + sample;
                }
            }
        }
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
            for [in_packet, in_band] in tile.rows(self.film.size[0]) {
                for (at, pixel) in in_packet.zip(&mut pixels[in_band]) {
                    let [r, g, b] = [0, 1, 2].map(|axis| components[axis * PACKET_RAYS + at].to_f64() as f32);
                    *pixel = [r, g, b, 1.0];
                }
            }
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
            for [in_packet, in_band] in tile.rows(width) {
                for (at, mean) in in_packet.zip(&mut means[in_band]) {
                    *mean = T::Vec3::from_array([0, 1, 2].map(|axis| sums[axis][at])) / count;
                }
            }
        }
        means
    }

    /// Sums the radiance of one set of samples for each pixel of a tile.
    fn sums(&self, tile: Tile, sampler: Sampler, set: u32) -> [[T; PACKET_RAYS]; 3] {
        let mut sums = [[T::zero(); PACKET_RAYS]; 3];
        let count = self.film.samples;
        for number in 0..count {
            let rays = PacketSamples::new(number, count, sampler);
            let pixel = |at: usize| tile.pixel(rays.pixels[at]);
            let mut streams = [const { SampleStream::Center }; PACKET_RAYS];
            let screen = match sampler {
                Sampler::Center => self.pixel_centers(tile),
                Sampler::Stratified => {
                    let pixels = [0, 1].map(|axis| std::array::from_fn(|at| pixel(at)[axis]));
                    let (strata, pairs) =
                        Strata::first_pairs(self.level, [count, set], &rays.indices, &pixels);
                    streams = strata.map(SampleStream::Stratified);
                    self.screen_positions(|at| {
                        Self::sample_position(pixel(at), centered([pairs[0][at], pairs[1][at]]))
                    })
                }
                _ => self.screen_positions(|at| {
                    let sample = Sample {
                        pixel: pixel(at),
                        index: rays.indices[at],
                        count,
                        set,
                    };
                    streams[at] = SampleStream::new(sampler, sample);
                    Self::sample_position(sample.pixel, streams[at].jitter())
                }),
            };
            let packet = self.camera.packet(&screen, self.level);
            let found = self.world.nearest_of_packet(&packet);
            let (mut active, mut radiance) = (rays.inside(tile), [[T::zero(); PACKET_RAYS]; 3]);
            if !self.figures.is_empty() {
                for at in 0..PACKET_RAYS {
                    if let Some(figure) = topmost_figure(&self.figures, [screen[0][at], screen[1][at]]) {
                        active &= !(1 << at);
                        let color = self.figures[figure].color.to_array();
                        (0..3).for_each(|axis| radiance[axis][at] = color[axis]);
                    }
                }
            }
            let origins = packet.all_origins();
            let samples = Samples {
                origins: each_slice(&origins),
                directions: each_slice(&packet.directions),
                t: found.t(),
                surfaces: found.surfaces(),
                active,
                streams: &mut streams,
                radiance: radiance.each_mut().map(|of_axis| &mut of_axis[..]),
            };
            self.world.trace(samples);
            rays.add(&radiance, &mut sums);
        }
        sums
    }

    /// Maps the pixel centers of a tile to the screen. The pixels of a column share x, those of a row share
    /// y.
    fn pixel_centers(&self, tile: Tile) -> [[T; PACKET_RAYS]; 2] {
        const SIDES: usize = TILE_SIDE as usize;
        let on_diagonal: [[T; 2]; SIDES] =
            std::array::from_fn(|at| self.camera.pixel_center(tile.pixel(at * (SIDES + 1))));
        let columns = on_diagonal.map(|[x, _]| x);
        let [mut xs, mut ys] = [[T::zero(); PACKET_RAYS]; 2];
        for (row, [_, y]) in on_diagonal.into_iter().enumerate() {
            let row = row * SIDES..(row + 1) * SIDES;
            xs[row.clone()].copy_from_slice(&columns);
            ys[row].fill(y);
        }
        [xs, ys]
    }

    /// Maps positions in the image to the screen.
    fn screen_positions(&self, mut position: impl FnMut(usize) -> [T; 2]) -> [[T; PACKET_RAYS]; 2] {
        let [mut xs, mut ys] = [[T::zero(); PACKET_RAYS]; 2];
        for (at, (x, y)) in xs.iter_mut().zip(&mut ys).enumerate() {
            [*x, *y] = position(at);
        }
        self.camera.screen_positions(self.level, &[xs, ys])
    }

    /// Returns the index of the surface behind the center of each pixel, bottom row first, or [`u32::MAX`]
    /// for the background.
    pub fn surfaces(&self) -> Vec<u32> {
        let [width, height] = self.film.size;
        let mut surfaces = vec![NO_SURFACE; width as usize * height as usize];
        let bands = surfaces
            .par_chunks_mut(width as usize * TILE_SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, surfaces)| {
            for tile in self.tiles(band as u32 * TILE_SIDE) {
                let packet = self.camera.packet(&self.pixel_centers(tile), self.level);
                let found = self.world.nearest_of_packet(&packet);
                for [in_packet, in_band] in tile.rows(width) {
                    for (surface, tag) in surfaces[in_band].iter_mut().zip(&found.surfaces()[in_packet]) {
                        *surface = tag.untag();
                    }
                }
            }
        });
        surfaces
    }
}
