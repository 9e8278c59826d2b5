//! Materials, lights and the background.

use super::{Color, Point};

/// The material of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// The reflection model.
    pub model: Model,
    /// The color.
    pub color: Color,
    /// A pattern with a second color.
    pub pattern: Option<Pattern>,
}

/// A pattern: the second color is used where the sum of its whole numbers is odd.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pattern {
    /// The whole numbers.
    pub kind: PatternKind,
    /// The second color.
    pub color: Color,
    /// The side of a square, or the width of a stripe, in scene units; > 0.
    pub size: f64,
    /// The coordinates p = (x, y, z) of a point.
    pub space: Space,
}

/// The whole numbers of a pattern at p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PatternKind {
    /// `floor(x / size)`, `floor(z / size)`, and in [`Space::Object`] also `floor(y / size)`.
    Checker,
    /// `floor(direction · p / size)`
    Stripes {
        /// The direction across the stripes, of length 1.
        direction: Point,
    },
}

/// The coordinates of a pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Space {
    /// The coordinates of the scene: surfaces move through the pattern.
    World,
    /// Coordinates relative to [`Shape::origin`](super::Shape::origin), along the surface's own axes: the
    /// pattern moves with the surface. In planes, and in the faces of boxes, the coordinate across them is 0.
    Object {
        /// The directions of x, y and z: a right-handed orthonormal basis.
        axes: [Point; 3],
    },
}

/// A reflection model. D is the ray's direction, N the outward normal, L the direction to a light, V = −D.
///
/// Surfaces with a BRDF f show `color · ambient + Σ light · f(L, V) · max(N·L, 0) · visibility`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// `color · |D·N|`
    Facing,
    /// The simplest BRDF, `f = color`: it reflects π times the incident light.
    Lambert,
    /// `f = color / π`
    Diffuse,
    /// Burley's BRDF.
    Disney(Disney),
    /// A lobe around the direction R of reflection: `f = color · (exponent + 2) / 2π · max(R·L, 0)^exponent`,
    /// the modified Phong BRDF of Lafortune and Willems (1994).
    Glossy {
        /// ≥ 0; larger values give narrower lobes.
        exponent: f64,
    },
    /// `color ·` the radiance along the reflected ray; black beyond the last path segment.
    Mirror,
    /// `color · (F · reflected + (1 − F) · refracted)`, with the refracted ray by Snell's law; F = 1 at total
    /// internal reflection.
    Glass {
        /// Index of refraction inside over outside; > 0.
        ior: f64,
        /// The formula for F.
        fresnel: Fresnel,
    },
    /// Shows its color, and is a light source for [`super::Integrator::Path`].
    Emitter,
}

/// The formula for the reflectance F of glass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fresnel {
    /// Fresnel's equations for unpolarized light.
    Exact,
    /// `F₀ + (1 − F₀)(1 − cos)⁵` with `F₀ = ((1 − ior) / (1 + ior))²` and the cosine on the side of
    /// the smaller index of refraction (Schlick 1994).
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

// Light sources.

/// The radiance of rays that hit nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// A single color.
    Uniform(Color),
    /// `mix(bottom, top, 0.5 · (1 + d.y))`, d the ray's unit direction.
    Gradient {
        /// The color straight down.
        bottom: Color,
        /// The color straight up.
        top: Color,
    },
}

/// A light without falloff, invisible to rays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// The position of the light's center.
    pub position: Point,
    /// The color.
    pub color: Color,
    /// Whether objects strictly between it and a surface cast shadows.
    pub shadow: bool,
    /// The radius; 0 for a point light. A sphere light is sampled by a direction in the cone that it
    /// subtends, uniformly over the solid angle, each time that it lights a surface.
    pub radius: f64,
    /// The index of the motion that moves it.
    pub motion: Option<usize>,
}
