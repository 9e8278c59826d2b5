//! A text that was written, as those take it who read it again: what stands for the host that it was written for.

use std::fmt::Write as _;

use super::Target;

/// A text as glslang reads it for Vulkan, our own bindings and all; nothing if glslang reads no such language.
///
/// GLSL ES 3.00 knows neither sets nor textures apart from samplers, and 3.10 is the first that may become SPIR-V. Of HLSL, glslang keeps to
/// the packing of a block but for one thing: D3D lets a scalar follow in the last row of an array, which naga fills up for that. Nor does it
/// take `(T[N])0` for an array of zeros.
#[must_use]
pub fn for_glslang(target: Target, text: &str) -> Option<String> {
    match target {
        Target::Glsl => {
            let mut adapted = String::new();
            let own = unused(text);
            for line in text.lines() {
                let _ = match part(line) {
                    Part::Version => writeln!(adapted, "#version 310 es"),
                    Part::Block(rest) => {
                        writeln!(adapted, "layout(std140, set = 0, binding = 0) uniform {rest}")
                    }
                    Part::Channel(shape, binding, name) => writeln!(
                        adapted,
                        "layout(set = 0, binding = {binding}) uniform highp texture{shape} {own}_t{binding};\n\
                         layout(set = 0, binding = {}) uniform highp sampler {own}_s{binding};\n\
                         #define {name} sampler{shape}({own}_t{binding}, {own}_s{binding})",
                        binding + 1
                    ),
                    Part::Precision | Part::Output(_) | Part::Main | Part::Other => {
                        writeln!(adapted, "{line}")
                    }
                };
            }
            Some(adapted)
        }
        Target::Hlsl => {
            let lines = text.lines().filter(|line| *line != "    int _pad7_0;");
            Some(lines.map(with_elements).collect::<Vec<_>>().join("\n"))
        }
        Target::Wgsl | Target::Spirv | Target::Msl => None,
    }
}

/// An array of more is left as it is.
const MOST_ELEMENTS: usize = 1 << 12;

/// A declaration of HLSL with its array of zeros spelled element by element.
fn with_elements(line: &str) -> String {
    let spelled = || {
        let (declared, zeros) = line.split_once(" = (")?;
        let (ty, size) = zeros.strip_suffix("])0;")?.split_once('[')?;
        let size = size.parse().ok().filter(|&size: &usize| size <= MOST_ELEMENTS)?;
        Some(format!(
            "{declared} = {{ {} }};",
            vec![format!("({ty})0"); size].join(", ")
        ))
    };
    spelled().unwrap_or_else(|| line.to_owned())
}

/// GLSL that was written, as a `ShaderToy` shader: its block and channels are `ShaderToy`'s inputs again.
#[must_use]
pub fn as_shadertoy(text: &str) -> String {
    let own = unused(text);
    // It has a `mainImage` already, that `main` calls.
    let text = text.replace("mainImage", &format!("{own}_image"));
    let mut adapted = String::new();
    let mut before = String::new();
    let mut after = String::new();
    for line in text.lines() {
        let _ = match part(line) {
            Part::Version | Part::Precision => Ok(()),
            Part::Block(rest) => {
                let member = rest.split_once('{').and_then(|(_, rest)| rest.split_once('}'));
                let member = member.map_or("", |(member, _)| member.trim());
                let name = member
                    .trim_end_matches(';')
                    .rsplit(' ')
                    .next()
                    .unwrap_or_default();
                let _ = writeln!(before, "    {name} = {BLOCK};");
                writeln!(adapted, "{member}")
            }
            Part::Channel(_, binding, name) => writeln!(adapted, "#define {name} iChannel{}", binding / 2),
            Part::Output(rest) => {
                let name = rest.trim_end_matches(';').rsplit(' ').next().unwrap_or_default();
                let _ = writeln!(after, "    {own}_color = {name};");
                writeln!(adapted, "{rest}")
            }
            Part::Main => writeln!(adapted, "void {own}_main() {{"),
            Part::Other => writeln!(adapted, "{line}"),
        };
    }
    let _ = writeln!(
        adapted,
        "void mainImage(out vec4 {own}_color, in vec2 {own}_at) {{\n{before}    {own}_main();\n{after}}}"
    );
    adapted
}

/// A word that is no part of any name in the text.
fn unused(text: &str) -> String {
    let mut word = "written".to_owned();
    while text.contains(&word) {
        word.push('n');
    }
    word
}

const BLOCK: &str = "ToyproofFrame(iResolution, iTime, iTimeDelta, iFrame, iFrameRate, \
    vec4[4](vec4(iChannelTime[0]), vec4(iChannelTime[1]), vec4(iChannelTime[2]), vec4(iChannelTime[3])), \
    iChannelResolution, iMouse, iDate, iSampleRate)";

/// What a line of naga's GLSL is to those who read it otherwise.
enum Part<'a> {
    Version,
    Precision,
    /// The uniform block; what follows `uniform`.
    Block(&'a str),
    /// A channel: its shape, the binding of its texture, and its name.
    Channel(&'a str, u32, &'a str),
    /// The colour; what follows the layout.
    Output(&'a str),
    Main,
    Other,
}

fn part(line: &str) -> Part<'_> {
    if line.starts_with("#version ") {
        return Part::Version;
    }
    if line.starts_with("precision ") {
        return Part::Precision;
    }
    if line == "void main() {" {
        return Part::Main;
    }
    if let Some(rest) = line.strip_prefix("layout(std140) uniform ") {
        return Part::Block(rest);
    }
    if let Some(rest) = line.strip_prefix("layout(location = 0) out ") {
        return Part::Output(rest);
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
        Some(Part::Channel(shape, binding, name))
    };
    channel().unwrap_or(Part::Other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_of_zeros_is_spelled_and_nothing_else() {
        assert_eq!(
            with_elements("static Ray rays[2] = (Ray[2])0;"),
            "static Ray rays[2] = { (Ray)0, (Ray)0 };"
        );
        for line in [
            "    float x = (1.0);",
            "float y[9999999] = (float[9999999])0;",
            "x = (a[2])0",
        ] {
            assert_eq!(with_elements(line), line);
        }
    }

    #[test]
    fn inputs_are_shadertoys_again() {
        let text = "#version 300 es\nprecision highp float;\n\
            layout(std140) uniform B_block_0Fragment { B _group_0_binding_0_fs; };\n\
            uniform highp sampler2D _group_0_binding_5_fs;\n\
            layout(location = 0) out vec4 _fs2p_location0;\n\
            void mainImage(inout vec4 c) {}\nvoid main() {\n}\n";
        let again = as_shadertoy(text);
        for words in [
            "B _group_0_binding_0_fs;\n",
            "#define _group_0_binding_5_fs iChannel2\n",
            "vec4 _fs2p_location0;\n",
            "void written_image(inout vec4 c) {}",
            "    written_color = _fs2p_location0;\n",
        ] {
            assert!(again.contains(words), "{again}");
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
