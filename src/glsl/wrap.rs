//! ShaderToy's surroundings of a shader, as GLSL 450: the inputs before it, `main` after it.

use super::Lowered;
use crate::source::FileId;

/// The inputs. `iChannelTime` is an array of vec4 inside the block, since WGSL has no uniform arrays with a
/// stride of 4 and std140 pads it to 16 in any case.
const PRELUDE: &str = "\
#version 450 core
#define HW_PERFORMANCE 1
layout(location = 0) out vec4 toyproof_colour;
layout(std140, set = 0, binding = 0) uniform ToyproofFrame {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    vec4 toyproof_channel_time[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
#define iChannelTime float[4](toyproof_channel_time[0].x, toyproof_channel_time[1].x, \
toyproof_channel_time[2].x, toyproof_channel_time[3].x)
layout(set = 0, binding = 1) uniform texture2D toyproof_texture0;
layout(set = 0, binding = 2) uniform sampler toyproof_sampler0;
layout(set = 0, binding = 3) uniform texture2D toyproof_texture1;
layout(set = 0, binding = 4) uniform sampler toyproof_sampler1;
layout(set = 0, binding = 5) uniform texture2D toyproof_texture2;
layout(set = 0, binding = 6) uniform sampler toyproof_sampler2;
layout(set = 0, binding = 7) uniform texture2D toyproof_texture3;
layout(set = 0, binding = 8) uniform sampler toyproof_sampler3;
#define iChannel0 sampler2D(toyproof_texture0, toyproof_sampler0)
#define iChannel1 sampler2D(toyproof_texture1, toyproof_sampler1)
#define iChannel2 sampler2D(toyproof_texture2, toyproof_sampler2)
#define iChannel3 sampler2D(toyproof_texture3, toyproof_sampler3)
";

const EPILOGUE: &str = "
void main() {
    vec4 toyproof_result = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(toyproof_result, gl_FragCoord.xy);
    toyproof_colour = vec4(toyproof_result.xyz, 1.0);
}
";

/// The author's text between prelude and epilogue.
pub(super) fn wrap(author: &str, file: FileId) -> Lowered {
    let start = PRELUDE.len();
    Lowered {
        text: [PRELUDE, author, EPILOGUE].concat(),
        author: start..start + author.len(),
        file,
    }
}
