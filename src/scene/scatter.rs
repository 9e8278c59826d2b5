//! Many spheres from a few numbers: one in each cell of a grid, its place, size and colour drawn by hashing.

use std::ops::Range;

use toyproof_image::pcg;

use super::{Material, Object, Point, Shape};

/// A grid of cubic cells with one sphere in each, wholly inside of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// The corner of the grid with the smallest coordinates.
    pub corner: Point,
    /// How many cells along x, y and z.
    pub cells: [u32; 3],
    /// The side of a cell; > 0.
    pub spacing: f64,
    /// The smallest and the largest radius; at most half a cell.
    pub radius: [f64; 2],
    /// Another number, other spheres.
    pub seed: u32,
    /// What they are made of. Each has a share of the colour, drawn for each component, from 0.2 up to all of it.
    pub material: Material,
    /// Which of the scene's motions moves them.
    pub motion: Option<usize>,
}

/// A scatter, and which of the scene's objects are its spheres.
#[derive(Debug, Clone, PartialEq)]
pub struct Scattered {
    /// What they come of.
    pub scatter: Scatter,
    /// Their places among [`super::Scene::objects`].
    pub objects: Range<usize>,
}

impl Scatter {
    /// The spheres, cell by cell, x fastest.
    ///
    /// The cell (x, y, z) of n starts a sequence of PCG hashes: the first is that of
    /// `seed + x + n.x · (y + n.y · z)`, and each further one that of the one before. The first tells the radius,
    /// the next three the place in x, y and z, the last three the colour, each as a number in [0, 1).
    pub fn spheres(&self) -> impl Iterator<Item = Object> {
        let [nx, ny, nz] = self.cells;
        let index = move |x, y, z| x + nx * (y + ny * z);
        (0..nz)
            .flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
            .map(move |cell| self.sphere(cell, index(cell[0], cell[1], cell[2])))
    }

    fn sphere(&self, cell: [u32; 3], index: u32) -> Object {
        let mut state = self.seed.wrapping_add(index);
        let mut draw = || {
            state = pcg(state);
            unit(state)
        };
        let [small, large] = self.radius;
        let radius = small + (large - small) * draw();
        let center = [0, 1, 2].map(|axis| {
            let room = self.spacing - 2.0 * radius;
            self.corner[axis] + f64::from(cell[axis]) * self.spacing + radius + room * draw()
        });
        let color = self.material.color.map(|c| c * (0.2 + 0.8 * draw()));
        Object {
            shape: Shape::Sphere { center, radius },
            material: Material {
                color,
                ..self.material
            },
            motion: self.motion,
        }
    }
}

/// The upper 24 bits as a number in [0, 1), which float32 holds exactly.
#[must_use]
#[inline]
pub fn unit(hash: u32) -> f64 {
    f64::from(hash >> 8) / f64::from(1 << 24)
}
