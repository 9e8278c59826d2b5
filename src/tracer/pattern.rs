//! Patterns: surfaces with a second color.

use toyproof_scene::{self as scene, PatternKind, Shape, Space};

use crate::real::{Real, Vector};

/// A pattern, in the coordinates of the scene or of its surface.
#[derive(Debug)]
pub(super) struct Pattern<T: Real> {
    /// The second color.
    pub(super) color: T::Vec3,
    kind: Kind<T>,
    /// The side of a square, or the width of a stripe.
    size: T,
    /// The coordinates of the surface; `None` for those of the scene.
    frame: Option<Frame<T>>,
}

#[derive(Debug)]
enum Kind<T: Real> {
    Checker,
    /// Stripes across a direction.
    Stripes(T::Vec3),
}

/// The coordinates of a surface.
#[derive(Debug)]
struct Frame<T: Real> {
    origin: T::Vec3,
    axes: [T::Vec3; 3],
    /// Whether the surface consists of planes that are perpendicular to an axis.
    is_flat: bool,
}

impl<T: Real> Pattern<T> {
    pub(super) fn new(pattern: &scene::Pattern, shape: &Shape) -> Self {
        Self {
            color: T::Vec3::from_f64(pattern.color),
            kind: match pattern.kind {
                PatternKind::Checker => Kind::Checker,
                PatternKind::Stripes { direction } => Kind::Stripes(T::Vec3::from_f64(direction)),
            },
            size: T::from_f64(pattern.size),
            frame: match pattern.space {
                Space::World => None,
                Space::Object { axes } => Some(Frame {
                    origin: T::Vec3::from_f64(shape.origin()),
                    axes: axes.map(T::Vec3::from_f64),
                    is_flat: matches!(shape, Shape::Plane { .. } | Shape::Box(_)),
                }),
            },
        }
    }

    /// Returns whether the surface has its second color at a point with the given normal: where the sum of
    /// the pattern's whole numbers is odd.
    pub(super) fn is_second(&self, point: T::Vec3, normal: T::Vec3) -> bool {
        let place = match &self.frame {
            None => point,
            Some(frame) => frame.place(point, normal),
        };
        let whole = |along: T| (along / self.size).floor();
        let sum = match self.kind {
            Kind::Checker => {
                let [x, y, z] = place.to_array().map(whole);
                if self.frame.is_some() { x + y + z } else { x + z }
            }
            Kind::Stripes(direction) => whole(direction.dot(place)),
        };
        let two = T::one() + T::one();
        sum - two * (sum / two).floor() != T::zero()
    }
}

impl<T: Real> Frame<T> {
    /// Returns the coordinates of a point. On a flat surface, the coordinate across it is 0, not what
    /// rounding leaves of it.
    fn place(&self, point: T::Vec3, normal: T::Vec3) -> T::Vec3 {
        let relative = point - self.origin;
        let is_across = |axis: T::Vec3| self.is_flat && axis.dot(normal).abs() > T::from_f64(0.5);
        let [x, y, z] = self.axes.map(|axis| {
            if is_across(axis) {
                T::zero()
            } else {
                axis.dot(relative)
            }
        });
        T::Vec3::new(x, y, z)
    }
}
