//! What surfaces do with light.

use super::Color;

/// What a surface does with light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// How it answers.
    pub model: Model,
    /// Its colour.
    pub color: Color,
    /// A second colour in every other square.
    pub checker: Option<Checker>,
}

/// Squares seen from above: where `floor(x / size) + floor(z / size)` is odd, the colour is another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checker {
    /// The other colour.
    pub color: Color,
    /// The side of a square in scene units; > 0.
    pub size: f64,
}

/// How a surface answers light. D is the ray's direction, N the outward normal, L the direction to a light, V = −D.
///
/// Surfaces with a BRDF f show `color · ambient + Σ light · f(L, V) · max(N·L, 0) · visibility`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// `color · |D·N|`
    Facing,
    /// The course's first BRDF, `f = color`: it gives more light than it gets, by π.
    Lambert,
    /// `f = color / π`
    Diffuse,
    /// Burley's.
    Disney(Disney),
    /// A lobe around the direction R of reflection: `f = color · (exponent + 2) / 2π · max(R·L, 0)^exponent`, the
    /// modified Phong BRDF of Lafortune and Willems (1994).
    Glossy {
        /// ≥ 0; the larger the narrower the lobe.
        exponent: f64,
    },
    /// `color ·` the radiance along the reflected ray; black beyond the last path segment.
    Mirror,
    /// `color · (F · reflected + (1 − F) · refracted)`, the refracted ray by Snell's law; where it is reflected
    /// totally, F = 1.
    Glass {
        /// Index of refraction inside over outside; > 0.
        ior: f64,
        /// How F comes about.
        fresnel: Fresnel,
    },
    /// It shows its colour, and under [`super::Integrator::Path`] lights the others.
    Emitter,
}

/// The share F of light that glass reflects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fresnel {
    /// Fresnel's equations for unpolarised light.
    Exact,
    /// `F₀ + (1 − F₀)(1 − cos)⁵` with `F₀ = ((1 − ior) / (1 + ior))²` and the cosine on the thinner side (Schlick
    /// 1994).
    Schlick,
}

/// The parameters of Burley's BRDF (“Physically Based Shading at Disney”, 2012), all in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "they are named and explained in the paper")]
pub struct Disney {
    pub metallic: f64,
    pub subsurface: f64,
    pub specular: f64,
    pub specular_tint: f64,
    pub roughness: f64,
    pub anisotropic: f64,
    pub sheen: f64,
    pub sheen_tint: f64,
    pub clearcoat: f64,
    pub clearcoat_gloss: f64,
}

impl Default for Disney {
    fn default() -> Self {
        Self {
            metallic: 0.0,
            subsurface: 0.0,
            specular: 0.5,
            specular_tint: 0.0,
            roughness: 0.5,
            anisotropic: 0.0,
            sheen: 0.0,
            sheen_tint: 0.5,
            clearcoat: 0.0,
            clearcoat_gloss: 1.0,
        }
    }
}
