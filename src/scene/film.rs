//! How a picture is sampled and developed.

/// How the picture is sampled and developed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples in each pixel, averaged; ≥ 1.
    pub samples: u32,
    /// Where they lie, and what else is drawn for them.
    pub sampler: Sampler,
    /// Path segments: 1 is camera rays only.
    pub max_depth: u32,
    /// How light finds its way.
    pub integrator: Integrator,
    /// What the mean of a pixel's samples goes through first.
    pub tone_map: ToneMap,
    /// And then, c^(1/gamma); > 0.
    pub gamma: f64,
}

/// Where a pixel's samples lie, and the numbers in [0, 1) that lights and surfaces draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampler {
    /// All at its centre; nothing can be drawn.
    Center,
    /// Where the course's `fract(sin(seed++) * 43758.5453123)` puts them, the seed 0 at each pixel; nothing else
    /// can be drawn.
    SineHash,
    /// Numbers from an integer hash, which a shader can draw too.
    Independent,
    /// One in each cell of a grid, drawn by hashing.
    Stratified,
    /// Sobol's sequence with Owen's scrambling.
    Sobol,
}

impl Sampler {
    /// Whether lights and surfaces can draw from it.
    #[must_use]
    pub fn draws(self) -> bool {
        !matches!(self, Self::Center | Self::SineHash)
    }
}

/// How light finds its way to the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Surfaces are lit by the lights; mirrors and glass send the ray on (Whitted 1980).
    Whitted,
    /// Every surface sends the ray on, in a direction that is drawn, and emitters are the lights (Kajiya 1986).
    Path,
}

/// A tone map, for each component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneMap {
    /// c
    None,
    /// c / (c + 1), Reinhard's
    Reinhard,
}
