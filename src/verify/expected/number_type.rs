//! The number types in which shaders and references are evaluated.

/// A number type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberType {
    /// f64.
    Double,
    /// f32.
    Single,
}

impl NumberType {
    /// How much numbers of a scene and coordinates of pixels are perturbed, relatively: by a few units in the
    /// last place.
    pub(crate) fn perturbation(self) -> f64 {
        match self {
            Self::Double => 4.0 * f64::EPSILON,
            Self::Single => 2.0 * f64::from(f32::EPSILON),
        }
    }
}
