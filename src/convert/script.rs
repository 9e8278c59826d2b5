//! The Python script that plays the passes of a project with the package `wgpu-shadertoy`.

use std::fmt::Write as _;

use toyproof_glsl::{Filter, Wrap};
use toyproof_player::Target;

use crate::graph::{HostGraph, SourceEntry};

/// The name of the script.
pub(crate) const SCRIPT_FILE: &str = "shader.py";

const HEAD: &str = "\
from pathlib import Path

from wgpu_shadertoy import BufferRenderPass, Shadertoy, ShadertoyChannelBuffer, ShadertoyChannelTexture


def code(name):
    return (Path(__file__).parent / name).read_text()


";

/// Writes the script for passes in these files.
///
/// # Errors
/// What the package does not have.
pub(crate) fn script(host_graph: &HostGraph, names: &[String]) -> Result<String, String> {
    let mut text = HEAD.to_owned();
    text += "buffers = [\n";
    let passes = host_graph.graph.passes();
    for (at, pass) in passes.iter().enumerate() {
        if let Some(what) = host_graph.missing_in_wgpu_shadertoy(at) {
            return Err(format!(
                "{what}, which the style `wgpu-shadertoy` does not have; use `--style plain`"
            ));
        }
        let inputs = inputs(host_graph, at);
        match pass.target {
            Target::Buffer(buffer) => {
                let letter = char::from(b'a' + buffer as u8);
                let _ = writeln!(
                    text,
                    "    BufferRenderPass(\n        \"{letter}\",\n        code=code(\"{}\"),\n        \
                     shader_type=\"wgsl\",\n        inputs={},\n    ),",
                    names[at],
                    indented(&inputs, "        ")
                );
            }
            Target::Image => {
                let _ = write!(
                    text,
                    "]\nshader = Shadertoy(\n    code(\"{}\"),\n    shader_type=\"wgsl\",\n    resolution=(640, 360),\n    \
                     buffers=buffers,\n    inputs={},\n)\n\nif __name__ == \"__main__\":\n    shader.show()\n",
                    names[at],
                    indented(&inputs, "    ")
                );
            }
        }
    }
    Ok(text)
}

/// The list of the channels of a pass, one a line.
fn inputs(host_graph: &HostGraph, pass: usize) -> String {
    let mut text = "[\n".to_owned();
    for channel in 0..4 {
        let input = host_graph.entry(pass, channel);
        let line = match input {
            None => "None,".to_owned(),
            Some(input) => {
                let wrap = match input.wrap {
                    Wrap::Clamp => "clamp",
                    Wrap::Repeat => "repeat",
                };
                let filter = match input.filter {
                    Filter::Nearest => "nearest",
                    Filter::Linear | Filter::Mipmap => "linear",
                };
                let sampler = format!("filter=\"{filter}\", wrap=\"{wrap}\"");
                match input.source {
                    SourceEntry::Buffer { buffer, .. } => {
                        let letter = buffer.trim_start_matches("buffer-");
                        format!("ShadertoyChannelBuffer(\"{letter}\", {sampler}),")
                    }
                    SourceEntry::Media { name, id, .. } => format!(
                        "ShadertoyChannelTexture({sampler}),  # {}: pass its array",
                        // The id is the project's, and may contain anything.
                        name.unwrap_or_else(|| id.escape_default().to_string())
                    ),
                    SourceEntry::Keyboard { .. } => {
                        format!("ShadertoyChannelTexture({sampler}),  # the keyboard")
                    }
                }
            }
        };
        let _ = writeln!(text, "    {line}");
    }
    text + "]"
}

fn indented(text: &str, by: &str) -> String {
    text.replace('\n', &format!("\n{by}"))
}
