//! Files of hosts as other compilers read them: embedded in a substitute for the engine, which has our uniform
//! block.

use std::fmt::Write as _;

use toyproof_glsl::Stage;
use toyproof_glsl::tree::{Input, InputType, Scalar, Type};

use super::host::CHost;
use super::language::Language;
use crate::template::{around_shader, channel_number, fill};

impl CHost {
    /// A line of a file in the substitute for its host; `None` for lines that only the host reads.
    fn line_in_substitute(self, line: &str) -> Option<String> {
        let trimmed = line.trim();
        match self.language() {
            Language::Hlsl => {
                let is_for_host = trimmed.starts_with("#pragma") || trimmed.starts_with("#include");
                (!is_for_host).then(|| line.to_owned())
            }
            Language::Msl => Some(line.to_owned()),
            Language::Glsl => Some(match line {
                // The first version that glslang compiles to SPIR-V.
                "#version 300 es" => "#version 310 es".to_owned(),
                "layout(std140) uniform Inputs {" => {
                    "layout(std140, set = 0, binding = 0) uniform Inputs {".to_owned()
                }
                _ => channel(line).unwrap_or_else(|| line.to_owned()),
            }),
            Language::Godot => {
                let is_for_host = ["shader_type ", "render_mode ", "uniform "];
                channel(line).or_else(|| {
                    let is_for_host = is_for_host.iter().any(|word| line.starts_with(word));
                    (!is_for_host).then(|| line.to_owned())
                })
            }
        }
    }

    /// Embeds a written file in a substitute for its host, which reads our uniform block.
    #[must_use]
    pub fn hosted(self, text: &str, stage: Stage) -> HostedText {
        let upside_down = self.is_upside_down(stage);
        if self.substitute().is_empty() {
            let text = text.to_owned();
            return HostedText { text, upside_down };
        }
        let program = match (text.split_once("HLSLPROGRAM\n"), text.rsplit_once("ENDHLSL")) {
            (Some((before, _)), Some((until, _))) => &until[before.len() + "HLSLPROGRAM\n".len()..],
            _ => text,
        };
        let lines = program.lines().filter_map(|line| self.line_in_substitute(line));
        let program: String = lines.flat_map(|line| [line, "\n".to_owned()]).collect();
        let replace = |text: String, &(code, adapted): &(&str, &str)| text.replace(code, adapted);
        let program = self.adaptations().iter().fold(program, replace);
        let holds = |condition: &str| match channel_number(condition) {
            _ if condition == "image" => stage == Stage::Image,
            _ if condition == "buffer" => stage != Stage::Image,
            Some(channel) => program.contains(&format!("iChannel{channel}")),
            None => program.contains(condition),
        };
        let values = [("$block", block(self.language()))];
        let [before, after] = around_shader(self.substitute()).map(|part| fill(part, holds, &values));
        HostedText {
            text: format!("{before}{program}{after}"),
            upside_down,
        }
    }
}

/// The declaration of a channel, `uniform sampler2D iChannel0;` with Godot's hints or a precision, for Vulkan: a
/// texture and a sampler with our bindings. `None` for other lines.
fn channel(line: &str) -> Option<String> {
    let (ty, rest) = line.strip_prefix("uniform ")?.split_once(' ')?;
    let (precision, ty, rest) = if let Some(ty) = ty.strip_prefix("sampler") {
        ("", ty, rest)
    } else {
        let (sampler, rest) = rest.split_once(' ')?;
        ("highp ", sampler.strip_prefix("sampler")?, rest)
    };
    let name = rest.split([' ', ';']).next()?;
    let channel: u32 = name.strip_prefix("iChannel")?.parse().ok()?;
    let [texture, sampler] = [2 * channel + 1, 2 * channel + 2];
    Some(format!(
        "layout(set = 0, binding = {texture}) uniform {precision}texture{ty} toyproof_texture{channel};\n\
         layout(set = 0, binding = {sampler}) uniform {precision}sampler toyproof_sampler{channel};\n\
         #define {name} sampler{ty}(toyproof_texture{channel}, toyproof_sampler{channel})"
    ))
}

/// The uniform block of our host, in which a prefix distinguishes the inputs from the shader's.
fn block(language: Language) -> String {
    let mut text = match language {
        Language::Hlsl | Language::Msl | Language::Glsl => "cbuffer ToyproofFrame : register(b0) {\n",
        Language::Godot => "layout(std140, set = 0, binding = 0) uniform ToyproofFrame {\n",
    }
    .to_owned();
    for input in Input::ALL {
        // In a block, each element of an array has 16 bytes.
        let ty = match (input.ty(), input.length()) {
            (InputType::Float, Some(_)) | (InputType::Vec4, _) => Type::Vector(Scalar::Float, 4),
            (InputType::Float, None) => Type::FLOAT,
            (InputType::Int, _) => Type::INT,
            (InputType::Vec3, _) => Type::Vector(Scalar::Float, 3),
        };
        let length = input.length();
        let length = length.map_or_else(String::new, |length| format!("[{length}]"));
        let ty = language.numeric_type(ty).unwrap_or_default();
        let component = ["", ".y", ".z", ".w"][input.offset() / 4 % 4];
        let place = match language {
            Language::Hlsl | Language::Msl | Language::Glsl => {
                format!(" : packoffset(c{}{component})", input.offset() / 16)
            }
            Language::Godot => String::new(),
        };
        let _ = writeln!(text, "    {ty} toyproof_{}{length}{place};", input.name());
    }
    text + "};\n"
}

/// A file that other compilers than the host's read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HostedText {
    /// The text, with our bindings and the entry point `main`.
    pub text: String,
    /// Whether row 0 of its target is the top of the image.
    pub upside_down: bool,
}
