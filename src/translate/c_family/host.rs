//! The hosts: a row of the table for each, with the template of the code around a shader. The conditions in a
//! template name the inputs that the host has.
//!
//! A host whose files only its engine completes has a second template: a substitute for the engine, so that
//! other compilers read the written code.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_glsl::tree::{
    Direction, ExprKind, Input, Item, Place, SamplerShape, Type, VariableId, VariableKind,
};
use toyproof_glsl::{Filter, Sampling, Stage, Wrap};

use super::language::Language;
use super::writer::{PrintResult, Writer};
use super::{Title, Unprintable};
use crate::backend::Target;
use crate::lower::UPWARD;
use crate::print::{Order, wrap};
use crate::template::{around_shader, channel_number, fill};

/// A host of a language with the syntax of C.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CHost {
    /// HLSL with our own bindings; row 0 of the target is the bottom.
    Hlsl,
    /// A module of Slang with our own bindings.
    Slang,
    /// A shader of Unity in `ShaderLab`, for the built-in pipeline and URP.
    Unity,
    /// A pixel shader of Windows Terminal.
    WindowsTerminal,
    /// A shader of Godot 4 for a `CanvasItem`.
    Godot,
    /// GLSL ES 3.00 with our own bindings; row 0 of the target is the bottom.
    Glsl,
    /// Metal with our own bindings; row 0 of the target is the bottom.
    Metal,
}

/// A row of the table.
struct Row {
    /// The value of `--style`.
    name: &'static str,
    /// The name for people.
    title: &'static str,
    language: Language,
    /// The extension of its files, without the dot.
    extension: &'static str,
    /// The code around a shader.
    template: &'static str,
    /// The code around the file in a substitute for the host; empty if the file is complete.
    substitute: &'static str,
    /// Code of the file, and the code that does the same in the substitute.
    adaptations: &'static [(&'static str, &'static str)],
    /// The names that the template and the host declare, other than those of inputs and channels.
    declared: &'static str,
    /// Whether y points down in the host's coordinates, which inverts the sign of its derivatives.
    is_upside_down: bool,
}

impl CHost {
    /// Every host.
    pub const ALL: [Self; 7] = [
        Self::Hlsl,
        Self::Slang,
        Self::Unity,
        Self::WindowsTerminal,
        Self::Godot,
        Self::Glsl,
        Self::Metal,
    ];

    #[expect(clippy::too_many_lines, reason = "a table")]
    fn row(self) -> Row {
        match self {
            Self::Hlsl => Row {
                name: "plain",
                title: "HLSL",
                language: Language::Hlsl,
                extension: "hlsl",
                template: include_str!("hosts/plain.hlsl"),
                substitute: "",
                adaptations: &[],
                declared: "Inputs gl_FragCoord",
                is_upside_down: false,
            },
            Self::Slang => Row {
                name: "slang",
                title: "Slang",
                language: Language::Hlsl,
                extension: "slang",
                template: include_str!("hosts/plain.slang"),
                substitute: "$shader\n",
                adaptations: &[
                    (
                        "[[vk::binding(0, 0)]] cbuffer Inputs {",
                        "cbuffer Inputs : register(b0) {",
                    ),
                    ("[shader(\"fragment\")]\n", ""),
                ],
                declared: "Inputs gl_FragCoord",
                is_upside_down: false,
            },
            Self::Unity => Row {
                name: "unity",
                title: "Unity",
                language: Language::Hlsl,
                extension: "shader",
                template: include_str!("hosts/unity.shader"),
                substitute: include_str!("hosts/unity_substitute.hlsl"),
                adaptations: &[
                    ("input.uv * iResolution.xy", "input.uv"),
                    ("int iFrame;", ""),
                    ("float4 iMouse;", ""),
                    ("float4 iDate;", ""),
                    (" iChannel0;", " iChannel0 : register(t1);"),
                    (" iChannel1;", " iChannel1 : register(t3);"),
                    (" iChannel2;", " iChannel2 : register(t5);"),
                    (" iChannel3;", " iChannel3 : register(t7);"),
                    ("iChannel0_state;", "iChannel0_state : register(s2);"),
                    ("iChannel1_state;", "iChannel1_state : register(s4);"),
                    ("iChannel2_state;", "iChannel2_state : register(s6);"),
                    ("iChannel3_state;", "iChannel3_state : register(s8);"),
                    (" sampleriChannel0;", " sampleriChannel0 : register(s2);"),
                    (" sampleriChannel1;", " sampleriChannel1 : register(s4);"),
                    (" sampleriChannel2;", " sampleriChannel2 : register(s6);"),
                    (" sampleriChannel3;", " sampleriChannel3 : register(s8);"),
                    ("float4 outputSize;", ""),
                    ("float4 iChannel0_TexelSize;", ""),
                    ("float4 iChannel1_TexelSize;", ""),
                    ("float4 iChannel2_TexelSize;", ""),
                    ("float4 iChannel3_TexelSize;", ""),
                ],
                declared: "vertex fragment Varyings appdata_base appdata_tan appdata_full appdata_img v2f_img \
                    v2f_vertex_lit Luminance LinearRgbToLuminance GammaToLinearSpace \
                    GammaToLinearSpaceExact LinearToGammaSpace LinearToGammaSpaceExact LinearEyeDepth Linear01Depth \
                    EncodeFloatRGBA DecodeFloatRGBA EncodeFloatRG DecodeFloatRG DecodeHDR DecodeLightmap \
                    UnpackNormal ParallaxOffset Shade4PointLights ShadeSH9 SampleSH fixed fixed2 fixed3 fixed4 \
                    sampleriChannel0 sampleriChannel1 sampleriChannel2 sampleriChannel3 upward outputSize",
                is_upside_down: true,
            },
            Self::WindowsTerminal => Row {
                name: "windows-terminal",
                title: "Windows Terminal",
                language: Language::Hlsl,
                extension: "hlsl",
                template: include_str!("hosts/windows_terminal.hlsl"),
                substitute: "$block\n$shader\n",
                adaptations: &[
                    (
                        TERMINALS_BLOCK,
                        "#define Resolution toyproof_iResolution.xy\n#define Time toyproof_iTime\n",
                    ),
                    ("iTimeDelta (1.0 / 60.0)", "iTimeDelta toyproof_iTimeDelta"),
                    ("iFrame int(Time * 60.0)", "iFrame toyproof_iFrame"),
                    ("iFrameRate 60.0", "iFrameRate toyproof_iFrameRate"),
                    ("iMouse float4(0.0, 0.0, 0.0, 0.0)", "iMouse toyproof_iMouse"),
                    (", float2 uv : TEXCOORD0) : SV_Target {", ") : SV_Target0 {"),
                    ("    float4 text = shaderTexture.Sample(samplerState, uv);\n", ""),
                    ("lerp(color.xyz, text.xyz, text.w)", "color.xyz"),
                ],
                declared: "upward shaderTexture samplerState PixelShaderSettings Time Scale Resolution Background",
                is_upside_down: true,
            },
            Self::Godot => Row {
                name: "godot",
                title: "Godot",
                language: Language::Godot,
                extension: "gdshader",
                template: include_str!("hosts/godot.gdshader"),
                substitute: include_str!("hosts/godot_substitute.glsl"),
                adaptations: &[],
                declared: "",
                is_upside_down: true,
            },
            Self::Glsl => Row {
                name: "plain",
                title: "GLSL ES",
                language: Language::Glsl,
                extension: "frag",
                template: include_str!("hosts/plain.frag"),
                substitute: include_str!("hosts/plain_substitute.frag"),
                adaptations: &[],
                declared: "Inputs main",
                is_upside_down: false,
            },
            Self::Metal => Row {
                name: "plain",
                title: "Metal",
                language: Language::Msl,
                extension: "metal",
                template: include_str!("hosts/plain.metal"),
                substitute: "",
                adaptations: &[],
                declared: "Inputs Shader main_ gl_FragCoord",
                is_upside_down: false,
            },
        }
    }

    /// The value of `--style`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The name for people.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.row().title
    }

    pub(super) fn language(self) -> Language {
        self.row().language
    }

    /// The language as which other compilers than the host's read a file ([`Self::hosted`]); `None` if only
    /// the host's does.
    #[must_use]
    pub fn read_as(self) -> Option<Target> {
        match self.language() {
            Language::Hlsl => Some(Target::Hlsl),
            Language::Godot | Language::Glsl => Some(Target::Glsl),
            Language::Msl => None,
        }
    }

    /// Whether it has the bindings of the other languages, so that naga can write what our own writer cannot.
    #[must_use]
    pub fn is_plain(self) -> bool {
        matches!(self, Self::Hlsl | Self::Metal | Self::Glsl)
    }

    /// The extension of its files, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        self.row().extension
    }

    /// Whether its passes are described by a graph, as those of our own bindings are.
    #[must_use]
    pub fn has_passes(self) -> bool {
        self != Self::WindowsTerminal
    }

    /// Whether y points down in the host's coordinates. Buffers are as in GLSL in every host that has them.
    pub(super) fn is_upside_down(self, stage: Stage) -> bool {
        self.row().is_upside_down && stage == Stage::Image
    }

    /// Whether derivatives along y must be multiplied by the direction of y in the target. What Unity renders
    /// to a texture is upside down in some graphics APIs.
    pub(super) fn orients_derivatives(self, stage: Stage) -> bool {
        self.is_upside_down(stage) || self == Self::Unity
    }

    /// The names that the code around a shader declares.
    pub(super) fn declared_words(self) -> Vec<&'static str> {
        const CHANNELS: [&str; 8] = [
            "iChannel0",
            "iChannel1",
            "iChannel2",
            "iChannel3",
            "iChannel0_sampler",
            "iChannel1_sampler",
            "iChannel2_sampler",
            "iChannel3_sampler",
        ];
        // What is passed to functions is declared by them.
        let is_global = |input: &&Input| {
            !self.language().passes_globals()
                || !matches!(input, Input::Resolution | Input::ChannelResolution)
        };
        let inputs = Input::ALL.iter().filter(is_global).map(|input| input.name());
        let own = self.row().declared.split(' ');
        own.chain(inputs).chain(CHANNELS).collect()
    }

    /// The code around a shader.
    pub(super) fn template(self) -> &'static str {
        self.row().template
    }

    /// The code around the file in a substitute for the host; empty if the file is complete.
    pub(super) fn substitute(self) -> &'static str {
        self.row().substitute
    }

    /// Code of the file, and the code that does the same in the substitute for the host.
    pub(super) fn adaptations(self) -> &'static [(&'static str, &'static str)] {
        self.row().adaptations
    }

    /// Whether the template has a line for a condition.
    fn knows(self, condition: &str) -> bool {
        let lines = self.template().lines();
        let mut conditions = lines
            .filter_map(|line| Some(line.split_once("//?")?.1))
            .flat_map(|conditions| conditions.split([' ', '&']));
        conditions.any(|known| known == condition)
            || self.template().contains(&format!("#define {condition} "))
    }
}

/// The names of the variables of an entry point, as templates name them.
const LOCALS: [(&str, &str); 6] = [
    ("$size", "size"),
    ("$coordinates", "fragCoord"),
    ("$position", "position"),
    ("$upward", UPWARD),
    ("$color", "color"),
    ("$output", "outputColor"),
];

/// What Windows Terminal declares.
const TERMINALS_BLOCK: &str = "\
Texture2D shaderTexture : register(t0);
SamplerState samplerState : register(s0);
cbuffer PixelShaderSettings : register(b0) {
    float Time;
    float Scale;
    float2 Resolution;
    float4 Background;
};
";

impl Writer<'_> {
    /// The whole file: the author's first comment, and the text in the host's code. `outside` stands before
    /// the structure that contains the text, in languages that need one.
    pub(super) fn embed(
        &self,
        order: &Order,
        first: &str,
        outside: &str,
        text: &str,
        title: Title,
    ) -> PrintResult<String> {
        let tree = &self.cx.tree;
        let mut inputs = BTreeSet::new();
        let mut channels = BTreeMap::new();
        let is_unread = |&id: &VariableId| !order.inputs.contains(&id);
        let passed = self.passed.iter().copied().filter(is_unread);
        for id in order.inputs.iter().copied().chain(passed) {
            match (tree[id].kind, tree[id].ty) {
                (VariableKind::Channel(channel), Type::Sampler(sampler)) => {
                    if !self.host.knows(&format!("channel{channel}")) {
                        return Err(self.not_provided(&format!("`{}`", tree[id].name), id));
                    }
                    channels.insert(channel, sampler.shape);
                }
                (VariableKind::Input(input), _) => {
                    if !self.host.knows(input.name()) {
                        return Err(self.not_provided(&format!("`{}`", input.name()), id));
                    }
                    inputs.insert(input);
                }
                _ => {}
            }
        }
        let main_image = self.cx.main_image;
        let brings = tree[main_image].parameters.first().map(|&color| tree[color].kind);
        let brings_color = brings == Some(VariableKind::Parameter(Direction::InOut));
        let holds = |condition: &str| match condition {
            "inputs" => !inputs.is_empty(),
            "channels" => !channels.is_empty(),
            "outside" => !outside.is_empty(),
            "stateless" => inputs.is_empty() && channels.is_empty() && !self.reads_position,
            "position" => self.reads_position || self.passes("position"),
            "derivatives" => self.takes_derivatives || self.passes(UPWARD),
            "image" => self.cx.stage == Stage::Image,
            "buffer" => self.cx.stage != Stage::Image,
            "single" => title.pass.is_none(),
            "pass" => title.pass.is_some(),
            "inout" => brings_color,
            "out" => !brings_color,
            "no_channels" => channels.is_empty(),
            _ => match Input::ALL.into_iter().find(|input| input.name() == condition) {
                Some(input) => inputs.contains(&input),
                None => channel_number(condition).is_some_and(|channel| channels.contains_key(&channel)),
            },
        };
        let mut values = vec![("$main_image", self.function(main_image).to_owned())];
        for (channel, value) in (0..).zip(["$texture0", "$texture1", "$texture2", "$texture3"]) {
            let shape = channels.get(&channel).copied().unwrap_or(SamplerShape::D2);
            values.push((value, self.language().texture_type(shape)));
        }
        for (channel, value) in (0..).zip(["$property0", "$property1", "$property2", "$property3"]) {
            values.push((value, property(channels.get(&channel).copied()).to_owned()));
        }
        let samplings = ["$sampling0", "$sampling1", "$sampling2", "$sampling3"];
        for (sampling, value) in self.cx.sampling.into_iter().zip(samplings) {
            let is_godot = self.language() == Language::Godot;
            let sampling = if is_godot {
                hints(sampling)
            } else {
                inline_sampler(sampling).to_owned()
            };
            values.push((value, sampling));
        }
        // Names in the entry point that nothing at global scope has.
        let taken = self.global_names(order);
        let local = |stem: &str| {
            let mut name = stem.to_owned();
            while taken.contains(name.as_str()) {
                name.push('_');
            }
            name
        };
        values.extend(LOCALS.map(|(value, name)| (value, local(name))));
        let passed = self
            .passed
            .iter()
            .map(|&id| format!(", {}", local(&self.cx.tree[id].name)));
        values.push(("$passed", passed.collect()));
        // The last, since a name may contain those of other values.
        values.push(("$name", name_of(title)));
        // Godot's style indents continuations by two levels.
        let levels = if self.language() == Language::Godot { 2 } else { 1 };
        values.push(("$outside", wrap(outside, levels).trim_end().to_owned()));
        let template = self.host.template();
        // The text is indented as its place in the template.
        let at = template.find("$shader\n").unwrap_or(0);
        let line = template[..at].rfind('\n').map_or(0, |end| end + 1);
        let indent = &template[line..at];
        let template = template.replace(&format!("{indent}$shader\n"), "$shader\n");
        let [before, after] = around_shader(&template).map(|part| fill(part, holds, &values));
        let text = text.lines().fold(String::new(), |mut text, line| {
            let indent = if line.is_empty() { "" } else { indent };
            let _ = writeln!(text, "{indent}{line}");
            text
        });
        let text = wrap(&text, levels);
        // The version comes first.
        let (version, before) = match before.split_once('\n') {
            Some((version, rest)) if version.starts_with("#version") => (format!("{version}\n"), rest),
            _ => (String::new(), before.as_str()),
        };
        Ok(format!("{version}{first}{before}{text}{after}"))
    }

    /// The names of the shader's functions, structures and constants.
    fn global_names(&self, order: &Order) -> HashSet<&str> {
        let items = order.items.iter().filter_map(|&item| match item {
            Item::Variable(id) => Some(self.variable(id)),
            Item::Function(id) => Some(self.function(id)),
            Item::Struct(id) => Some(self.structure_name(id)),
            Item::Prototype(_) => None,
        });
        items.chain(self.macros.names()).collect()
    }

    /// Whether `mainImage` gets this from the host's entry point.
    fn passes(&self, name: &str) -> bool {
        self.passed.iter().any(|&id| self.cx.tree[id].name == name)
    }

    /// The first place where a variable is used.
    fn first_use(&self, id: VariableId) -> Option<Place> {
        let exprs = self.cx.tree.exprs.iter();
        let uses = exprs.filter(|(_, expr)| matches!(expr.kind, ExprKind::Variable(used) if used == id));
        uses.map(|(_, expr)| expr.at).min_by_key(|at| at.span.start)
    }

    /// The error about an input that the host does not have.
    fn not_provided(&self, what: &str, id: VariableId) -> Unprintable {
        let host = self.host.name();
        let message = format!("{what} is not available in the style `{host}`");
        let diagnostic = Diagnostic::new(Code::UnsupportedByTarget, message);
        let diagnostic = match self.first_use(id) {
            Some(at) => diagnostic.at(at.span),
            None => diagnostic,
        };
        Unprintable::Host(Box::new(
            diagnostic.help("use `--style plain`, which has every input and channel"),
        ))
    }
}

/// The name of a shader in the files of its host, within quotation marks.
fn name_of(title: Title) -> String {
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\\');
    let name = if let Some(pass) = title.pass {
        format!("{}/{pass}", title.name)
    } else {
        let stem = Path::new(title.name).file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    };
    name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
}

/// The type of a texture in `ShaderLab`, and what stands for a missing one.
fn property(shape: Option<SamplerShape>) -> &'static str {
    match shape {
        Some(SamplerShape::D3) => "3D) = \"\"",
        Some(SamplerShape::Cube) => "Cube) = \"\"",
        _ => "2D) = \"black\"",
    }
}

/// The name of a sampler of Unity, whose words say how it samples (“Using sampler states” in its manual).
fn inline_sampler(sampling: Sampling) -> &'static str {
    match (sampling.filter, sampling.wrap) {
        (Filter::Nearest, Wrap::Clamp) => "point_clamp_",
        (Filter::Nearest, Wrap::Repeat) => "point_repeat_",
        (Filter::Linear, Wrap::Clamp) => "linear_clamp_",
        (Filter::Linear, Wrap::Repeat) => "linear_repeat_",
        (Filter::Mipmap, Wrap::Clamp) => "trilinear_clamp_",
        (Filter::Mipmap, Wrap::Repeat) => "trilinear_repeat_",
    }
}

/// How Godot samples a texture.
fn hints(sampling: Sampling) -> String {
    let filter = match sampling.filter {
        Filter::Nearest => "filter_nearest",
        Filter::Linear => "filter_linear",
        Filter::Mipmap => "filter_linear_mipmap",
    };
    let wrap = match sampling.wrap {
        Wrap::Clamp => "repeat_disable",
        Wrap::Repeat => "repeat_enable",
    };
    format!("{filter}, {wrap}, hint_default_black")
}
