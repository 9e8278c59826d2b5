//! Common mistakes in ray–sphere intersection, as formulas, to recognize the one that a function makes.

use glam::DVec3;
use serde::Serialize;

use super::{MissConvention, Signature};
use crate::case::RaySphere;
use crate::tally::Outcome;

/// A common mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Mistake {
    /// The behavior of the function, as text to follow its name.
    pub description: &'static str,
    /// The identifier.
    pub name: &'static str,
    /// Whether the function is right for callers that keep to its precondition.
    pub recoverable: bool,
}

/// The root that is returned.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    /// The nearer positive one.
    Ahead,
    /// The farther one, if positive.
    Farther,
    /// The nearer one, if positive.
    NearerAlone,
    /// The nearer one, positive or not.
    Anywhere,
    /// The nearer one if positive, else the farther one, positive or not.
    FartherAnywhere,
    /// The t at which the ray is nearest to the center.
    Middle,
}

/// a t² + b t + c = 0 with a = d·d, b = 2 f·d, c = f·f − r², with variations.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each flag is an independent variation of the formula"
)]
struct Model {
    /// The factor of b.
    b: f64,
    /// The factor 4 of b² − 4ac.
    four: f64,
    /// The factor 2 of 2a.
    two: f64,
    /// Whether roots are divided by a.
    divides_by_a: bool,
    /// The term subtracted from f·f, as a function of the radius.
    square: fn(f64) -> f64,
    /// Whether the center is subtracted from the origin.
    subtracts_center: bool,
    /// The function taken for the square root of the discriminant.
    root: fn(f64) -> f64,
    /// Whether a negative discriminant is a miss.
    tests_discriminant: bool,
    choice: Choice,
    /// Whether a is replaced by 1.
    unit: bool,
    /// Whether t is measured in units of length instead of directions.
    t_in_lengths: bool,
    /// Whether the discriminant is r² − |f − (f·d) d|².
    recentered: bool,
}

const CORRECT: Model = Model {
    b: 1.0,
    four: 4.0,
    two: 2.0,
    divides_by_a: true,
    square: |r| r * r,
    subtracts_center: true,
    root: f64::sqrt,
    tests_discriminant: true,
    choice: Choice::Ahead,
    unit: false,
    t_in_lengths: false,
    recentered: false,
};

macro_rules! mistakes {
    ($($name:tt: $description:literal, { $($field:ident: $value:expr),* };)*) => {
        /// The mistakes that show with unit directions; the first that fits is reported.
        const MISTAKES: &[(Mistake, Model)] = &[$((
            Mistake { name: $name, description: $description, recoverable: false },
            Model { $($field: $value,)* ..CORRECT },
        )),*];
    };
}

mistakes! {
    "roots-not-halved": "does not divide the roots by 2a", { two: 1.0 };
    "roots-halved-twice": "divides by 2a, but its b is half of the textbook's b", { two: 4.0 };
    LARGER_ROOT: "returns the larger root, where the ray leaves the sphere", { choice: Choice::Farther };
    "behind-origin": "does not check t > 0: callers must, or hits behind the ray's origin count", { choice: Choice::Anywhere };
    "behind-origin": "does not check t > 0: callers must, or hits behind the ray's origin count", { choice: Choice::FartherAnywhere };
    "not-from-inside": "returns only the nearer root: its results are right only for rays that start outside", { choice: Choice::NearerAlone };
    "closest-point": "returns the t of the point nearest to the center, not that of the hit", { choice: Choice::Middle };
    "radius-not-squared": "does not square the radius", { square: |r| r };
    RADIUS_ADDED: "adds r² instead of subtracting it", { square: |r| -r * r };
    "diameter": "uses the diameter instead of the radius", { square: |r| 4.0 * r * r };
    "sign-of-b": "uses b with the wrong sign", { b: -1.0 };
    "discriminant-without-4": "omits the factor 4 in b² − 4ac", { four: 1.0 };
    "half-b-with-4": "keeps the factor 4 in b² − 4ac, but its b is half of the textbook's b", { four: 16.0, two: 4.0 };
    "discriminant-plus": "adds 4ac instead of subtracting it", { four: -4.0 };
    "no-square-root": "does not take the square root of the discriminant", { root: |disc| disc };
    "discriminant-not-tested": "does not check for a negative discriminant", { tests_discriminant: false };
    "center-ignored": "does not subtract the center from the origin", { subtracts_center: false };
}

const LARGER_ROOT: &str = "larger-root";

/// What the name of a function contains whose result is where the ray leaves the sphere.
const EXITS: [&str; 4] = ["exit", "far", "leave", "back"];

/// The name of the mistake whose formula never hits anything from outside.
const RADIUS_ADDED: &str = "radius-added";

// Mistakes that show only with directions that are not unit vectors.

const UNIT: Mistake = Mistake {
    name: "unit-direction-only",
    description: "assumes a = 1: its results are right only for directions of length 1",
    recoverable: true,
};
const DIVIDES_BY_TWO: Mistake = Mistake {
    name: "not-divided-by-a",
    description: "divides the roots by 2, not by 2a: its results are right only for directions of length 1",
    recoverable: true,
};
const LENGTHS: Mistake = Mistake {
    name: "t-as-distance",
    description: "normalizes the direction: its t is a distance, not a multiple of the direction",
    recoverable: true,
};

impl Model {
    /// The t that the formula returns; `None` for a miss.
    fn t(&self, ray_sphere: &RaySphere) -> Option<f64> {
        let [o, d, c] =
            [ray_sphere.o, ray_sphere.d, ray_sphere.c].map(|v| DVec3::from_array(v.map(f64::from)));
        let f = if self.subtracts_center { o - c } else { o };
        let a = if self.unit { 1.0 } else { d.dot(d) };
        let b = 2.0 * self.b * f.dot(d);
        let k = f.dot(f) - (self.square)(f64::from(ray_sphere.r));
        let closest = f - d * f.dot(d);
        let disc = if self.recentered {
            4.0 * ((self.square)(f64::from(ray_sphere.r)) - closest.dot(closest))
        } else {
            b * b - self.four * a * k
        };
        if disc < 0.0 && self.tests_discriminant {
            return None;
        }
        let root = (self.root)(disc);
        let below = self.two * if self.divides_by_a { a } else { 1.0 };
        let scale = if self.t_in_lengths { d.length() } else { 1.0 };
        let [near, far, middle] = [-b - root, -b + root, -b].map(|t| t / below * scale);
        let ahead = |t: f64| (t > 0.0 || t.is_nan()).then_some(t);
        match self.choice {
            Choice::Ahead => ahead(near).or(ahead(far)),
            Choice::Farther => ahead(far),
            Choice::NearerAlone => ahead(near),
            Choice::Anywhere => Some(near),
            Choice::FartherAnywhere => ahead(near).or(Some(far)),
            Choice::Middle => ahead(middle),
        }
    }

    /// Whether a function's outcomes fit this model.
    fn fits(&self, outcomes: &[(RaySphere, Outcome)], convention: &MissConvention) -> bool {
        let same = |(ray_sphere, outcome): &&(RaySphere, Outcome)| match (self.t(ray_sphere), *outcome) {
            (Some(t), Outcome::Hit(hit)) => (t - hit).abs() <= 1e-5 * t.abs(),
            (Some(t), Outcome::Nan) => t.is_nan(),
            (Some(t), Outcome::Miss) => convention.behind_is_miss() && t <= 0.0,
            (None, outcome) => outcome == Outcome::Miss,
        };
        let fitting = outcomes.iter().filter(same).count();
        // A few cases may depend on an epsilon in the function.
        !outcomes.is_empty() && fitting * 100 >= outcomes.len() * 99
    }
}

/// Recognizes the mistake that explains a function's outcomes for unit directions (`unit`) and for directions
/// of other lengths (`other`). A function that never hits anything for another reason has the outcomes of one
/// that adds the squared radius, so that its text decides.
pub(super) fn recognize(
    unit: &[(RaySphere, Outcome)],
    other: &[(RaySphere, Outcome)],
    convention: &MissConvention,
    signature: &Signature,
) -> Option<Mistake> {
    let fits = |model: &Model, outcomes| model.fits(outcomes, convention);
    if fits(&CORRECT, unit) {
        let unit = Model {
            unit: true,
            ..CORRECT
        };
        let recentered = Model {
            recentered: true,
            ..unit
        };
        let divided_by_two = Model {
            divides_by_a: false,
            ..CORRECT
        };
        let lengths = Model {
            t_in_lengths: true,
            ..CORRECT
        };
        let with = [
            (UNIT, unit),
            (UNIT, recentered),
            (DIVIDES_BY_TWO, divided_by_two),
            (LENGTHS, lengths),
        ];
        let mut with = with.into_iter().filter(|_| !fits(&CORRECT, other));
        return with
            .find(|(_, model)| fits(model, other))
            .map(|(mistake, _)| mistake);
    }
    let name = signature.name.to_lowercase();
    let is_exit = EXITS.iter().any(|word| name.contains(word));
    let is_written = |mistake: &Mistake| match mistake.name {
        RADIUS_ADDED => signature.adds_squared_radius,
        LARGER_ROOT => !is_exit,
        _ => true,
    };
    let mut found = MISTAKES.iter().filter(|(mistake, _)| is_written(mistake));
    let found = found.find(|(_, model)| fits(model, unit));
    found.map(|&(mistake, _)| Mistake {
        // Callers may test t, or start outside.
        recoverable: matches!(mistake.name, "behind-origin" | "not-from-inside"),
        ..mistake
    })
}
