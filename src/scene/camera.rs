//! The camera and its projection.

use glam::DVec3;

use super::Point;

/// An eye and the screen in front of it: x ∈ [−1, 1], y ∈ [−1, 1] / aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The pinhole, or the center of the plane in which parallel rays start.
    pub eye: Point,
    /// The point at the center of the image; `None` for the direction −z.
    pub look_at: Option<Point>,
    /// The direction, of length 1, that is up in the image; not parallel to the viewing direction.
    pub up: Point,
    /// The clockwise rotation of the camera about its viewing direction, in degrees, as seen by the camera.
    pub roll: f64,
    /// The projection.
    pub projection: Projection,
}

impl Camera {
    /// The up direction of a camera that is not turned.
    pub const UP: Point = [0.0, 1.0, 0.0];

    /// Returns the viewing direction, of length 1.
    pub fn forward(&self) -> Point {
        let Some(look_at) = self.look_at else {
            return [0.0, 0.0, -1.0];
        };
        // Halved, so that the difference does not overflow.
        let way = 0.5 * DVec3::from_array(look_at) - 0.5 * DVec3::from_array(self.eye);
        (way / way.abs().max_element()).normalize().to_array()
    }

    /// Returns the directions to the right, up and forward, orthonormal; `None` for those of a camera that is
    /// not turned, which are x, y and −z: shaders and the tracer then omit the rotation.
    pub fn axes(&self) -> Option<[Point; 3]> {
        if self.look_at.is_none() && self.up == Self::UP && self.roll == 0.0 {
            return None;
        }
        let forward = DVec3::from_array(self.forward());
        let right = forward.cross(DVec3::from_array(self.up)).normalize();
        let up = right.cross(forward);
        // libm's sine and cosine: the same bits on every platform.
        let (sine, cosine) = libm::sincos(self.roll.to_radians());
        let axes = [right * cosine - up * sine, up * cosine + right * sine, forward];
        Some(axes.map(|axis| axis.to_array()))
    }
}

/// A projection of rays through the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Rays start at the eye.
    Pinhole {
        /// The distance of the screen plane from the eye; > 0. The horizontal angle of view is
        /// `2 · atan(1 / screen_distance)`.
        screen_distance: f64,
    },
    /// Rays start in the plane through the eye and go along the viewing direction.
    Parallel {
        /// The width of the image in scene units; > 0.
        width: f64,
    },
}
