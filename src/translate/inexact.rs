//! The functions whose last bits are implementation-defined: one list for both expansions, in the
//! tree (`lower::polyfill`) and in SPIR-V (`backend::spirv`).

use ::spirv::{GlslStd450Op as Ext, Op};
use toyproof_glsl::tree::BuiltIn;
use toyproof_math::{self as math, FloatTerm, Matrix};

/// A function whose last bits are implementation-defined.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InexactFunction<'a> {
    pub(crate) built_in: BuiltIn,
    instruction: Instruction,
    pub(crate) definition: Definition<'a>,
}

/// The SPIR-V instruction of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Instruction {
    Extended(Ext),
    Core(Op),
}

/// The composition of exact operations that replaces a function.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Definition<'a> {
    /// Of one component of each argument.
    Unary(fn(FloatTerm<'a>) -> FloatTerm<'a>),
    Binary(fn(FloatTerm<'a>, FloatTerm<'a>) -> FloatTerm<'a>),
    Ternary(fn(FloatTerm<'a>, FloatTerm<'a>, FloatTerm<'a>) -> FloatTerm<'a>),
    /// Of all components of all arguments, matrices in column order.
    Vectors(fn(&[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>>),
    /// A GLSL body, of the parameter `toyproof_a`.
    Glsl(&'static str),
}

impl<'a> InexactFunction<'a> {
    const fn extended(built_in: BuiltIn, instruction: Ext, definition: Definition<'a>) -> Self {
        Self {
            built_in,
            instruction: Instruction::Extended(instruction),
            definition,
        }
    }

    const fn core(built_in: BuiltIn, instruction: Op, definition: Definition<'a>) -> Self {
        Self {
            built_in,
            instruction: Instruction::Core(instruction),
            definition,
        }
    }

    #[rustfmt::skip]
    const ALL: [Self; 39] = {
        use BuiltIn as B;
        use Definition::{Binary, Glsl, Ternary, Unary, Vectors};
        [
            Self::extended(B::Radians, Ext::Radians, Unary(math::radians)),
            Self::extended(B::Degrees, Ext::Degrees, Unary(math::degrees)),
            Self::extended(B::Sin, Ext::Sin, Unary(math::sin)),
            Self::extended(B::Cos, Ext::Cos, Unary(math::cos)),
            Self::extended(B::Tan, Ext::Tan, Unary(math::tan)),
            Self::extended(B::Asin, Ext::Asin, Unary(math::asin)),
            Self::extended(B::Acos, Ext::Acos, Unary(math::acos)),
            Self::extended(B::Atan, Ext::Atan, Unary(math::atan)),
            Self::extended(B::Atan, Ext::Atan2, Binary(math::atan2)),
            Self::extended(B::Sinh, Ext::Sinh, Unary(math::sinh)),
            Self::extended(B::Cosh, Ext::Cosh, Unary(math::cosh)),
            Self::extended(B::Tanh, Ext::Tanh, Unary(math::tanh)),
            Self::extended(B::Asinh, Ext::Asinh, Unary(math::asinh)),
            Self::extended(B::Acosh, Ext::Acosh, Unary(math::acosh)),
            Self::extended(B::Atanh, Ext::Atanh, Unary(math::atanh)),
            Self::extended(B::Pow, Ext::Pow, Binary(math::pow)),
            Self::extended(B::Exp, Ext::Exp, Unary(math::exp)),
            Self::extended(B::Log, Ext::Log, Unary(math::log)),
            Self::extended(B::Exp2, Ext::Exp2, Unary(math::exp2)),
            Self::extended(B::Log2, Ext::Log2, Unary(math::log2)),
            Self::extended(B::InverseSqrt, Ext::InverseSqrt, Unary(math::inverse_sqrt)),
            Self::extended(B::Fract, Ext::Fract, Unary(math::fract)),
            Self::core(B::Mod, Op::FMod, Binary(math::modulo)),
            Self::extended(B::Mix, Ext::FMix, Ternary(math::mix)),
            Self::extended(B::Step, Ext::Step, Binary(math::step)),
            Self::extended(B::Smoothstep, Ext::SmoothStep, Ternary(math::smoothstep)),
            Self::extended(B::Length, Ext::Length, Vectors(|a| vec![math::length(&a[0])])),
            Self::extended(B::Distance, Ext::Distance, Vectors(|a| vec![math::distance(&a[0], &a[1])])),
            Self::core(B::Dot, Op::Dot, Vectors(|a| vec![math::dot(&a[0], &a[1])])),
            Self::extended(B::Cross, Ext::Cross, Vectors(|a| cross(&a[0], &a[1]))),
            Self::extended(B::Normalize, Ext::Normalize, Vectors(|a| math::normalize(&a[0]))),
            Self::extended(B::Faceforward, Ext::FaceForward, Vectors(|a| math::faceforward(&a[0], &a[1], &a[2]))),
            Self::extended(B::Reflect, Ext::Reflect, Vectors(|a| math::reflect(&a[0], &a[1]))),
            Self::extended(B::Refract, Ext::Refract, Vectors(|a| math::refract(&a[0], &a[1], a[2][0]))),
            Self::extended(B::Determinant, Ext::Determinant, Vectors(|a| vec![math::determinant(&square(&a[0]))])),
            Self::extended(B::Inverse, Ext::MatrixInverse, Vectors(|a| math::inverse(&square(&a[0])).components())),
            Self::extended(B::UnpackSnorm2x16, Ext::UnpackSnorm2x16, Glsl(
                "return vec2(max(float(int(toyproof_a << 16u) >> 16u) / 32767.0, -1.0), \
                 max(float(int(toyproof_a) >> 16u) / 32767.0, -1.0));",
            )),
            Self::extended(B::UnpackUnorm2x16, Ext::UnpackUnorm2x16, Glsl(
                "return vec2(float(int(toyproof_a & 65535u)) / 65535.0, float(int(toyproof_a >> 16u)) / 65535.0);",
            )),
            // Mesa 22.3 treats the upper half of a constant as zero.
            Self::extended(B::UnpackHalf2x16, Ext::UnpackHalf2x16, Glsl(
                "return vec2(unpackHalf2x16(toyproof_a).x, unpackHalf2x16(toyproof_a >> 16u).x);",
            )),
        ]
    };

    /// The function of that name with that number of arguments, if its last bits are implementation-defined.
    pub(crate) fn of(built_in: BuiltIn, arguments: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|function| {
            function.built_in == built_in
                && function
                    .definition
                    .argument_count()
                    .is_none_or(|count| count == arguments)
        })
    }

    /// The function that an instruction of `GLSL.std.450` computes.
    pub(crate) fn of_extended(instruction: Ext) -> Option<Self> {
        Self::of_instruction(Instruction::Extended(instruction))
    }

    /// The function that a core instruction of SPIR-V computes.
    pub(crate) fn of_core(instruction: Op) -> Option<Self> {
        Self::of_instruction(Instruction::Core(instruction))
    }

    fn of_instruction(instruction: Instruction) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|function| function.instruction == instruction)
    }
}

impl Definition<'_> {
    /// Whether a function of vectors is that of their components.
    pub(crate) fn is_componentwise(self) -> bool {
        self.argument_count().is_some()
    }

    /// The number of arguments of a componentwise function.
    fn argument_count(self) -> Option<usize> {
        match self {
            Self::Unary(_) => Some(1),
            Self::Binary(_) => Some(2),
            Self::Ternary(_) => Some(3),
            Self::Vectors(_) | Self::Glsl(_) => None,
        }
    }
}

fn cross<'a>(a: &[FloatTerm<'a>], b: &[FloatTerm<'a>]) -> Vec<FloatTerm<'a>> {
    math::cross([a[0], a[1], a[2]], [b[0], b[1], b[2]]).to_vec()
}

fn square<'a>(components: &[FloatTerm<'a>]) -> Matrix<FloatTerm<'a>> {
    Matrix::new(components, components.len().isqrt())
}
