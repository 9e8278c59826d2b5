//! Figures on the screen, given by implicit functions f of the screen coordinates; the inside is f < 0.

use super::Color;

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
