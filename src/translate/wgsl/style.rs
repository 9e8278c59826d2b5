//! The code around a shader: entry point, bindings and direction of y for each kind of host, and stand-ins
//! for the hosts to run the result here. `docs/conversion.md` cites the hosts' documentation.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use toyproof_glsl::tree::{Direction, ExprId, ExprKind, Input, SamplerShape, Swizzle, Type, VariableKind};

use super::Unprintable;
use super::writer::{Text, Writer};
use crate::print::Order;

/// The kind of host that WGSL is written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Style {
    /// A fragment shader with our own bindings; row 0 of its target is the bottom.
    #[default]
    Plain,
    /// `shader_main` of the Python package wgpu-shadertoy.
    WgpuShadertoy,
    /// A compute shader for compute.toys.
    ComputeToys,
    /// A `Material2d` of Bevy.
    Bevy,
}

/// The members of the uniform block, with their types, offsets and sizes in bytes.
const MEMBERS: [(&str, &str, Input, u32, u32); 10] = [
    ("iResolution", "vec3f", Input::Resolution, 0, 12),
    ("iTime", "f32", Input::Time, 12, 4),
    ("iTimeDelta", "f32", Input::TimeDelta, 16, 4),
    ("iFrame", "i32", Input::Frame, 20, 4),
    ("iFrameRate", "f32", Input::FrameRate, 24, 4),
    ("iChannelTime", "array<vec4f, 4>", Input::ChannelTime, 32, 64),
    (
        "iChannelResolution",
        "array<vec3f, 4>",
        Input::ChannelResolution,
        96,
        64,
    ),
    ("iMouse", "vec4f", Input::Mouse, 160, 16),
    ("iDate", "vec4f", Input::Date, 176, 16),
    ("iSampleRate", "f32", Input::SampleRate, 192, 4),
];

// The names that the hosts and their stand-ins declare.
const PLAIN_NAMES: &str = "Inputs inputs main gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 iChannel0_sampler \
    iChannel1_sampler iChannel2_sampler iChannel3_sampler";
const WGPU_SHADERTOY_NAMES: &str = "Varyings ShadertoyInput input main shader_main gl_FragCoord i_mouse i_date i_resolution i_time \
    i_channel_resolution i_time_delta i_frame i_framerate i_channel0 i_channel1 i_channel2 \
    i_channel3 sampler0 sampler1 sampler2 sampler3 ToyproofFrame toyproof_frame";
const COMPUTE_TOYS_NAMES: &str = "main_image gl_FragCoord screen time mouse custom dispatch channel0 channel1 pass_in pass_out \
    nearest bilinear trilinear nearest_repeat bilinear_repeat trilinear_repeat Time Mouse Custom \
    DispatchInfo keyDown assert passStore passLoad passSampleLevelBilinearRepeat int uint float \
    int2 int3 int4 uint2 uint3 uint4 float2 float3 float4 bool2 bool3 bool4 float2x2 float3x3 \
    float4x4 data Data ToyproofFrame toyproof_frame toyproof_color \
    toyproof_size";
const BEVY_NAMES: &str = "view globals fragment VertexOutput gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 \
    iChannel0_sampler iChannel1_sampler iChannel2_sampler iChannel3_sampler View Globals main ToyproofFrame \
    toyproof_frame";

impl Style {
    /// Every style.
    pub const ALL: [Self; 4] = [Self::Plain, Self::WgpuShadertoy, Self::ComputeToys, Self::Bevy];

    /// The value of `--style`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::WgpuShadertoy => "wgpu-shadertoy",
            Self::ComputeToys => "compute-toys",
            Self::Bevy => "bevy",
        }
    }

    /// The names that the host or the entry point declares, which the author's items must avoid.
    pub(super) fn reserved_names(self) -> impl Iterator<Item = &'static str> {
        let code = match self {
            Self::Plain => PLAIN_NAMES,
            Self::WgpuShadertoy => WGPU_SHADERTOY_NAMES,
            Self::ComputeToys => COMPUTE_TOYS_NAMES,
            Self::Bevy => BEVY_NAMES,
        };
        code.split(' ')
    }

    /// Whether y points down in the host's coordinates, which inverts the sign of its derivatives.
    pub(super) fn is_upside_down(self) -> bool {
        self != Self::Plain
    }

    /// The name of a channel's texture.
    pub(super) fn texture(self, channel: u8) -> String {
        match self {
            Self::Plain | Self::Bevy => format!("iChannel{channel}"),
            Self::WgpuShadertoy => format!("i_channel{channel}"),
            Self::ComputeToys => format!("channel{channel}"),
        }
    }

    /// The name of a channel's sampler.
    pub(super) fn sampler(self, channel: u8) -> String {
        match self {
            Self::Plain | Self::Bevy => format!("iChannel{channel}_sampler"),
            Self::WgpuShadertoy => format!("sampler{channel}"),
            Self::ComputeToys => "bilinear_repeat".to_owned(),
        }
    }
}

impl Writer<'_> {
    /// The code that reads an input.
    pub(super) fn input(&mut self, input: Input) -> Result<String, Unprintable> {
        let missing = Err(Unprintable("an input that the host does not have"));
        let code = match self.style {
            Style::Plain => {
                let member = MEMBERS.iter().find(|member| member.2 == input);
                return member.map_or(missing, |member| Ok(format!("inputs.{}", member.0)));
            }
            Style::WgpuShadertoy => match input {
                Input::Resolution => "i_resolution",
                Input::Time => "i_time",
                Input::TimeDelta => "i_time_delta",
                Input::Frame => "i32(i_frame)",
                Input::FrameRate => "i_framerate",
                Input::Mouse => "i_mouse",
                Input::Date => "i_date",
                Input::SampleRate => "44100.0f",
                Input::ChannelTime | Input::ChannelResolution | Input::Channel(_) => return missing,
            },
            Style::ComputeToys => match input {
                Input::Resolution => "vec3f(vec2f(textureDimensions(screen)), 1.0)",
                Input::Time => "time.elapsed",
                Input::TimeDelta => "time.delta",
                Input::Frame => "i32(time.frame)",
                Input::SampleRate => "44100.0f",
                _ => return missing,
            },
            Style::Bevy => match input {
                Input::Resolution => "vec3f(view.viewport.zw, 1.0)",
                Input::Time => "globals.time",
                Input::TimeDelta => "globals.delta_time",
                Input::Frame => "i32(globals.frame_count)",
                Input::SampleRate => "44100.0f",
                _ => return missing,
            },
        };
        Ok(code.to_owned())
    }

    /// The code that reads components of the image's size, for hosts that provide only two.
    pub(super) fn resolution(&mut self, vector: ExprId, components: Swizzle) -> Option<Text> {
        let ExprKind::Variable(id) = self.cx.tree[vector].kind else {
            return None;
        };
        let is_resolution = self.cx.tree[id].kind == VariableKind::Input(Input::Resolution);
        if !is_resolution || components.components().iter().any(|&component| component > 1) {
            return None;
        }
        let name = components.name();
        let code = match (self.style, components.size()) {
            (Style::ComputeToys, 1) => format!("f32(textureDimensions(screen).{name})"),
            (Style::ComputeToys, 2) if name == "xy" => "vec2f(textureDimensions(screen))".to_owned(),
            (Style::ComputeToys, size) => format!("vec{size}f(textureDimensions(screen).{name})"),
            (Style::Bevy, _) => format!("view.viewport.{}", name.replace('x', "z").replace('y', "w")),
            _ => return None,
        };
        Some(Text::primary(code))
    }

    /// Prints the code before the author's text.
    pub(super) fn style_head(&mut self, order: &Order) -> Result<(), Unprintable> {
        let tree = &self.cx.tree;
        let mut inputs = BTreeSet::new();
        let mut channels = Vec::new();
        for &id in &order.inputs {
            match (tree[id].kind, tree[id].ty) {
                (VariableKind::Input(Input::Channel(channel)), Type::Sampler(sampler)) => {
                    channels.push((channel, sampler));
                }
                (VariableKind::Input(input), _) => {
                    inputs.extend(MEMBERS.iter().position(|member| member.2 == input));
                }
                _ => {}
            }
        }
        if self.uses_derivatives && self.style == Style::Plain {
            // GLSL allows derivatives in non-uniform control flow and leaves their values undefined. Other
            // hosts put declarations before the text, after which directives are not allowed; they use naga,
            // which does not check this.
            self.line("diagnostic(off, derivative_uniformity);");
            self.line("");
        }
        match self.style {
            Style::Plain => self.plain_head(&inputs, &channels)?,
            Style::WgpuShadertoy => {}
            Style::ComputeToys => {
                if self.uses_derivatives {
                    return Err(Unprintable("a derivative in a compute shader"));
                }
                if channels.iter().any(|&(channel, _)| channel > 1) {
                    return Err(Unprintable("a channel that the host does not have"));
                }
            }
            Style::Bevy => {
                self.line("#import bevy_sprite::mesh2d_vertex_output::VertexOutput");
                self.line("#import bevy_sprite::mesh2d_view_bindings::{globals, view}");
                self.line("");
                for &(channel, sampler) in &channels {
                    self.channel("#{MATERIAL_BIND_GROUP}", 2 * channel, channel, sampler.shape)?;
                }
            }
        }
        if self.style != Style::Plain
            && channels
                .iter()
                .any(|(_, sampler)| sampler.shape != SamplerShape::D2)
        {
            return Err(Unprintable("a texture that the host does not have"));
        }
        if self.reads_position {
            self.line("var<private> gl_FragCoord: vec4f;");
            self.line("");
        }
        Ok(())
    }

    /// Prints the members of the uniform block that are read, and the channels.
    fn plain_head(
        &mut self,
        inputs: &BTreeSet<usize>,
        channels: &[(u8, toyproof_glsl::tree::Sampler)],
    ) -> Result<(), Unprintable> {
        if !inputs.is_empty() {
            self.line("struct Inputs {");
            // The first member is always declared, to keep the offsets of the others.
            let mut members: Vec<usize> = inputs.iter().copied().collect();
            if members.first() != Some(&0) {
                members.insert(0, 0);
            }
            for (at, &member) in members.iter().enumerate() {
                let (name, ty, _, offset, size) = MEMBERS[member];
                let next = members.get(at + 1).map(|&next| MEMBERS[next].3);
                // Only members with sizes of at least 16 bytes have an alignment of 16.
                let natural = next.map(|next| {
                    let align = if matches!(next, 32 | 96 | 160 | 176) {
                        16
                    } else {
                        4
                    };
                    (offset + size).next_multiple_of(align)
                });
                let wide = if natural == next {
                    String::new()
                } else {
                    format!("@size({}) ", next.unwrap_or(0) - offset)
                };
                self.line(&format!("    {wide}{name}: {ty},"));
            }
            self.line("}");
            self.line("");
            self.line("@group(0) @binding(0) var<uniform> inputs: Inputs;");
        }
        for &(channel, sampler) in channels {
            self.channel("0", 1 + 2 * channel, channel, sampler.shape)?;
        }
        if !(inputs.is_empty() && channels.is_empty()) {
            self.line("");
        }
        Ok(())
    }

    fn channel(
        &mut self,
        group: &str,
        binding: u8,
        channel: u8,
        shape: SamplerShape,
    ) -> Result<(), Unprintable> {
        let shape = match shape {
            SamplerShape::D2 => "2d",
            SamplerShape::D3 => "3d",
            SamplerShape::Cube => "cube",
            SamplerShape::D2Array => return Err(Unprintable("an array of textures")),
        };
        let (texture, sampler) = (self.style.texture(channel), self.style.sampler(channel));
        self.line(&format!(
            "@group({group}) @binding({binding}) var {texture}: texture_{shape}<f32>;"
        ));
        self.line(&format!(
            "@group({group}) @binding({}) var {sampler}: sampler;",
            binding + 1
        ));
        Ok(())
    }

    /// Prints the entry point.
    pub(super) fn style_end(&mut self) {
        let main_image = self.function(self.cx.main_image);
        let begin = self
            .cx
            .startup_function
            .map(|begin| format!("{}();", self.function(begin)));
        let position = |writer: &mut Self, from: &str| {
            if writer.reads_position {
                writer.line(&format!("    gl_FragCoord = {from};"));
            }
        };
        self.line("");
        match self.style {
            Style::Plain => {
                self.line("@fragment");
                self.line("fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {");
                position(self, "position");
                self.body(begin, &format!("{main_image}(&color, position.xy);"));
                self.line("    return vec4f(color.xyz, 1.0);");
            }
            Style::WgpuShadertoy => {
                self.line("fn shader_main(frag_coord: vec2f) -> vec4f {");
                position(self, "vec4f(frag_coord, 0.5, 1.0)");
                self.body(begin, &format!("{main_image}(&color, frag_coord);"));
                self.line("    return vec4f(color.xyz, 1.0);");
            }
            Style::ComputeToys => {
                self.line(COMPUTE_ENTRY);
                self.line("    let size = textureDimensions(screen);");
                self.line("    if id.x >= size.x || id.y >= size.y {");
                self.line("        return;");
                self.line("    }");
                self.line("    // Row 0 is the top here, and the bottom in GLSL.");
                self.line("    let frag_coord = vec2f(f32(id.x) + 0.5, f32(size.y - id.y) - 0.5);");
                position(self, "vec4f(frag_coord, 0.5, 1.0)");
                self.body(begin, &format!("{main_image}(&color, frag_coord);"));
                self.line("    // The screen holds linear colors; ShaderToy shows its values as they are.");
                self.line(&format!("    {COMPUTE_STORE}"));
            }
            Style::Bevy => {
                self.line(BEVY_ENTRY);
                self.line("    // y points down here, and up in GLSL.");
                self.line("    let pixel = in.position.xy - view.viewport.xy;");
                self.line("    let frag_coord = vec2f(pixel.x, view.viewport.w - pixel.y);");
                position(self, "vec4f(frag_coord, in.position.zw)");
                self.body(begin, &format!("{main_image}(&color, frag_coord);"));
                self.line("    // The view takes linear colors; ShaderToy shows its values as they are.");
                self.line(&format!("    {BEVY_RETURN}"));
            }
        }
        self.line("}");
    }

    fn body(&mut self, begin: Option<String>, call: &str) {
        if let Some(begin) = begin {
            self.line(&format!("    {begin}"));
        }
        let main_image = &self.cx.tree[self.cx.main_image];
        let brings = main_image
            .parameters
            .first()
            .map(|&color| self.cx.tree[color].kind);
        self.line(match brings {
            Some(VariableKind::Parameter(Direction::InOut)) => "    var color = vec4f(0.0, 0.0, 0.0, 1.0);",
            _ => "    var color: vec4f;",
        });
        self.line(&format!("    {call}"));
    }
}

/// A complete WGSL module.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hosted {
    /// The module's text, with our bindings and the entry point `main`.
    pub text: String,
    /// Whether row 0 of its target is the top of the image.
    pub upside_down: bool,
}

/// The uniform block of our host.
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
    /// Embeds a shader printed in this style in a stand-in for its host, which reads our uniform block.
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

    /// Applies the host's preprocessor or pipeline where declarations are not sufficient.
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
const COMPUTE_ENTRY: &str =
    "@compute @workgroup_size(16, 16)\nfn main_image(@builtin(global_invocation_id) id: vec3u) {";
/// The statement that writes a pixel: the screen has linear colors, while `ShaderToy` shows values unchanged.
const COMPUTE_STORE: &str =
    "textureStore(screen, vec2i(id.xy), vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0));";
/// The entry point for Bevy.
const BEVY_ENTRY: &str = "@fragment\nfn fragment(in: VertexOutput) -> @location(0) vec4f {";
/// The statement that returns a pixel: the view's texture is `Rgba8UnormSrgb`, which takes linear colors.
const BEVY_RETURN: &str = "return vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0);";
