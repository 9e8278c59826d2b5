//! Expansion of filtered texture lookups into fetches of single texels and exact operations: for strict
//! shaders only.
//!
//! Drivers compute the weights of filters with few bits, and the level of mipmaps by their own formulas. The
//! evaluator (`toyproof_eval`) computes the same steps as the text that is generated here.

use std::fmt::Write as _;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Direction, ExprId, ExprKind, FunctionId, Place, Sampler, Scalar,
    Statement, StatementKind, Type, Value, VariableId, VariableKind,
};
use toyproof_glsl::{Filter, Sampling, Wrap};

use crate::lower::context::LoweringContext;
use crate::lower::generated::{Expansion, Level};
use crate::lower::polyfill::{self, function};

const VEC2: Type = Type::Vector(Scalar::Float, 2);
const VEC4: Type = Type::Vector(Scalar::Float, 4);
const IVEC2: Type = Type::Vector(Scalar::Int, 2);

/// Expands the lookups of channels with two dimensions.
pub(super) fn expand_lookups(cx: &mut LoweringContext) {
    cx.checks_fetches = true;
    cx.each_expression(|cx, id| {
        let ExprKind::BuiltIn { function, arguments } = &cx.tree[id].kind else {
            return;
        };
        let (function, arguments) = (*function, arguments.clone());
        if let Some(lookup) = Lookup::from_call(cx, function, &arguments) {
            lookup.expand(cx, id, arguments[1..].to_vec());
        } else if matches!(function, BuiltIn::TexelFetch | BuiltIn::TexelFetchOffset)
            && is_channel(cx, arguments[0])
        {
            // Of a volume. A fetch from a sampler parameter is in a function that is no longer called.
            cx.checks_fetches = false;
        }
    });
}

/// Whether a texture is one of the four channels, rather than a parameter.
fn is_channel(cx: &LoweringContext, texture: ExprId) -> bool {
    matches!(cx.tree[texture].kind, ExprKind::Variable(variable)
        if matches!(cx.tree[variable].kind, VariableKind::Channel(_)))
}

/// A filtered lookup of a channel.
struct Lookup {
    /// The variable of the channel.
    texture: VariableId,
    channel: u8,
    level: Level,
    is_projected: bool,
    has_offset: bool,
}

impl Lookup {
    fn from_call(cx: &LoweringContext, function: BuiltIn, arguments: &[ExprId]) -> Option<Self> {
        use BuiltIn as B;
        use Level::{Biased, Fetched, Given, Gradient, Implicit, Size};
        let (level, is_projected, has_offset) = match function {
            B::Texture => (Implicit, false, false),
            B::TextureOffset => (Implicit, false, true),
            B::TextureProj => (Implicit, true, false),
            B::TextureProjOffset => (Implicit, true, true),
            B::TextureLod => (Given, false, false),
            B::TextureLodOffset => (Given, false, true),
            B::TextureProjLod => (Given, true, false),
            B::TextureProjLodOffset => (Given, true, true),
            B::TextureGrad => (Gradient, false, false),
            B::TextureGradOffset => (Gradient, false, true),
            B::TextureProjGrad => (Gradient, true, false),
            B::TextureProjGradOffset => (Gradient, true, true),
            B::TexelFetch => (Fetched, false, false),
            B::TexelFetchOffset => (Fetched, false, true),
            B::TextureSize => (Size, false, false),
            _ => return None,
        };
        let ExprKind::Variable(texture) = cx.tree[*arguments.first()?].kind else {
            return None;
        };
        let VariableKind::Channel(channel) = cx.tree[texture].kind else {
            return None;
        };
        let without_bias = if has_offset { 3 } else { 2 };
        let is_biased = level == Implicit && arguments.len() > without_bias;
        (cx.tree[texture].ty == Type::Sampler(Sampler::D2)).then_some(Self {
            texture,
            channel,
            level: if is_biased { Biased } else { level },
            is_projected,
            has_offset,
        })
    }

    /// Replaces the lookup `id` by a call with these arguments, without the channel.
    fn expand(&self, cx: &mut LoweringContext, id: ExprId, mut arguments: Vec<ExprId>) {
        let at = cx.tree[id].at;
        if self.is_projected {
            let position = arguments[0];
            let ty = cx.tree[position].ty;
            let projected = function(cx, Expansion::Projection, vec![ty], VEC2, at);
            arguments[0] = cx.build(at).call(projected, vec![position]);
        }
        // The offset is last; a bias follows it in the author's call.
        let offset = if self.has_offset {
            arguments.remove(if self.level == Level::Biased {
                1
            } else {
                arguments.len() - 1
            })
        } else {
            let mut build = cx.build(at);
            let zeros = [0, 0].map(|zero| build.literal(Value::Int(zero)));
            build.construct(Constructor::Vector, zeros.to_vec(), IVEC2)
        };
        arguments.push(offset);
        let expansion = Expansion::Lookup {
            texture: self.texture,
            channel: self.channel,
            level: self.level,
        };
        polyfill::call(cx, id, expansion, arguments);
    }
}

/// The names of the parameters: the coordinates, and up to two arguments for the level.
const NAMES: [&str; 3] = ["toyproof_p", "toyproof_a", "toyproof_b"];

/// The name of the parameter for the offset.
const OFFSET: &str = "toyproof_offset";

/// Adds the function for the lookups of a channel with arguments of these types.
pub(super) fn lookup_function(
    cx: &mut LoweringContext,
    (texture, channel, level): (VariableId, u8, Level),
    types: &[Type],
    at: Place,
) -> FunctionId {
    let sampling = cx.sampling[usize::from(channel)];
    let names = NAMES.into_iter().take(types.len() - 1).chain([OFFSET]);
    let parameters: Vec<_> = types
        .iter()
        .zip(names)
        .map(|(&ty, name)| (Direction::In, ty, name))
        .collect();
    let ty = if level == Level::Size { IVEC2 } else { VEC4 };
    let id = cx.function(format!("toyproof_lookup_{channel}"), &parameters, ty, at);
    let is_implicit = matches!(level, Level::Implicit | Level::Biased | Level::Gradient);
    let is_text = sampling.filter != Filter::Mipmap || !is_implicit;
    if is_text {
        let text = match level {
            Level::Fetched => fetch_text(channel),
            Level::Size => format!("return {};", size_of_level(&self::texture(channel), "toyproof_p")),
            _ => text(channel, sampling),
        };
        cx.helpers.insert(id, text);
        cx.helper_inputs.insert(id, texture);
        return id;
    }
    let given = Expansion::Lookup {
        texture,
        channel,
        level: Level::Given,
    };
    let lookup = function(cx, given, vec![VEC2, Type::FLOAT, IVEC2], VEC4, at);
    let level_of_detail = function(cx, Expansion::LevelOfDetail, vec![VEC2, VEC2], Type::FLOAT, at);
    let parameters = cx.tree[id].parameters.clone();
    let mut build = cx.build(at);
    let size = {
        let texture = build.variable(texture);
        let zero = build.literal(Value::Int(0));
        let kind = ExprKind::BuiltIn {
            function: BuiltIn::TextureSize,
            arguments: vec![texture, zero],
        };
        let size = build.push(kind, IVEC2);
        build.construct(Constructor::Vector, vec![size], VEC2)
    };
    let derivatives = [(BuiltIn::DFdx, 1), (BuiltIn::DFdy, 2)].map(|(function, given)| {
        let derivative = if level == Level::Gradient {
            build.variable(parameters[given])
        } else {
            let arguments = vec![build.variable(parameters[0])];
            build.push(ExprKind::BuiltIn { function, arguments }, VEC2)
        };
        let size = build.copy(size);
        build.binary(BinaryOp::Multiply, derivative, size, VEC2)
    });
    let mut detail = build.call(level_of_detail, derivatives.to_vec());
    if level == Level::Biased {
        let bias = build.variable(parameters[1]);
        detail = build.binary(BinaryOp::Add, detail, bias, Type::FLOAT);
    }
    let [p, offset] =
        [parameters[0], parameters[parameters.len() - 1]].map(|parameter| build.variable(parameter));
    let value = build.call(lookup, vec![p, detail, offset]);
    cx.tree[id].body = Some(vec![Statement::new(StatementKind::Return(Some(value)), at)]);
    id
}

/// The body of a fetch of the texel `toyproof_p` in the level `toyproof_a`. Beyond the texture, browsers
/// return zeros, and naga the texel at the edge.
fn fetch_text(channel: u8) -> String {
    let texture = texture(channel);
    format!(
        "ivec2 toyproof_at = toyproof_p + {OFFSET};
    int toyproof_level = min(max(toyproof_a, 0), textureQueryLevels({texture}) - 1);
    ivec2 toyproof_size = {size};
    ivec2 toyproof_near = min(max(toyproof_at, ivec2(0)), toyproof_size - ivec2(1));
    vec4 toyproof_texel = texelFetch({texture}, toyproof_near, toyproof_level);
    bool toyproof_is_inside = toyproof_level == toyproof_a
        && toyproof_near.x == toyproof_at.x && toyproof_near.y == toyproof_at.y;
    return mix(vec4(0.0), toyproof_texel, bvec4(toyproof_is_inside));",
        size = size_of_level(&texture, "toyproof_level"),
    )
}

/// The size of a level. Mesa's software driver returns that of one level to all pixels that it computes
/// together.
fn size_of_level(texture: &str, level: &str) -> String {
    format!("max(ivec2(uvec2(textureSize({texture}, 0)) >> uvec2(uint({level}) & 31u)), ivec2(1))")
}

/// The texture of a channel, as naga's GLSL combines it with its sampler.
fn texture(channel: u8) -> String {
    format!("sampler2D(iChannel{channel}, iChannel{channel}_sampler)")
}

/// The body of a lookup at `toyproof_p`. With mipmaps, the level is `toyproof_a`; other arguments are
/// ignored.
fn text(channel: u8, sampling: Sampling) -> String {
    let texture = texture(channel);
    if sampling.filter != Filter::Mipmap {
        let mut text = String::new();
        push_level(&mut text, &texture, sampling, "0", "0");
        return text + "return toyproof_color0;";
    }
    let mut text = format!(
        "int toyproof_last = textureQueryLevels({texture}) - 1;
    float toyproof_lod = min(max(toyproof_a, 0.0), float(toyproof_last));
    float toyproof_below = floor(toyproof_lod);
    float toyproof_between = toyproof_lod - toyproof_below;
    int toyproof_level = int(toyproof_below);\n    "
    );
    push_level(&mut text, &texture, sampling, "0", "toyproof_level");
    text += "if (toyproof_between > 0.0) {\n    ";
    push_level(
        &mut text,
        &texture,
        sampling,
        "1",
        "min(toyproof_level + 1, toyproof_last)",
    );
    text += "toyproof_color0 = toyproof_color0 + (toyproof_color1 - toyproof_color0) * toyproof_between;
    }
    return toyproof_color0;";
    text
}

/// Writes the lookup of a level as the variable `toyproof_color{n}`.
fn push_level(text: &mut String, texture: &str, sampling: Sampling, n: &str, level: &str) {
    // Far coordinates, and NaN, must fit an integer.
    let (place, least, most) = match sampling.wrap {
        Wrap::Repeat => ("(toyproof_p - floor(toyproof_p))", "-1.0", "0.0"),
        Wrap::Clamp => ("toyproof_p", "-16.0", "16.0"),
    };
    let wrapped = |place: &str| match sampling.wrap {
        Wrap::Repeat => format!("ivec2(uvec2({place} + 32 * toyproof_size{n}) % uvec2(toyproof_size{n}))"),
        Wrap::Clamp => format!("min(max({place}, ivec2(0)), toyproof_size{n} - ivec2(1))"),
    };
    let half = if sampling.filter == Filter::Nearest {
        ""
    } else {
        " - vec2(0.5)"
    };
    let _ = write!(
        text,
        "ivec2 toyproof_size{n} = {size};
    vec2 toyproof_side{n} = vec2(toyproof_size{n});
    vec2 toyproof_at{n} = min(max({place} * toyproof_side{n}{half}, vec2({least})), toyproof_side{n} + vec2({most}));
    vec2 toyproof_floor{n} = floor(toyproof_at{n});
    ivec2 toyproof_i{n} = ivec2(toyproof_floor{n}) + {OFFSET};
    ivec2 toyproof_low{n} = {low};\n    ",
        size = if level == "0" {
            format!("textureSize({texture}, 0)")
        } else {
            size_of_level(texture, level)
        },
        low = wrapped(&format!("toyproof_i{n}")),
    );
    let fetch = |x: &str, y: &str| {
        format!("texelFetch({texture}, ivec2(toyproof_{x}{n}.x, toyproof_{y}{n}.y), {level})")
    };
    if sampling.filter == Filter::Nearest {
        let _ = write!(text, "vec4 toyproof_color{n} = {};\n    ", fetch("low", "low"));
        return;
    }
    let _ = write!(
        text,
        "ivec2 toyproof_high{n} = {high};
    vec2 toyproof_weight{n} = toyproof_at{n} - toyproof_floor{n};
    vec4 toyproof_a{n} = {a};
    vec4 toyproof_b{n} = {b};
    vec4 toyproof_c{n} = {c};
    vec4 toyproof_d{n} = {d};
    vec4 toyproof_lower{n} = toyproof_a{n} + (toyproof_b{n} - toyproof_a{n}) * toyproof_weight{n}.x;
    vec4 toyproof_upper{n} = toyproof_c{n} + (toyproof_d{n} - toyproof_c{n}) * toyproof_weight{n}.x;
    vec4 toyproof_color{n} = toyproof_lower{n} + (toyproof_upper{n} - toyproof_lower{n}) * toyproof_weight{n}.y;\n    ",
        high = wrapped(&format!("(toyproof_i{n} + ivec2(1))")),
        a = fetch("low", "low"),
        b = fetch("high", "low"),
        c = fetch("low", "high"),
        d = fetch("high", "high"),
    );
}

/// The body of the projection of coordinates of a type.
pub(super) fn projection(ty: Type, name: &str) -> String {
    let last = if ty == VEC4 { "w" } else { "z" };
    format!("return {name}.xy / {name}.{last};")
}
