//! How a scene is viewed and rendered: film, camera, and figures on the screen.

use glam::DVec3;

use super::{Color, Point};

/// The largest number of samples per pixel.
pub const MAX_SAMPLES: u32 = 65_536;

/// How the image is sampled and tone-mapped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel, averaged; from 1 to [`MAX_SAMPLES`].
    pub samples: u32,
    /// The source of sample positions and random numbers.
    pub sampler: Sampler,
    /// The maximum number of path segments; 1 is camera rays only.
    pub max_depth: u32,
    /// The light transport algorithm.
    pub integrator: Integrator,
    /// The tone map, applied to the mean of a pixel's samples.
    pub tone_map: ToneMap,
    /// The exponent of the transfer curve c^(1/gamma), applied after the tone map; > 0.
    pub gamma: f64,
}

/// The source of sample positions in a pixel, and of the random numbers in [0, 1) for lights and surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampler {
    /// All samples at the pixel center; no random numbers.
    Center,
    /// Positions from the exercises' `fract(sin(seed++) * 43758.5453123)`, with seed 0 at each pixel; no
    /// further random numbers.
    SineHash,
    /// Independent numbers from an integer hash that a shader can also compute.
    Independent,
    /// One jittered sample in each cell of a grid, by hashing.
    Stratified,
    /// Sobol's sequence with Owen's scrambling.
    Sobol,
}

impl Sampler {
    /// Whether the sampler provides random numbers for lights and surfaces.
    pub fn is_stochastic(self) -> bool {
        !matches!(self, Self::Center | Self::SineHash)
    }

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Center => "center",
            Self::SineHash => "sine-hash",
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::Sobol => "sobol",
        }
    }
}

/// The light transport algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Direct light from point and sphere lights; mirrors and glass continue the ray (Whitted 1980).
    Whitted,
    /// Path tracing: every surface continues the ray in a sampled direction, and emitters are the lights
    /// (Kajiya 1986).
    Path,
}

/// A tone map, applied to each component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneMap {
    /// c
    None,
    /// c / (c + 1), Reinhard's
    Reinhard,
}

// The camera.

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
    /// not turned: x, y and −z.
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

// Figures on the screen, given by implicit functions f of the screen coordinates; the inside is f < 0.

/// A figure, in screen coordinates: x ∈ [−1, 1], y ∈ [−1, 1] / aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The outline.
    pub outline: Outline,
    /// The fill color.
    pub color: Color,
}

/// The outline of a figure, with f of a point (x, y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    /// `(x − cx)² + (y − cy)² − radius²`
    Disk {
        /// (cx, cy)
        center: [f64; 2],
        /// > 0
        radius: f64,
    },
    /// `y − height − amplitude · sin(frequency · x)`: the region below a sine wave.
    Wave {
        /// The mean height.
        height: f64,
        /// The amplitude.
        amplitude: f64,
        /// In radians per unit of x.
        frequency: f64,
    },
    /// `(u² + v² − 1)³ − u² v³` with `(u, v) = ((x, y) − center) / size`
    Heart {
        /// The center.
        center: [f64; 2],
        /// About half its height; > 0.
        size: f64,
    },
}
