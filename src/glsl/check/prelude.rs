//! What is declared before the author's first line: `ShaderToy`'s inputs, and the variables and constants of §7.

use std::ops::RangeInclusive;

use super::Checker;
use super::scope::Entity;
use crate::tree::{BuiltInVariable, Constant, Input, Sampler, Scalar, Type, Value, Variable, VariableKind};

/// The smallest values that WebGL 2 promises (§7.3).
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

/// How far a texture lookup can be offset on every machine.
pub(super) const TEXEL_OFFSETS: RangeInclusive<i32> = -8..=7;

impl Checker<'_> {
    pub(super) fn declare_prelude(&mut self) {
        let vec = |size| Type::Vector(Scalar::Float, size);
        let times = self.tree.array_of(Type::FLOAT, 4);
        let resolutions = self.tree.array_of(vec(3), 4);
        let inputs = [
            ("iResolution", vec(3), Input::Resolution),
            ("iTime", Type::FLOAT, Input::Time),
            ("iTimeDelta", Type::FLOAT, Input::TimeDelta),
            ("iFrameRate", Type::FLOAT, Input::FrameRate),
            ("iFrame", Type::INT, Input::Frame),
            ("iChannelTime", times, Input::ChannelTime),
            ("iChannelResolution", resolutions, Input::ChannelResolution),
            ("iMouse", vec(4), Input::Mouse),
            ("iDate", vec(4), Input::Date),
            ("iSampleRate", Type::FLOAT, Input::SampleRate),
        ];
        for (name, ty, input) in inputs {
            self.built_in(name, ty, VariableKind::Input(input), None);
        }
        let channels = ["iChannel0", "iChannel1", "iChannel2", "iChannel3"];
        for ((name, shape), index) in channels.into_iter().zip(self.channels.shapes).zip(0..) {
            let ty = Type::Sampler(Sampler::float(shape));
            self.built_in(name, ty, VariableKind::Input(Input::Channel(index)), None);
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
    }

    fn built_in(&mut self, name: &str, ty: Type, kind: VariableKind, value: Option<i32>) {
        let variable = self.tree.variables.push(Variable {
            name: name.to_owned(),
            ty,
            kind,
            initialiser: None,
            value: value.map(|value| Constant::scalar(Value::Int(value))),
            at: None,
        });
        // A name that the text does not hold needs no meaning.
        if let Some(symbol) = self.words.find(name) {
            self.scopes.declare(symbol, Entity::Variable(variable));
        }
    }
}
