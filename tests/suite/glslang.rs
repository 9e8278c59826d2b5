//! glslang as an independent compiler: the same shader through `glslangValidator`, with our bindings.

use std::fs;
use std::path::Path;
use std::process::Command;

/// The prelude that makes a shader's SPIR-V compatible with our bindings. No channels.
const PRELUDE: &str = "#version 310 es
precision highp float;
precision highp int;
layout(std140, set = 0, binding = 0) uniform Frame {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    float iChannelTime[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
layout(location = 0) out vec4 painted;
";

const EPILOGUE: &str = "
void main() {
    vec4 result = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(result, gl_FragCoord.xy);
    painted = vec4(result.xyz, 1.0);
}
";

/// Compiles a shader with glslang: its SPIR-V words, or the error messages.
pub(crate) fn words(shader: &str, folder: &Path) -> Result<Vec<u32>, String> {
    let (source, compiled) = (folder.join("s.frag"), folder.join("s.spv"));
    fs::write(&source, format!("{PRELUDE}{shader}{EPILOGUE}")).unwrap();
    let output = Command::new("glslangValidator")
        .args(["-V", "-S", "frag", "-o"])
        .args([&compiled, &source])
        .output()
        .unwrap();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Ok(words_of(&fs::read(&compiled).unwrap()))
}

/// The SPIR-V words of a `.spv` file.
pub(crate) fn words_of(bytes: &[u8]) -> Vec<u32> {
    bytes
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
        .collect()
}
