//! Adapts written text so that other tools can read it again: substitutes for the host that it was written
//! for.

use std::fmt::Write as _;

use toyproof_glsl::tree::{Input, InputType};

use crate::TranslateError;
use crate::backend::{Target, write_glsl};
use crate::naga_ir::ValidModule;

/// Adapts a text for glslang with Vulkan semantics, including our bindings; `None` if glslang does not
/// support the language.
///
/// GLSL ES 3.00 has neither descriptor sets nor textures apart from samplers, and 3.10 is the first version
/// that compiles to SPIR-V. For HLSL, glslang packs blocks like D3D with one exception: D3D places a scalar
/// in the last row of a preceding array, which naga pads for that.
pub fn for_glslang(target: Target, text: &str) -> Option<String> {
    match target {
        Target::Glsl => {
            let mut adapted = String::new();
            let own = unused_prefix(text);
            for line in text.lines() {
                let _ = match classify(line) {
                    Line::Version => writeln!(adapted, "#version 310 es"),
                    Line::Block(rest) => {
                        writeln!(adapted, "layout(std140, set = 0, binding = 0) uniform {rest}")
                    }
                    Line::Channel(shape, binding, name) => writeln!(
                        adapted,
                        "layout(set = 0, binding = {binding}) uniform highp texture{shape} {own}_t{binding};\n\
                         layout(set = 0, binding = {}) uniform highp sampler {own}_s{binding};\n\
                         #define {name} sampler{shape}({own}_t{binding}, {own}_s{binding})",
                        binding + 1
                    ),
                    Line::Precision | Line::Output(_) | Line::Other => {
                        writeln!(adapted, "{line}")
                    }
                };
            }
            Some(adapted)
        }
        Target::Hlsl => {
            let lines = text.lines().filter(|line| *line != "    int _pad7_0;");
            Some(lines.collect::<Vec<_>>().join("\n"))
        }
        Target::Wgsl | Target::Spirv | Target::Msl => None,
    }
}

/// Converts GLSL that was written from a lowered shader to a `ShaderToy` shader.
///
/// `ShaderToy` declares the inputs, the output and the entry point itself, so the declarations that a WebGL 2
/// host needs are replaced, line by line; everything else stays as written. A declaration that is not
/// recognized stays too, and the front end rejects it: a mistake here cannot make a wrong file a proved one.
pub fn as_shadertoy(text: &str) -> String {
    with_shadertoy_inputs(text, &Input::ALL.map(value).join(", "))
}

/// Writes a module as a `ShaderToy` shader, so that a file in a language without tools on this machine can be
/// evaluated.
///
/// # Errors
/// naga's message if it cannot write the module, or if its uniform block is not the one that
/// [`crate::backend`] documents.
pub fn shadertoy(module: &ValidModule) -> Result<String, TranslateError> {
    // The evaluator returns zeros for a level that a texture does not have.
    let module = &module.with_most_levels();
    let text = write_glsl(module)?;
    let naga = module.module();
    let mut values = Vec::new();
    for (_, global) in naga.global_variables.iter() {
        let naga::TypeInner::Struct { members, .. } = &naga.types[global.ty].inner else {
            continue;
        };
        if global.space != naga::AddressSpace::Uniform {
            continue;
        }
        for member in members {
            let mut inputs = Input::ALL.into_iter();
            let input = inputs.find(|input| input.offset() == member.offset as usize);
            values.push(value(input.ok_or_else(|| {
                TranslateError::new(format_args!("the block has no input at byte {}", member.offset))
            })?));
        }
    }
    Ok(with_shadertoy_inputs(&text, &values.join(", ")))
}

/// Replaces the interface of a WebGL 2 host by `ShaderToy`'s; `values` initializes the members of the block.
fn with_shadertoy_inputs(text: &str, values: &str) -> String {
    let own = unused_prefix(text);
    // The text has a `main`, and may have a `mainImage` that it calls.
    let mut adapted = format!("#define main {own}_main\n#define mainImage {own}_image\n");
    let mut before = String::new();
    let mut after = String::new();
    for line in text.lines() {
        let _ = match classify(line) {
            Line::Version | Line::Precision => Ok(()),
            Line::Block(rest) => {
                let member = rest.split_once('{').and_then(|(_, rest)| rest.split_once('}'));
                let member = member.map_or("", |(member, _)| member.trim());
                let (ty, name) = member.trim_end_matches(';').split_once(' ').unwrap_or_default();
                let _ = writeln!(before, "    {name} = {ty}({values});");
                writeln!(adapted, "{member}")
            }
            Line::Channel(_, binding, name) => writeln!(adapted, "#define {name} iChannel{}", binding / 2),
            Line::Output(rest) => {
                let name = rest.trim_end_matches(';').rsplit(' ').next().unwrap_or_default();
                let _ = writeln!(after, "    {own}_color = {name};");
                writeln!(adapted, "{rest}")
            }
            Line::Other => writeln!(adapted, "{line}"),
        };
    }
    let _ = writeln!(
        adapted,
        "#undef main\n#undef mainImage\n\
         void mainImage(out vec4 {own}_color, in vec2 {own}_at) {{\n{before}    {own}_main();\n{after}}}"
    );
    adapted
}

/// A prefix that does not occur in the text.
fn unused_prefix(text: &str) -> String {
    let mut prefix = "written".to_owned();
    while text.contains(&prefix) {
        prefix.push('n');
    }
    prefix
}

/// The value of a member of the uniform block in a `ShaderToy` shader.
fn value(input: Input) -> String {
    match (input.ty(), input.length()) {
        // The elements are padded.
        (InputType::Float, Some(length)) => {
            let elements: Vec<_> = (0..length)
                .map(|at| format!("vec4({}[{at}])", input.name()))
                .collect();
            format!("vec4[{length}]({})", elements.join(", "))
        }
        _ => input.name().to_owned(),
    }
}

/// The role of a line in naga's GLSL.
enum Line<'a> {
    Version,
    Precision,
    /// The uniform block, with the text after `uniform`.
    Block(&'a str),
    /// A channel: its shape, the binding of its texture, and its name.
    Channel(&'a str, u32, &'a str),
    /// The output color, with the text after the layout.
    Output(&'a str),
    Other,
}

fn classify(line: &str) -> Line<'_> {
    if line.starts_with("#version ") {
        return Line::Version;
    }
    if line.starts_with("precision ") {
        return Line::Precision;
    }
    if let Some(rest) = line.strip_prefix("layout(std140) uniform ") {
        return Line::Block(rest);
    }
    if let Some(rest) = line.strip_prefix("layout(location = 0) out ") {
        return Line::Output(rest);
    }
    let channel = || {
        let (shape, name) = line
            .strip_prefix("uniform highp sampler")?
            .strip_suffix(';')?
            .split_once(' ')?;
        let binding = name
            .strip_prefix("_group_0_binding_")?
            .strip_suffix("_fs")?
            .parse()
            .ok()?;
        Some(Line::Channel(shape, binding, name))
    };
    channel().unwrap_or(Line::Other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_become_those_of_shadertoy() {
        let text = "#version 300 es\nprecision highp float;\n\
            layout(std140) uniform B_block_0Fragment { B _group_0_binding_0_fs; };\n\
            uniform highp sampler2D _group_0_binding_5_fs;\n\
            layout(location = 0) out vec4 _fs2p_location0;\n\
            void mainImage(inout vec4 c) {}\nvoid main() {\n}\n";
        let again = as_shadertoy(text);
        for expected in [
            "B _group_0_binding_0_fs;\n",
            "#define _group_0_binding_5_fs iChannel2\n",
            "vec4 _fs2p_location0;\n",
            "void mainImage(inout vec4 c) {}",
            "    written_color = _fs2p_location0;\n",
        ] {
            assert!(again.contains(expected), "{again}");
        }
        let vulkan = for_glslang(Target::Glsl, text).unwrap();
        assert!(
            vulkan.contains("binding = 6) uniform highp sampler written_s5;"),
            "{vulkan}"
        );
        let named = as_shadertoy(&text.replace("void main()", "float written_main, writtenn;\nvoid main()"));
        assert!(named.contains("    writtennn_main();\n"), "{named}");
    }
}
