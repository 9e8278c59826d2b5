//! The functions whose precision is measured, their exact values, and what Vulkan permits.

use super::arguments::{Range, UNIT};
use super::precision::Permitted;

/// A function or operation of up to six floats.
#[derive(Debug, Clone, Copy)]
pub struct Function {
    /// The GLSL expression of `x`, `y`, `z`, `u`, `v` and `w`.
    pub expression: &'static str,
    /// The range of each operand in which shaders usually compute.
    pub usual: &'static [Range],
    /// The value in double precision.
    pub exact: fn(&[f64]) -> f64,
    /// The permitted results.
    pub permitted: fn(&[Permitted]) -> Permitted,
    /// The same, in the specification's words.
    pub limit: &'static str,
}

impl Function {
    /// Whether strict runs leave it to the driver, and rely on a correct rounding.
    pub fn is_strict(&self) -> bool {
        ["x + y", "x * y", "x / y", "sqrt(x)"].contains(&self.expression)
    }

    /// Whether it inherits its precision from a formula.
    pub fn is_inherited(&self) -> bool {
        self.limit.starts_with("inherited from ")
    }
}

/// Arguments of trigonometric functions: [−π, π], rounded inwards.
const TURN: Range = (-3.141_592_5, 3.141_592_5);
const SMALL: Range = (-10.0, 10.0);
const POSITIVE: Range = (0.0, 10.0);

fn dot(a: [Permitted; 3], b: [Permitted; 3]) -> Permitted {
    let [x, y, z] = [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
    // In any order.
    ((x + y) + z).or((x + z) + y).or((y + z) + x)
}

fn square(v: &[Permitted]) -> Permitted {
    let v = [v[0], v[1], v[2]];
    dot(v, v)
}

fn norm(v: &[f64]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

fn one() -> Permitted {
    Permitted::exactly(1.0)
}

fn half() -> Permitted {
    Permitted::exactly(0.5)
}

fn sinh(x: Permitted) -> Permitted {
    (x.exp() - (-x).exp()) * half()
}

fn cosh(x: Permitted) -> Permitted {
    (x.exp() + (-x).exp()) * half()
}

/// `smoothstep` is undefined unless the first edge is less than the second.
fn smoothstep(v: &[f64]) -> f64 {
    let t = ((v[2] - v[0]) / (v[1] - v[0])).clamp(0.0, 1.0);
    if v[0] < v[1] {
        t * t * (3.0 - 2.0 * t)
    } else {
        f64::NAN
    }
}

macro_rules! functions {
    ($($expression:literal in [$($range:expr),+]: $exact:expr, $permitted:expr, $limit:literal;)*) => {
        /// All measured functions.
        pub static FUNCTIONS: &[Function] = &[$(Function {
            expression: $expression,
            usual: &[$($range),+],
            exact: $exact,
            permitted: $permitted,
            limit: $limit,
        }),*];
    };
}

functions! {
    "x + y" in [SMALL, SMALL]: |v| v[0] + v[1], |v| v[0] + v[1], "correctly rounded";
    "x * y" in [SMALL, SMALL]: |v| v[0] * v[1], |v| v[0] * v[1], "correctly rounded";
    "x / y" in [SMALL, SMALL]: |v| v[0] / v[1], |v| v[0] / v[1], "2.5 ULP";
    "sqrt(x)" in [POSITIVE]: |v| v[0].sqrt(), |v| v[0].sqrt(), "inherited from 1 / inversesqrt(x)";
    "inversesqrt(x)" in [POSITIVE]: |v| 1.0 / v[0].sqrt(), |v| v[0].inverse_sqrt(), "2 ULP";
    "sin(x)" in [TURN]: |v| libm::sin(v[0]), |v| v[0].sin(), "2⁻¹¹ absolute in [−π, π]";
    "cos(x)" in [TURN]: |v| libm::cos(v[0]), |v| v[0].cos(), "2⁻¹¹ absolute in [−π, π]";
    "tan(x)" in [TURN]: |v| libm::tan(v[0]), |v| v[0].sin() / v[0].cos(), "inherited from sin(x) / cos(x)";
    "asin(x)" in [UNIT]: |v| libm::asin(v[0]), |v| v[0].atan2((one() - v[0] * v[0]).sqrt()),
        "inherited from atan(x, sqrt(1 − x·x))";
    "acos(x)" in [UNIT]: |v| libm::acos(v[0]), |v| (one() - v[0] * v[0]).sqrt().atan2(v[0]),
        "inherited from atan(sqrt(1 − x·x), x)";
    "atan(x)" in [SMALL]: |v| libm::atan(v[0]), |v| v[0].atan(), "4096 ULP";
    "atan(x, y)" in [SMALL, SMALL]: |v| libm::atan2(v[0], v[1]), |v| v[0].atan2(v[1]), "4096 ULP";
    "exp(x)" in [SMALL]: |v| libm::exp(v[0]), |v| v[0].exp(), "3 + 2·|x| ULP";
    "exp2(x)" in [SMALL]: |v| libm::exp2(v[0]), |v| v[0].exp2(), "3 + 2·|x| ULP";
    "log(x)" in [POSITIVE]: |v| libm::log(v[0]), |v| v[0].log(), "3 ULP; 2⁻²¹ absolute in [0.5, 2]";
    "log2(x)" in [POSITIVE]: |v| libm::log2(v[0]), |v| v[0].log2(), "3 ULP; 2⁻²¹ absolute in [0.5, 2]";
    // GLSL leaves the power of a negative base undefined.
    "pow(x, y)" in [POSITIVE, SMALL]: |v| if v[0] > 0.0 { libm::pow(v[0], v[1]) } else { f64::NAN },
        |v| (v[1] * v[0].log2()).exp2(), "inherited from exp2(y · log2(x))";
    "sinh(x)" in [SMALL]: |v| libm::sinh(v[0]), |v| sinh(v[0]), "inherited from (exp(x) − exp(−x)) · 0.5";
    "cosh(x)" in [SMALL]: |v| libm::cosh(v[0]), |v| cosh(v[0]), "inherited from (exp(x) + exp(−x)) · 0.5";
    "tanh(x)" in [SMALL]: |v| libm::tanh(v[0]), |v| sinh(v[0]) / cosh(v[0]), "inherited from sinh(x) / cosh(x)";
    "asinh(x)" in [SMALL]: |v| libm::asinh(v[0]), |v| (v[0] + (v[0] * v[0] + one()).sqrt()).log(),
        "inherited from log(x + sqrt(x·x + 1))";
    "acosh(x)" in [(1.0, 10.0)]: |v| if v[0] < 1.0 { f64::NAN } else { libm::acosh(v[0]) },
        |v| (v[0] + (v[0] * v[0] - one()).sqrt()).log(), "inherited from log(x + sqrt(x·x − 1))";
    "atanh(x)" in [UNIT]: |v| libm::atanh(v[0]), |v| ((one() + v[0]) / (one() - v[0])).log() * half(),
        "inherited from log((1 + x) / (1 − x)) · 0.5";
    "fract(x)" in [SMALL]: |v| v[0] - v[0].floor(), |v| v[0] - v[0].floor(), "correctly rounded";
    "mod(x, y)" in [SMALL, SMALL]: modulo, |v| v[0] - v[1] * (v[0] / v[1]).floor(),
        "inherited from x − y · floor(x / y)";
    "mix(x, y, z)" in [SMALL, SMALL, UNIT]: |v| v[0] * (1.0 - v[2]) + v[1] * v[2],
        // The second form is the first one by the distributive law, which an implementation may use.
        |v| (v[0] * (one() - v[2]) + v[1] * v[2]).or(v[0] + (v[1] - v[0]) * v[2]),
        "inherited from x · (1 − z) + y · z";
    "smoothstep(x, y, z)" in [UNIT, POSITIVE, SMALL]: smoothstep,
        |v| {
            let t = ((v[2] - v[0]) / (v[1] - v[0])).clamp(0.0, 1.0);
            t * t * (Permitted::exactly(3.0) - Permitted::exactly(2.0) * t)
        },
        "inherited from t · t · (3 − 2 · t), t = clamp((z − x) / (y − x), 0, 1)";
    "dot(vec3(x, y, z), vec3(u, v, w))" in [SMALL, SMALL, SMALL, SMALL, SMALL, SMALL]:
        |v| v[0] * v[3] + v[1] * v[4] + v[2] * v[5],
        |v| dot([v[0], v[1], v[2]], [v[3], v[4], v[5]]), "inherited from x·u + y·v + z·w";
    "length(vec3(x, y, z))" in [SMALL, SMALL, SMALL]: norm, |v| square(v).sqrt(),
        "inherited from sqrt(dot(v, v))";
    "normalize(vec3(x, y, z)).x" in [SMALL, SMALL, SMALL]: |v| v[0] / norm(v),
        |v| v[0] * square(v).inverse_sqrt(), "inherited from v · inversesqrt(dot(v, v))";
}

/// `x − y · floor(x / y)`, exactly.
fn modulo(v: &[f64]) -> f64 {
    let rest = libm::fmod(v[0], v[1]);
    if rest != 0.0 && (rest < 0.0) != (v[1] < 0.0) {
        rest + v[1]
    } else {
        rest
    }
}
