//! Test cases, and the steps that they are sampled for.

use std::fmt;

use glam::DVec3;

use crate::exact::{self, Intersection};

/// The default margin: only the axis of grazing rays tests cases that rounding decides.
pub(crate) const MARGIN: f64 = 1e-3;

/// A test case, and its layout as three texels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Case {
    /// A ray and a sphere.
    Sphere(RaySphere),
    /// A ray and the quadric q·p² + 2 g z + k = 0.
    Quadric {
        /// The origin of the ray.
        o: [f32; 3],
        /// The direction of the ray, of any length.
        d: [f32; 3],
        /// The coefficients of x², y² and z².
        q: [f32; 3],
        /// Half of the coefficient of z.
        g: f32,
        /// The constant term.
        k: f32,
    },
    /// A ray that leaves a sphere at the hit of a first ray.
    Secondary {
        /// The first ray and the sphere.
        first: RaySphere,
        /// The cosine between the second ray and the normal; 0 for a mirror reflection.
        cosine: f32,
    },
}

/// A ray and a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaySphere {
    /// The origin of the ray.
    pub o: [f32; 3],
    /// The direction of the ray, of any length.
    pub d: [f32; 3],
    /// The sphere's center.
    pub c: [f32; 3],
    /// The radius of the sphere.
    pub r: f32,
}

impl RaySphere {
    /// Rounds a ray and a sphere to floats.
    pub(crate) fn rounded(o: DVec3, d: DVec3, c: DVec3, r: f64) -> Self {
        let [o, d, c] = [o, d, c].map(|v| v.to_array().map(|x| x as f32));
        Self { o, d, c, r: r as f32 }
    }

    /// The intersection of the ray with the sphere; `None` if a part is infinite or NaN.
    pub(crate) fn intersection(&self) -> Option<Intersection> {
        exact::sphere(self.o, self.d, self.c, self.r)
    }
}

impl Case {
    /// The texels from which a shader reads the case, in three channels.
    pub(crate) fn texels(&self) -> [[f32; 4]; 3] {
        let texel = |[x, y, z]: [f32; 3], w| [x, y, z, w];
        match *self {
            Self::Sphere(RaySphere { o, d, c, r }) => [texel(o, r), texel(d, 0.0), texel(c, 0.0)],
            Self::Quadric { o, d, q, g, k } => [texel(o, g), texel(d, k), texel(q, 0.0)],
            Self::Secondary {
                first: RaySphere { o, d, c, r },
                cosine,
            } => [texel(o, r), texel(d, cosine), texel(c, 0.0)],
        }
    }
}

/// Declares the named configurations.
macro_rules! labels {
    ($($label:ident = $name:literal,)*) => {
        /// A named configuration, the step of an axis without a quantity.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Label {
            $(#[doc = concat!("“", $name, "”")] $label,)*
        }

        impl fmt::Display for Label {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $(Self::$label => $name,)*
                })
            }
        }
    };
}

labels! {
    OriginInside = "origin inside",
    OriginOnSurface = "origin on the surface",
    OriginUlpInside = "origin 1 ULP inside",
    OriginUlpOutside = "origin 1 ULP outside",
    ZeroCoordinates = "zero coordinates",
    ZeroDirection = "zero direction",
    ZeroRadius = "zero radius",
    NegativeRadius = "negative radius",
    DenormalScene = "denormal scene",
    DenormalDirection = "denormal direction",
    InfiniteOrigin = "infinite origin",
    InfiniteDirection = "infinite direction",
    InfiniteCenter = "infinite center",
    InfiniteRadius = "infinite radius",
    NanOrigin = "NaN origin",
    NanDirection = "NaN direction",
    NanRadius = "NaN radius",
    AlongCylinder = "ray along a cylinder",
    AlongConeSide = "ray along a cone's side",
    AlongParaboloidAxis = "ray along a paraboloid's axis",
    ThroughConeApex = "ray through a cone's apex",
    ThroughParaboloidApex = "ray through a paraboloid's apex",
    Scale1 = "scale 1",
    Scale1000 = "scale 1e3",
    Ground = "ground r = 1000",
}

/// A step of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A quantity.
    Number(f64),
    /// A named configuration.
    Label(Label),
}

impl Step {
    /// The quantity; 0 for a named configuration.
    pub(crate) fn value(self) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Label(_) => 0.0,
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) if *number == 0.0 => f.write_str("0"),
            Self::Number(number) => write!(f, "{number:e}"),
            Self::Label(label) => label.fmt(f),
        }
    }
}
