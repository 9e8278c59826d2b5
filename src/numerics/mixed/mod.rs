//! Which variables of a shader may be `mediump`: numbers of 16 bits, as GPUs of phones have them, before its
//! image visibly changes. Found by bisection on its declarations, as Precimonious does for C (Rubio-González
//! et al., SC 2013), on images in which 16 bits are emulated to the bit.

mod emulation;
mod unit;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::Serialize;
use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::{Frame, Image};
use toyproof_verify::compare::{PixelStatus, precision};

use self::emulation::Emulation;
use self::unit::{Unit, units};

/// The share of pixels that may visibly change.
const MAX_SHARE: f64 = 0.001;

/// What may be `mediump`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedPrecision {
    /// The names of the variables, and of the functions whose results may be.
    pub names: Vec<String>,
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
}

/// Images of a shader in which some declarations have 16 bits.
struct Trials<'a> {
    checked: &'a Checked,
    text: &'a str,
    frame: &'a Frame,
    own: Image,
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
        text,
        frame,
        own,
        deadline,
        interrupt,
        is_over: false,
    };
    let mut accepted = Vec::new();
    trials.bisect(&units, &mut accepted);
    let changed_pixels = trials.changed(&accepted).unwrap_or(0);
    let mut names: Vec<String> = accepted.iter().flat_map(|unit| unit.names.clone()).collect();
    names.sort();
    names.dedup();
    Some(MixedPrecision {
        names,
        tried: units.iter().map(|unit| unit.names.len()).sum(),
        operations: trials.executed(&accepted),
        changed_pixels,
        is_complete: !trials.is_over,
        text: qualified(text, &accepted),
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
    /// The number of pixels that visibly change; `None` if the time is over, or if the emulation does not
    /// compile.
    fn changed(&self, units: &[&Unit]) -> Option<u64> {
        let text = Emulation::new(self.checked, self.text, units.iter().copied()).text();
        let mut files = Files::default();
        let file = files.add(File::new("<mediump>", text));
        let options = glsl::Options {
            deadline: Deadline::after(self.deadline.saturating_duration_since(Instant::now())),
            ..self.checked.options()
        };
        let checked = glsl::check(&files, file, &options).ok()?;
        let image = render(&checked, self.frame, self.deadline)?;
        let undefined = vec![false; image.pixels().len()];
        let statuses = precision(&self.own, &image, &undefined);
        Some(
            statuses
                .iter()
                .filter(|status| **status == PixelStatus::Differs)
                .count() as u64,
        )
    }

    /// The share of the executed operations that have 16 bits; `None` if they cannot be counted in time.
    fn executed(&self, units: &[&Unit]) -> Option<f64> {
        let medium = Emulation::new(self.checked, self.text, units.iter().copied()).operations;
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
        let all: Vec<&Unit> = accepted.iter().copied().chain(units).collect();
        let limit = MAX_SHARE * self.own.pixels().len() as f64;
        if self.changed(&all).is_some_and(|changed| changed as f64 <= limit) {
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
    use super::*;

    fn check(text: &str) -> (Checked, Files) {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        (
            glsl::check(&files, file, &glsl::Options::default()).unwrap(),
            files,
        )
    }

    /// The color of the first pixel with all declarations in 16 bits.
    fn emulated(body: &str) -> [f32; 3] {
        let text = format!(
            "float square(float x) {{ return x * x; }} void mainImage(out vec4 c, in vec2 p) {{ {body} }}"
        );
        let (checked, _) = check(&text);
        let units = units(&checked, &text);
        let text = Emulation::new(&checked, &text, &units).text();
        let (checked, _) = check(&text);
        let frame = Frame {
            size: [1, 1],
            ..Frame::default()
        };
        let image = render(
            &checked,
            &frame,
            Instant::now() + std::time::Duration::from_secs(60),
        )
        .unwrap();
        let [r, g, b, _] = image.pixels()[0];
        [r, g, b]
    }

    #[test]
    fn operations_have_the_results_of_sixteen_bits() {
        // IEEE 754 binary16: 0.1 is 0x2E66, 0.0999755859375; its square 0.009995117… is nearest to 0x211E;
        // and 2049 is between 2048 and 2050.
        assert_eq!(
            emulated("float x = 0.1; c = vec4(x, square(x), x * x, 1.0);"),
            [0.099_975_586, 0.009_994_507, 0.009_994_507]
        );
        assert_eq!(
            emulated(
                "float x = 2048.0; x += 1.0; vec2 v = vec2(65504.0, 1.0e-8); c = vec4(x, v.x * 2.0, v.y, 1.0);"
            ),
            [2048.0, f32::INFINITY, 0.0]
        );
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
