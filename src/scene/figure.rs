//! Figures on the screen, given by implicit functions of its x and y: inside is where f < 0.

use super::Color;

/// A figure, in screen coordinates: x ∈ [−1, 1], y ∈ [−1, 1] / aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Where it is.
    pub outline: Outline,
    /// What it is filled with.
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
    /// `y − height − amplitude · sin(frequency · x)`: what lies below a sine wave.
    Wave {
        /// Its middle.
        height: f64,
        /// How far it swings.
        amplitude: f64,
        /// In radians per unit of x.
        frequency: f64,
    },
    /// `(u² + v² − 1)³ − u² v³` with `(u, v) = ((x, y) − center) / size`
    Heart {
        /// Its middle.
        center: [f64; 2],
        /// Half its height, about; > 0.
        size: f64,
    },
}
