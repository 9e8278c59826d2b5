//! The built-in functions (GLSL ES 3.00.6 §8): one row for each, with everything that other stages need to
//! know about it. Only the evaluator's implementation is elsewhere.

mod constant;
mod documentation;
mod table;

use toyproof_math::FloatTerm;

use self::constant::ConstantFunction;
pub use self::documentation::{Documentation, Overload};
pub use self::table::BuiltIn;
use crate::tree::{BinaryOp, Constant, Type, Value};

/// What is known of a function.
struct Row {
    name: &'static str,
    /// The signatures, in the notation of the specification. `genType` and similar types match a scalar and
    /// its vectors, `vec` the vectors alone, `mat` any matrix, `g` before `sampler` and `vec4` any of the
    /// three texel types; each has the same binding throughout one signature. `[float]` is optional; `const`
    /// requires a constant expression. The first signature that matches applies.
    signatures: &'static [&'static str],
    /// The value for constants.
    constant: ConstantFunction,
    wgsl: Wgsl,
    /// The definitions that replace the function where the last bits must not depend on the implementation:
    /// one for each number of arguments. Empty for functions that all implementations compute alike.
    exact: &'static [ExactDefinition],
}

/// The form of a function in WGSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wgsl {
    /// A function of the same name.
    Same,
    /// A function of another name.
    Named(&'static str),
    /// A function of the same name, whose arguments have the type of the result: scalars in place of vectors
    /// are extended.
    Splat,
    /// An operator between two operands.
    Operator(BinaryOp),
    /// `bitcast` to the type of the result.
    Bitcast,
    /// Another form, which depends on the arguments.
    Special,
    /// WGSL has no such function.
    Missing,
}

/// The composition of exact operations that replaces a function.
#[derive(Debug, Clone, Copy)]
pub struct ExactDefinition {
    /// The instruction of SPIR-V that is replaced.
    pub instruction: Instruction,
    /// What replaces the instruction.
    pub definition: Definition,
}

/// An instruction of SPIR-V, by its name in the specification.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instruction {
    /// An instruction of the extended set `GLSL.std.450`.
    Extended(&'static str),
    /// A core instruction.
    Core(&'static str),
}

/// A composition of exact operations.
#[derive(Debug, Clone, Copy)]
pub enum Definition {
    /// A function of one component of the argument.
    Unary(for<'a> fn(FloatTerm<'a>) -> FloatTerm<'a>),
    /// A function of one component of each of two arguments.
    Binary(for<'a> fn(FloatTerm<'a>, FloatTerm<'a>) -> FloatTerm<'a>),
    /// A function of one component of each of three arguments.
    Ternary(for<'a> fn(FloatTerm<'a>, FloatTerm<'a>, FloatTerm<'a>) -> FloatTerm<'a>),
    /// A function of all components of all arguments, matrices in column order.
    Vectors(for<'a> fn(&[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>>),
    /// The body of a GLSL function with one parameter, named `toyproof_a`.
    Glsl(&'static str),
}

impl Definition {
    /// The number of arguments of a componentwise function; `None` for others.
    pub fn argument_count(self) -> Option<usize> {
        match self {
            Self::Unary(_) => Some(1),
            Self::Binary(_) => Some(2),
            Self::Ternary(_) => Some(3),
            Self::Vectors(_) | Self::Glsl(_) => None,
        }
    }
}

/// A function of `GLSL.std.450`.
const fn ext(name: &'static str, definition: Definition) -> ExactDefinition {
    ExactDefinition {
        instruction: Instruction::Extended(name),
        definition,
    }
}

/// A core instruction.
const fn core(name: &'static str, definition: Definition) -> ExactDefinition {
    ExactDefinition {
        instruction: Instruction::Core(name),
        definition,
    }
}

/// The name in a signature such as `float sin(float)`.
const fn name_in(signature: &'static str) -> &'static str {
    let bytes = signature.as_bytes();
    let mut start = 0;
    while bytes[start] != b' ' {
        start += 1;
    }
    let mut end = start;
    while bytes[end] != b'(' {
        end += 1;
    }
    signature.split_at(end).0.split_at(start + 1).1
}

impl Row {
    const fn new(signatures: &'static [&'static str]) -> Self {
        Self {
            name: name_in(signatures[0]),
            signatures,
            constant: ConstantFunction::Unknown,
            wgsl: Wgsl::Same,
            exact: &[],
        }
    }
}

impl BuiltIn {
    /// The name in GLSL.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The signatures, in the notation of the specification.
    pub(crate) fn signatures(self) -> &'static [&'static str] {
        self.row().signatures
    }

    /// The value for constant arguments, of type `ty`; `None` if the value is undefined or not supported.
    pub(crate) fn of_constants(self, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
        self.row().constant.call(ty, arguments)
    }

    /// The form in WGSL.
    pub fn wgsl(self) -> Wgsl {
        self.row().wgsl
    }

    /// The definitions by exact operations, one for each number of arguments; empty unless the last bits are
    /// implementation-defined.
    pub fn exact_definitions(self) -> &'static [ExactDefinition] {
        self.row().exact
    }

    /// The index of the parameter that is written, if any: `modf`'s second.
    pub fn out_parameter(self) -> Option<usize> {
        (self == Self::Modf).then_some(1)
    }

    /// Whether the function reads a texture; such calls are not constant expressions (§4.3.3).
    pub fn is_texture(self) -> bool {
        // The table lists the texture functions in a row.
        self >= Self::TextureSize && self <= Self::TextureProjGradOffset
    }

    /// Whether the function is a derivative, which uses the neighbors in the pixel's quad.
    pub fn is_derivative(self) -> bool {
        matches!(self, Self::DFdx | Self::DFdy | Self::Fwidth)
    }
}
