//! The shapes of surfaces.

use glam::DVec3;

use super::Point;
use super::motion::Place;

/// A shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// All points at a distance from one.
    Sphere {
        /// That one.
        center: Point,
        /// That distance; > 0.
        radius: f64,
    },
    /// A piece of a surface of second degree.
    Quadric(Quadric),
    /// An endless plane.
    Plane {
        /// A point on it.
        point: Point,
        /// Of length 1; to the side that it is seen from, or away from it.
        normal: Point,
    },
}

/// A quadric in a frame of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    /// Which one, in its own coordinates.
    pub kind: QuadricKind,
    /// Where its own origin lies.
    pub origin: Point,
    /// The directions of its own x, y and z: of length 1, at right angles, right-handed.
    pub axes: [Point; 3],
}

/// Quadrics in coordinates of their own, the axis along z. All lengths are > 0.
///
/// Ellipsoids are closed and their normal is outward. The others are open at their ends, and their normal is turned
/// to the ray that meets them, as is a plane's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuadricKind {
    /// `(x/rx)² + (y/ry)² + (z/rz)² = 1`
    Ellipsoid {
        /// (rx, ry, rz)
        radii: [f64; 3],
    },
    /// `x² + y² = radius²`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation says it")]
    Cylinder { radius: f64, height: f64 },
    /// `x² + y² = (radius · z / height)²`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation says it")]
    Cone { radius: f64, height: f64 },
    /// `x² + y² = radius² · z / height`, 0 ≤ z ≤ height
    #[expect(missing_docs, reason = "the equation says it")]
    Paraboloid { radius: f64, height: f64 },
    /// `x² + y² = waist² + (radius² − waist²) · (2 z / height)²`, |z| ≤ height / 2; waist < radius
    #[expect(missing_docs, reason = "the equation says it")]
    Hyperboloid { waist: f64, radius: f64, height: f64 },
}

/// The equation of a quadric, in units of its own: q·p² + 2 g z + k = 0, the square taken component by component.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the equation says it")]
pub struct Equation {
    pub q: [f64; 3],
    pub g: f64,
    pub k: f64,
    /// What z lies between; a closed surface has no ends.
    pub ends: Option<[f64; 2]>,
}

impl QuadricKind {
    /// Its largest radius.
    #[must_use]
    pub fn size(&self) -> f64 {
        match *self {
            Self::Ellipsoid { radii } => radii.into_iter().fold(0.0, f64::max),
            Self::Cylinder { radius, .. }
            | Self::Cone { radius, .. }
            | Self::Paraboloid { radius, .. }
            | Self::Hyperboloid { radius, .. } => radius,
        }
    }

    /// Its equation where lengths are counted in `unit`, which is given in scene units.
    #[must_use]
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
    /// A quadric around an axis of length 1.
    #[must_use]
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
    /// Whether it has an inside.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Sphere { .. } => true,
            Self::Quadric(quadric) => matches!(quadric.kind, QuadricKind::Ellipsoid { .. }),
            Self::Plane { .. } => false,
        }
    }

    /// The shape after a motion.
    pub(super) fn moved(&self, place: &Place) -> Self {
        match *self {
            Self::Sphere { center, radius } => Self::Sphere {
                center: place.point(center),
                radius,
            },
            Self::Quadric(Quadric { kind, origin, axes }) => Self::Quadric(Quadric {
                kind,
                origin: place.point(origin),
                axes: axes.map(|axis| place.direction(axis)),
            }),
            Self::Plane { point, normal } => Self::Plane {
                point: place.point(point),
                normal: place.direction(normal),
            },
        }
    }
}
