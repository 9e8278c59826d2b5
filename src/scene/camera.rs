//! Where a scene is seen from.

use super::Point;

/// An eye and the screen before it: x ∈ [−1, 1], y ∈ [−1, 1] / aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The pinhole, or the middle of the plane that parallel rays start in.
    pub eye: Point,
    /// What the rays through the screen do.
    pub projection: Projection,
}

/// What the rays through the screen do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// They start at the eye.
    Pinhole {
        /// The screen plane lies at z = eye.z − this; > 0.
        screen_distance: f64,
    },
    /// They start in the plane z = eye.z and go along −z.
    Parallel {
        /// The picture's width in scene units; > 0.
        width: f64,
    },
}
