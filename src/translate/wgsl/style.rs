//! What surrounds a shader: entry point, bindings and direction of y, as the kind of host has them. `docs/conversion.md` says where
//! each host tells so.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use toyproof_glsl::tree::{Direction, ExprId, ExprKind, Input, SamplerShape, Swizzle, Type, VariableKind};

use super::Unprintable;
use super::host::{BEVY_ENTRY, BEVY_RETURN, COMPUTE_ENTRY, COMPUTE_STORE};
use super::text::Text;
use super::writer::Writer;
use crate::print::Order;

/// The kind of host that WGSL is for.
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

// What the hosts declare, and what stands for them (`host.rs`).
const PLAIN_WORDS: &str = "Inputs inputs main gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 iChannel0_sampler \
    iChannel1_sampler iChannel2_sampler iChannel3_sampler";
const WGPU_SHADERTOY_WORDS: &str = "Varyings ShadertoyInput input main shader_main gl_FragCoord i_mouse i_date i_resolution i_time \
    i_channel_resolution i_time_delta i_frame i_framerate i_channel0 i_channel1 i_channel2 \
    i_channel3 sampler0 sampler1 sampler2 sampler3 ToyproofFrame toyproof_frame";
const COMPUTE_TOYS_WORDS: &str = "main_image gl_FragCoord screen time mouse custom dispatch channel0 channel1 pass_in pass_out \
    nearest bilinear trilinear nearest_repeat bilinear_repeat trilinear_repeat Time Mouse Custom \
    DispatchInfo keyDown assert passStore passLoad passSampleLevelBilinearRepeat int uint float \
    int2 int3 int4 uint2 uint3 uint4 float2 float3 float4 bool2 bool3 bool4 float2x2 float3x3 \
    float4x4 data Data ToyproofFrame toyproof_frame toyproof_color \
    toyproof_size";
const BEVY_WORDS: &str = "view globals fragment VertexOutput gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 \
    iChannel0_sampler iChannel1_sampler iChannel2_sampler iChannel3_sampler View Globals main ToyproofFrame \
    toyproof_frame";

impl Style {
    /// Every style.
    pub const ALL: [Self; 4] = [Self::Plain, Self::WgpuShadertoy, Self::ComputeToys, Self::Bevy];

    /// The name that `--style` takes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::WgpuShadertoy => "wgpu-shadertoy",
            Self::ComputeToys => "compute-toys",
            Self::Bevy => "bevy",
        }
    }

    /// What the host or its frame declares, and no author's thing may be called.
    pub(super) fn words(self) -> impl Iterator<Item = &'static str> {
        let words = match self {
            Self::Plain => PLAIN_WORDS,
            Self::WgpuShadertoy => WGPU_SHADERTOY_WORDS,
            Self::ComputeToys => COMPUTE_TOYS_WORDS,
            Self::Bevy => BEVY_WORDS,
        };
        words.split(' ')
    }

    /// Whether y of the host's own coordinates points down, so that its derivatives have the other sign.
    pub(super) fn is_upside_down(self) -> bool {
        self != Self::Plain
    }

    /// A channel's texture.
    pub(super) fn texture(self, channel: u8) -> String {
        match self {
            Self::Plain | Self::Bevy => format!("iChannel{channel}"),
            Self::WgpuShadertoy => format!("i_channel{channel}"),
            Self::ComputeToys => format!("channel{channel}"),
        }
    }

    /// A channel's sampler.
    pub(super) fn sampler(self, channel: u8) -> String {
        match self {
            Self::Plain | Self::Bevy => format!("iChannel{channel}_sampler"),
            Self::WgpuShadertoy => format!("sampler{channel}"),
            Self::ComputeToys => "bilinear_repeat".to_owned(),
        }
    }
}

impl Writer<'_> {
    /// An input where it is read.
    pub(super) fn input(&mut self, input: Input) -> Result<String, Unprintable> {
        let missing = Err(Unprintable("an input that the host does not have"));
        let words = match self.style {
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
        Ok(words.to_owned())
    }

    /// Components of the picture's size, where the host has it in two numbers.
    pub(super) fn resolution(&mut self, vector: ExprId, components: Swizzle) -> Option<Text> {
        let ExprKind::Variable(id) = self.draft.tree[vector].kind else {
            return None;
        };
        let is_resolution = self.draft.tree[id].kind == VariableKind::Input(Input::Resolution);
        if !is_resolution || components.components().iter().any(|&component| component > 1) {
            return None;
        }
        let name = components.name();
        let words = match (self.style, components.size()) {
            (Style::ComputeToys, 1) => format!("f32(textureDimensions(screen).{name})"),
            (Style::ComputeToys, 2) if name == "xy" => "vec2f(textureDimensions(screen))".to_owned(),
            (Style::ComputeToys, size) => format!("vec{size}f(textureDimensions(screen).{name})"),
            (Style::Bevy, _) => format!("view.viewport.{}", name.replace('x', "z").replace('y', "w")),
            _ => return None,
        };
        Some(Text::primary(words))
    }

    /// What stands before the author's text.
    pub(super) fn style_head(&mut self, order: &Order) -> Result<(), Unprintable> {
        let tree = &self.draft.tree;
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
        if self.derives && self.style == Style::Plain {
            // GLSL allows derivatives anywhere, and leaves open what they are where control flow is not uniform. Other hosts put
            // declarations before the text, where no directive may follow; they are built on naga, which does not ask for it.
            self.line("diagnostic(off, derivative_uniformity);");
            self.line("");
        }
        match self.style {
            Style::Plain => self.plain_head(&inputs, &channels)?,
            Style::WgpuShadertoy => {}
            Style::ComputeToys => {
                if self.derives {
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

    /// The uniform block, as far as it is read, and the channels.
    fn plain_head(
        &mut self,
        inputs: &BTreeSet<usize>,
        channels: &[(u8, toyproof_glsl::tree::Sampler)],
    ) -> Result<(), Unprintable> {
        if !inputs.is_empty() {
            self.line("struct Inputs {");
            // It begins with the first, so that all others have their place.
            let mut members: Vec<usize> = inputs.iter().copied().collect();
            if members.first() != Some(&0) {
                members.insert(0, 0);
            }
            for (at, &member) in members.iter().enumerate() {
                let (name, ty, _, offset, size) = MEMBERS[member];
                let next = members.get(at + 1).map(|&next| MEMBERS[next].3);
                // Only members of 16 bytes are aligned by themselves.
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

    /// The entry point.
    pub(super) fn style_end(&mut self) {
        let main_image = self.function(self.draft.main_image);
        let begin = self
            .draft
            .begin
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
                self.line("    // The screen holds linear colours; ShaderToy shows its values as they are.");
                self.line(&format!("    {COMPUTE_STORE}"));
            }
            Style::Bevy => {
                self.line(BEVY_ENTRY);
                self.line("    // y points down here, and up in GLSL.");
                self.line("    let pixel = in.position.xy - view.viewport.xy;");
                self.line("    let frag_coord = vec2f(pixel.x, view.viewport.w - pixel.y);");
                position(self, "vec4f(frag_coord, in.position.zw)");
                self.body(begin, &format!("{main_image}(&color, frag_coord);"));
                self.line("    // The view takes linear colours; ShaderToy shows its values as they are.");
                self.line(&format!("    {BEVY_RETURN}"));
            }
        }
        self.line("}");
    }

    fn body(&mut self, begin: Option<String>, call: &str) {
        if let Some(begin) = begin {
            self.line(&format!("    {begin}"));
        }
        let main_image = &self.draft.tree[self.draft.main_image];
        let brings = main_image
            .parameters
            .first()
            .map(|&colour| self.draft.tree[colour].kind);
        self.line(match brings {
            Some(VariableKind::Parameter(Direction::InOut)) => "    var color = vec4f(0.0, 0.0, 0.0, 1.0);",
            _ => "    var color: vec4f;",
        });
        self.line(&format!("    {call}"));
    }
}
