//! The text of an issue for the project whose fault a shader shows. It is for readers who know only that
//! project, so it says what `ShaderToy` shaders are, and how to reproduce the fault without toyproof.

use std::fmt::Write as _;

use toyproof_diagnostic::grouped;
use toyproof_image::{Frame, Input, InputType};
use toyproof_project::PROJECT_FILE;
use toyproof_translate::backend::Target;

use crate::fault::{Ending, Fault, Finding};
use crate::khronos;

/// The longest listing of SPIR-V, in lines: a longer one hides the shader.
const MAX_LISTING_LINES: usize = 300;

/// What a report says.
#[derive(Debug, Clone)]
pub struct Report<'a> {
    /// The reduced shader.
    pub shader: &'a str,
    /// The files of the reduced project, by their names; `None` for a single shader.
    pub folder: Option<&'a [(String, String)]>,
    /// The name of its file or folder.
    pub file_name: &'a str,
    /// What it shows.
    pub finding: &'a Finding,
    /// What is rendered.
    pub frame: &'a Frame,
    /// The command that shows the fault with toyproof.
    pub command: &'a str,
    /// What the user's command prints about the shader, if the fault is how it ends.
    pub output: Option<&'a str>,
    /// The GLSL 450 that naga reads, if naga is involved.
    pub lowered: Option<&'a str>,
    /// The SPIR-V that a driver gets, with the workarounds for it.
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

/// The assembly of a module, if `spirv-dis` is installed and the text is short.
fn short_assembly(module: &[u8]) -> Option<String> {
    khronos::spirv_dis(module).filter(|text| text.lines().count() <= MAX_LISTING_LINES)
}

impl Report<'_> {
    /// The report as Markdown.
    pub fn markdown(&self) -> String {
        let mut out = format!("# {}\n\n", self.title());
        let assembly = self.spirv.and_then(short_assembly);
        paragraph(&mut out, &self.summary(assembly.as_deref()));
        out.push_str("## Shader\n\n");
        match self.lowered {
            Some(lowered) => self.list_lowered(&mut out, lowered),
            None => self.list_shader(&mut out),
        }
        if let (Some(module), Some(assembly)) = (self.spirv, &assembly) {
            let writer = if self.lowered.is_some() {
                "The SPIR-V that naga writes, as the driver gets it:"
            } else {
                "The SPIR-V that the driver gets:"
            };
            paragraph(&mut out, writer);
            listing(&mut out, "spirv", assembly);
            if let Some(opinion) = khronos::spirv_val(module) {
                paragraph(&mut out, &opinion.to_string());
            }
        }
        let (expected, actual) = self.expected_and_actual();
        let _ = writeln!(out, "## Expected\n\n{expected}\n\n## Actual\n\n{actual}\n");
        let steps = self.steps(assembly.as_deref());
        let _ = writeln!(out, "## How to reproduce\n\n{steps}\n");
        self.list_versions(&mut out);
        if self.lowered.is_some() || self.spirv.is_some() {
            self.list_origin(&mut out);
        }
        out
    }

    /// The shader as naga reads it.
    fn list_lowered(&self, out: &mut String, lowered: &str) {
        paragraph(
            out,
            "This fragment shader was reduced automatically from a larger one.",
        );
        listing(out, "glsl", lowered);
        if let Some(opinion) = khronos::glslang(lowered) {
            paragraph(out, &opinion.to_string());
        }
        if matches!(self.finding.fault, Fault::Toolchain { .. }) {
            paragraph(
                out,
                "Variables without an initializer are zero in the expected image, as in WebGL. naga's writers \
                 initialize them with zero, too.",
            );
        }
    }

    /// The shader as the reducer left it.
    fn list_shader(&self, out: &mut String) {
        if let Some(files) = self.folder {
            paragraph(
                out,
                "This is a project of several passes, in GLSL ES 3.00 as shadertoy.com runs it: in each frame, the \
                 buffers render images that passes read as textures, also their own of the frame before. It was \
                 reduced automatically from a larger one.",
            );
            for (name, text) in files {
                paragraph(out, &format!("`{name}`:"));
                let language = if name == PROJECT_FILE { "toml" } else { "glsl" };
                listing(out, language, text);
            }
            return;
        }
        paragraph(
            out,
            if self.shader.contains("mainImage") {
                "This is GLSL ES 3.00 as shadertoy.com runs it: `mainImage` is called for each pixel with the \
                 coordinates of its center, and sets its color. It was reduced automatically from a larger shader."
            } else {
                "This is a complete fragment shader. It was reduced automatically from a larger one."
            },
        );
        listing(out, "glsl", self.shader);
    }

    fn list_versions(&self, out: &mut String) {
        out.push_str("## Versions\n\n");
        let mut versions = Vec::new();
        if self.lowered.is_some() || self.spirv.is_some() {
            versions.push(format!("naga {}", self.naga));
        }
        versions.extend(self.device.map(|device| format!("driver: {device}")));
        versions.push(format!("system: {}", self.system));
        versions.push(concat!("toyproof ", env!("CARGO_PKG_VERSION")).to_owned());
        if matches!(self.finding.fault, Fault::Command { .. }) {
            versions.insert(
                0,
                "the program that the command runs: (add its version)".to_owned(),
            );
        }
        for version in versions {
            let _ = writeln!(out, "- {version}");
        }
    }

    /// How the fault was found, for those who use toyproof.
    fn list_origin(&self, out: &mut String) {
        out.push_str("\n## How it was found\n\n");
        let found = format!(
            "toyproof, a tool for ShaderToy shaders, found and reduced it. With toyproof: save the shader {} as \
             `{}`, and run `{}`.",
            if self.lowered.is_some() { "below" } else { "above" },
            self.file_name,
            self.command
        );
        let found = match self.without {
            Some(_) => format!("{found} Without `--without`, toyproof works around the fault."),
            None => found,
        };
        paragraph(out, &found);
        if self.lowered.is_some() {
            listing(out, "glsl", self.shader);
        }
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
            Fault::Command { command, ending } => format!("`{}` {ending}", command.shown()),
        }
    }

    fn summary(&self, assembly: Option<&str>) -> String {
        match &self.finding.fault {
            Fault::Naga { .. } => {
                "naga's GLSL front end, its validator or one of its writers does not accept a shader that \
                 the specification allows."
                    .to_owned()
            }
            Fault::Driver { .. } => {
                "The driver does not survive a fragment shader whose SPIR-V is valid.".to_owned()
            }
            Fault::Toolchain { .. } if self.without.is_some() => format!(
                "naga's GLSL front end gives a shader another meaning: the image of its SPIR-V has other values than \
                 the specification defines. {}",
                self.differing()
            ),
            Fault::Toolchain { .. } => format!(
                "A driver renders other float32 values than IEEE 754 arithmetic gives, although all arithmetic is \
                 decorated with `NoContraction`. {} None of these pixels depends on an operation with an undefined \
                 result.{}",
                self.differing(),
                float_controls(assembly)
            ),
            Fault::Diagnostic { .. } | Fault::Verdict { .. } => {
                "toyproof's result on this shader is in question.".to_owned()
            }
            Fault::Command { .. } => "The command ends like this for the shader below.".to_owned(),
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
                        pixel.x, pixel.y, self.frame.size[0], self.frame.size[1]
                    );
                    (format!("{place}: {}", color(pixel.expected)), color(pixel.actual))
                }
                None => ("Another verdict.".to_owned(), self.finding.to_string()),
            },
            Fault::Diagnostic { .. } => (
                "The shader without this message, or another message.".to_owned(),
                quoted,
            ),
            Fault::Command { command, ending } => {
                let expected = match ending {
                    Ending::Exit(0) => "Another exit status: the command ends with 0 if there is a fault.",
                    _ => "The command ends with exit status 0.",
                };
                let actual = format!("`{}` {ending}.", command.shown());
                let output = self.output.map(str::trim_end).filter(|output| !output.is_empty());
                let actual = match output {
                    Some(output) => format!("{actual} It prints:\n\n```text\n{output}\n```"),
                    None => format!("{actual} It prints nothing."),
                };
                (expected.to_owned(), actual)
            }
        }
    }

    fn steps(&self, assembly: Option<&str>) -> String {
        if self.folder.is_some() {
            let command = match &self.finding.fault {
                Fault::Command { command, .. } => command.shown(),
                _ => self.command.to_owned(),
            };
            return format!(
                "Save the files in a folder `{}`, and run `{command}`.",
                self.file_name
            );
        }
        let translate = |extension: &str| {
            format!(
                "With naga's command line (`cargo install naga-cli`): save the shader as `shader.frag`, and \
                 run `naga --input-kind glsl --shader-stage frag shader.frag shader.{extension}`."
            )
        };
        match &self.finding.fault {
            Fault::Naga { target, .. } => translate(target.extension()),
            Fault::Toolchain { .. } if self.without.is_some() => {
                format!("{} Read the result, or {}", translate("spv"), self.draw(assembly))
            }
            Fault::Driver { .. } | Fault::Toolchain { .. } => {
                let module = match (self.spirv.map(spirv_version), assembly) {
                    (Some([major, minor]), Some(_)) => format!(
                        "Save the SPIR-V above as `shader.spvasm`, assemble it with \
                         `spirv-as --target-env spv{major}.{minor} shader.spvasm -o shader.spv`"
                    ),
                    _ => format!(
                        "Write the SPIR-V with `toyproof convert {} -o shader.spv --float strict`",
                        self.file_name
                    ),
                };
                format!("{module}, and {}", self.draw(assembly))
            }
            Fault::Command { command, .. } => format!(
                "Save the shader as `{}`, and run `{}`.",
                command.file_name(),
                command.shown()
            ),
            Fault::Diagnostic { .. } | Fault::Verdict { .. } => {
                format!(
                    "Save the shader as `{}`, and run `{}`.",
                    self.file_name, self.command
                )
            }
        }
    }

    /// How to render the image with any Vulkan program.
    fn draw(&self, assembly: Option<&str>) -> String {
        let [width, height] = self.frame.size;
        let mut text = format!(
            "draw one triangle that covers a target of {width}×{height} pixels in `R32G32B32A32_SFLOAT`, with this \
             fragment shader and any vertex shader that sets the position, with the depth 0. Read pixels back as \
             floats; row 0 is the bottom."
        );
        if assembly.is_none_or(|assembly| assembly.contains(" Binding 0\n")) {
            let inputs = nonzero_inputs(self.frame).join(", ");
            let _ = write!(
                text,
                " Binding 0 of set 0 is a uniform block of 208 bytes, zero but for these inputs: {inputs}."
            );
        }
        text
    }
}

/// What a driver may do to numbers if the module does not forbid it: Vulkan's appendix on the precision and
/// operation of SPIR-V instructions.
fn float_controls(assembly: Option<&str>) -> &'static str {
    if assembly.is_some_and(|assembly| assembly.contains("SignedZeroInfNanPreserve")) {
        return "";
    }
    " The module has no execution mode of `SPV_KHR_float_controls`, so Vulkan allows the driver to ignore the sign of \
     zero, to assume that no value is infinite or NaN, and to flush denormalized values; if the difference comes from \
     one of these, the driver is not at fault."
}

/// The major and minor version of a module, from its second word.
fn spirv_version(module: &[u8]) -> [u8; 2] {
    [6, 5].map(|byte| module.get(byte).copied().unwrap_or_default())
}

/// The inputs of a frame that are not zero, with their places in the uniform block.
fn nonzero_inputs(frame: &Frame) -> Vec<String> {
    let block = frame.block();
    let inputs = Input::ALL.into_iter().filter_map(|input| {
        let start = input.offset();
        // The elements of an array have 16 bytes each, of which the components come first.
        let elements = (0..input.length().unwrap_or(1)).map(|element| start + 16 * element);
        let values: Vec<f64> = elements
            .flat_map(|element| (0..input.ty().components()).map(move |component| element + 4 * component))
            .map(|byte| {
                let word = [block[byte], block[byte + 1], block[byte + 2], block[byte + 3]];
                match input.ty() {
                    InputType::Int => f64::from(i32::from_le_bytes(word)),
                    _ => f64::from(f32::from_le_bytes(word)),
                }
            })
            .collect();
        let shown: Vec<String> = values.iter().map(f64::to_string).collect();
        let is_zero = values.iter().all(|&value| value == 0.0);
        (!is_zero).then(|| format!("`{}` ({}) at byte {start}", input.name(), shown.join(", ")))
    });
    inputs.collect()
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

/// A color with the bits of its components. All digits are shown: the fewest that distinguish a float32 from
/// others would be another number, such as 2147483600 for 2³¹.
fn color(components: [f32; 3]) -> String {
    let shown = components.map(|component| {
        let value = f64::from(component);
        format!("{value:?} (0x{:08x})", component.to_bits())
    });
    format!("({})", shown.join(", "))
}

fn listing(out: &mut String, language: &str, text: &str) {
    let _ = writeln!(out, "```{language}\n{}\n```\n", text.trim_end());
}

fn paragraph(out: &mut String, text: &str) {
    out.push_str(text);
    out.push_str("\n\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(fault: Fault) -> Finding {
        Finding {
            fault,
            message: None,
            pixel: None,
            differing: None,
            device: None,
        }
    }

    fn report<'a>(finding: &'a Finding, frame: &'a Frame) -> Report<'a> {
        Report {
            shader: "void mainImage(out vec4 c, in vec2 p) {}\n",
            folder: None,
            file_name: "small.glsl",
            finding,
            frame,
            command: "toyproof check small.glsl --size 16x9",
            output: None,
            lowered: None,
            spirv: None,
            device: None,
            without: None,
            naga: "30.0.1",
            system: "Linux x86_64",
        }
    }

    fn assert_contains(text: &str, parts: &[&str]) {
        for part in parts {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }

    #[test]
    fn a_report_names_both_values_and_the_way_to_them() {
        let pixel = toyproof_verify::compare::Pixel {
            x: 3,
            y: 0,
            expected: [0.0, f32::NAN, 1.0],
            actual: [0.0, 0.0, 2_147_483_648.0],
        };
        let finding = Finding {
            pixel: Some(pixel),
            differing: Some([2, 144]),
            ..finding(Fault::Toolchain {
                pass: toyproof_player::Target::Image,
                is_finite: false,
            })
        };
        let frame = Frame {
            size: [16, 9],
            time: 2.5,
            ..Frame::default()
        };
        // The first words of a module of SPIR-V 1.3.
        let spirv = [0x0723_0203_u32, 0x0001_0300].map(u32::to_le_bytes).concat();
        let report = Report {
            spirv: Some(&spirv),
            device: Some("llvmpipe Mesa 22.3.6"),
            ..report(&finding, &frame)
        };
        assert_eq!(spirv_version(&spirv), [1, 3]);
        assert_contains(
            &report.markdown(),
            &[
                "# llvmpipe Mesa 22.3.6: a fragment shader",
                "2 of 144 pixels differ.",
                "no execution mode of `SPV_KHR_float_controls`",
                "Pixel (3, 0), counted from 0",
                "(0.0 (0x00000000), NaN (0x7fc00000), 1.0 (0x3f800000))",
                "2147483648.0 (0x4f000000))",
                "16×9 pixels in `R32G32B32A32_SFLOAT`",
                "`iResolution` (16, 9, 1) at byte 0, `iTime` (2.5) at byte 12, ",
                "`toyproof check small.glsl --size 16x9`",
                "- driver: llvmpipe Mesa 22.3.6\n",
            ],
        );
        let of_naga = Report {
            without: Some("short-circuit"),
            lowered: Some("#version 450\nvoid main() {}\n"),
            ..report
        };
        let text = of_naga.markdown();
        assert!(
            text.starts_with("# A valid fragment shader is translated"),
            "{text}"
        );
        assert_contains(
            &text,
            &[
                "as in WebGL",
                "Without `--without`, toyproof works around the fault.",
            ],
        );
        // naga's shader comes first; that of ShaderToy is at the end.
        let [first, last] = ["#version 450", "mainImage"].map(|part| text.find(part).unwrap());
        assert!(first < last, "{text}");
    }

    #[test]
    fn a_report_on_a_command_has_its_file_and_its_output() {
        let command = |ending| Fault::Command {
            command: crate::fault::CommandLine::new("naga {} {}.wgsl", "small.frag").unwrap(),
            ending,
        };
        let frame = Frame::default();
        let failed = finding(command(Ending::Exit(1)));
        let text = Report {
            output: Some("error: invalid\n"),
            ..report(&failed, &frame)
        }
        .markdown();
        assert_contains(
            &text,
            &[
                "# `naga small.frag small.frag.wgsl` ends with exit status 1\n",
                "## Expected\n\nThe command ends with exit status 0.",
                "It prints:\n\n```text\nerror: invalid\n```",
                "Save the shader as `small.frag`, and run `naga small.frag small.frag.wgsl`.",
            ],
        );
        // The program that the command runs need not be the naga of toyproof.
        assert!(!text.contains("naga 30.0.1"), "{text}");
        let shown = finding(command(Ending::Exit(0)));
        let text = report(&shown, &frame).markdown();
        assert_contains(&text, &["Another exit status", "It prints nothing."]);
    }
}
