//! Expansion of filtered texture lookups into fetches of single texels and exact operations: for strict
//! shaders only.
//!
//! Drivers compute the weights of filters with few bits, and the level of mipmaps by their own formulas. The
//! evaluator (`toyproof_eval`) computes the same steps as the text that is generated here
//! ([`super::lookup_text`]). A cube map is then an array of six images.

use toyproof_glsl::Filter;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Direction, ExprId, ExprKind, FunctionId, Place, Sampler, SamplerShape,
    Scalar, Statement, StatementKind, Type, Value, VariableId, VariableKind,
};

use crate::lower::context::LoweringContext;
use crate::lower::generated::{Expansion, Level};
use crate::lower::lookup_text::{OFFSET, Texture};
use crate::lower::polyfill::{self, function};

const VEC2: Type = Type::Vector(Scalar::Float, 2);
const VEC3: Type = Type::Vector(Scalar::Float, 3);
const VEC4: Type = Type::Vector(Scalar::Float, 4);

/// Expands the lookups of channels.
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
            // Of another type. A fetch from a sampler parameter is in a function that is no longer called.
            cx.checks_fetches = false;
        }
    });
    for id in cx.tree.variables.ids() {
        if cx.tree[id].ty == Type::Sampler(Sampler::float(SamplerShape::Cube))
            && matches!(cx.tree[id].kind, VariableKind::Channel(_))
        {
            cx.tree[id].ty = Type::Sampler(Sampler::float(SamplerShape::D2Array));
        }
    }
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
    shape: SamplerShape,
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
        Some(Self {
            texture,
            shape: shape(cx, texture)?,
            channel,
            level: if is_biased { Biased } else { level },
            is_projected,
            has_offset,
        })
    }

    /// Replaces the lookup `id` by a call with these arguments, without the channel.
    fn expand(&self, cx: &mut LoweringContext, id: ExprId, mut arguments: Vec<ExprId>) {
        let at = cx.tree[id].at;
        let axes = axes(self.shape);
        if self.is_projected {
            let position = arguments[0];
            let ty = cx.tree[position].ty;
            let coordinates = Type::vector(Scalar::Float, axes);
            let projected = function(cx, Expansion::Projection(axes), vec![ty], coordinates, at);
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
            no_offset(cx, axes, at)
        };
        if self.shape == SamplerShape::Cube
            && self.level != Level::Size
            && !has_level_of_detail(cx, self.channel, self.level)
        {
            arguments[0] = cube_place(cx, arguments[0], at);
        }
        arguments.push(offset);
        let expansion = Expansion::Lookup {
            texture: self.texture,
            channel: self.channel,
            level: self.level,
        };
        polyfill::call(cx, id, expansion, arguments);
    }
}

/// The shape of a texture whose lookups are expanded.
fn shape(cx: &LoweringContext, texture: VariableId) -> Option<SamplerShape> {
    let shapes = [SamplerShape::D2, SamplerShape::D3, SamplerShape::Cube];
    let mut shapes = shapes.into_iter();
    shapes.find(|shape| cx.tree[texture].ty == Type::Sampler(Sampler::float(*shape)))
}

/// The number of axes of a texture: the two of the face for a cube map.
fn axes(shape: SamplerShape) -> u8 {
    if shape == SamplerShape::D3 { 3 } else { 2 }
}

/// Whether the level of a lookup is computed from derivatives.
fn has_level_of_detail(cx: &LoweringContext, channel: u8, level: Level) -> bool {
    cx.sampling[usize::from(channel)].filter == Filter::Mipmap
        && matches!(level, Level::Implicit | Level::Biased | Level::Gradient)
}

/// An offset of zero.
fn no_offset(cx: &mut LoweringContext, axes: u8, at: Place) -> ExprId {
    let mut build = cx.build(at);
    let zeros = (0..axes).map(|_| build.literal(Value::Int(0))).collect();
    build.construct(Constructor::Vector, zeros, Type::vector(Scalar::Int, axes))
}

/// The face that a direction points to, and the place on it.
fn cube_place(cx: &mut LoweringContext, direction: ExprId, at: Place) -> ExprId {
    let place = function(cx, Expansion::CubePlace, vec![VEC3], VEC3, at);
    cx.build(at).call(place, vec![direction])
}

/// The names of the parameters: the coordinates, and up to two arguments for the level.
const NAMES: [&str; 3] = ["toyproof_p", "toyproof_a", "toyproof_b"];

/// Adds the function for the lookups of a channel with arguments of these types.
pub(super) fn lookup_function(
    cx: &mut LoweringContext,
    (texture, channel, level): (VariableId, u8, Level),
    types: &[Type],
    at: Place,
) -> FunctionId {
    let shape = shape(cx, texture).unwrap_or(SamplerShape::D2);
    let names = NAMES.into_iter().take(types.len() - 1).chain([OFFSET]);
    let parameters: Vec<_> = types
        .iter()
        .zip(names)
        .map(|(&ty, name)| (Direction::In, ty, name))
        .collect();
    let size = Type::vector(Scalar::Int, axes(shape));
    let ty = if level == Level::Size { size } else { VEC4 };
    let id = cx.function(format!("toyproof_lookup_{channel}"), &parameters, ty, at);
    if has_level_of_detail(cx, channel, level) {
        let value = at_level_of_detail(cx, (texture, channel, level), shape, id, at);
        cx.tree[id].body = Some(vec![Statement::new(StatementKind::Return(Some(value)), at)]);
        return id;
    }
    let text = Texture { channel, shape };
    let text = match level {
        Level::Fetched => text.fetch(),
        Level::Size => format!("return {};", text.size_of_level(NAMES[0])),
        _ => text.lookup(cx.sampling[usize::from(channel)]),
    };
    cx.helpers.insert(id, text);
    cx.helper_inputs.insert(id, texture);
    id
}

/// The value of a lookup whose level is computed from derivatives, in the function with this id.
fn at_level_of_detail(
    cx: &mut LoweringContext,
    (texture, channel, level): (VariableId, u8, Level),
    shape: SamplerShape,
    id: FunctionId,
    at: Place,
) -> ExprId {
    let axes = axes(shape);
    let [axes_type, size_type] = [Scalar::Float, Scalar::Int].map(|scalar| Type::vector(scalar, axes));
    let lookup = |level| Expansion::Lookup {
        texture,
        channel,
        level,
    };
    let is_cube = shape == SamplerShape::Cube;
    let place_type = if is_cube { VEC3 } else { axes_type };
    let given = vec![place_type, Type::FLOAT, size_type];
    let given = function(cx, lookup(Level::Given), given, VEC4, at);
    let size = function(cx, lookup(Level::Size), vec![Type::INT, size_type], size_type, at);
    let level_of_detail = vec![axes_type; 2];
    let level_of_detail = function(cx, Expansion::LevelOfDetail, level_of_detail, Type::FLOAT, at);
    let gradient = is_cube.then(|| function(cx, Expansion::CubeGradient, vec![VEC3; 2], VEC2, at));
    let parameters = cx.tree[id].parameters.clone();
    let derivatives = [(BuiltIn::DFdx, 1), (BuiltIn::DFdy, 2)].map(|(function, given)| {
        let zeros = no_offset(cx, axes, at);
        let mut build = cx.build(at);
        let mut derivative = if level == Level::Gradient {
            build.variable(parameters[given])
        } else {
            let arguments = vec![build.variable(parameters[0])];
            let ty = build.tree[parameters[0]].ty;
            build.push(ExprKind::BuiltIn { function, arguments }, ty)
        };
        if let Some(gradient) = gradient {
            let direction = build.variable(parameters[0]);
            derivative = build.call(gradient, vec![direction, derivative]);
        }
        let whole = build.literal(Value::Int(0));
        let size = build.call(size, vec![whole, zeros]);
        let size = build.construct(Constructor::Vector, vec![size], axes_type);
        build.binary(BinaryOp::Multiply, derivative, size, axes_type)
    });
    let mut build = cx.build(at);
    let mut detail = build.call(level_of_detail, derivatives.to_vec());
    if level == Level::Biased {
        let bias = build.variable(parameters[1]);
        detail = build.binary(BinaryOp::Add, detail, bias, Type::FLOAT);
    }
    let [mut place, offset] =
        [parameters[0], parameters[parameters.len() - 1]].map(|parameter| build.variable(parameter));
    if is_cube {
        place = cube_place(cx, place, at);
    }
    cx.build(at).call(given, vec![place, detail, offset])
}

/// The body of the projection of coordinates of a type to this number of axes.
pub(super) fn projection(ty: Type, axes: u8, name: &str) -> String {
    let last = if ty == VEC4 { "w" } else { "z" };
    let first = if axes == 3 { "xyz" } else { "xy" };
    format!("return {name}.{first} / {name}.{last};")
}
