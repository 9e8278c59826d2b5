//! What surrounds a shader and is not there in naga's GLSL, or not fed: `gl_PointCoord`, `gl_FragDepth`, `gl_MaxDrawBuffers`,
//! uniforms that nobody sets, samplers among them. `iChannelTime` is an array of `vec4`.
//!
//! naga refuses a `uniform` outside of a block, and WGSL a uniform array of floats.

use toyproof_glsl::tree::{
    BuiltIn, BuiltInVariable, Constructor, ExprId, ExprKind, Input, Scalar, Swizzle, Type, Value, VariableId,
    VariableKind,
};

use super::draft::Draft;
use super::{constant, zero};

pub(super) fn run(draft: &mut Draft) {
    let padded = channel_time(draft);
    draft.each_expression(|draft, id| match draft.tree[id].kind {
        ExprKind::Index { base, index } if is_channel_time(draft, base, padded) => {
            let mut build = draft.build_at(id);
            let array = build.variable(padded);
            let vector = build.index(array, index);
            if let Some(components) = Swizzle::new(&[0]) {
                build.tree[id].kind = ExprKind::Swizzle { vector, components };
            }
        }
        ExprKind::Variable(variable) => self::variable(draft, id, variable),
        ExprKind::BuiltIn {
            function,
            ref arguments,
        } if function.is_texture() => {
            let unfed = |id: ExprId| match draft.tree[id].kind {
                ExprKind::Variable(variable) => draft.tree[variable].kind == VariableKind::Uniform,
                _ => false,
            };
            if arguments.first().is_some_and(|&sampler| unfed(sampler)) {
                let node = black(draft, id, function);
                draft.tree[id] = draft.tree[node].clone();
            }
        }
        _ => {}
    });
    // Whole, it is an array of floats again; one element of it was told above.
    draft.each_expression(|draft, id| {
        if is_channel_time(draft, id, padded) {
            let ty = draft.tree[id].ty;
            let mut build = draft.build_at(id);
            let elements = (0..4).filter_map(|channel| {
                let array = build.variable(padded);
                let index = build.literal(Value::Int(channel));
                let vector = build.index(array, index);
                Some(build.swizzle(vector, Swizzle::new(&[0])?))
            });
            let arguments = elements.collect();
            draft.tree[id].kind = ExprKind::Construct {
                constructor: Constructor::Array,
                arguments,
            };
            draft.tree[id].ty = ty;
        }
    });
}

/// `iChannelTime` as it lies in the uniform block.
fn channel_time(draft: &mut Draft) -> VariableId {
    let ty = draft.tree.array_of(Type::vector(Scalar::Float, 4), 4);
    let kind = VariableKind::Input(Input::ChannelTime);
    let name = "iChannelTime".to_owned();
    draft.tree.variables.push(toyproof_glsl::tree::Variable {
        name,
        ty,
        kind,
        initialiser: None,
        value: None,
        at: None,
    })
}

fn is_channel_time(draft: &Draft, id: ExprId, padded: VariableId) -> bool {
    match draft.tree[id].kind {
        ExprKind::Variable(variable) => {
            variable != padded && draft.tree[variable].kind == VariableKind::Input(Input::ChannelTime)
        }
        _ => false,
    }
}

fn variable(draft: &mut Draft, id: ExprId, variable: VariableId) {
    let node = match draft.tree[variable].kind {
        // The picture is painted by triangles that face the viewer.
        VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => draft.build_at(id).literal(Value::Bool(true)),
        VariableKind::BuiltInConstant => match draft.tree[variable].value.clone() {
            Some(value) => constant::spell(draft, &value, id),
            None => return,
        },
        _ => return,
    };
    draft.tree[id] = draft.tree[node].clone();
}

/// What a lookup of an empty texture gives.
fn black(draft: &mut Draft, id: ExprId, function: BuiltIn) -> ExprId {
    let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
    if function == BuiltIn::TextureSize || ty.component_count() != Some(4) {
        return zero::value(draft, ty, at);
    }
    let scalar = ty.scalar().unwrap_or(Scalar::Float);
    let mut build = draft.build(at);
    let components = [false, false, false, true].map(|one| build.small(scalar, one));
    build.construct(Constructor::Vector, components.to_vec(), ty)
}
