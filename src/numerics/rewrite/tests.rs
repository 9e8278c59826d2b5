use toyproof_diagnostic::{File, Files};

use super::*;

/// Rewrites a shader whose gray is an expression of x in [0, 1), which `definitions` may precede.
fn rewritten(definitions: &str, gray: &str) -> Rewrites {
    let text = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ float x = p.x / iResolution.x; {definitions} c = vec4(vec3({gray}), 1.0); }}"
    );
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text.as_str()));
    let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
    let frame = Frame {
        size: [64, 4],
        ..Frame::default()
    };
    let subject = Subject {
        checked: &checked,
        text: &text,
        frame: &frame,
        near: None,
        max_candidates: 400,
    };
    let deadline = Instant::now() + std::time::Duration::from_secs(60);
    rewrite(subject, deadline, &AtomicBool::new(false)).unwrap()
}

/// An expression that loses digits, for each identity.
const LOSSES: &[(&str, &str, &str)] = &[
    ("terms that cancel exactly", "float a = 3.0e7;", "(a + x) - a"),
    (
        "a difference of squares as a product",
        "float a = 1.0e4, b = a + 1.0e-3 * x;",
        "0.04 * (b * b - a * a)",
    ),
    (
        "the distance of the center from the ray as a vector",
        "vec3 f = vec3(x, 0.0, 5.0e3), d = vec3(0.0, 0.0, -1.0); float b = dot(f, d);",
        "b * b - (dot(f, f) - 1.0)",
    ),
    (
        "the root that cancels from the one that does not",
        "float b = -3.0e5, k = 6.0e5 * x;",
        "-b - sqrt(b * b - k)",
    ),
    (
        "the conjugate of a difference of roots",
        "float a = 1.0e-6 * x;",
        "1.0e6 * (sqrt(1.0 + a) - 1.0)",
    ),
    ("half angles", "float a = 1.0e-3 * x;", "1.0e6 * (1.0 - cos(a))"),
    (
        "a difference of two values of a function as a product",
        "float a = 1.0 + x, e = 1.0e-6;",
        "1.0e6 * (sin(a + e) - sin(a))",
    ),
    (
        "differences before sums",
        "vec3 o = vec3(1.0e7), q = vec3(1.0e7); float a = (o + x).y; vec3 r = o + x;",
        "(r - q).x",
    ),
    (
        "the difference of the arguments of dot products",
        "vec3 n = vec3(0.6, 0.8, 0.0), q = vec3(3.0e6), r = q + vec3(0.0, floor(8.0 * x), 0.0);",
        "0.1 * (dot(n, r) - dot(n, q))",
    ),
    (
        "the conjugate of a difference of roots",
        "float r = 1.0e6, d = 1.0e3 * x;",
        "sqrt(d * d + (r + x) * (r + x)) - r",
    ),
    (
        "a difference of two values of a function as a product",
        "float a = 1.0 + x, e = 1.0e-6 * x, b = a + e;",
        "1.0e6 * (sin(b) * cos(a) - cos(b) * sin(a))",
    ),
    (
        "log(1 + x) as Kahan computes it",
        "float n = 1.0e6;",
        "0.3 * pow(1.0 + x / n, n)",
    ),
    (
        "distances and cross products of unit vectors",
        "vec3 n = vec3(0.0, 0.0, 1.0), h = normalize(vec3(1.0e-4 * x, 0.0, 1.0)); float d = dot(n, h), k = 1.0e-9;",
        "1.0e8 * (d * d * (k - 1.0) + 1.0)",
    ),
    (
        "distances and cross products of unit vectors",
        "vec3 d = vec3(0.6, 0.8, 0.0), v = vec3(540.0, 720.0, x); float t = dot(v, d);",
        "dot(v, v) - t * t",
    ),
    (
        "exp(x) - 1 by its series near 0",
        "vec3 s = vec3(1.0, 0.5, x); float k = 1.0e-6;",
        "((s - s * exp(-0.5 * k)) / k).y",
    ),
    (
        "one exponential instead of several",
        "vec2 e = exp(vec2(90.0 + x, 90.0));",
        "(e / (e.x + e.y)).x",
    ),
    (
        "the difference of the eigenvalues of a symmetric matrix",
        "float a = 1.0 + 1.0e-3 * x, b = 1.0, k = 1.0e-4, trace = a + b, det = a * b - k * k;",
        "1.0e3 * sqrt(trace * trace - 4.0 * det)",
    ),
    (
        "the dot products of parts of a far point",
        "vec3 n = vec3(0.5, 0.25, 0.0), q = vec3(3.0e6, 2.0e5, 0.0), r = q + vec3(x, 0.0, 0.0); float w = 1.55e6;",
        "dot(n, r) - w",
    ),
    (
        "the area of a triangle from two of its sides",
        "vec2 a = vec2(4.0e3), b = vec2(4.0e3, 4001.0), t = vec2(4.0e3 + floor(8.0 * x) / 8.0, 4.0e3);",
        "-(a.x * b.y - a.y * b.x + b.x * t.y - b.y * t.x + t.x * a.y - t.y * a.x)",
    ),
    (
        "the distance from a far center by its squares",
        "vec3 v = vec3(x, x, 0.0);",
        "length(v + vec3(0.0, 1.0e6, 0.0)) - 1.0e6",
    ),
    (
        "the haversine of an angle on a sphere",
        "float a = 0.7, b = 0.7 + 1.0e-5 * x, l = 1.0e-5 * x;",
        "5.0e4 * acos(sin(a) * sin(b) + cos(a) * cos(b) * cos(l))",
    ),
    (
        "an angle from both of its sides",
        "vec2 a = vec2(1.0, 0.0), b = normalize(vec2(1.0, 1.0e-3 * x));",
        "1.0e3 * acos(dot(a, b))",
    ),
    (
        "a difference of reciprocals over their product",
        "float a = 1.0e6 + 1.0e6 * x;",
        "1.0e12 * (1.0 / a - 1.0 / (a + 1.0))",
    ),
    (
        "exp(x) - 1 by its series near 0",
        "float a = 1.0e-6 * x;",
        "1.0e6 * (exp(a) - 1.0)",
    ),
    (
        "log(1 + x) as Kahan computes it",
        "float a = 1.0e-6 * x;",
        "1.0e6 * log(1.0 + a)",
    ),
    (
        "one exponential instead of several",
        "float a = 80.0 + 40.0 * x;",
        "exp(a) / (1.0 + exp(a)) - 0.5",
    ),
    (
        "a weighted mean of both ends",
        "float a = 1.0e8, t = 1.0;",
        "a + (x - a) * t",
    ),
    (
        "scaled by the largest component",
        "vec2 v = vec2(1.0e25, 1.0e25 * x);",
        "1.0e-26 * length(v)",
    ),
    (
        "distances and cross products of unit vectors",
        "vec3 a = vec3(1.0, 0.0, 0.0), b = normalize(vec3(1.0, 1.0e-4 * x, 0.0)); float d = dot(a, b);",
        "1.0e4 * sqrt(1.0 - d * d)",
    ),
    (
        "the difference of nearly parallel vectors in a product",
        "vec2 a = vec2(3.0e3, 2.0e3), e = 1.0e-4 * vec2(x, 1.0); vec2 b = a + e;",
        "a.x * b.y - a.y * b.x",
    ),
    (
        "the area of a triangle from its sorted sides",
        "float a = 200.0, b = 200.0, e = 1.0e-3 * x, s = 0.5 * (a + b + e);",
        "10.0 * sqrt(s * (s - a) * (s - b) * (s - e))",
    ),
    (
        "x - sin(x) by its series near 0",
        "float a = 1.0e-3 * x;",
        "6.0e9 * (a - sin(a))",
    ),
    (
        "powers of the ratio of two numbers",
        "float a = 0.2 * x, b = 0.1;",
        "pow(pow(a, 50.0) + pow(b, 50.0), 1.0 / 50.0)",
    ),
    (
        "a larger step of a difference quotient",
        "float e = 1.0e-6;",
        "0.5 * (asin(0.5 * (x + e)) - asin(0.5 * x)) / e",
    ),
];

#[test]
fn every_identity_makes_a_shader_more_precise() {
    for &(identity, definitions, gray) in LOSSES {
        let found = rewritten(definitions, gray);
        let message = found.fix.as_ref().map_or("nothing", |fix| &fix.message);
        assert!(
            message.contains(identity),
            "{identity}: {message}, {:?}",
            found.before
        );
        assert!(
            found.after.imprecise < found.before.imprecise,
            "{identity}: {message}"
        );
    }
    let untested = RULES
        .iter()
        .filter(|rule| LOSSES.iter().all(|(name, ..)| *name != rule.name));
    assert_eq!(
        untested.map(|rule| rule.name).collect::<Vec<_>>(),
        [] as [&str; 0]
    );
}

#[test]
fn the_variance_of_a_loop_is_that_of_differences() {
    let found = rewritten(
        "float sum = 0.0, squares = 0.0; \
         for (int i = 0; i < 8; i++) { float v = 300.0 + x * sin(float(i)); sum += v; squares += v * v; } \
         float mean = sum / 8.0;",
        "squares / 8.0 - mean * mean",
    );
    let fix = found.fix.unwrap();
    assert!(
        found.before.imprecise > 0 && found.after.imprecise == 0,
        "{fix:?}"
    );
    assert!(
        fix.message
            .starts_with("write 3 other forms: the variance of differences from the first sample"),
        "{}",
        fix.message
    );
}

#[test]
fn precise_shaders_stay_as_they_are() {
    let found = rewritten("float a = 2.0 * x;", "sqrt(1.0 + a) - 1.0");
    assert!(found.fix.is_none() && found.before.imprecise == 0, "{found:?}");
}

#[test]
fn only_steps_are_made_larger() {
    // The error is that of `1.0 + x * k`, of which k is a factor.
    let found = rewritten(
        "float k = 1.0e-5;",
        "(sqrt(abs(sin(1.0 + x * k) - sin(1.0))) / sqrt(k))",
    );
    let message = found.fix.map(|fix| fix.message).unwrap_or_default();
    assert!(
        found.before.imprecise > 0 && !message.contains("step"),
        "{message}"
    );
}

#[test]
fn long_expressions_are_left_as_they_are() {
    let squares = vec!["x * x"; 3000].join(" + ");
    let text = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ float x = p.x, s = sqrt({squares}), t = s - x; c = vec4(s - t); }}"
    );
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text.as_str()));
    let subject = Subject {
        checked: &glsl::check(&files, file, &glsl::Options::default()).unwrap(),
        text: &text,
        frame: &Frame::default(),
        near: None,
        max_candidates: usize::MAX,
    };
    let found = candidates(&subject);
    let bytes: usize = found
        .iter()
        .flat_map(|one| &one.edits)
        .map(|edit| edit.replacement.len())
        .sum();
    // Those of the root alone would have hundreds of megabytes.
    assert!(
        !found.is_empty() && bytes < 1 << 20,
        "{} forms, {bytes} bytes",
        found.len()
    );
}

#[test]
fn rounding_that_no_identity_avoids_is_left() {
    let found = rewritten("", "fract(sin(x * 1000.0) * 4375800.5453)");
    assert!(found.fix.is_none() && found.before.imprecise > 0, "{found:?}");
}
