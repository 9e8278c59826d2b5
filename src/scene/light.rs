//! Where light comes from.

use super::{Color, Point};

/// What a ray sees that meets nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// One colour.
    Uniform(Color),
    /// `mix(bottom, top, 0.5 · (1 + d.y))`, d the ray's unit direction.
    Gradient {
        /// Straight below.
        bottom: Color,
        /// Straight above.
        top: Color,
    },
}

/// A light without falloff. Rays do not meet it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Where it is.
    pub position: Point,
    /// Its colour.
    pub color: Color,
    /// Whether what lies strictly between it and a surface shades the surface.
    pub shadow: bool,
    /// 0 for a point. A light with a radius is a sphere: each time that it lights a surface, a direction is drawn
    /// from the cone that it fills, uniformly over the solid angle.
    pub radius: f64,
    /// Which of the scene's motions moves it.
    pub motion: Option<usize>,
}
