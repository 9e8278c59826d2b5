//! A stand-in for each kind of host: what it declares around a shader, fed from our own uniform block, so that the shader can be read
//! and run here.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::Style;

/// A whole WGSL module.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hosted {
    /// Its text; our own bindings, entry point `main`.
    pub text: String,
    /// Whether the first row of its target is the top of the picture, as hosts have it.
    pub upside_down: bool,
}

/// The block that our own host feeds.
const FRAME: &str = "
struct ToyproofFrame {
    resolution: vec3f,
    time: f32,
    time_delta: f32,
    frame: i32,
    @size(8) frame_rate: f32,
    channel_time: array<vec4f, 4>,
    channel_resolution: array<vec3f, 4>,
    mouse: vec4f,
    date: vec4f,
    sample_rate: f32,
}
@group(0) @binding(0) var<uniform> toyproof_frame: ToyproofFrame;
";

const WGPU_SHADERTOY: [&str; 2] = [
    "var<private> i_mouse: vec4f;
var<private> i_date: vec4f;
var<private> i_resolution: vec3f;
var<private> i_time: f32;
var<private> i_time_delta: f32;
var<private> i_frame: u32;
var<private> i_framerate: f32;
",
    "@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    i_mouse = toyproof_frame.mouse;
    i_date = toyproof_frame.date;
    i_resolution = toyproof_frame.resolution;
    i_time = toyproof_frame.time;
    i_time_delta = toyproof_frame.time_delta;
    i_frame = u32(toyproof_frame.frame);
    i_framerate = toyproof_frame.frame_rate;
    return shader_main(vec2f(position.x, i_resolution.y - position.y));
}
",
];

const COMPUTE_TOYS: [&str; 2] = [
    "struct Time { frame: u32, elapsed: f32, delta: f32 }
var<private> time: Time;
var<private> toyproof_color: vec4f;
fn toyproof_size() -> vec2u { return vec2u(toyproof_frame.resolution.xy); }
",
    "@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    time = Time(u32(toyproof_frame.frame), toyproof_frame.time, toyproof_frame.time_delta);
    main_image(vec3u(vec2u(position.xy), 0u));
    return toyproof_color;
}
",
];

const BEVY: [&str; 2] = [
    "struct VertexOutput { position: vec4f }
struct View { viewport: vec4f }
struct Globals { time: f32, delta_time: f32, frame_count: u32 }
var<private> view: View;
var<private> globals: Globals;
",
    "@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    view = View(vec4f(0.0, 0.0, toyproof_frame.resolution.xy));
    globals = Globals(toyproof_frame.time, toyproof_frame.time_delta, u32(toyproof_frame.frame));
    return fragment(VertexOutput(position));
}
",
];

impl Style {
    /// A shader that was printed in this style, within what stands for its host.
    #[must_use]
    pub fn hosted(self, text: &str) -> Hosted {
        let [before, after] = match self {
            Self::Plain => {
                let text = text.to_owned();
                return Hosted {
                    text,
                    upside_down: false,
                };
            }
            Self::WgpuShadertoy => WGPU_SHADERTOY,
            Self::ComputeToys => COMPUTE_TOYS,
            Self::Bevy => BEVY,
        };
        let mut channels = String::new();
        if self != Self::Bevy {
            for channel in 0..4 {
                let (texture, sampler) = (self.texture(channel), self.sampler(channel));
                if text.contains(&format!("{texture},")) {
                    let at = 1 + 2 * channel;
                    let _ = writeln!(
                        channels,
                        "@group(0) @binding({at}) var {texture}: texture_2d<f32>;"
                    );
                    if !channels.contains(&format!("var {sampler}:")) {
                        let _ = writeln!(channels, "@group(0) @binding({}) var {sampler}: sampler;", at + 1);
                    }
                }
            }
        }
        let text = format!("{FRAME}{before}{channels}{}{after}", self.adapted(text));
        Hosted {
            text,
            upside_down: true,
        }
    }

    /// What the host's own preprocessor or pipeline would make of a text, as far as it cannot be declared.
    fn adapted(self, text: &str) -> String {
        match self {
            Self::Plain | Self::WgpuShadertoy => text.to_owned(),
            Self::ComputeToys => text
                .replace("textureDimensions(screen)", "toyproof_size()")
                .replace(COMPUTE_ENTRY, "fn main_image(id: vec3u) {")
                .replace(COMPUTE_STORE, "toyproof_color = vec4f(color.xyz, 1.0);"),
            Self::Bevy => {
                let lines = text
                    .lines()
                    .filter(|line| !line.starts_with("#import"))
                    .map(|line| {
                        let bound = line.strip_prefix("@group(#{MATERIAL_BIND_GROUP}) @binding(");
                        match bound.and_then(|rest| rest.split_once(')')) {
                            Some((binding, rest)) => {
                                let binding = binding.parse::<u32>().unwrap_or(0) + 1;
                                format!("@group(0) @binding({binding}){rest}\n")
                            }
                            None => format!("{line}\n"),
                        }
                    });
                let text: String = lines.collect();
                text.replace(BEVY_ENTRY, "fn fragment(in: VertexOutput) -> vec4f {")
                    .replace(BEVY_RETURN, "return vec4f(color.xyz, 1.0);")
            }
        }
    }
}

/// The entry point for compute.toys.
pub(super) const COMPUTE_ENTRY: &str =
    "@compute @workgroup_size(16, 16)\nfn main_image(@builtin(global_invocation_id) id: vec3u) {";
/// How it writes a pixel: the screen holds linear colours, `ShaderToy` shows its values as they are.
pub(super) const COMPUTE_STORE: &str =
    "textureStore(screen, vec2i(id.xy), vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0));";
/// The entry point for Bevy.
pub(super) const BEVY_ENTRY: &str = "@fragment\nfn fragment(in: VertexOutput) -> @location(0) vec4f {";
/// How it gives a pixel: the view's texture is `Rgba8UnormSrgb`, which takes linear colours.
pub(super) const BEVY_RETURN: &str = "return vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0);";
