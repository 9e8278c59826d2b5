//! Classic mistakes in the intersection of a ray with a sphere, as formulas: which of them does a function follow?

use glam::DVec3;
use serde::Serialize;

use super::super::axis::Shot;
use super::super::tally::Outcome;

/// A mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Mistake {
    /// A word for it.
    pub name: &'static str,
    /// What the function does, to stand after its name.
    pub says: &'static str,
    /// Whether it is right as long as its callers keep to something.
    pub excusable: bool,
}

/// How roots are chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    /// The nearer one that lies ahead.
    Ahead,
    /// The farther one, if it lies ahead.
    Farther,
    /// The nearer one, if it lies ahead.
    NearerAlone,
    /// The nearer one, wherever it lies.
    Anywhere,
    /// The nearer one if it lies ahead, else the farther one, wherever that lies.
    FartherAnywhere,
    /// Where the ray comes nearest to the centre.
    Middle,
}

/// a t² + b t + c = 0 with a = d·d, b = 2 f·d, c = f·f − r², as somebody may write it.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a thing that is done or not"
)]
struct Model {
    /// What b is multiplied by.
    b: f64,
    /// The 4 of b² − 4ac.
    four: f64,
    /// The 2 of 2a.
    two: f64,
    /// Whether roots are divided by a.
    over_a: bool,
    /// What is subtracted from f·f for a radius.
    square: fn(f64) -> f64,
    /// Whether the centre is subtracted from the origin.
    centred: bool,
    /// What is taken for the root of the discriminant.
    root: fn(f64) -> f64,
    /// Whether a negative discriminant is a miss.
    tested: bool,
    choice: Choice,
    /// Whether a is 1.
    unit: bool,
    /// Whether t counts in lengths.
    lengths: bool,
    /// Whether the discriminant is r² − |f − (f·d) d|².
    recentred: bool,
}

const RIGHT: Model = Model {
    b: 1.0,
    four: 4.0,
    two: 2.0,
    over_a: true,
    square: |r| r * r,
    centred: true,
    root: f64::sqrt,
    tested: true,
    choice: Choice::Ahead,
    unit: false,
    lengths: false,
    recentred: false,
};

macro_rules! mistakes {
    ($($name:literal: $says:literal, { $($field:ident: $value:expr),* };)*) => {
        /// All of them that show with directions of length 1; the first that fits is named.
        const MISTAKES: &[(Mistake, Model)] = &[$((
            Mistake { name: $name, says: $says, excusable: false },
            Model { $($field: $value,)* ..RIGHT },
        )),*];
    };
}

mistakes! {
    "roots-not-halved": "does not divide the roots by 2a", { two: 1.0 };
    "roots-halved-twice": "divides by 2a though its b is half of the textbook's", { two: 4.0 };
    "larger-root": "takes the larger root, where the ray leaves the sphere", { choice: Choice::Farther };
    "behind-the-eye": "does not ask whether t > 0: what lies behind counts", { choice: Choice::Anywhere };
    "behind-the-eye": "does not ask whether t > 0: what lies behind counts", { choice: Choice::FartherAnywhere };
    "not-from-inside": "forgets the second root: a ray that starts inside meets nothing", { choice: Choice::NearerAlone };
    "closest-point": "gives the t at which the ray comes nearest to the centre, not where it meets the sphere", { choice: Choice::Middle };
    "radius-not-squared": "does not square the radius", { square: |r| r };
    "radius-added": "adds r² where it is to be subtracted", { square: |r| -r * r };
    "diameter": "takes the diameter for the radius", { square: |r| 4.0 * r * r };
    "sign-of-b": "has the sign of b wrong", { b: -1.0 };
    "discriminant-without-4": "forgets the 4 in b² − 4ac", { four: 1.0 };
    "half-b-with-4": "keeps the 4 of b² − 4ac though its b is half of the textbook's", { four: 16.0, two: 4.0 };
    "discriminant-plus": "adds 4ac where it is to be subtracted", { four: -4.0 };
    "no-square-root": "does not take the root of the discriminant", { root: |disc| disc };
    "discriminant-not-tested": "does not ask whether the discriminant is negative", { tested: false };
    "centre-ignored": "does not subtract the centre from the origin", { centred: false };
}

/// How a mistake that shows only with directions of another length is called.
const UNIT: Mistake = Mistake {
    name: "direction-of-length-1",
    says: "takes a = 1: it is right only for directions of length 1",
    excusable: true,
};
const DIVIDES_BY_TWO: Mistake = Mistake {
    name: "not-over-a",
    says: "divides the roots by 2, not by 2a: it is right only for directions of length 1",
    excusable: true,
};
const LENGTHS: Mistake = Mistake {
    name: "t-in-lengths",
    says: "normalises the direction: its t counts in lengths, not in directions",
    excusable: true,
};

impl Model {
    /// None for a miss.
    fn t(&self, shot: &Shot) -> Option<f64> {
        let [o, d, c] = [shot.o, shot.d, shot.c].map(|v| DVec3::from_array(v.map(f64::from)));
        let f = if self.centred { o - c } else { o };
        let a = if self.unit { 1.0 } else { d.dot(d) };
        let b = 2.0 * self.b * f.dot(d);
        let k = f.dot(f) - (self.square)(f64::from(shot.r));
        let closest = f - d * f.dot(d);
        let disc = if self.recentred {
            4.0 * ((self.square)(f64::from(shot.r)) - closest.dot(closest))
        } else {
            b * b - self.four * a * k
        };
        if disc < 0.0 && self.tested {
            return None;
        }
        let root = (self.root)(disc);
        let below = self.two * if self.over_a { a } else { 1.0 };
        let scale = if self.lengths { d.length() } else { 1.0 };
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

    /// Whether a function that says these things follows it; what lies behind is a miss to some.
    fn fits(&self, told: &[(Shot, Outcome)], behind_is_miss: bool) -> bool {
        let same = |(shot, outcome): &&(Shot, Outcome)| match (self.t(shot), *outcome) {
            (Some(t), Outcome::Hit(told)) => (t - told).abs() <= 1e-5 * t.abs(),
            (Some(t), Outcome::Nan) => t.is_nan(),
            (Some(t), Outcome::Miss) => behind_is_miss && t <= 0.0,
            (None, outcome) => outcome == Outcome::Miss,
        };
        let fitting = told.iter().filter(same).count();
        // A few may hang by an epsilon of the function's own.
        !told.is_empty() && fitting * 100 >= told.len() * 99
    }
}

/// The mistake that a function follows which says these things of rays with directions of length 1, and those of other directions.
pub(super) fn recognise(
    unit: &[(Shot, Outcome)],
    other: &[(Shot, Outcome)],
    behind_is_miss: bool,
) -> Option<Mistake> {
    let fits = |model: &Model, told| model.fits(told, behind_is_miss);
    if fits(&RIGHT, unit) {
        let with = [
            (UNIT, Model { unit: true, ..RIGHT }),
            (
                UNIT,
                Model {
                    unit: true,
                    recentred: true,
                    ..RIGHT
                },
            ),
            (
                DIVIDES_BY_TWO,
                Model {
                    over_a: false,
                    ..RIGHT
                },
            ),
            (
                LENGTHS,
                Model {
                    lengths: true,
                    ..RIGHT
                },
            ),
        ];
        let mut with = with.into_iter().filter(|_| !fits(&RIGHT, other));
        return with
            .find(|(_, model)| fits(model, other))
            .map(|(mistake, _)| mistake);
    }
    let found = MISTAKES.iter().find(|(_, model)| fits(model, unit));
    found.map(|&(mistake, _)| mistake)
}
