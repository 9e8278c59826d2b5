//! The built-in declarations: `ShaderToy`'s inputs, the variables and constants of §7, and the shapes of
//! channels.

use std::ops::RangeInclusive;

use super::Checker;
use super::scope::Entity;
use crate::Options;
use crate::tree::{
    BuiltInVariable, Constant, ExprId, ExprKind, Input, InputType, Sampler, SamplerShape, Scalar, Type,
    Value, Variable, VariableKind,
};

/// The minimum values that WebGL 2 guarantees (§7.3).
const LIMITS: [(&str, i32); 9] = [
    ("gl_MaxVertexAttribs", 16),
    ("gl_MaxVertexUniformVectors", 256),
    ("gl_MaxVertexOutputVectors", 16),
    ("gl_MaxFragmentInputVectors", 15),
    ("gl_MaxVertexTextureImageUnits", 16),
    ("gl_MaxCombinedTextureImageUnits", 32),
    ("gl_MaxTextureImageUnits", 16),
    ("gl_MaxFragmentUniformVectors", 224),
    ("gl_MaxDrawBuffers", 4),
];

/// The range of texel offsets that every implementation supports.
pub(super) const TEXEL_OFFSETS: RangeInclusive<i32> = -8..=7;

impl Checker<'_> {
    pub(super) fn declare_prelude(&mut self) {
        let vec = |size| Type::Vector(Scalar::Float, size);
        for input in Input::ALL {
            let ty = match input.ty() {
                InputType::Float => Type::FLOAT,
                InputType::Int => Type::INT,
                InputType::Vec3 => vec(3),
                InputType::Vec4 => vec(4),
            };
            let ty = match input.length() {
                Some(length) => self.tree.array_of(ty, length as u32),
                None => ty,
            };
            self.built_in(input.name(), ty, VariableKind::Input(input), None);
        }
        let channels = ["iChannel0", "iChannel1", "iChannel2", "iChannel3"];
        for ((name, shape), index) in channels.into_iter().zip(self.channels.shapes).zip(0..) {
            let ty = Type::Sampler(Sampler::float(shape));
            self.built_in(name, ty, VariableKind::Channel(index), None);
        }
        let variables = [
            ("gl_FragCoord", vec(4), BuiltInVariable::FragCoord),
            ("gl_FrontFacing", Type::BOOL, BuiltInVariable::FrontFacing),
            ("gl_PointCoord", vec(2), BuiltInVariable::PointCoord),
            ("gl_FragDepth", Type::FLOAT, BuiltInVariable::FragDepth),
        ];
        for (name, ty, variable) in variables {
            self.built_in(name, ty, VariableKind::BuiltIn(variable), None);
        }
        let offsets = [
            ("gl_MinProgramTexelOffset", *TEXEL_OFFSETS.start()),
            ("gl_MaxProgramTexelOffset", *TEXEL_OFFSETS.end()),
        ];
        for (name, value) in LIMITS.into_iter().chain(offsets) {
            self.built_in(name, Type::INT, VariableKind::BuiltInConstant, Some(value));
        }
        self.declare_old_outputs();
    }

    /// Whether another tab has an input of this name.
    pub(super) fn is_input_of_other_tabs(&self, name: &str) -> bool {
        let mut variables = self
            .tree
            .variables
            .iter()
            .map(|(_, variable)| variable)
            .take_while(|variable| variable.kind.is_input());
        !self.stage.has_input(name) && variables.any(|input| input.name == name)
    }

    fn built_in(&mut self, name: &str, ty: Type, kind: VariableKind, value: Option<i32>) {
        let variable = self.tree.variables.push(Variable {
            name: name.to_owned(),
            ty,
            kind,
            initializer: None,
            value: value.map(|value| Constant::scalar(Value::Int(value))),
            at: None,
        });
        // A name that does not occur in the text need not be in scope.
        let is_declared = !kind.is_input() || (self.dialect.is_implicit() && self.stage.has_input(name));
        if let Some(symbol) = self.interner.find(name).filter(|_| is_declared) {
            self.scopes.declare(symbol, Entity::Variable(variable));
        }
    }
}

// Inference of the shapes of channels that the options do not give.

/// The known or inferred shapes of the four channels.
#[derive(Debug, Clone)]
pub(crate) struct Channels {
    pub(crate) shapes: [SamplerShape; 4],
    /// Which shapes the options give.
    given: [bool; 4],
    /// Whether a use changed a shape in this pass: then the shader must be parsed again.
    pub(crate) changed: bool,
}

impl Channels {
    pub(crate) fn new(options: &Options) -> Self {
        Self {
            shapes: options.channels.map(|shape| shape.unwrap_or(SamplerShape::D2)),
            given: options.channels.map(|shape| shape.is_some()),
            changed: false,
        }
    }
}

impl Checker<'_> {
    /// Called when no overload takes the arguments: returns whether one would if a channel among them had a
    /// different shape, and changes the channel's shape.
    pub(super) fn infer_channel(
        &mut self,
        arguments: &[ExprId],
        resolves: impl Fn(&Self, &[Type]) -> bool,
    ) -> bool {
        for (position, &argument) in arguments.iter().enumerate() {
            let Some(channel) = self
                .channel(argument)
                .filter(|&channel| !self.channels.given[channel])
            else {
                continue;
            };
            let mut types = self.types(arguments);
            // Shapes only move forward in this list, so that the shader is parsed a few times at most. Every
            // lookup that takes a cube and a direction also takes a volume, but not the reverse.
            let order = [SamplerShape::D2, SamplerShape::Cube, SamplerShape::D3];
            let now = self.channels.shapes[channel];
            if types[position] != Type::Sampler(Sampler::float(now)) {
                // Changed earlier in this pass, which continues with the old shape until the shader is parsed
                // again.
                return true;
            }
            for &shape in order.iter().skip_while(|&&shape| shape != now).skip(1) {
                types[position] = Type::Sampler(Sampler::float(shape));
                if resolves(self, &types) {
                    self.channels.shapes[channel] = shape;
                    self.channels.changed = true;
                    return true;
                }
            }
        }
        false
    }

    /// The shapes of the channels so far.
    pub(crate) fn channels(&self) -> &Channels {
        &self.channels
    }

    fn channel(&self, argument: ExprId) -> Option<usize> {
        let ExprKind::Variable(variable) = self.tree[argument].kind else {
            return None;
        };
        match self.tree[variable].kind {
            VariableKind::Channel(channel) => Some(usize::from(channel)),
            _ => None,
        }
    }
}
