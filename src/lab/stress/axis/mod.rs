//! The extremes: what is taken to its limits, and rays and surfaces drawn for each step on the way.

mod quadric;
mod secondary;
mod sphere;

use std::fmt;

use super::random::Random;

/// What a ray is thrown at, and how the numbers are laid out for a shader: three texels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Case {
    /// A ray and a sphere.
    Sphere(Shot),
    /// A ray and the quadric q·p² + 2 g z + k = 0.
    Quadric {
        /// Where the ray starts.
        o: [f32; 3],
        /// Where it goes, of any length.
        d: [f32; 3],
        /// The factors of x², y² and z².
        q: [f32; 3],
        /// Half of the factor of z.
        g: f32,
        /// What is added.
        k: f32,
    },
    /// A ray that leaves the sphere where another met it.
    Secondary {
        /// The first ray and the sphere.
        first: Shot,
        /// The cosine of the second ray with the normal, ahead; 0 for a mirror's.
        cosine: f32,
    },
}

/// A ray and a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// Where the ray starts.
    pub o: [f32; 3],
    /// Where it goes, of any length.
    pub d: [f32; 3],
    /// The sphere's centre.
    pub c: [f32; 3],
    /// Its radius.
    pub r: f32,
}

impl Case {
    /// As a shader reads it from three channels.
    pub(super) fn texels(&self) -> [[f32; 4]; 3] {
        let texel = |[x, y, z]: [f32; 3], w| [x, y, z, w];
        match *self {
            Self::Sphere(Shot { o, d, c, r }) => [texel(o, r), texel(d, 0.0), texel(c, 0.0)],
            Self::Quadric { o, d, q, g, k } => [texel(o, g), texel(d, k), texel(q, 0.0)],
            Self::Secondary {
                first: Shot { o, d, c, r },
                cosine,
            } => [texel(o, r), texel(d, cosine), texel(c, 0.0)],
        }
    }
}

/// What cases are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// [`Case::Sphere`]
    Spheres,
    /// [`Case::Quadric`]
    Quadrics,
    /// [`Case::Secondary`]
    Secondaries,
}

/// A step of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A size.
    Number(f64),
    /// A circumstance.
    Word(&'static str),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) if *number == 0.0 => f.write_str("0"),
            Self::Number(number) => write!(f, "{number:e}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}

/// Which steps are the easy ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Easy {
    /// The first; every next is harder.
    First,
    /// The one of size 1; it gets harder to both sides.
    One,
    /// Both ends; it gets harder towards the middle.
    Ends,
    /// The steps have no order.
    Any,
}

/// What is taken to its limits.
pub struct Axis {
    /// In a word or three.
    pub name: &'static str,
    /// What its cases are of.
    pub kind: Kind,
    /// Its steps in their order.
    pub steps: Vec<Step>,
    /// Where it begins.
    pub easy: Easy,
    /// How near to touching a case may be: the least |δ|.
    pub margin: f64,
    /// Draws a case; none if what was drawn does not fit.
    draw: fn(&mut Random, Step) -> Option<Case>,
}

impl Axis {
    /// A case for a step, whatever its margin.
    pub(super) fn draw(&self, random: &mut Random, step: Step) -> Option<Case> {
        (self.draw)(random, step)
    }
}

/// Away from the edges of things: a case that is decided by rounding is the business of the axis of grazing rays alone.
const MARGIN: f64 = 1e-3;

fn decades(from: i32, to: i32, by: i32) -> Vec<Step> {
    let steps = 0..=(to - from) / by;
    steps.map(|i| Step::Number(ten(from + i * by))).collect()
}

/// The number nearest to a power of ten.
fn ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

fn words(words: &[&'static str]) -> Vec<Step> {
    words.iter().map(|word| Step::Word(word)).collect()
}

/// All axes.
#[must_use]
pub fn axes() -> Vec<Axis> {
    let spheres = |name, steps, easy, draw| Axis {
        name,
        kind: Kind::Spheres,
        steps,
        easy,
        margin: MARGIN,
        draw,
    };
    let quadrics = |name, steps, easy, margin, draw| Axis {
        name,
        kind: Kind::Quadrics,
        steps,
        easy,
        margin,
        draw,
    };
    let grazing = (1..=20).map(|i| Step::Number(ten(-i)));
    let missing = (1..=20).rev().map(|i| Step::Number(-ten(-i)));
    let rays = words(&["scale 1", "scale 1e3", "ground r = 1000"]);
    let secondary = |name, steps, draw| Axis {
        name,
        kind: Kind::Secondaries,
        steps,
        easy: Easy::Any,
        margin: 0.0,
        draw,
    };
    vec![
        spheres("scale", decades(-30, 30, 5), Easy::One, sphere::scaled),
        spheres("distance/radius", decades(0, 12, 1), Easy::First, sphere::distant),
        Axis {
            margin: 0.0,
            ..spheres(
                "grazing",
                grazing.chain(missing).collect(),
                Easy::Ends,
                sphere::grazing,
            )
        },
        spheres("origin", words(&sphere::ORIGINS), Easy::Any, sphere::near),
        spheres(
            "gap of shells",
            decades(-7, -1, 1).into_iter().rev().collect(),
            Easy::First,
            sphere::shells,
        ),
        spheres("|d|", decades(-20, 20, 2), Easy::One, sphere::stretched),
        spheres(
            "world offset",
            [Step::Number(0.0)].into_iter().chain(decades(1, 7, 1)).collect(),
            Easy::First,
            sphere::offset,
        ),
        Axis {
            margin: 0.0,
            ..spheres("parts", words(&sphere::PARTS), Easy::Any, sphere::parts)
        },
        quadrics(
            "A/|q|",
            decades(-14, -1, 1).into_iter().rev().collect(),
            Easy::First,
            MARGIN,
            quadric::flat,
        ),
        quadrics(
            "distance/size",
            decades(0, 7, 1),
            Easy::First,
            MARGIN,
            quadric::distant,
        ),
        quadrics(
            "rays of a quadric",
            words(&quadric::RAYS),
            Easy::Any,
            0.0,
            quadric::rays,
        ),
        secondary("mirrored rays", rays.clone(), secondary::mirrored),
        secondary("grazing rays", rays, secondary::grazing),
    ]
}

fn single(v: glam::DVec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

fn number(step: Step) -> f64 {
    match step {
        Step::Number(number) => number,
        Step::Word(_) => 0.0,
    }
}
