//! The test subjects: methods to intersect a ray with a sphere or a quadric, and to start a ray from a
//! surface, each written once, in GLSL. The evaluator runs them in f32 and f64, a GPU unchanged.

use toyproof_glsl as glsl;

use crate::axis::Kind;
use crate::function::Signature;

/// A formula for ray–sphere intersection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Formula {
    /// The name.
    pub name: &'static str,
    /// `float NAME(vec3 o, vec3 d, vec3 c, float r, float tMin)`, for directions of any length unless stated
    /// otherwise: returns the smallest t above tMin, or a value not above tMin if there is none.
    pub text: &'static str,
}

/// The formula of the course's slides: t² + 2 b t + c = 0 with a = 1.
pub const UNIT: Formula = Formula {
    name: "course",
    text: "// b² − c, for directions of length 1.
float course(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    vec3 f = o - c;
    float b = dot(f, d);
    float disc = b * b - (dot(f, f) - r * r);
    if (disc < 0.0) return -1.0;
    float near = -b - sqrt(disc);
    return near > tMin ? near : -b + sqrt(disc);
}
",
};

const TEXTBOOK: Formula = Formula {
    name: "textbook",
    text: "// b² − 4ac, and both roots over 2a.
float textbook(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    vec3 f = o - c;
    float a = dot(d, d);
    float b = 2.0 * dot(f, d);
    float k = dot(f, f) - r * r;
    float disc = b * b - 4.0 * a * k;
    if (disc < 0.0) return -1.0;
    float near = (-b - sqrt(disc)) / (2.0 * a);
    return near > tMin ? near : (-b + sqrt(disc)) / (2.0 * a);
}
",
};

const HALF_B: Formula = Formula {
    name: "half-b",
    text: "// b² − ac with half of the textbook's b.
float halfB(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    vec3 f = o - c;
    float a = dot(d, d);
    float b = dot(f, d);
    float disc = b * b - a * (dot(f, f) - r * r);
    if (disc < 0.0) return -1.0;
    float near = (-b - sqrt(disc)) / a;
    return near > tMin ? near : (-b + sqrt(disc)) / a;
}
",
};

const GEOMETRIC: Formula = Formula {
    name: "geometric",
    text: "// By Pythagoras from the point of the ray that is nearest to the center.
float geometric(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    vec3 f = c - o;
    float a = dot(d, d);
    float ahead = dot(f, d) / a;
    float aside = dot(f, f) - ahead * ahead * a;
    if (aside > r * r) return -1.0;
    float reach = sqrt((r * r - aside) / a);
    return ahead - reach > tMin ? ahead - reach : ahead + reach;
}
",
};

/// The recentered discriminant with stable roots: Haines, Günther and Akenine-Möller, “Precision Improvements
/// for Ray/Sphere Intersection”, Ray Tracing Gems (2019), chapter 7.
pub const RECENTERED: Formula = Formula {
    name: "recentered",
    text: "// The distance of the line from the center as a vector, and roots that do not cancel.
float recentered(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    vec3 f = o - c;
    float a = dot(d, d);
    float b = -dot(f, d);
    vec3 closest = f + (b / a) * d;
    float disc = r * r - dot(closest, closest);
    if (disc < 0.0) return -1.0;
    float q = b < 0.0 ? b - sqrt(a * disc) : b + sqrt(a * disc);
    float one = (dot(f, f) - r * r) / q;
    float other = q / a;
    float near = one < other ? one : other;
    float far = one < other ? other : one;
    return near > tMin ? near : far;
}
",
};

const SCALED: Formula = Formula {
    name: "scaled",
    text: "// A power of two at or below a positive number.
float powerOfTwo(float x) {
    float power = uintBitsToFloat(floatBitsToUint(abs(x)) & 0x7f800000u);
    return power > 0.0 && power < 1.0e38 ? power : 1.0;
}

// The recentered discriminant, the sphere near size 1 and the direction near length 1.
float scaled(vec3 o, vec3 d, vec3 c, float r, float tMin) {
    float unit = powerOfTwo(r);
    float size = powerOfTwo(max(abs(d.x), max(abs(d.y), abs(d.z))));
    vec3 f = (o - c) / unit;
    vec3 e = d / size;
    float s = r / unit;
    float a = dot(e, e);
    float b = -dot(f, e);
    vec3 closest = f + (b / a) * e;
    float disc = s * s - dot(closest, closest);
    if (disc < 0.0) return -1.0;
    float q = b < 0.0 ? b - sqrt(a * disc) : b + sqrt(a * disc);
    float one = (dot(f, f) - s * s) / q / size * unit;
    float other = q / a / size * unit;
    float near = one < other ? one : other;
    float far = one < other ? other : one;
    return near > tMin ? near : far;
}
",
};

/// All formulas for ray–sphere intersection.
pub const FORMULAS: [Formula; 6] = [UNIT, TEXTBOOK, HALF_B, GEOMETRIC, RECENTERED, SCALED];

impl Formula {
    /// The name of the formula's GLSL function.
    #[must_use]
    pub fn function(&self) -> &'static str {
        if self.name == HALF_B.name {
            "halfB"
        } else {
            self.name
        }
    }
}

/// A test subject.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The name.
    pub name: String,
    /// The kind of cases that it is tested on.
    pub kind: Kind,
    /// A shader: it reads the texels of a case from channels 0 to 2, and returns the result as a color.
    pub text: String,
    /// Whether the subject is also meaningful in f64.
    pub in_f64: bool,
    /// The interpretation of the shader's color.
    pub reading: Reading,
    /// The options of the shader's language.
    pub options: glsl::Options,
}

/// The interpretation of the color that a shader returns for a case.
#[derive(Debug, Clone)]
pub enum Reading {
    /// Red is t; a value that is not positive is a miss.
    Root,
    /// Red is 1 if the ray hits the surface that it leaves, green is 1 if it misses a nearby one.
    Secondary,
    /// The result of a function of that signature: t, flag and second t.
    Function(Signature),
}

/// A function of this name with the form of `mainImage`, which reads a case and returns `result`, an expression
/// of type vec3 that may use the texels `a`, `b` and `c`.
pub(crate) fn main(name: &str, steps: &str, result: &str) -> String {
    format!(
        "void {name}(out vec4 color, in vec2 place) {{
    ivec2 at = ivec2(place);
    vec4 a = texelFetch(iChannel0, at, 0);
    vec4 b = texelFetch(iChannel1, at, 0);
    vec4 c = texelFetch(iChannel2, at, 0);
{steps}    color = vec4({result}, 1.0);
}}
"
    )
}

/// All built-in subjects.
#[must_use]
pub fn subjects() -> Vec<Subject> {
    let spheres = FORMULAS.into_iter().map(|formula| Subject {
        name: formula.name.to_owned(),
        kind: Kind::Spheres,
        text: formula.text.to_owned()
            + &main(
                "mainImage",
                "",
                &format!(
                    "vec3({}(a.xyz, b.xyz, c.xyz, a.w, 0.0), 0.0, 0.0)",
                    formula.function()
                ),
            ),
        in_f64: true,
        reading: Reading::Root,
        options: glsl::Options::default(),
    });
    let quadrics = QUADRICS.into_iter().map(|(name, text)| Subject {
        name: name.to_owned(),
        kind: Kind::Quadrics,
        text: text.to_owned()
            + &main(
                "mainImage",
                "",
                "vec3(quadric(a.xyz, b.xyz, c.xyz, a.w, b.w), 0.0, 0.0)",
            ),
        in_f64: true,
        reading: Reading::Root,
        options: glsl::Options::default(),
    });
    let secondaries = STRATEGIES.into_iter().map(|strategy| Subject {
        name: strategy.name.to_owned(),
        kind: Kind::Secondaries,
        text: format!("{}{}{}", RECENTERED.text, strategy.helper, strategy.main()),
        in_f64: strategy.helper.is_empty(),
        reading: Reading::Secondary,
        options: glsl::Options::default(),
    });
    spheres.chain(quadrics).chain(secondaries).collect()
}

/// Formulas to intersect a ray with q·p² + 2 g z + k = 0.
const QUADRICS: [(&str, &str); 2] = [
    (
        "quadric, textbook",
        "float quadric(vec3 o, vec3 d, vec3 q, float g, float k) {
    float a = dot(q * d, d);
    float b = 2.0 * (dot(q * d, o) + g * d.z);
    float c = dot(q * o, o) + 2.0 * g * o.z + k;
    float disc = b * b - 4.0 * a * c;
    if (disc < 0.0) return -1.0;
    float one = (-b - sqrt(disc)) / (2.0 * a);
    float other = (-b + sqrt(disc)) / (2.0 * a);
    float near = one < other ? one : other;
    float far = one < other ? other : one;
    return near > 0.0 ? near : far;
}
",
    ),
    (
        "quadric, recentered",
        "// From the point of the ray that is nearest to the origin, with roots that do not cancel.
float quadric(vec3 o, vec3 d, vec3 q, float g, float k) {
    float ahead = -dot(o, d) / dot(d, d);
    vec3 p = o + ahead * d;
    float a = dot(q * d, d);
    float b = -(dot(q * d, p) + g * d.z);
    float c = dot(q * p, p) + 2.0 * g * p.z + k;
    float disc = b * b - a * c;
    if (disc < 0.0 || (a == 0.0 && b == 0.0)) return -1.0;
    float root = b < 0.0 ? b - sqrt(disc) : b + sqrt(disc);
    float one = ahead + (root == 0.0 ? 0.0 : c / root);
    float other = a == 0.0 ? one : ahead + root / a;
    float near = one < other ? one : other;
    float far = one < other ? other : one;
    return near > 0.0 ? near : far;
}
",
    ),
];

/// A strategy to avoid self-intersection of a ray with the surface that it leaves.
#[derive(Debug, Clone, Copy)]
struct Strategy {
    name: &'static str,
    /// A helper function for `start`, which may use the bits of f32.
    helper: &'static str,
    /// The ray's origin, from the point `p` with the normal `n` on the sphere (c, r).
    start: &'static str,
    /// The minimum accepted t.
    t_min: &'static str,
    /// Whether the surface that the ray starts from is tested, too.
    tests_own: bool,
}

const PLAIN: Strategy = Strategy {
    name: "t > 0",
    helper: "",
    start: "p",
    t_min: "0.0",
    tests_own: true,
};

const STRATEGIES: [Strategy; 7] = [
    PLAIN,
    Strategy {
        name: "t > 1e-4",
        t_min: "1.0e-4",
        ..PLAIN
    },
    Strategy {
        name: "t > 1e-3",
        t_min: "1.0e-3",
        ..PLAIN
    },
    Strategy {
        name: "p + 1e-3 n",
        start: "p + 1.0e-3 * n",
        ..PLAIN
    },
    // Wächter and Binder, “A Fast and Robust Method for Avoiding Self-Intersection”, Ray Tracing Gems
    // (2019), chapter 6.
    Strategy {
        name: "offset in ULPs",
        helper: "float moved(float p, float n) {
    int steps = int(256.0 * n);
    float by = intBitsToFloat(floatBitsToInt(p) + (p < 0.0 ? -steps : steps));
    return abs(p) < 1.0 / 32.0 ? p + n / 65536.0 : by;
}
",
        start: "vec3(moved(p.x, n.x), moved(p.y, n.y), moved(p.z, n.z))",
        ..PLAIN
    },
    // Pharr, Jakob and Humphreys, “Physically Based Rendering” (4th edition, 2023), 6.8.6: offset to the edge
    // of the rounding-error bounds of a point projected back onto the sphere.
    Strategy {
        name: "error-bound offset",
        helper: "vec3 offErrorBounds(vec3 p, vec3 n, vec3 c, float r) {
    vec3 local = (p - c) * (r / length(p - c));
    vec3 error = 5.0 * 5.97e-8 * abs(local) + 5.97e-8 * abs(local + c);
    return local + c + dot(abs(n), error) * n;
}
",
        start: "offErrorBounds(p, n, c.xyz, a.w)",
        ..PLAIN
    },
    Strategy {
        name: "skip own surface",
        tests_own: false,
        ..PLAIN
    },
];

impl Strategy {
    /// A `mainImage` that intersects the first ray with the sphere, sends the second, and tests it against
    /// the sphere again, and against a small sphere nearly in contact with its origin.
    fn main(&self) -> String {
        let Self {
            start,
            t_min,
            tests_own,
            ..
        } = self;
        let steps = format!(
            "    vec3 p = a.xyz + recentered(a.xyz, b.xyz, c.xyz, a.w, 0.0) * b.xyz;
    vec3 n = normalize(p - c.xyz);
    vec3 away = b.w == 0.0 ? reflect(b.xyz, n) : normalize(normalize(b.xyz - dot(b.xyz, n) * n) + b.w * n);
    vec3 start = {start};
    float tMin = {t_min};
    float again = {tests_own} ? recentered(start, away, c.xyz, a.w, tMin) : -1.0;
    float near = recentered(start, away, p + (0.1001 * a.w) * away, 0.1 * a.w, tMin);
    bool seen = near > tMin && near < 0.1 * a.w;
"
        );
        main("mainImage", &steps, "vec3(again > tMin, !seen, 0.0)")
    }
}
