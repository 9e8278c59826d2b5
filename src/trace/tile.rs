//! Eight by eight pixels at a time, whose camera rays are traced together.

use rayon::prelude::*;

use super::real::{Real, Vector};
use super::sampler::{Draws, Sample};
use super::seen::Seen;
use super::spheres::{PACKET, Packet};
use super::style::Exact;
use super::world::First;
use super::{Kernel, Tracer, figure, film};
use crate::scene::Sampler;

/// The side of a tile in pixels.
pub(super) const SIDE: u32 = 8;

/// Pixels of the picture, up to eight each way.
#[derive(Debug, Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    fn count(&self) -> usize {
        (self.size[0] * self.size[1]) as usize
    }

    /// Row by row; beyond the last, the first again, so that every ray of a packet is some pixel's.
    fn pixel(&self, at: usize) -> [u32; 2] {
        let at = if at < self.count() { at as u32 } else { 0 };
        [
            self.corner[0] + at % self.size[0],
            self.corner[1] + at / self.size[0],
        ]
    }
}

impl<T: Real> Tracer<T> {
    /// The tiles of a band: of as many rows as a tile has, or what is left of them.
    fn tiles(&self, bottom: u32) -> impl Iterator<Item = Tile> {
        let [width, height] = self.film.size;
        (0..width).step_by(SIDE as usize).map(move |left| Tile {
            corner: [left, bottom],
            size: [SIDE.min(width - left), SIDE.min(height - bottom)],
        })
    }

    /// The place of a tile's pixel in its band.
    fn in_band(&self, tile: Tile, at: usize) -> usize {
        let [x, y] = tile.pixel(at);
        ((y - tile.corner[1]) * self.film.size[0] + x) as usize
    }

    /// Paints a band.
    pub(super) fn band(&self, bottom: u32, pixels: &mut [[f32; 4]]) {
        for tile in self.tiles(bottom) {
            for (at, color) in self.paint(tile).into_iter().enumerate().take(tile.count()) {
                let [r, g, b] = color.map(|c| c.to_f64() as f32);
                pixels[self.in_band(tile, at)] = [r, g, b, 1.0];
            }
        }
    }

    /// The developed means of a tile's pixels.
    fn paint(&self, tile: Tile) -> [[T; 3]; PACKET] {
        let mut sums = [T::Vec3::ZERO; PACKET];
        let count = self.film.samples;
        for index in 0..count {
            let sample = |at| Sample {
                pixel: tile.pixel(at),
                index,
                count,
                set: 0,
            };
            let mut draws: [Draws; PACKET] =
                std::array::from_fn(|at| Draws::new(self.film.sampler, sample(at)));
            let screen = if self.film.sampler == Sampler::Center {
                self.middles(tile)
            } else {
                let place = |at: usize| Self::place(sample(at), &mut draws[at]);
                self.places(place)
            };
            let seen = self.look_together(&screen);
            for ((sum, seen), draws) in sums.iter_mut().zip(seen).zip(&mut draws).take(tile.count()) {
                *sum = *sum + self.radiance(seen, draws, &Exact);
            }
        }
        let count = T::from_f64(f64::from(count));
        sums.map(|sum| (sum / count).to_array().map(|c| film::develop(&self.film, c)))
    }

    /// The middles of a tile's pixels on the screen. Those of a column have one x, those of a row one y.
    fn middles(&self, tile: Tile) -> [[T; PACKET]; 2] {
        let half = T::from_f64(0.5);
        let diagonal: [[T; 2]; SIDE as usize] = std::array::from_fn(|at| {
            let pixel = tile.corner.map(|first| first + at as u32);
            self.camera
                .screen(pixel.map(|along| T::from_f64(f64::from(along)) + half))
        });
        [0, 1].map(|axis| {
            std::array::from_fn(|at| {
                let along = tile.pixel(at)[axis] - tile.corner[axis];
                diagonal[along as usize][axis]
            })
        })
    }

    /// Where on the screen these places of the picture are.
    fn places(&self, mut place: impl FnMut(usize) -> [T; 2]) -> [[T; PACKET]; 2] {
        let places: [[T; 2]; PACKET] = std::array::from_fn(|at| self.camera.screen(place(at)));
        [0, 1].map(|axis| places.map(|place| place[axis]))
    }

    /// What lies at these places.
    fn look_together(&self, screen: &[[T; PACKET]; 2]) -> [Seen<T>; PACKET] {
        let packet = self.camera.packet(screen, self.level);
        let first = self.nearest_of_packet(&packet);
        std::array::from_fn(
            |at| match figure::topmost(&self.figures, [screen[0][at], screen[1][at]]) {
                Some(figure) => Seen::Figure(figure),
                None => Seen::Scene(packet.ray(at), first[at]),
            },
        )
    }

    fn nearest_of_packet(&self, packet: &Packet<T>) -> [First<T>; PACKET] {
        match &self.kernel {
            Kernel::Spheres(world) => world.nearest_of_packet(packet),
            Kernel::Shapes(world) => world.nearest_of_packet(packet),
        }
    }

    /// The surfaces behind the middles of the pixels, by their numbers in the scene, bottom row first.
    #[must_use]
    pub fn surfaces(&self) -> Vec<Option<u32>> {
        let [width, height] = self.film.size;
        let mut surfaces = vec![None; width as usize * height as usize];
        let bands = surfaces.par_chunks_mut(width as usize * SIDE as usize);
        bands.enumerate().for_each(|(band, surfaces)| {
            for tile in self.tiles(band as u32 * SIDE) {
                let packet = self.camera.packet(&self.middles(tile), self.level);
                let first = self.nearest_of_packet(&packet);
                for (at, first) in first.into_iter().enumerate().take(tile.count()) {
                    surfaces[self.in_band(tile, at)] = first.map(|(_, surface)| surface as u32);
                }
            }
        });
        surfaces
    }
}
