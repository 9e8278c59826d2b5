//! The shapes of surfaces, and grids of random spheres.

use std::ops::Range;

use glam::{DQuat, DVec3};
use toyproof_image::pcg;

use super::motion::Transform;
use super::{Material, Object, Point};

/// The directions of the scene's x, y and z.
pub(super) const IDENTITY: [Point; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// The center.
        center: Point,
        /// The radius; > 0.
        radius: f64,
    },
    /// A piece of a surface of second degree.
    Quadric(Quadric),
    /// An infinite plane.
    Plane {
        /// A point on it.
        point: Point,
        /// The normal, of length 1, to either side.
        normal: Point,
    },
    /// A box.
    Box(Cuboid),
}

/// A box. It is closed, and its normals point outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// The center.
    pub center: Point,
    /// The lengths of the edges along the axes; > 0.
    pub size: [f64; 3],
    /// The directions of the edges: a right-handed orthonormal basis.
    pub axes: [Point; 3],
}

/// A quadric in a local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    /// The kind, in local coordinates.
    pub kind: QuadricKind,
    /// The origin of the local frame.
    pub origin: Point,
    /// The axes of the local frame: a right-handed orthonormal basis.
    pub axes: [Point; 3],
}

/// Quadrics in local coordinates, with the axis along z. All lengths are > 0.
///
/// Ellipsoids are closed and have outward normals. The others are open at their ends, and their normals face
/// the ray, as do those of planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadricKind {
    /// `(x/rx)² + (y/ry)² + (z/rz)² = 1`
    Ellipsoid {
        /// (rx, ry, rz)
        radii: [f64; 3],
    },
    /// `x² + y² = radius²`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation explains them")]
    Cylinder { radius: f64, height: f64 },
    /// `x² + y² = (radius · z / height)²`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation explains them")]
    Cone { radius: f64, height: f64 },
    /// `x² + y² = radius² · z / height`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation explains them")]
    Paraboloid { radius: f64, height: f64 },
    /// `x² + y² = waist² + (radius² − waist²) · (2 z / height)²`, |z| ≤ height / 2; waist < radius
    #[expect(missing_docs, reason = "the equation explains them")]
    Hyperboloid { waist: f64, radius: f64, height: f64 },
}

/// The equation of a quadric, in local units: q·p² + 2 g z + k = 0, where p² is component-wise.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the equation explains them")]
pub struct Equation {
    pub q: [f64; 3],
    pub g: f64,
    pub k: f64,
    /// The range of z; `None` for closed surfaces.
    pub ends: Option<[f64; 2]>,
}

impl QuadricKind {
    /// Returns the largest radius.
    pub fn size(&self) -> f64 {
        match *self {
            Self::Ellipsoid { radii } => radii.into_iter().fold(0.0, f64::max),
            Self::Cylinder { radius, .. }
            | Self::Cone { radius, .. }
            | Self::Paraboloid { radius, .. }
            | Self::Hyperboloid { radius, .. } => radius,
        }
    }

    /// Returns the equation with lengths measured in `unit`, which is given in scene units.
    pub fn equation(&self, unit: f64) -> Equation {
        let round = |z2: f64, g: f64, k: f64, ends: [f64; 2]| Equation {
            q: [1.0, 1.0, z2],
            g,
            k,
            ends: Some(ends),
        };
        match *self {
            Self::Ellipsoid { radii } => Equation {
                // Relative to the unit, so that no square overflows.
                q: radii.map(|radius| (unit / radius) * (unit / radius)),
                g: 0.0,
                k: -1.0,
                ends: None,
            },
            Self::Cylinder { radius, height } => {
                let r = radius / unit;
                round(0.0, 0.0, -r * r, [0.0, height / unit])
            }
            Self::Cone { radius, height } => {
                let slope = radius / height;
                round(-slope * slope, 0.0, 0.0, [0.0, height / unit])
            }
            Self::Paraboloid { radius, height } => {
                let g = -0.5 * (radius / unit) * (radius / height);
                round(0.0, g, 0.0, [0.0, height / unit])
            }
            Self::Hyperboloid {
                waist,
                radius,
                height,
            } => {
                let half = 0.5 * height;
                let slope2 = (radius - waist) / half * ((radius + waist) / half);
                let (w, end) = (waist / unit, half / unit);
                round(-slope2, 0.0, -w * w, [-end, end])
            }
        }
    }
}

impl Quadric {
    /// Returns a quadric around an axis of length 1.
    pub fn around(axis: Point, origin: Point, kind: QuadricKind) -> Self {
        let z = DVec3::from_array(axis);
        let (x, y) = z.any_orthonormal_pair();
        Self {
            kind,
            origin,
            axes: [x, y, z].map(|axis| axis.to_array()),
        }
    }
}

impl Shape {
    /// Whether the shape encloses a volume.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Sphere { .. } | Self::Box(_) => true,
            Self::Quadric(quadric) => matches!(quadric.kind, QuadricKind::Ellipsoid { .. }),
            Self::Plane { .. } => false,
        }
    }

    /// Returns the origin of the shape's own coordinates: the center of a sphere or a quadric, the end of a
    /// quadric that begins there, the point of a plane, and the corner of a box with the smallest
    /// coordinates.
    pub fn origin(&self) -> Point {
        match *self {
            Self::Sphere { center, .. } => center,
            Self::Quadric(quadric) => quadric.origin,
            Self::Plane { point, .. } => point,
            Self::Box(Cuboid { center, size, axes }) => {
                let half = axes
                    .iter()
                    .zip(size)
                    .map(|(axis, size)| DVec3::from_array(*axis) * (0.5 * size));
                (DVec3::from_array(center) - half.sum::<DVec3>()).to_array()
            }
        }
    }

    /// Returns the directions of its own coordinates x, y and z, before any motion. The axis of a quadric and
    /// the normal of a plane are y; x and z result from the shortest rotation of the scene's y to that
    /// direction.
    pub fn axes(&self) -> [Point; 3] {
        let upright = |y: Point| {
            let rotation = DQuat::from_rotation_arc(DVec3::Y, DVec3::from_array(y));
            DVec3::AXES.map(|axis| (rotation * axis).to_array())
        };
        match *self {
            Self::Sphere { .. } => IDENTITY,
            Self::Quadric(quadric) => match quadric.kind {
                QuadricKind::Ellipsoid { .. } => quadric.axes,
                _ => upright(quadric.axes[2]),
            },
            Self::Plane { normal, .. } => upright(normal),
            Self::Box(cuboid) => cuboid.axes,
        }
    }

    /// Returns the transformed shape.
    pub(super) fn transformed(&self, transform: &Transform) -> Self {
        match *self {
            Self::Sphere { center, radius } => Self::Sphere {
                center: transform.point(center),
                radius,
            },
            Self::Quadric(Quadric { kind, origin, axes }) => Self::Quadric(Quadric {
                kind,
                origin: transform.point(origin),
                axes: axes.map(|axis| transform.direction(axis)),
            }),
            Self::Plane { point, normal } => Self::Plane {
                point: transform.point(point),
                normal: transform.direction(normal),
            },
            Self::Box(Cuboid { center, size, axes }) => Self::Box(Cuboid {
                center: transform.point(center),
                size,
                axes: axes.map(|axis| transform.direction(axis)),
            }),
        }
    }
}

// Scatters: a sphere in each cell of a grid, with random position, size and color from a hash.

/// A grid of cubic cells with one sphere inside each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// The corner of the grid with the smallest coordinates.
    pub corner: Point,
    /// The number of cells along x, y and z.
    pub cells: [u32; 3],
    /// The side of a cell; > 0.
    pub spacing: f64,
    /// The smallest and the largest radius; at most half a cell.
    pub radius: [f64; 2],
    /// The seed of the hash.
    pub seed: u32,
    /// The material of the spheres. Each component of the color is scaled by a random factor from 0.2 to 1.
    pub material: Material,
    /// The index of the motion that moves them.
    pub motion: Option<usize>,
}

/// A scatter, and which of the scene's objects are its spheres.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterObjects {
    /// The scatter.
    pub scatter: Scatter,
    /// The indices of the scatter's spheres in [`super::Scene::objects`].
    pub objects: Range<usize>,
}

impl Scatter {
    /// Returns the spheres, cell by cell, x fastest.
    ///
    /// The cell (x, y, z) of n starts a sequence of PCG hashes: the first is that of `seed + x + n.x · (y +
    /// n.y · z)`, and each further one that of the one before. Converted to numbers in [0, 1), the first
    /// gives the radius, the next three the position in x, y and z, and the last three the color.
    pub fn spheres(&self) -> impl Iterator<Item = Object> {
        let [nx, ny, nz] = self.cells;
        let index = move |x, y, z| x + nx * (y + ny * z);
        (0..nz)
            .flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
            .map(move |cell| self.sphere(cell, index(cell[0], cell[1], cell[2])))
    }

    fn sphere(&self, cell: [u32; 3], index: u32) -> Object {
        let mut state = self.seed.wrapping_add(index);
        let mut random = || {
            state = pcg(state);
            unit(state)
        };
        let [small, large] = self.radius;
        let radius = small + (large - small) * random();
        let center = [0, 1, 2].map(|axis| {
            let room = self.spacing - 2.0 * radius;
            self.corner[axis] + f64::from(cell[axis]) * self.spacing + radius + room * random()
        });
        let color = self.material.color.map(|c| c * (0.2 + 0.8 * random()));
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

/// Converts the upper 24 bits of a hash to a number in [0, 1), which float32 represents exactly.
#[inline]
pub fn unit(hash: u32) -> f64 {
    f64::from(hash >> 8) / f64::from(1 << 24)
}
