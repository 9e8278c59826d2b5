//! GLSL of `mainImage` and the functions that it calls: samples and their mean, tone map, camera, figures,
//! background, random numbers. `«Name: text»` marks a [slot](super::slot).

use std::fmt::Write;

use super::expression::{number, vector};
use super::parts::Parts;
use crate::{Background, Camera, Figure, Outline, Projection, Sampler, Scene, ToneMap};

impl Parts<'_> {
    pub(super) fn main(&self, scene: &Scene) -> String {
        let film = &scene.film;
        let multisampled = film.samples > 1;
        let (indent, index) = if multisampled {
            ("        ", "«SampleIndex: i»")
        } else {
            ("    ", "0")
        };
        let start = match film.sampler {
            Sampler::Independent => format!("{indent}startSample(fragCoord, {index});\n"),
            _ => String::new(),
        };
        let sample = if film.sampler == Sampler::Center {
            format!("{indent}«SampleStatement: color += «Sample: pixelColor(fragCoord)»;»\n")
        } else {
            format!(
                "{start}\
                 {indent}«SampleXStatement: float x = «SampleX: fragCoord.x + random() - 0.5»;»\n\
                 {indent}«SampleYStatement: float y = «SampleY: fragCoord.y + random() - 0.5»;»\n\
                 {indent}«SampleStatement: color += «Sample: pixelColor(vec2(x, y))»;»\n"
            )
        };
        let samples = if multisampled {
            format!(
                "    for (int i = 0; «SampleCondition: i < SAMPLES»; i++) {{\n{sample}    }}\n    \
                 «MeanStatement: color /= float(«MeanDivisor: SAMPLES»);»\n"
            )
        } else {
            sample
        };
        let scene_made = if self.models.is_empty() {
            ""
        } else {
            "    makeScene();\n"
        };
        let seed = match film.sampler {
            Sampler::SineHash => "    seed = 0.0;\n",
            _ => "",
        };
        format!(
            "void mainImage(out vec4 fragColor, in vec2 fragCoord) {{\n{scene_made}{seed}    vec3 color = vec3(0.0);\n\
             {samples}{}    fragColor = vec4(«FinalColor: color», 1.0);\n}}\n",
            post_process(scene)
        )
    }
}

fn post_process(scene: &Scene) -> String {
    let mut text = String::new();
    if scene.film.tone_map == ToneMap::Reinhard {
        text.push_str("    «ToneMapStatement: color = «ToneMapped: color / (color + 1.0)»;»\n");
    }
    if scene.film.gamma != 1.0 {
        let _ = writeln!(
            text,
            "    «GammaStatement: color = pow(color, vec3(«GammaExponent: 1.0 / «Gamma: {}»»));»",
            number(scene.film.gamma)
        );
    }
    text
}

// The camera.

/// Returns `pixelColor`, the color at a point of the image: that of a figure, or of the ray.
pub(super) fn camera_function(scene: &Scene) -> String {
    let camera = &scene.camera;
    let is_turned = camera.axes().is_some();
    let (eye, axes) = if is_turned {
        ("eye".to_owned(), camera_axes(camera))
    } else {
        (vector(camera.eye), String::new())
    };
    let ray = match camera.projection {
        Projection::Pinhole { screen_distance } if is_turned => format!(
            "trace(eye, «CameraDirection: normalize(«ScreenPoint: x * right + y * up + \
             «ScreenDistance: {}» * forward»)»)",
            number(screen_distance)
        ),
        Projection::Parallel { width } if is_turned => format!(
            "trace(eye + {} * «ParallelOffset: (x * right + y * up)», «ParallelDirection: forward»)",
            number(0.5 * width)
        ),
        Projection::Pinhole { screen_distance } => {
            format!(
                "trace({eye}, \
                 «CameraDirection: normalize(«ScreenPoint: vec3(x, y, «ScreenZ: -«ScreenDistance: {}»»)»)»)",
                number(screen_distance)
            )
        }
        Projection::Parallel { width } => format!(
            "trace({eye} + {} * «ParallelOffset: vec3(x, y, 0.0)», «ParallelDirection: vec3(0.0, 0.0, -1.0)»)",
            number(0.5 * width)
        ),
    };
    let figures = figure_tests(&scene.figures);
    format!(
        "vec3 pixelColor(vec2 fragCoord) {{\n    «AspectStatement: float aspect = «AspectRatio: iResolution.x / iResolution.y»;»\n    \
         float x = «ScreenX: fragCoord.x / iResolution.x * 2.0 - 1.0»;\n    \
         float y = «ScreenYOverAspect: «ScreenY: (fragCoord.y / iResolution.y * 2.0 - 1.0)» / aspect»;\n{figures}{axes}    return {ray};\n}}\n"
    )
}

/// Returns the code that computes the axes of a camera that is turned.
fn camera_axes(camera: &Camera) -> String {
    let forward = match camera.look_at {
        Some(look_at) => format!("«Forward: normalize(«LookAt: {}» - eye)»", vector(look_at)),
        None => vector(camera.forward()),
    };
    let level = format!(
        "«Right: normalize(«RightCross: cross(forward, «UpReference: {}»)»)»",
        vector(camera.up)
    );
    let axes = if camera.roll == 0.0 {
        format!("    vec3 right = {level};\n    vec3 up = «Up: cross(right, forward)»;\n")
    } else {
        format!(
            "    vec3 level = {level};\n    \
             vec3 upright = «Up: cross(level, forward)»;\n    \
             float roll = «Roll: radians(«RollDegrees: {}»)»;\n    \
             vec3 right = cos(roll) * level - sin(roll) * upright;\n    \
             vec3 up = cos(roll) * upright + sin(roll) * level;\n",
            number(camera.roll)
        )
    };
    let eye = vector(camera.eye);
    format!("    vec3 eye = {eye};\n    vec3 forward = {forward};\n{axes}")
}

// Figures on the screen.

fn pair([x, y]: [f64; 2]) -> String {
    format!("vec2({}, {})", number(x), number(y))
}

/// Returns the implicit function of an outline, and its call at p.
fn function(outline: &Outline) -> (&'static str, String) {
    match *outline {
        Outline::Disk { center, radius } => (DISK, format!("disk(p, {}, {})", pair(center), number(radius))),
        Outline::Wave {
            height,
            amplitude,
            frequency,
        } => {
            let [height, amplitude, frequency] = [height, amplitude, frequency].map(number);
            (WAVE, format!("wave(p, {height}, {amplitude}, {frequency})"))
        }
        Outline::Heart { center, size } => (HEART, format!("heart(p, {}, {})", pair(center), number(size))),
    }
}

/// Returns the implicit functions in use, negative inside.
pub(super) fn figure_functions(figures: &[Figure]) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    for figure in figures {
        let (text, _) = function(&figure.outline);
        if !pieces.iter().any(|piece| piece == text) {
            pieces.push(text.to_owned());
        }
    }
    pieces
}

/// Returns code that returns the color of the topmost figure that covers (x, y).
pub(super) fn figure_tests(figures: &[Figure]) -> String {
    if figures.is_empty() {
        return String::new();
    }
    let tests = figures.iter().rev().map(|figure| {
        let (_, call) = function(&figure.outline);
        format!(
            "    if ({call} < 0.0) {{\n        return {};\n    }}\n",
            vector(figure.color)
        )
    });
    "    vec2 p = vec2(x, y);\n".to_owned() + &tests.collect::<String>()
}

const DISK: &str = "float disk(vec2 p, vec2 center, float radius) {
    vec2 d = p - center;
    return «DiskFunction: dot(d, d) - radius * radius»;
}
";

const WAVE: &str = "// Below a sine wave.
float wave(vec2 p, float height, float amplitude, float frequency) {
    return «WaveFunction: p.y - height - amplitude * sin(frequency * p.x)»;
}
";

const HEART: &str = "float heart(vec2 p, vec2 center, float size) {
    vec2 q = (p - center) / size;
    float ring = dot(q, q) - 1.0;
    return «HeartFunction: ring * ring * ring - q.x * q.x * q.y * q.y * q.y»;
}
";

// The background.

pub(super) fn background_function(background: &Background) -> String {
    let color = match *background {
        Background::Uniform(color) => vector(color),
        Background::Gradient { bottom, top } => format!(
            "mix({}, {}, «BackgroundHeight: 0.5 * (1.0 + direction.y)»)",
            vector(bottom),
            vector(top)
        ),
    };
    format!(
        "vec3 background(vec3 direction) {{\n    «BackgroundStatement: return «BackgroundColor: {color}»;»\n}}\n"
    )
}

// Random numbers.

pub(super) fn random_functions(sampler: Sampler) -> String {
    if sampler == Sampler::SineHash {
        SINE_HASH.to_owned()
    } else {
        format!("{PCG}\n{INDEPENDENT}")
    }
}

const SINE_HASH: &str = "float seed;

float random() {
    return fract(sin(seed++) * 43758.5453123);
}
";

pub(super) const PCG: &str = "// The integer hash PCG (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return «HashResult: (word >> 22u) ^ word»;
}
";

const INDEPENDENT: &str = "uint state;

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}
";

pub(super) const AROUND: &str =
    "// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
vec3 around(vec3 w, float cosine, float turn) {
    vec3 up = abs(w.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(up, w));
    vec3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = «Turn: 6.28318530718 * turn»;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}
";
