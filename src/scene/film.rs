//! How the image of a scene is sampled and tone-mapped.

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
