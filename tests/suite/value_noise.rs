//! Noise whose hash belongs to the assignment determines what is shown: it is compared pixel by pixel, and the noise
//! of a sampler by its mean.

use std::time::Duration;

use toyproof::explain::Findings;
use toyproof::verify::{DEFAULT_TOLERANCE, Expected, ShaderReference, Verdict};

use crate::support::{Edit, Exercise, SPHERE, check_reference, edit, frame, linted};

/// Clouds of value noise, drifting to the left above a plain.
const CLOUDS: &str = "float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }

float noise(vec2 p) {
    vec2 i = floor(p);
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    float below = mix(hash(i), hash(i + vec2(1.0, 0.0)), f.x);
    float above = mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), f.x);
    return mix(below, above, f.y);
}

float fbm(vec2 p) {
    float sum = 0.0;
    float amplitude = 0.5;
    for (int i = 0; i < 5; i++) {
        sum += amplitude * noise(p);
        p = 2.0 * p + vec2(17.0, 5.0);
        amplitude *= 0.5;
    }
    return sum;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = fragCoord / iResolution.y;
    vec3 color = mix(vec3(0.75, 0.85, 0.95), vec3(0.2, 0.45, 0.8), uv.y);
    float cover = smoothstep(0.4, 0.7, fbm(4.0 * uv + vec2(iTime, 0.0)));
    color = mix(color, vec3(1.0), cover);
    if (uv.y < 0.3) {
        color = vec3(0.15, 0.35, 0.1);
    }
    fragColor = vec4(color, 1.0);
}
";

/// The same clouds by somebody else, with an integer hash.
const INTEGER_HASH: Edit = (
    "float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }",
    "float hash(vec2 p) {
    uvec2 q = uvec2(ivec2(p)) * uvec2(1597334673u, 3812015801u);
    return float((q.x ^ q.y) * 1597334673u) / 4294967295.0;
}",
);

/// Another way to write the same noise.
const OTHER_STYLE: &str = "const vec2 FACTORS = vec2(127.1, 311.7);

float random(float x, float y) {
    float s = sin(x * FACTORS.x + y * FACTORS.y) * 43758.5453;
    return s - floor(s);
}

float cells(vec2 at) {
    vec2 cell = floor(at), t = at - cell;
    vec2 weight = smoothstep(vec2(0.0), vec2(1.0), t);
    float a = random(cell.x, cell.y), b = random(cell.x + 1.0, cell.y);
    float c = random(cell.x, cell.y + 1.0), d = random(cell.x + 1.0, cell.y + 1.0);
    return a * (1.0 - weight.x) * (1.0 - weight.y) + b * weight.x * (1.0 - weight.y)
        + c * (1.0 - weight.x) * weight.y + d * weight.x * weight.y;
}

void mainImage(out vec4 o, vec2 pixel) {
    vec2 st = pixel / iResolution.y, at = st * 4.0;
    at.x += iTime;
    float scale = 1.0, density = 0.0;
    for (int octave = 1; octave <= 5; ++octave) {
        scale /= 2.0;
        density += cells(at) * scale;
        at = at + at + vec2(17.0, 5.0);
    }
    float t = clamp((density - 0.4) / 0.3, 0.0, 1.0);
    t *= t * (3.0 - 2.0 * t);
    vec3 sky = vec3(0.75, 0.85, 0.95) * (1.0 - st.y) + vec3(0.2, 0.45, 0.8) * st.y;
    o.rgb = st.y < 0.3 ? vec3(0.15, 0.35, 0.1) : sky + (1.0 - sky) * t;
    o.a = 1.0;
}
";

/// Mistakes that leave the kind of the noise as it is.
const MISTAKES: &[Edit] = &[
    ("i < 5", "i < 4"),
    ("i < 5", "i < 6"),
    ("amplitude *= 0.5", "amplitude *= 0.6"),
    ("p = 2.0 * p", "p = 2.1 * p"),
    ("+ vec2(17.0, 5.0)", ""),
    ("4.0 * uv", "5.0 * uv"),
    ("+ vec2(iTime, 0.0)", "- vec2(iTime, 0.0)"),
    ("vec2(iTime, 0.0)", "vec2(0.0, iTime)"),
    ("hash(i + vec2(1.0, 1.0))", "hash(i + vec2(1.0, 2.0))"),
    ("f = f * f * (3.0 - 2.0 * f);", ""),
];

fn exercise() -> Exercise {
    Exercise { time: 1.7, ..SPHERE }
}

fn reference(text: &str) -> Expected {
    let (checked, lints) = linted(text);
    let exercise = exercise();
    let frame = frame(&exercise, exercise.size);
    let timeout = Duration::from_secs(60);
    let reference = ShaderReference::new(&checked, &lints, &frame, DEFAULT_TOLERANCE, timeout);
    Expected::Shader(Box::new(reference.unwrap().0))
}

fn check(reference: &Expected, shader: &str) -> Findings {
    check_reference(reference, shader, &exercise())
}

#[test]
fn mistakes_in_noise_are_wrong_and_another_style_is_correct() {
    let wrong_hashes = [("127.1", "12.9898"), ("q.x ^ q.y", "q.x + q.y")];
    for (hash, wrong_hash) in [None, Some(INTEGER_HASH)].into_iter().zip(wrong_hashes) {
        let clouds = edit(CLOUDS, hash.as_slice(), "clouds");
        let reference = reference(&clouds);
        let right = check(&reference, &clouds);
        assert_eq!(right.verdict, Verdict::Correct, "{:?}", right.reason);
        for &mistake in MISTAKES.iter().chain([&wrong_hash]) {
            let found = check(&reference, &edit(&clouds, &[mistake], "clouds"));
            assert_eq!(found.verdict, Verdict::Wrong, "{mistake:?}: {:?}", found.reason);
            assert!(!found.reason.compares_means(), "{mistake:?}: {:?}", found.reason);
        }
    }
    let other = check(&reference(CLOUDS), OTHER_STYLE);
    assert_eq!(other.verdict, Verdict::Correct, "{:?}", other.reason);
}

/// The grain of a film differs from pixel to pixel, like a sampler's noise.
#[test]
fn grain_is_no_picture() {
    let grain = |seed: &str| {
        format!(
            "float hash(vec2 p) {{ return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }}
            void mainImage(out vec4 c, in vec2 p) {{
                vec2 uv = p / iResolution.xy;
                float sum = 0.0;
                for (int i = 0; i < 8; i++) {{ sum += hash(p + float(i) * {seed}) / 8.0; }}
                c = vec4(uv * 0.6 + 0.4 * sum, 0.4 * sum, 1.0);
            }}"
        )
    };
    let found = check(&reference(&grain("0.731")), &grain("1.379"));
    assert_ne!(found.verdict, Verdict::Wrong, "{:?}", found.reason);
    assert!(found.reason.compares_means(), "{:?}", found.reason);
}
