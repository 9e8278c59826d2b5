//! Eight by eight pixels at a time, whose camera rays are traced together.

use rayon::prelude::*;
use smallvec::SmallVec;
use toyproof_scene::Sampler;

use super::ray::First;
use super::real::{Real, Vector};
use super::sampler::{Draws, Sample, Strata, offset};
use super::spheres::{Found, NONE, PACKET, Packet};
use super::style::Exact;
use super::world::Walk;
use super::{Kernel, Tracer, figure, film};

/// The side of a tile in pixels.
pub(super) const SIDE: u32 = 8;

/// Pixels of the picture, up to eight each way.
#[derive(Debug, Clone, Copy)]
struct Tile {
    corner: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    /// Goes through those of its pixels that are in the picture: their places in a packet, and in the band, whose rows
    /// have that many pixels.
    #[inline]
    fn each(&self, width: u32, mut with: impl FnMut(usize, usize)) {
        for row in 0..self.size[1] {
            for column in 0..self.size[0] {
                let in_band = row * width + self.corner[0] + column;
                with((row * SIDE + column) as usize, in_band as usize);
            }
        }
    }

    /// Row by row; beyond the picture's edge those at the edge again, so that every ray of a packet is some pixel's.
    #[inline]
    fn pixel(&self, at: usize) -> [u32; 2] {
        let within = [at as u32 % SIDE, at as u32 / SIDE];
        [0, 1].map(|axis| self.corner[axis] + within[axis].min(self.size[axis] - 1))
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

    /// Paints a band.
    pub(super) fn band(&self, bottom: u32, pixels: &mut [[f32; 4]]) {
        let count = T::from_f64(f64::from(self.film.samples));
        for tile in self.tiles(bottom) {
            let sums = self.sums(tile, self.film.sampler, 0);
            tile.each(self.film.size[0], |at, in_band| {
                let mean = (sums[at] / count).to_array();
                let [r, g, b] = mean.map(|c| film::develop(&self.film, c).to_f64() as f32);
                pixels[in_band] = [r, g, b, 1.0];
            });
        }
    }

    /// The means of a band's pixels over one set of samples that another sampler draws, row by row: yet to be developed.
    pub(super) fn means(&self, bottom: u32, sampler: Sampler, set: u32) -> Vec<T::Vec3> {
        let [width, height] = self.film.size;
        let count = T::from_f64(f64::from(self.film.samples));
        let mut means = vec![T::Vec3::ZERO; (SIDE.min(height - bottom) * width) as usize];
        for tile in self.tiles(bottom) {
            let sums = self.sums(tile, sampler, set);
            tile.each(width, |at, in_band| means[in_band] = sums[at] / count);
        }
        means
    }

    /// The sums of one set of samples of a tile's pixels.
    fn sums(&self, tile: Tile, sampler: Sampler, set: u32) -> [T::Vec3; PACKET] {
        let mut sums = [T::Vec3::ZERO; PACKET];
        let count = self.film.samples;
        for index in 0..count {
            let mut draws = [const { Draws::Center }; PACKET];
            let screen = match sampler {
                Sampler::Center => self.middles(tile),
                Sampler::Stratified => {
                    let pixels = [0, 1].map(|axis| std::array::from_fn(|at| tile.pixel(at)[axis]));
                    let (strata, pairs) = Strata::first_pairs(self.level, [index, count, set], &pixels);
                    draws = strata.map(Draws::Stratified);
                    self.places(|at| Self::place(tile.pixel(at), offset([pairs[0][at], pairs[1][at]])))
                }
                _ => self.places(|at| {
                    let sample = Sample {
                        pixel: tile.pixel(at),
                        index,
                        count,
                        set,
                    };
                    draws[at] = Draws::new(sampler, sample);
                    Self::place(sample.pixel, draws[at].jitter())
                }),
            };
            let packet = self.camera.packet(&screen, self.level);
            let found = self.find(&packet);
            let mut walks: SmallVec<[Walk<T>; PACKET]> = SmallVec::new();
            let mut places: SmallVec<[usize; PACKET]> = SmallVec::new();
            tile.each(self.film.size[0], |at, _| {
                let figure = figure::topmost(&self.figures, [screen[0][at], screen[1][at]]);
                let first = self.first(&packet, &found, at);
                match (figure, first.get()) {
                    (Some(figure), _) => sums[at] = sums[at] + self.figures[figure].color,
                    // Much of many pictures, and quickly told.
                    (None, None) => sums[at] = sums[at] + self.background(packet.ray(at).direction),
                    (None, Some(_)) => {
                        let draws = std::mem::replace(&mut draws[at], Draws::Center);
                        walks.push(Walk::new(packet.ray(at), first, draws));
                        places.push(at);
                    }
                }
            });
            match &self.kernel {
                Kernel::Spheres(world) => world.walk(&mut walks, &Exact),
                Kernel::Shapes(world) => world.walk(&mut walks, &Exact),
            }
            for (walk, at) in walks.iter().zip(places) {
                sums[at] = sums[at] + walk.sum;
            }
        }
        sums
    }

    /// The middles of a tile's pixels on the screen. Those of a column have one x, those of a row one y.
    fn middles(&self, tile: Tile) -> [[T; PACKET]; 2] {
        const SIDES: usize = SIDE as usize;
        let half = T::from_f64(0.5);
        let [x, y]: [[T; SIDES]; 2] = [0, 1].map(|axis| {
            std::array::from_fn(|at| {
                let along = tile.pixel(at * (SIDES + 1))[axis];
                T::from_f64(f64::from(along)) + half
            })
        });
        let (x, y) = (
            x.map(|x| self.camera.screen_x(x)),
            y.map(|y| self.camera.screen_y(y)),
        );
        [
            std::array::from_fn(|at| x[at % SIDES]),
            std::array::from_fn(|at| y[at / SIDES]),
        ]
    }

    /// Where on the screen these places of the picture are.
    fn places(&self, mut place: impl FnMut(usize) -> [T; 2]) -> [[T; PACKET]; 2] {
        let places: [[T; 2]; PACKET] = std::array::from_fn(|at| self.camera.screen(place(at)));
        [0, 1].map(|axis| places.map(|place| place[axis]))
    }

    /// The spheres that the rays of a packet meet first.
    fn find(&self, packet: &Packet<T>) -> Found<T> {
        let mut found = Found::nothing();
        match &self.kernel {
            Kernel::Spheres(world) => world.spheres.nearest_of_packet(packet, &mut found),
            Kernel::Shapes(world) => world.spheres.nearest_of_packet(packet, &mut found),
        }
        found
    }

    /// What comes along a ray that meets nothing.
    #[inline]
    fn background(&self, direction: T::Vec3) -> T::Vec3 {
        match &self.kernel {
            Kernel::Spheres(world) => world.background.color(direction),
            Kernel::Shapes(world) => world.background.color(direction),
        }
    }

    /// What one of the rays of a packet meets first, with the other shapes.
    #[inline]
    fn first(&self, packet: &Packet<T>, found: &Found<T>, at: usize) -> First<T> {
        match &self.kernel {
            Kernel::Spheres(world) => world.first(packet, found, at),
            Kernel::Shapes(world) => world.first(packet, found, at),
        }
    }

    /// The surfaces behind the middles of the pixels, by their numbers in the scene, bottom row first; [`u32::MAX`] where there is
    /// none.
    #[must_use]
    pub fn surfaces(&self) -> Vec<u32> {
        let [width, height] = self.film.size;
        let mut surfaces = vec![NONE; width as usize * height as usize];
        let bands = surfaces
            .par_chunks_mut(width as usize * SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, surfaces)| {
            for tile in self.tiles(band as u32 * SIDE) {
                let packet = self.camera.packet(&self.middles(tile), self.level);
                let found = self.find(&packet);
                tile.each(width, |at, in_band| {
                    if let Some((_, surface)) = self.first(&packet, &found, at).get() {
                        surfaces[in_band] = surface as u32;
                    }
                });
            }
        });
        surfaces
    }
}
