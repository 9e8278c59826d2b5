//! Two shaders that were compared to the bit, in a report of `compare`.

use serde::Serialize;
use toyproof_diagnostic::{Files, grouped, plural};
use toyproof_explain::equality::{FirstDifference, Origin};
use toyproof_verify::NumberType;
use toyproof_verify::debug::digits;

use crate::SourceRange;
use crate::reason::excerpt;

/// Two shaders whose bits were compared.
#[derive(Debug, Clone, Serialize)]
pub struct ComparedShaders {
    /// The first and the last frame.
    pub frames: [i32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The passes that were compared.
    pub passes: Vec<String>,
    /// The passes that only the first shader has.
    pub only_in_a: Vec<String>,
    /// The passes that only the second shader has.
    pub only_in_b: Vec<String>,
    /// The first difference; null if all bits are equal.
    pub first: Option<FirstDifferenceRecord>,
}

/// The first pixel that differs, of the first pass in the first frame.
#[derive(Debug, Clone, Serialize)]
pub struct FirstDifferenceRecord {
    frame: i32,
    pass: String,
    x: u32,
    y: u32,
    /// Red, green, blue and alpha in the first shader; null where they are not finite.
    a: [f32; 4],
    /// The same in the second shader.
    b: [f32; 4],
    /// The number of pixels of this pass and frame that differ.
    differing: u64,
    pixels: u64,
    /// Where the difference arises in the first shader; null if that was not found.
    place_in_a: Option<ShaderPlace>,
    /// Where it arises in the second shader.
    place_in_b: Option<ShaderPlace>,
}

/// A statement or expression, and its value in the pixel.
#[derive(Debug, Clone, Serialize)]
pub struct ShaderPlace {
    file: String,
    #[serde(flatten)]
    range: SourceRange,
    /// The text on one line, shortened, in backticks.
    text: String,
    /// The components; null where they are not finite.
    value: Vec<f64>,
    /// Whether the other shader does not compute this value in the pixel; else, this is the last assignment.
    is_unknown: bool,
}

impl ShaderPlace {
    fn new(origin: &Origin, files: &Files) -> Self {
        Self {
            file: files.name(origin.span).to_owned(),
            range: SourceRange::new(origin.span, files),
            text: excerpt(files.text(origin.span)),
            value: origin.value.clone(),
            is_unknown: origin.is_unknown,
        }
    }

    /// ``wave.glsl, line 3: `p.x * 7.0` is 2.5, which other.glsl does not compute``
    fn describe(&self, other: &str) -> String {
        let parts: Vec<String> = self
            .value
            .iter()
            .map(|&part| digits(part, NumberType::Single))
            .collect();
        let value = match &parts[..] {
            [only] => only.clone(),
            _ => format!("({})", parts.join(", ")),
        };
        let reason = if self.is_unknown {
            format!(", which {other} does not compute")
        } else {
            String::new()
        };
        format!(
            "{}, line {}: {} is {value}{reason}",
            self.file, self.range.line, self.text
        )
    }
}

impl FirstDifferenceRecord {
    /// Creates the record; `files` are those of the two shaders.
    #[must_use]
    pub fn new(found: &FirstDifference, files: [&Files; 2]) -> Self {
        let place = |shader: usize| {
            let origin = found.origins[shader].as_ref()?;
            Some(ShaderPlace::new(origin, files[shader]))
        };
        Self {
            frame: found.frame,
            pass: found.target.to_string(),
            x: found.pixel[0],
            y: found.pixel[1],
            a: found.colors[0],
            b: found.colors[1],
            differing: found.differing,
            pixels: found.pixels,
            place_in_a: place(0),
            place_in_b: place(1),
        }
    }
}

impl ComparedShaders {
    /// Whether all bits are equal.
    #[must_use]
    pub fn are_equal(&self) -> bool {
        self.first.is_none()
    }

    /// The lines for people; the names are those of the shaders.
    pub(super) fn lines(&self, [a, b]: [&str; 2]) -> Vec<String> {
        let [width, height] = self.size;
        let [first, last] = self.frames;
        let frames = if first == last {
            format!("frame {first}")
        } else {
            format!("frames {first} to {last}")
        };
        let passes = match &self.passes[..] {
            [_] => String::new(),
            passes => format!(" of {}", toyproof_diagnostic::all_of(passes)),
        };
        let mut lines = Vec::new();
        match &self.first {
            None => lines.push(format!(
                "{frames}{passes} {} equal to the bit in float32, at {width}×{height}",
                if first == last && self.passes.len() == 1 {
                    "is"
                } else {
                    "are"
                }
            )),
            Some(found) => {
                lines.push(format!(
                    "first difference: frame {}, {}, pixel ({}, {})",
                    found.frame, found.pass, found.x, found.y
                ));
                let color = |color: [f32; 4]| {
                    let shown = if found.pass == "Image" {
                        &color[..3]
                    } else {
                        &color[..]
                    };
                    let parts = shown
                        .iter()
                        .map(|&part| digits(f64::from(part), NumberType::Single));
                    format!("({})", parts.collect::<Vec<_>>().join(", "))
                };
                lines.push(format!("  {a}: {}", color(found.a)));
                lines.push(format!("  {b}: {}", color(found.b)));
                let places = [(&found.place_in_a, b), (&found.place_in_b, a)];
                lines.extend(
                    places
                        .into_iter()
                        .filter_map(|(place, other)| Some(place.as_ref()?.describe(other))),
                );
                lines.push(format!(
                    "{} of {} pixels of this pass {} in this frame",
                    grouped(found.differing),
                    grouped(found.pixels),
                    plural(found.differing, "differs", "differ")
                ));
            }
        }
        for (name, only) in [(a, &self.only_in_a), (b, &self.only_in_b)] {
            if !only.is_empty() {
                let passes = toyproof_diagnostic::all_of(only);
                lines.push(format!("not compared, only in {name}: {passes}"));
            }
        }
        lines
    }
}
