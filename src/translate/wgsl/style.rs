//! The code around a shader: entry point, bindings and direction of y for each kind of host, and substitutes
//! for the hosts to run the result here. `docs/guide/converting.md` cites the hosts' documentation.
//!
//! The code is in `styles/`, as templates.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_glsl::Stage;
use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, Input, InputType, Place, Sampler, SamplerShape, Scalar, Swizzle, Type,
    Variable, VariableId, VariableKind,
};

use super::Unprintable;
use super::writer::{Class, Text, Writer};
use crate::print::Order;
use crate::template::{around_shader, channel_number, fill};

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

// The names that the hosts and their substitutes declare.
const PLAIN_NAMES: &str = "Inputs inputs Uniforms uniforms main gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 iChannel0_sampler \
    iChannel1_sampler iChannel2_sampler iChannel3_sampler";
const WGPU_SHADERTOY_NAMES: &str = "Varyings ShadertoyInput input main shader_main gl_FragCoord i_mouse i_date i_resolution i_time \
    i_channel_resolution i_time_delta i_frame i_framerate i_channel0 i_channel1 i_channel2 \
    i_channel3 sampler0 sampler1 sampler2 sampler3 ToyproofFrame toyproof_frame";
const COMPUTE_TOYS_NAMES: &str = "main main_image gl_FragCoord screen time mouse custom dispatch channel0 channel1 pass_in pass_out \
    nearest bilinear trilinear nearest_repeat bilinear_repeat trilinear_repeat Time Mouse Custom \
    DispatchInfo keyDown assert passStore passLoad passSampleLevelBilinearRepeat int uint float \
    int2 int3 int4 uint2 uint3 uint4 float2 float3 float4 bool2 bool3 bool4 float2x2 float3x3 \
    float4x4 data Data ToyproofFrame toyproof_frame toyproof_color \
    toyproof_size shadertoy_mouse";
const BEVY_NAMES: &str = "Inputs inputs view globals fragment VertexOutput gl_FragCoord iChannel0 iChannel1 iChannel2 iChannel3 \
    iChannel0_sampler iChannel1_sampler iChannel2_sampler iChannel3_sampler View Globals main ToyproofFrame \
    toyproof_frame";

impl Style {
    /// Every style.
    pub const ALL: [Self; 4] = [Self::Plain, Self::WgpuShadertoy, Self::ComputeToys, Self::Bevy];

    /// The value of `--style`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::WgpuShadertoy => "wgpu-shadertoy",
            Self::ComputeToys => "compute-toys",
            Self::Bevy => "bevy",
        }
    }

    /// The code around a shader.
    fn template(self) -> &'static str {
        match self {
            Self::Plain => include_str!("styles/plain.wgsl"),
            Self::WgpuShadertoy => include_str!("styles/wgpu_shadertoy.wgsl"),
            Self::ComputeToys => include_str!("styles/compute_toys.wgsl"),
            Self::Bevy => include_str!("styles/bevy.wgsl"),
        }
    }

    /// The code of a substitute for the host, around the printed module; `None` if the module is complete.
    fn host_template(self) -> Option<&'static str> {
        match self {
            Self::Plain => None,
            Self::WgpuShadertoy => Some(include_str!("styles/wgpu_shadertoy_host.wgsl")),
            Self::ComputeToys => Some(include_str!("styles/compute_toys_host.wgsl")),
            Self::Bevy => Some(include_str!("styles/bevy_host.wgsl")),
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

    /// Whether y points down in the host's coordinates, which inverts the sign of its derivatives. Buffers
    /// are as in GLSL in every host that has them.
    pub(super) fn is_upside_down(self, stage: Stage) -> bool {
        self != Self::Plain && stage == Stage::Image
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
    /// The code that reads an input, which the variable `id` is.
    pub(super) fn input(&self, id: VariableId, input: Input) -> Result<String, Unprintable> {
        let name = input.name();
        if self.style.is_in_uniform_block(input) {
            return Ok(format!("inputs.{name}"));
        }
        let missing = || Err(self.not_provided(&format!("`{name}`"), self.first_use(id)));
        let code = match self.style {
            Style::Plain => return missing(),
            Style::WgpuShadertoy => match input {
                Input::Resolution => "i_resolution",
                Input::Time => "i_time",
                Input::TimeDelta => "i_time_delta",
                Input::Frame => "i32(i_frame)",
                Input::FrameRate => "i_framerate",
                Input::Mouse => "i_mouse",
                Input::Date => "i_date",
                Input::SampleRate => "44100.0f",
                Input::ChannelTime | Input::ChannelResolution => return missing(),
            },
            Style::ComputeToys => match input {
                Input::Resolution => "vec3f(vec2f(textureDimensions(screen)), 1.0)",
                Input::Time => "time.elapsed",
                Input::TimeDelta => "time.delta",
                Input::Frame => "i32(time.frame)",
                Input::Mouse => "shadertoy_mouse()",
                Input::SampleRate => "44100.0f",
                _ => return missing(),
            },
            Style::Bevy => match input {
                Input::Resolution => "vec3f(view.viewport.zw, 1.0)",
                Input::Time => "globals.time",
                Input::TimeDelta => "globals.delta_time",
                Input::Frame => "i32(globals.frame_count)",
                Input::SampleRate => "44100.0f",
                _ => return missing(),
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

    /// The code before and after the author's text.
    pub(super) fn style_code(&self, order: &Order) -> Result<[String; 2], Unprintable> {
        let tree = &self.cx.tree;
        let mut inputs = BTreeSet::new();
        let mut uniforms = BTreeSet::new();
        let mut channels = BTreeMap::new();
        for &id in &order.inputs {
            match (tree[id].kind, tree[id].ty) {
                (VariableKind::Channel(channel), Type::Sampler(sampler)) => {
                    self.check_channel(id, channel, sampler)?;
                    channels.insert(channel, sampler.shape);
                }
                (VariableKind::Input(input), _) => {
                    inputs.insert(input);
                    if self.style.is_in_uniform_block(input) {
                        uniforms.insert(input);
                    }
                }
                _ => {}
            }
        }
        self.check_derivatives()?;
        let main_image = self.cx.main_image;
        let brings = tree[main_image].parameters.first().map(|&color| tree[color].kind);
        let brings_color = brings == Some(VariableKind::Parameter(Direction::InOut));
        let holds = |condition: &str| match condition {
            // GLSL allows derivatives in non-uniform control flow and leaves their values undefined. Other
            // hosts than ours put declarations before the text, after which directives are not allowed; they
            // use naga, which does not check this.
            "derivatives" => self.uses_derivatives,
            "inputs" => !uniforms.is_empty(),
            "uniforms" => !self.uniforms.is_empty(),
            "channels" => !channels.is_empty(),
            "position" => self.reads_position,
            "startup" => self.cx.startup_function.is_some(),
            "image" => self.cx.stage == Stage::Image,
            "buffer" => self.cx.stage != Stage::Image,
            "inout" => brings_color,
            "out" => !brings_color,
            _ => match Input::ALL.into_iter().find(|input| input.name() == condition) {
                Some(input) => inputs.contains(&input),
                None => channel_number(condition).is_some_and(|channel| channels.contains_key(&channel)),
            },
        };
        let startup = self.cx.startup_function.map(|startup| self.function(startup));
        let mut values = vec![
            ("$members", self.style.members(&uniforms)),
            ("$uniforms", self.uniforms.join("\n    ")),
            ("$startup", startup.unwrap_or_default().to_owned()),
            ("$main_image", self.function(main_image).to_owned()),
        ];
        for (channel, name) in (0..).zip(["$shape0", "$shape1", "$shape2", "$shape3"]) {
            let shape = channels.get(&channel).copied().and_then(dimension);
            values.push((name, shape.unwrap_or_default().to_owned()));
        }
        Ok(around_shader(self.style.template()).map(|part| fill(part, holds, &values)))
    }

    /// Whether a variable is a uniform of the author that is read from a block, as the host has one.
    pub(super) fn is_in_block(&self, id: VariableId) -> bool {
        let variable = &self.cx.tree[id];
        let has_value = variable.kind == VariableKind::Uniform && variable.initializer.is_some();
        has_value && self.style == Style::Plain
    }

    /// The code that reads a uniform of the author. Blocks have no `bool`: 0 is `false`.
    pub(super) fn uniform(&self, id: VariableId) -> Text {
        let member = format!("uniforms.{}", self.variable(id));
        match self.cx.tree[id].ty {
            Type::Scalar(Scalar::Bool) => Text::new(format!("{member} != 0u"), Class::Relation),
            Type::Vector(Scalar::Bool, size) => {
                Text::new(format!("{member} != vec{size}u()"), Class::Relation)
            }
            _ => Text::primary(member),
        }
    }

    /// Adds a uniform of the author to the block.
    pub(super) fn add_uniform(&mut self, id: VariableId) -> Result<(), Unprintable> {
        let Variable { ty, initializer, .. } = self.cx.tree[id];
        let initializer = initializer.ok_or(Unprintable::Construct("a uniform without a value"))?;
        let value = self.value(initializer)?.code;
        let (ty, value) = match ty {
            Type::Scalar(Scalar::Bool) => ("u32".to_owned(), format!("u32({value})")),
            Type::Vector(Scalar::Bool, size) => {
                let ty = format!("vec{size}u");
                let value = format!("{ty}({value})");
                (ty, value)
            }
            _ => (self.type_name(ty), value),
        };
        self.uniforms
            .push(format!("{}: {ty},{VALUE}{value}", self.variable(id)));
        Ok(())
    }

    /// Checks that the host has a channel, with a texture of that shape.
    fn check_channel(&self, id: VariableId, channel: u8, sampler: Sampler) -> Result<(), Unprintable> {
        let name = &self.cx.tree[id].name;
        if self.style == Style::ComputeToys && channel > 1 {
            return Err(self.not_provided(&format!("`{name}`"), self.first_use(id)));
        }
        match sampler.shape {
            SamplerShape::D2 => Ok(()),
            SamplerShape::D3 | SamplerShape::Cube if self.style == Style::Plain => Ok(()),
            SamplerShape::D2Array if self.style == Style::Plain => {
                Err(Unprintable::Construct("an array texture"))
            }
            _ => {
                let what = format!("`{name}`, a `{}`,", sampler.name());
                Err(self.not_provided(&what, self.first_use(id)))
            }
        }
    }

    /// Checks that derivatives are not taken in a compute shader.
    fn check_derivatives(&self) -> Result<(), Unprintable> {
        if self.style != Style::ComputeToys || !self.uses_derivatives {
            return Ok(());
        }
        let exprs = self.cx.tree.exprs.iter();
        let calls = exprs.filter_map(|(_, expr)| match expr.kind {
            ExprKind::BuiltIn { function, .. } => Some((function, expr.at)),
            _ => None,
        });
        let call = calls
            .filter(|(function, _)| function.is_derivative() || function.is_texture())
            .min_by_key(|(function, at)| (!function.is_derivative(), at.span.start));
        let (name, at) = call.map_or(("dFdx", None), |(function, at)| (function.name(), Some(at)));
        Err(self.not_provided(&format!("`{name}`"), at))
    }

    /// The first place where a variable is used.
    fn first_use(&self, id: VariableId) -> Option<Place> {
        let exprs = self.cx.tree.exprs.iter();
        let uses = exprs.filter(|(_, expr)| matches!(expr.kind, ExprKind::Variable(used) if used == id));
        uses.map(|(_, expr)| expr.at).min_by_key(|at| at.span.start)
    }

    /// The error about a feature that the host does not provide.
    fn not_provided(&self, what: &str, at: Option<Place>) -> Unprintable {
        let style = self.style.name();
        let message = format!("{what} is not available in the style `{style}`");
        let diagnostic = Diagnostic::new(Code::UnsupportedByTarget, message);
        let diagnostic = match at {
            Some(at) => diagnostic.at(at.span),
            None => diagnostic,
        };
        Unprintable::Host(Box::new(
            diagnostic.help("use `--style plain`, which has every input and derivatives"),
        ))
    }
}

impl Style {
    /// Whether the style reads an input from a uniform block of its own.
    fn is_in_uniform_block(self, input: Input) -> bool {
        match self {
            Self::Plain => true,
            Self::WgpuShadertoy | Self::ComputeToys => false,
            Self::Bevy => matches!(
                input,
                Input::FrameRate | Input::ChannelTime | Input::ChannelResolution | Input::Mouse | Input::Date
            ),
        }
    }

    /// Declares the members of the uniform block that are read.
    fn members(self, inputs: &BTreeSet<Input>) -> String {
        let declarations = if self == Self::Plain {
            // The first member is always declared, to keep the offsets of the others.
            let mut members = inputs.clone();
            members.insert(Input::ALL[0]);
            members_at_offsets(&members)
        } else {
            inputs.iter().map(|&input| member(input)).collect()
        };
        let declarations = declarations.join("\n    ");
        if declarations.contains("@size") {
            format!("// `@size` skips inputs that the shader does not read.\n    {declarations}")
        } else {
            declarations
        }
    }
}

/// Declares an input as a member of a uniform block. Elements of arrays have a stride of 16 bytes.
fn member(input: Input) -> String {
    let name = input.name();
    let ty = match (input.ty(), input.length()) {
        (InputType::Float, None) => "f32",
        (InputType::Int, _) => "i32",
        (InputType::Vec3, _) => "vec3f",
        (InputType::Float, Some(_)) | (InputType::Vec4, _) => "vec4f",
    };
    match input.length() {
        Some(length) => format!("{name}: array<{ty}, {length}>,"),
        None => format!("{name}: {ty},"),
    }
}

/// Declares members of the uniform block at the offsets of our host.
fn members_at_offsets(inputs: &BTreeSet<Input>) -> Vec<String> {
    let following = inputs.iter().skip(1).map(Some).chain([None]);
    let declarations = inputs.iter().zip(following).map(|(input, next)| match next {
        Some(next) if (input.offset() + input.size()).next_multiple_of(next.align()) != next.offset() => {
            format!("@size({}) {}", next.offset() - input.offset(), member(*input))
        }
        _ => member(*input),
    });
    declarations.collect()
}

/// The suffix of the type of a texture.
fn dimension(shape: SamplerShape) -> Option<&'static str> {
    match shape {
        SamplerShape::D2 => Some("2d"),
        SamplerShape::D3 => Some("3d"),
        SamplerShape::Cube => Some("cube"),
        SamplerShape::D2Array => None,
    }
}

/// The block of the author's uniforms, as the template declares it.
const BLOCK: &str = "@group(0) @binding(9) var<uniform> uniforms: Uniforms;";

/// What precedes the value of a uniform behind its member of the block.
const VALUE: &str = " // ";

/// A module whose uniforms of the author have the values in the comments: our host has no block for them.
fn with_values(text: &str) -> String {
    let Some((_, block)) = text.split_once("struct Uniforms {\n") else {
        return text.to_owned();
    };
    let members = block.lines().take_while(|line| *line != "}");
    let members = members.filter(|line| !line.trim_start().starts_with("//"));
    let values = members.filter_map(|line| Some(line.split_once(VALUE)?.1));
    let values: Vec<&str> = values.collect();
    let variable = format!(
        "var<private> uniforms: Uniforms = Uniforms({});",
        values.join(", ")
    );
    text.replace(BLOCK, &variable)
}

/// A complete WGSL module.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostedShader {
    /// The module's text, with our bindings and the entry point `main`.
    pub text: String,
    /// Whether row 0 of the module's target is the top of the image.
    pub upside_down: bool,
}

/// Declares the uniform block of our host.
fn frame() -> String {
    let members = members_at_offsets(&Input::ALL.into()).join("\n    ");
    format!(
        "\nstruct ToyproofFrame {{\n    {members}\n}}\n\
         @group(0) @binding(0) var<uniform> toyproof_frame: ToyproofFrame;\n"
    )
}

impl Style {
    /// Embeds an image printed in this style in a substitute for its host, which reads our uniform block.
    pub fn hosted(self, text: &str) -> HostedShader {
        self.hosted_in(text, Stage::Image)
    }

    /// Embeds a pass printed in this style in a substitute for its host.
    pub fn hosted_in(self, text: &str, stage: Stage) -> HostedShader {
        let Some(host) = self.host_template() else {
            return HostedShader {
                text: with_values(text),
                upside_down: false,
            };
        };
        let reads = |condition: &str| match channel_number(condition) {
            Some(channel) => text.contains(&format!("{},", self.texture(channel))),
            None if condition == "image" => stage == Stage::Image,
            None if condition == "buffer" => stage != Stage::Image,
            None if self.is_in_uniform_block(Input::Mouse) => text.contains(&format!("inputs.{condition}")),
            None => text.contains("shadertoy_mouse"),
        };
        let [before, after] = around_shader(host).map(|part| fill(part, reads, &[]));
        HostedShader {
            text: format!("{}{before}{}{after}", frame(), self.adapted(text)),
            upside_down: self.is_upside_down(stage),
        }
    }

    /// Applies the host's preprocessor or pipeline where declarations are not sufficient.
    fn adapted(self, text: &str) -> String {
        let mut text = text.to_owned();
        if self == Self::Bevy {
            let lines = text.lines().filter(|line| !line.starts_with("#import"));
            text = lines.flat_map(|line| [line, "\n"]).collect();
            for binding in 0..8 {
                let bound = |group: &str, binding: u8| format!("@group({group}) @binding({binding})");
                text = text.replace(
                    &bound("#{MATERIAL_BIND_GROUP}", binding),
                    &bound("0", binding + 1),
                );
            }
        }
        let replace = |text: String, &(code, adapted): &(&str, &str)| text.replace(code, adapted);
        self.adaptations().iter().fold(text, replace)
    }

    /// Code of the style's template, and the code that does the same without the host's pipeline.
    fn adaptations(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Plain | Self::WgpuShadertoy => &[],
            Self::ComputeToys => &[
                ("textureDimensions(screen)", "toyproof_size()"),
                (
                    "@compute @workgroup_size(16, 16)\nfn main_image(@builtin(global_invocation_id) id: vec3u) {",
                    "fn main_image(id: vec3u) {",
                ),
                (
                    "textureStore(screen, vec2i(id.xy), vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0));",
                    "toyproof_color = vec4f(color.xyz, 1.0);",
                ),
            ],
            Self::Bevy => &[
                (
                    "@group(#{MATERIAL_BIND_GROUP}) @binding(8) var<uniform> inputs: Inputs;",
                    "var<private> inputs: Inputs;",
                ),
                (
                    "@fragment\nfn fragment(in: VertexOutput) -> @location(0) vec4f {",
                    "fn fragment(in: VertexOutput) -> vec4f {",
                ),
                (
                    "return vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0);",
                    "return vec4f(color.xyz, 1.0);",
                ),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn templates_have_known_conditions_and_values_only() {
        const CONDITIONS: [&str; 10] = [
            "derivatives",
            "inputs",
            "uniforms",
            "channels",
            "position",
            "startup",
            "out",
            "inout",
            "image",
            "buffer",
        ];
        const VALUES: [&str; 8] = [
            "$members",
            "$uniforms",
            "$startup",
            "$main_image",
            "$shape0",
            "$shape1",
            "$shape2",
            "$shape3",
        ];
        for style in Style::ALL {
            let template = style.template();
            let values = VALUES.map(|name| (name, String::new()));
            for text in [Some(template), style.host_template()].into_iter().flatten() {
                assert_eq!(text.matches("$shader\n").count(), 1, "{text}");
                assert!(text.lines().all(|line| line.len() <= 110), "{text}");
                for part in around_shader(text) {
                    let known = |name: &str| {
                        assert!(
                            CONDITIONS.contains(&name)
                                || Input::ALL.iter().any(|input| input.name() == name)
                                || channel_number(name).is_some_and(|number| number < 4),
                            "{name}"
                        );
                        true
                    };
                    assert!(!fill(part, known, &values).contains('$'), "{part}");
                }
            }
            for (code, _) in style.adaptations() {
                assert!(template.contains(code), "{code}");
            }
        }
    }
}
