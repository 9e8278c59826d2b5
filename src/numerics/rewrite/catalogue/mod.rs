//! The catalogue of identities: forms of an expression that are equal to it, but lose fewer digits for some
//! values. Which form is better is not decided here, but measured.
//!
//! Sources: Higham, Accuracy and Stability of Numerical Algorithms, 2nd edition (2002), chapter 1; Goldberg,
//! “What Every Computer Scientist Should Know About Floating-Point Arithmetic” (1991), sections 1.4 and 4;
//! Haines, Günther and Akenine-Möller, “Precision Improvements for Ray/Sphere Intersection”, Ray Tracing Gems
//! (2019), chapter 7; Kahan, “How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?”
//! (2006), section 12.

mod algebra;
mod function;
mod vector;

use toyproof_glsl::tree::ExprId;

pub(super) use self::algebra::shifted_variance;
use self::algebra::{
    cancelling_terms, conjugate, difference_of_products, difference_of_squares, eigenvalues, larger_step,
    quadratic_root, reassociated, reciprocals, weighted_mean,
};
use self::function::{
    angle_minus_sine, exponential_minus_one, exponentials, haversine, logarithm_of_one_plus,
    one_minus_cosine, scaled_powers, trigonometric_difference,
};
use self::vector::{
    angle, cross_product, discriminant, dot_difference, dot_of_sum, far_distance, nearly_parallel,
    scaled_length, triangle_area, triangle_of_points,
};
use super::site::Definitions;

/// An identity: other forms of an expression, in parentheses where needed.
pub(super) struct Rule {
    /// The identity, as users know it.
    pub(super) name: &'static str,
    /// Whether the new form has the same value in exact arithmetic. Otherwise it is one whose error of
    /// approximation may be smaller than that of rounding.
    pub(super) is_exact: bool,
    pub(super) forms: fn(&Definitions<'_>, ExprId) -> Vec<Option<String>>,
}

const fn rule(name: &'static str, forms: fn(&Definitions<'_>, ExprId) -> Vec<Option<String>>) -> Rule {
    Rule {
        name,
        is_exact: true,
        forms,
    }
}

/// Products of vectors that are nearly parallel, also by component.
fn parallel(at: &Definitions<'_>, expr: ExprId) -> Vec<Option<String>> {
    let mut forms = cross_product(at, expr);
    forms.extend(difference_of_products(at, expr));
    forms
}

/// All identities; the first ones keep the form of a shader best.
pub(super) const RULES: &[Rule] = &[
    rule("terms that cancel exactly", cancelling_terms),
    rule("a difference of squares as a product", difference_of_squares),
    rule(
        "the distance of the center from the ray as a vector",
        discriminant,
    ),
    rule("the root that cancels from the one that does not", quadratic_root),
    rule("the conjugate of a difference of roots", conjugate),
    rule("half angles", one_minus_cosine),
    rule(
        "a difference of two values of a function as a product",
        trigonometric_difference,
    ),
    rule("differences before sums", reassociated),
    rule("the difference of the arguments of dot products", dot_difference),
    rule("the dot products of parts of a far point", dot_of_sum),
    rule("the distance from a far center by its squares", far_distance),
    rule("the haversine of an angle on a sphere", haversine),
    rule("an angle from both of its sides", angle),
    rule("a difference of reciprocals over their product", reciprocals),
    rule("exp(x) - 1 by its series near 0", exponential_minus_one),
    rule("log(1 + x) as Kahan computes it", logarithm_of_one_plus),
    rule("one exponential instead of several", exponentials),
    rule("a weighted mean of both ends", weighted_mean),
    rule("distances and cross products of unit vectors", nearly_parallel),
    rule("the difference of nearly parallel vectors in a product", parallel),
    rule(
        "the difference of the eigenvalues of a symmetric matrix",
        eigenvalues,
    ),
    rule("the area of a triangle from its sorted sides", triangle_area),
    rule("the area of a triangle from two of its sides", triangle_of_points),
    rule("x - sin(x) by its series near 0", angle_minus_sine),
    rule("scaled by the largest component", scaled_length),
    rule("powers of the ratio of two numbers", scaled_powers),
    Rule {
        name: "a larger step of a difference quotient",
        is_exact: false,
        forms: larger_step,
    },
];
