//! Which variables of a shader may be `mediump`: numbers of 16 bits, as GPUs of phones have them, before its
//! image visibly changes. Found by bisection on its declarations, as Precimonious does for C (Rubio-González
//! et al., SC 2013), on images in which 16 bits are emulated to the bit.

mod emulation;
mod library;
mod unit;

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::Serialize;
use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::ExprId;
use toyproof_image::{Frame, Image};
use toyproof_verify::compare::visible_pixels;

use self::emulation::Emulation;
use self::unit::{Unit, units};

/// The share of pixels that may visibly change.
const MAX_SHARE: f64 = 0.001;

/// What may be `mediump`.
#[derive(Debug, Clone, Serialize)]
pub struct MixedPrecision {
    /// The names of the variables, and of the functions whose results may be.
    pub names: Vec<String>,
    /// Their number; several variables may have one name.
    pub found: usize,
    /// The number of variables and results that were tried.
    pub tried: usize,
    /// The share of the operations that the pixels execute which have 16 bits then; `None` if they cannot be
    /// counted in time.
    pub operations: Option<f64>,
    /// The number of pixels that visibly change.
    pub changed_pixels: u64,
    /// Whether the time was enough to try everything.
    pub is_complete: bool,
    /// The shader with the qualifiers.
    #[serde(skip)]
    pub text: String,
    /// The image of the shader as it is.
    #[serde(skip)]
    pub own: Image,
    /// The shader that rounds to 16 bits what may have 16 bits.
    #[serde(skip)]
    pub emulated: Checked,
    /// Its image.
    #[serde(skip)]
    pub image: Image,
}

/// Images of a shader in which some declarations have 16 bits.
struct Trials<'a> {
    checked: &'a Checked,
    frame: &'a Frame,
    own: Image,
    /// The image with what is accepted.
    image: Image,
    deadline: Instant,
    interrupt: &'a AtomicBool,
    is_over: bool,
}

/// Finds what may be `mediump` in a frame, until the deadline; `None` if the shader cannot be rendered in
/// time.
#[must_use]
pub fn mixed_precision(
    checked: &Checked,
    text: &str,
    frame: &Frame,
    deadline: Instant,
    interrupt: &AtomicBool,
) -> Option<MixedPrecision> {
    let own = render(checked, frame, deadline)?;
    let units = units(checked, text);
    let mut trials = Trials {
        checked,
        frame,
        image: own.clone(),
        own,
        deadline,
        interrupt,
        is_over: false,
    };
    let mut accepted = Vec::new();
    trials.bisect(&units, &mut accepted);
    let emulation = Emulation::new(checked, accepted.iter().copied());
    let count = |units: &mut dyn Iterator<Item = &Unit>| units.map(|unit| unit.names.len()).sum();
    let mut names: Vec<String> = accepted.iter().flat_map(|unit| unit.names.clone()).collect();
    names.sort();
    names.dedup();
    Some(MixedPrecision {
        names,
        found: count(&mut accepted.iter().copied()),
        tried: count(&mut units.iter()),
        operations: trials.executed(&emulation.operations),
        changed_pixels: visible_pixels(&trials.own, &trials.image),
        is_complete: !trials.is_over,
        text: qualified(text, &accepted),
        own: trials.own,
        emulated: emulation.shader(),
        image: trials.image,
    })
}

fn render(checked: &Checked, frame: &Frame, deadline: Instant) -> Option<Image> {
    let limit = deadline.saturating_duration_since(Instant::now());
    let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit)).ok()?;
    let settings = Settings::<f32> {
        undefined: UndefinedPolicy::Plain,
        deadline: Some(deadline),
        ..Settings::default()
    };
    Some(program.render(frame, &settings).ok()?.framebuffer.image())
}

impl<'a> Trials<'a> {
    /// The share of the executed operations that have 16 bits; `None` if they cannot be counted in time.
    fn executed(&self, medium: &HashSet<ExprId>) -> Option<f64> {
        let limit = self.deadline.saturating_duration_since(Instant::now());
        let program = Program::within(self.checked, limit).ok()?;
        let settings = Settings {
            deadline: Some(self.deadline),
            ..Settings::plain()
        };
        let profile = program.profile(self.frame, &settings).ok()?;
        let counts = profile
            .origins()
            .filter(|(origin, _)| origin.expr.is_some_and(|expr| medium.contains(&expr)));
        let count: u64 = counts.map(|(_, count)| count).sum();
        Some(count as f64 / profile.operations().max(1) as f64)
    }

    /// Adds the units that may have 16 bits beside those that are accepted: all, or those of each half.
    fn bisect(&mut self, units: &'a [Unit], accepted: &mut Vec<&'a Unit>) {
        if units.is_empty() {
            return;
        }
        if self.interrupt.load(Ordering::Relaxed) || Instant::now() > self.deadline {
            self.is_over = true;
            return;
        }
        let all = accepted.iter().copied().chain(units);
        let emulated = Emulation::new(self.checked, all).shader();
        let limit = MAX_SHARE * self.own.pixels().len() as f64;
        let image = render(&emulated, self.frame, self.deadline);
        let image = image.filter(|image| visible_pixels(&self.own, image) as f64 <= limit);
        if let Some(image) = image {
            self.image = image;
            accepted.extend(units);
        } else if units.len() > 1 {
            let (first, second) = units.split_at(units.len() / 2);
            self.bisect(first, accepted);
            self.bisect(second, accepted);
        }
    }
}

/// The text with `mediump` in front of the types of these declarations.
fn qualified(text: &str, units: &[&Unit]) -> String {
    let mut places: Vec<_> = units.iter().map(|unit| unit.at).collect();
    places.sort_by_key(|at| std::cmp::Reverse(at.start));
    let mut text = text.to_owned();
    for at in places {
        text.replace_range(at.start as usize..at.end as usize, "mediump ");
    }
    text
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;

    use super::*;

    fn check(text: &str) -> (Checked, Files) {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        (
            glsl::check(&files, file, &glsl::Options::default()).unwrap(),
            files,
        )
    }

    /// The color of the first pixel of a body of `mainImage`, as it is and with all declarations in 16 bits.
    fn colors(body: &str) -> [[f32; 3]; 2] {
        let text = format!(
            "float square(float x) {{ return x * x; }} void mainImage(out vec4 c, in vec2 p) {{ {body} }}"
        );
        let (checked, _) = check(&text);
        let units = units(&checked, &text);
        let emulated = Emulation::new(&checked, &units).shader();
        let frame = Frame {
            size: [1, 1],
            ..Frame::default()
        };
        [checked, emulated].map(|shader| {
            let deadline = Instant::now() + std::time::Duration::from_secs(60);
            let image = render(&shader, &frame, deadline).unwrap();
            let [r, g, b, _] = image.pixels()[0];
            [r, g, b]
        })
    }

    fn emulated(body: &str) -> [f32; 3] {
        colors(body)[1]
    }

    #[test]
    fn operations_have_the_results_of_sixteen_bits() {
        // IEEE 754 binary16: 0.1 is 0x2E66, 0.0999755859375; its square 0.009995117… is nearest to 0x211E;
        // and 2049 is between 2048 and 2050.
        assert_eq!(
            emulated("float x = 0.1; c = vec4(x, square(x), x * x, 1.0);"),
            [0.099_975_586, 0.009_994_507, 0.009_994_507]
        );
        let limits = "float x = 2048.0; x += 1.0; vec2 v = vec2(65504.0, 1.0e-8);";
        assert_eq!(
            emulated(&format!("{limits} c = vec4(x, v.x * 2.0, v.y, 1.0);")),
            [2048.0, f32::INFINITY, 0.0]
        );
        // 300² + 300² exceeds 65504, and x − 3·⌊x/3⌋ has the rounded quotient, 3.
        let steps = "vec2 v = vec2(300.0); float x = 8.9985, y = 3.0; x -= 0.0; v.x += 0.0;";
        assert_eq!(
            emulated(&format!(
                "{steps} c = vec4(length(v), mod(x, y), dot(v, v.yx) - v.x, 1.0);"
            )),
            [f32::INFINITY, 0.0, f32::INFINITY]
        );
    }

    #[test]
    fn constants_have_the_precision_of_what_they_are_combined_with() {
        // The number of 16 bits next to 0.1, times 3, is halfway between 1228/4096 and 1229/4096; 0.3 is
        // nearer to the latter.
        let values = "float x = 3.0; vec2 v = vec2(x, 0.1); v.x += 0.0;";
        assert_eq!(
            emulated(&format!(
                "{values} c = vec4(vec2(x, 0.1) * x, (x > 5.0 ? x : 0.1) * x, 1.0);"
            )),
            [9.0, 1228.0 / 4096.0, 1228.0 / 4096.0]
        );
    }

    #[test]
    fn functions_of_several_operations_compute_what_they_do_in_32_bits() {
        let values = "float x = 2.3, y = 0.7, t = 0.3; vec2 a = vec2(0.3, 0.8), b = vec2(-0.6, 0.2);
            vec3 u = vec3(0.3, 0.5, -0.7), v = vec3(0.6, -0.2, 0.4);
            vec4 q = vec4(u, 0.4), r = vec4(v, -0.3);";
        for expression in [
            "vec3(mod(x, y), mod(a, b))",
            "vec3(mod(q, r).wx, mod(v, y).z)",
            "mix(u, v, t)",
            "vec3(mix(x, y, t), mix(q, r, q).yw)",
            "smoothstep(v, u, vec3(0.1))",
            "vec3(smoothstep(0.1, y, t), smoothstep(0.1, 0.9, a))",
            "vec3(dot(a, b), dot(u, v), dot(q, r))",
            "vec3(length(a), length(u), length(q))",
            "vec3(distance(a, b), distance(u, v), distance(q, r))",
            "normalize(u) + vec3(normalize(a), normalize(q).w)",
            "faceforward(u, v, u + v) + faceforward(v, u, -u)",
            "reflect(u, v) + vec3(reflect(a, b), reflect(q, r).w)",
            "refract(normalize(u), normalize(v), 0.8) + vec3(refract(normalize(a), normalize(b), y), 0.0)",
            "cross(u, v)",
        ] {
            let [single, half] = colors(&format!("{values} c = vec4({expression}, 1.0);"));
            for (single, half) in single.into_iter().zip(half) {
                assert!((single - half).abs() < 4e-3, "{expression}: {single} {half}");
            }
            assert_ne!(single, half, "{expression}");
        }
        let total = format!("{values} c = vec4(refract(normalize(u), normalize(v.zxy), 3.0), 1.0);");
        assert_eq!(emulated(&total), [0.0; 3]);
    }

    #[test]
    fn operands_of_full_precision_keep_it() {
        let sum = emulated("float x = 1.0; c = vec4(x + p.x * 0.0002, 1.0 + 0.0002 * x, 0.0, 1.0);");
        assert_eq!(sum, [1.0 + 0.5 * 0.0002, 1.0, 0.0]);
    }

    #[test]
    fn only_what_stays_invisible_gets_mediump() {
        let text = "void mainImage(out vec4 c, in vec2 p) {
    float fine = p.x / 64.0;
    float coarse = step(32.0, p.x);
    c = vec4(fract(fine * 1000.0), coarse, coarse * 0.5, 1.0);
}";
        let (checked, _) = check(text);
        let frame = Frame {
            size: [64, 4],
            ..Frame::default()
        };
        let deadline = Instant::now() + std::time::Duration::from_secs(60);
        let found = mixed_precision(&checked, text, &frame, deadline, &AtomicBool::new(false)).unwrap();
        assert_eq!(
            (found.names, found.tried, found.changed_pixels),
            (vec!["coarse".to_owned()], 2, 0)
        );
        assert!(
            found.is_complete && found.text.contains("    mediump float coarse"),
            "{}",
            found.text
        );
        // `coarse * 0.5` is one of `p.x / 64.0`, `fine * 1000.0`, it, and `step` and `fract`, which count as
        // two.
        assert_eq!(found.operations, Some(1.0 / 7.0));
    }
}
