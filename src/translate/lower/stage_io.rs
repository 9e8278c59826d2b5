//! The shader's interface: built-in variables, uniforms, samplers and texture lookups.

use std::collections::HashMap;

use toyproof_glsl::tree::{
    BinaryOp, Block, BuiltIn, BuiltInVariable, Condition, Constructor, ExprId, ExprKind, Function,
    FunctionId, Input, Item, Label, Scalar, Statement, StatementKind, Swizzle, Type, Value, Variable,
    VariableId, VariableKind, walk,
};

use crate::lower::context::{Builder, LoweringContext};
use crate::lower::{constant, initializer};

/// Replaces built-in variables and uniforms that naga's GLSL lacks or that are not set: `gl_FrontFacing`,
/// constants such as `gl_MaxDrawBuffers`, and lookups of samplers that are plain uniforms. `iChannelTime`
/// becomes an array of `vec4`. Other such variables, for example `gl_PointCoord` and `gl_FragDepth`, become
/// private globals when they are printed.
///
/// naga refuses a `uniform` outside a block; WGSL refuses a uniform array of floats.
pub(super) fn lower_stage_io(cx: &mut LoweringContext) {
    let padded = channel_time(cx);
    cx.each_expression(|cx, id| match cx.tree[id].kind {
        ExprKind::Index { base, index } if is_channel_time(cx, base, padded) => {
            let mut build = cx.build_at(id);
            let array = build.variable(padded);
            let vector = build.index(array, index);
            if let Some(components) = Swizzle::new(&[0]) {
                build.tree[id].kind = ExprKind::Swizzle { vector, components };
            }
        }
        ExprKind::Variable(variable) => self::variable(cx, id, variable),
        ExprKind::BuiltIn {
            function,
            ref arguments,
        } if function.is_texture() => {
            let is_unset = |id: ExprId| match cx.tree[id].kind {
                ExprKind::Variable(variable) => cx.tree[variable].kind == VariableKind::Uniform,
                _ => false,
            };
            if arguments.first().is_some_and(|&sampler| is_unset(sampler)) {
                let node = empty_texel(cx, id, function);
                cx.tree[id] = cx.tree[node].clone();
            }
        }
        _ => {}
    });
    // As a whole it is rebuilt as an array of floats; its single elements are rewritten above.
    cx.each_expression(|cx, id| {
        if is_channel_time(cx, id, padded) {
            let ty = cx.tree[id].ty;
            let mut build = cx.build_at(id);
            let elements = (0..4).filter_map(|channel| {
                let array = build.variable(padded);
                let index = build.literal(Value::Int(channel));
                let vector = build.index(array, index);
                Some(build.swizzle(vector, Swizzle::new(&[0])?))
            });
            let arguments = elements.collect();
            cx.tree[id].kind = ExprKind::Construct {
                constructor: Constructor::Array,
                arguments,
            };
            cx.tree[id].ty = ty;
        }
    });
}

/// `iChannelTime` as it is laid out in the uniform block.
fn channel_time(cx: &mut LoweringContext) -> VariableId {
    let ty = cx.tree.array_of(Type::vector(Scalar::Float, 4), 4);
    let kind = VariableKind::Input(Input::ChannelTime);
    let variable = Variable::new("iChannelTime", ty, kind, None);
    cx.tree.variables.push(variable)
}

fn is_channel_time(cx: &LoweringContext, id: ExprId, padded: VariableId) -> bool {
    match cx.tree[id].kind {
        ExprKind::Variable(variable) => {
            variable != padded && cx.tree[variable].kind == VariableKind::Input(Input::ChannelTime)
        }
        _ => false,
    }
}

fn variable(cx: &mut LoweringContext, id: ExprId, variable: VariableId) {
    let node = match cx.tree[variable].kind {
        // The image is rendered with triangles that face the viewer.
        VariableKind::BuiltIn(BuiltInVariable::FrontFacing) => cx.build_at(id).literal(Value::Bool(true)),
        VariableKind::BuiltInConstant => match cx.tree[variable].value.clone() {
            Some(value) => constant::constant_expression(cx, &value, id),
            None => return,
        },
        _ => return,
    };
    cx.tree[id] = cx.tree[node].clone();
}

/// The result of a lookup in an empty texture.
fn empty_texel(cx: &mut LoweringContext, id: ExprId, function: BuiltIn) -> ExprId {
    let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
    if function == BuiltIn::TextureSize || ty.component_count() != Some(4) {
        return initializer::zero_value(cx, ty, at);
    }
    let scalar = ty.scalar().unwrap_or(Scalar::Float);
    let mut build = cx.build(at);
    let components = [false, false, false, true].map(|one| build.zero_or_one(scalar, one));
    build.construct(Constructor::Vector, components.to_vec(), ty)
}

/// Replaces sampler parameters: `vec4 f(sampler2D s, vec2 p)` is cloned for each channel that it is called
/// with.
///
/// naga's `sampler2D(texture, sampler)` is not a value that can be passed (gfx-rs/wgpu #5256).
pub(super) fn specialize_samplers(cx: &mut LoweringContext) {
    let mut clones = HashMap::new();
    let mut pending: Vec<FunctionId> = cx
        .tree
        .functions
        .iter()
        .filter(|(_, function)| samplers(cx, function).is_empty())
        .map(|(id, _)| id)
        .collect();
    // A new clone may call others with its channels.
    while let Some(function) = pending.pop() {
        let Some(body) = &cx.tree[function].body else {
            continue;
        };
        for root in walk::roots(&cx.tree, body) {
            for call in cx.tree.postorder(root) {
                pending.extend(specialize(cx, call, &mut clones));
            }
        }
    }
    // The originals are no longer called.
    let tree = &cx.tree;
    let general = |item: &Item| matches!(item, Item::Function(id) | Item::Prototype(id) if !samplers(cx, &tree[*id]).is_empty());
    let items = tree.items.iter().copied().filter(|item| !general(item)).collect();
    cx.tree.items = items;
}

/// The positions of the sampler parameters.
fn samplers(cx: &LoweringContext, function: &Function) -> Vec<usize> {
    let is_sampler = |&id: &VariableId| matches!(cx.tree[id].ty, Type::Sampler(_));
    let positions = function.parameters.iter().enumerate();
    positions
        .filter(|(_, id)| is_sampler(id))
        .map(|(at, _)| at)
        .collect()
}

type Clones = HashMap<(FunctionId, Vec<VariableId>), FunctionId>;

/// Redirects a call that passes channels to a clone for these channels. Returns the clone if it is new.
fn specialize(cx: &mut LoweringContext, call: ExprId, clones: &mut Clones) -> Option<FunctionId> {
    let ExprKind::Call {
        function,
        ref arguments,
    } = cx.tree[call].kind
    else {
        return None;
    };
    let positions = samplers(cx, &cx.tree[function]);
    if positions.is_empty() {
        return None;
    }
    let channels: Option<Vec<VariableId>> = positions
        .iter()
        .map(|&at| match cx.tree[*arguments.get(at)?].kind {
            ExprKind::Variable(channel) => Some(channel),
            _ => None,
        })
        .collect();
    let channels = channels?;
    let left = arguments
        .iter()
        .enumerate()
        .filter(|(at, _)| !positions.contains(at))
        .map(|(_, &id)| id);
    let arguments = left.collect();
    let key = (function, channels);
    let known = clones.get(&key).copied();
    let special = known.unwrap_or_else(|| Cloner::clone_function(cx, key.0, &positions, &key.1));
    clones.insert(key, special);
    cx.tree[call].kind = ExprKind::Call {
        function: special,
        arguments,
    };
    known.is_none().then_some(special)
}

/// Clones a function, with channels in place of its samplers.
struct Cloner<'a> {
    cx: &'a mut LoweringContext,
    variables: HashMap<VariableId, VariableId>,
}

impl Cloner<'_> {
    fn clone_function(
        cx: &mut LoweringContext,
        general: FunctionId,
        positions: &[usize],
        channels: &[VariableId],
    ) -> FunctionId {
        let mut special = cx.tree[general].clone();
        for &channel in channels {
            special.name = format!("{}_{}", special.name, cx.tree[channel].name);
        }
        let mut cloner = Cloner {
            cx,
            variables: HashMap::new(),
        };
        for (&at, &channel) in positions.iter().zip(channels) {
            cloner.variables.insert(special.parameters[at], channel);
        }
        let parameters = std::mem::take(&mut special.parameters);
        let kept = parameters
            .into_iter()
            .enumerate()
            .filter(|(at, _)| !positions.contains(at));
        special.parameters = kept.map(|(_, parameter)| cloner.declare(parameter)).collect();
        special.body = special.body.map(|body| cloner.block(&body));
        let special = cx.tree.functions.push(special);
        cx.tree.items.push(Item::Function(special));
        special
    }

    fn declare(&mut self, variable: VariableId) -> VariableId {
        let mut new = self.cx.tree[variable].clone();
        new.initializer = new.initializer.map(|expr| self.expression(expr));
        let new = self.cx.tree.variables.push(new);
        self.variables.insert(variable, new);
        new
    }

    fn expression(&mut self, root: ExprId) -> ExprId {
        let variables = &self.variables;
        let rename = |variable| variables.get(&variable).copied().unwrap_or(variable);
        self.cx.build_at(root).copy_with(root, rename)
    }

    fn block(&mut self, block: &Block) -> Block {
        block.iter().map(|statement| self.statement(statement)).collect()
    }

    fn condition(&mut self, condition: Condition) -> Condition {
        match condition {
            Condition::Expression(expr) => Condition::Expression(self.expression(expr)),
            Condition::Declare(variable) => Condition::Declare(self.declare(variable)),
        }
    }

    fn statement(&mut self, statement: &Statement) -> Statement {
        let mut new = statement.clone();
        match &mut new.kind {
            StatementKind::Expression(expr) | StatementKind::Return(Some(expr)) => {
                *expr = self.expression(*expr);
            }
            StatementKind::Declare(variable) => *variable = self.declare(*variable),
            StatementKind::Block(body) => *body = self.block(body),
            StatementKind::If { arms, otherwise } => {
                for arm in arms {
                    arm.condition = self.expression(arm.condition);
                    arm.body = self.block(&arm.body);
                }
                if let Some(body) = otherwise {
                    *body = self.block(body);
                }
            }
            StatementKind::Switch { selector, cases } => {
                *selector = self.expression(*selector);
                for case in cases {
                    for label in &mut case.labels {
                        if let Label::Case { expr, .. } = label {
                            *expr = self.expression(*expr);
                        }
                    }
                    case.body = self.block(&case.body);
                }
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                *init = self.block(init);
                *condition = condition.map(|condition| self.condition(condition));
                *step = step.map(|step| self.expression(step));
                *body = self.block(body);
            }
            StatementKind::While { condition, body } => {
                *condition = self.condition(*condition);
                *body = self.block(body);
            }
            StatementKind::DoWhile { body, condition } => {
                *body = self.block(body);
                *condition = self.expression(*condition);
            }
            StatementKind::Return(None)
            | StatementKind::Struct(_)
            | StatementKind::Break
            | StatementKind::Continue
            | StatementKind::Discard => {}
        }
        new
    }
}

/// Applies the offsets of `texelFetchOffset`, and replaces constant offsets of texture lookups by literals.
///
/// naga fetches without the offset, and its IR requires offsets to be literals.
pub(super) fn lower_texel_offsets(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        let ExprKind::BuiltIn {
            function: BuiltIn::TexelFetchOffset,
            arguments,
        } = &cx.tree[id].kind
        else {
            return;
        };
        if let &[sampler, texel, lod, offset] = arguments.as_slice() {
            let whole = cx.tree[texel].ty;
            let mut build = cx.build_at(id);
            let offset = widen(&mut build, offset, whole);
            let texel = build.binary(BinaryOp::Add, texel, offset, whole);
            let arguments = vec![sampler, texel, lod];
            cx.tree[id].kind = ExprKind::BuiltIn {
                function: BuiltIn::TexelFetch,
                arguments,
            };
        }
    });
    cx.each_expression(|cx, id| {
        if let ExprKind::BuiltIn { function, arguments } = &cx.tree[id].kind
            && let Some(position) = offset_position(*function)
            && let Some(&offset) = arguments.get(position)
            && let Some(value) = cx.tree.value(offset)
        {
            let value = constant::constant_expression(cx, &value, offset);
            cx.tree[offset] = cx.tree[value].clone();
        }
    });
}

/// Extends an offset to the texel's size; the layer of an array has no offset.
fn widen(build: &mut Builder<'_>, offset: ExprId, whole: Type) -> ExprId {
    if build.tree[offset].ty == whole {
        return offset;
    }
    let layer = build.literal(Value::Int(0));
    build.construct(Constructor::Vector, vec![offset, layer], whole)
}

fn offset_position(function: BuiltIn) -> Option<usize> {
    match function {
        BuiltIn::TextureOffset | BuiltIn::TextureProjOffset => Some(2),
        BuiltIn::TextureLodOffset | BuiltIn::TextureProjLodOffset => Some(3),
        BuiltIn::TextureGradOffset | BuiltIn::TextureProjGradOffset => Some(4),
        _ => None,
    }
}
