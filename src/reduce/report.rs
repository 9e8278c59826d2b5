//! The text of an issue for the project whose fault a shader shows. It is for readers who know only that
//! project, so it says what `ShaderToy` shaders are, and how to reproduce the fault without toyproof.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use toyproof_diagnostic::grouped;
use toyproof_translate::backend::Target;

use crate::fault::{Fault, Finding};

/// The longest listing of code that naga or a driver gets, in lines: a longer one hides the shader.
const MAX_LISTING_LINES: usize = 300;

/// What a report says.
#[derive(Debug, Clone)]
pub struct Report<'a> {
    /// The reduced shader.
    pub shader: &'a str,
    /// The name of its file.
    pub file_name: &'a str,
    /// What it shows.
    pub finding: &'a Finding,
    /// The size of the image in pixels.
    pub size: [u32; 2],
    /// The command that shows the fault with toyproof.
    pub command: &'a str,
    /// The GLSL 450 that naga reads, if naga is involved.
    pub lowered: Option<&'a str>,
    /// The SPIR-V that a driver gets.
    pub spirv: Option<&'a [u8]>,
    /// The driver's name and version.
    pub device: Option<&'a str>,
    /// toyproof's workaround for a fault of naga that was left out, so that naga is at fault.
    pub without: Option<&'a str>,
    /// The version of naga.
    pub naga: &'a str,
    /// The operating system.
    pub system: &'a str,
}

impl Report<'_> {
    /// The report as Markdown.
    pub fn markdown(&self) -> String {
        let mut out = format!("# {}\n\n", self.title());
        let paragraph = |out: &mut String, text: &str| {
            out.push_str(text);
            out.push_str("\n\n");
        };
        paragraph(&mut out, &self.summary());
        out.push_str("## Shader\n\n");
        paragraph(
            &mut out,
            if self.shader.contains("mainImage") {
                "This is GLSL ES 3.00 as shadertoy.com runs it: `mainImage` is called for each pixel with the \
                 coordinates of its center, and sets its color. It was reduced automatically from a larger shader."
            } else {
                "This is a complete fragment shader. It was reduced automatically from a larger one."
            },
        );
        listing(&mut out, "glsl", self.shader);
        if let Some(lowered) = self
            .lowered
            .filter(|text| text.lines().count() <= MAX_LISTING_LINES)
        {
            paragraph(
                &mut out,
                "toyproof lowers it to this GLSL 4.50, which naga's front end reads:",
            );
            listing(&mut out, "glsl", lowered);
        }
        if let Some(assembly) = self.spirv.and_then(disassembled) {
            paragraph(&mut out, "The SPIR-V that the driver gets:");
            listing(&mut out, "spirv", &assembly);
        }
        let (expected, actual) = self.expected_and_actual();
        let _ = writeln!(out, "## Expected\n\n{expected}\n\n## Actual\n\n{actual}\n");
        let _ = writeln!(out, "## How to reproduce\n\n{}\n", self.steps());
        out.push_str("## Versions\n\n");
        let toyproof = concat!("toyproof ", env!("CARGO_PKG_VERSION"));
        let mut versions = vec![toyproof.to_owned(), format!("naga {}", self.naga)];
        versions.extend(self.device.map(|device| format!("driver: {device}")));
        versions.push(format!("system: {}", self.system));
        for version in versions {
            let _ = writeln!(out, "- {version}");
        }
        out
    }

    fn title(&self) -> String {
        let message = self.finding.message.as_deref().unwrap_or_default();
        let message = message
            .lines()
            .find(|line| !line.trim().is_empty())
            .unwrap_or_default()
            .trim();
        match &self.finding.fault {
            Fault::Naga { target, .. } => format!(
                "A valid fragment shader is not translated to {}: {message}",
                language(*target)
            ),
            Fault::Driver { .. } => format!("{}: {message}", self.device.unwrap_or("Vulkan driver")),
            Fault::Toolchain { .. } if self.without.is_some() => {
                "A valid fragment shader is translated to SPIR-V that renders wrong values".to_owned()
            }
            Fault::Toolchain { .. } => format!(
                "{}: a fragment shader with `NoContraction` renders wrong values",
                self.device.unwrap_or("Vulkan driver")
            ),
            Fault::Diagnostic { code, .. } => format!("{code}: {message}"),
            Fault::Verdict { verdict, .. } => format!("The verdict on a shader is `{verdict}`"),
            Fault::Command { command, ending } => format!("`{command}` {ending}"),
        }
    }

    fn summary(&self) -> String {
        match &self.finding.fault {
            Fault::Naga { .. } => {
                "naga's GLSL front end, its validator or one of its writers does not accept a shader that \
                 the specification allows. It was found with toyproof, a tool for ShaderToy shaders, which gives \
                 them to naga as GLSL 4.50."
                    .to_owned()
            }
            Fault::Driver { .. } => {
                "The driver does not survive a fragment shader whose SPIR-V is valid.".to_owned()
            }
            Fault::Toolchain { .. } if self.without.is_some() => format!(
                "naga's GLSL front end gives a shader another meaning: the image of its SPIR-V has other values than \
                 the specification defines. {} It was found with toyproof, a tool for ShaderToy shaders, which gives \
                 them to naga as GLSL 4.50.",
                self.differing()
            ),
            Fault::Toolchain { .. } => format!(
                "A driver renders other float32 values than IEEE 754 arithmetic gives, although all arithmetic is \
                 decorated with `NoContraction`. {} None of these pixels depends on an operation with an undefined \
                 result.",
                self.differing()
            ),
            Fault::Diagnostic { .. } | Fault::Verdict { .. } => {
                "toyproof's result on this shader is in question.".to_owned()
            }
            Fault::Command { .. } => "The command ends like this for the following shader.".to_owned(),
        }
    }

    fn differing(&self) -> String {
        let differing = self.finding.differing;
        differing.map_or_else(String::new, |[differing, pixels]| {
            format!("{} of {} pixels differ.", grouped(differing), grouped(pixels))
        })
    }

    fn expected_and_actual(&self) -> (String, String) {
        let message = self.finding.message.as_deref().unwrap_or_default();
        let quoted = format!("```text\n{}\n```", message.trim_end());
        match &self.finding.fault {
            Fault::Naga { target, .. } => (format!("naga writes {}.", language(*target)), quoted),
            Fault::Driver { .. } => ("The driver renders an image.".to_owned(), quoted),
            Fault::Toolchain { .. } | Fault::Verdict { .. } => match &self.finding.pixel {
                Some(pixel) => {
                    let place = format!(
                        "Pixel ({}, {}), counted from 0 from the left and from the bottom, of {}×{} pixels",
                        pixel.x, pixel.y, self.size[0], self.size[1]
                    );
                    (format!("{place}: {}", color(pixel.expected)), color(pixel.actual))
                }
                None => ("Another verdict.".to_owned(), self.finding.to_string()),
            },
            Fault::Diagnostic { .. } => (
                "The shader without this message, or another message.".to_owned(),
                quoted,
            ),
            Fault::Command { ending, .. } => ("The command succeeds.".to_owned(), format!("It {ending}.")),
        }
    }

    fn steps(&self) -> String {
        let [width, height] = self.size;
        let own = format!(
            "With toyproof: save the shader as `{}`, and run `{}`.",
            self.file_name, self.command
        );
        let own = match self.without {
            Some(_) => format!("{own} Without `--without`, toyproof works around the fault."),
            None => own,
        };
        let draw = format!(
            "draw one triangle that covers a target of {width}×{height} pixels in `R32G32B32A32_SFLOAT`, with this \
             fragment shader and any vertex shader that sets the position. Binding 0 of set 0 is a uniform block with \
             zeros but for `iResolution`, which is ({width}, {height}, 1). Read pixels back as floats; row 0 is the \
             bottom."
        );
        let translate = |extension: &str| {
            format!(
                "With naga's command line (`cargo install naga-cli`): save the GLSL 4.50 above as `shader.frag`, and \
                 run `naga --input-kind glsl --shader-stage frag shader.frag shader.{extension}`."
            )
        };
        match &self.finding.fault {
            Fault::Naga { target, .. } => format!("{}\n\n{own}", translate(target.extension())),
            Fault::Toolchain { .. } if self.without.is_some() => {
                format!("{} Read the result, or {draw}\n\n{own}", translate("spv"))
            }
            Fault::Driver { .. } | Fault::Toolchain { .. } => {
                format!("Without toyproof: assemble the SPIR-V above with `spirv-as`, and {draw}\n\n{own}")
            }
            Fault::Command { command, .. } => {
                format!("Save the shader as a file, and run `{command}` on it.")
            }
            Fault::Diagnostic { .. } | Fault::Verdict { .. } => own,
        }
    }
}

/// A language, as its users write it.
pub(crate) fn language(target: Target) -> &'static str {
    match target {
        Target::Wgsl => "WGSL",
        Target::Spirv => "SPIR-V",
        Target::Msl => "MSL",
        Target::Hlsl => "HLSL",
        Target::Glsl => "GLSL ES",
    }
}

/// A color with the bits of its components.
fn color(components: [f32; 3]) -> String {
    let shown = components.map(|component| format!("{component:?} (0x{:08x})", component.to_bits()));
    format!("({})", shown.join(", "))
}

fn listing(out: &mut String, language: &str, text: &str) {
    let _ = writeln!(out, "```{language}\n{}\n```\n", text.trim_end());
}

/// SPIR-V as assembly, if `spirv-dis` is installed and the text is short.
fn disassembled(words: &[u8]) -> Option<String> {
    let mut file = tempfile::NamedTempFile::new().ok()?;
    file.write_all(words).ok()?;
    let output = Command::new("spirv-dis")
        .arg("--no-color")
        .arg(file.path())
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let is_short = text.lines().count() <= MAX_LISTING_LINES;
    (output.status.success() && is_short).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_names_both_values_and_the_way_to_them() {
        let pixel = toyproof_verify::compare::Pixel {
            x: 3,
            y: 0,
            expected: [0.0, f32::NAN, 1.0],
            actual: [0.0, 0.0, 1.0],
        };
        let finding = Finding {
            fault: Fault::Toolchain { is_finite: false },
            message: None,
            pixel: Some(pixel),
            differing: Some([2, 144]),
            device: None,
        };
        let report = Report {
            shader: "void mainImage(out vec4 c, in vec2 p) {}\n",
            file_name: "small.glsl",
            finding: &finding,
            size: [16, 9],
            command: "toyproof check small.glsl --size 16x9",
            lowered: None,
            spirv: None,
            device: Some("llvmpipe Mesa 22.3.6"),
            without: None,
            naga: "30.0.1",
            system: "Linux x86_64",
        };
        let text = report.markdown();
        for part in [
            "# llvmpipe Mesa 22.3.6: a fragment shader",
            "2 of 144 pixels differ.",
            "Pixel (3, 0), counted from 0",
            "(0.0 (0x00000000), NaN (0x7fc00000), 1.0 (0x3f800000))",
            "16×9 pixels in `R32G32B32A32_SFLOAT`",
            "`toyproof check small.glsl --size 16x9`",
            "- driver: llvmpipe Mesa 22.3.6\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        let of_naga = Report {
            without: Some("short-circuit"),
            ..report
        };
        assert!(
            of_naga
                .markdown()
                .starts_with("# A valid fragment shader is translated")
        );
    }
}
