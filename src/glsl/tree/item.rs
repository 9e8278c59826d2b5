//! What stands outside of functions, and the variables of all scopes.

use super::{Block, Constant, ExprId, Id, Place, StructId, Type};

/// One declaration at global scope, in the author's order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Item {
    /// A structure.
    Struct(StructId),
    /// A variable or constant.
    Variable(VariableId),
    /// `float f(float);`: a declaration without body of a function that is defined elsewhere, or never called.
    Prototype(FunctionId),
    /// A function with its body.
    Function(FunctionId),
}

/// Names a function of a tree.
pub type FunctionId = Id<Function>;

/// A function of the author: one overload of its name.
#[derive(Debug, Clone)]
pub struct Function {
    /// The author's name for it.
    pub name: String,
    /// `void` for none.
    pub return_type: Type,
    /// In order; each is a [`VariableKind::Parameter`]. Those of the definition, if there is one.
    pub parameters: Vec<VariableId>,
    /// None if it is declared and never defined; then nothing calls it.
    pub body: Option<Block>,
    /// Where its name stands in the definition, else in the first prototype.
    pub at: Place,
}

/// Names a variable of a tree.
pub type VariableId = Id<Variable>;

/// A variable, a constant, a parameter, a uniform or something built in.
#[derive(Debug, Clone)]
pub struct Variable {
    /// The author's name for it; empty for a parameter without one. Several variables may share a name: scopes
    /// are resolved.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// What it is.
    pub kind: VariableKind,
    /// What it begins with. Of a local without one, and of a global, the beginning is zero, as in WebGL.
    pub initialiser: Option<ExprId>,
    /// The value of a constant.
    pub value: Option<Constant>,
    /// Where its name stands; none for what is built in.
    pub at: Option<Place>,
}

/// What a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VariableKind {
    /// At global scope, written by the shader. Its initialiser is a constant expression, except under `lenient`:
    /// then initialisers run before `mainImage`, in the author's order.
    Global,
    /// `const` with an initialiser, at any scope. [`Variable::value`] is known if the initialiser is a constant
    /// expression, as it is except under `lenient`.
    Const,
    /// Inside of a function.
    Local,
    /// Of a function.
    Parameter(Direction),
    /// A uniform that `ShaderToy` feeds.
    Input(Input),
    /// A uniform that the author declares and nobody feeds: zero.
    Uniform,
    /// A varying that the author declares with `in` and nobody feeds: zero.
    Varying,
    /// An output that the author declares with `out`, and nobody reads.
    Output,
    /// `gl_FragCoord` and the like.
    BuiltIn(BuiltInVariable),
    /// `gl_MaxDrawBuffers` and the like; its value is known.
    BuiltInConstant,
}

/// How a parameter is passed (§6.1.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Copied in; the function may change its copy.
    In,
    /// `const in`: copied in, never changed.
    ConstIn,
    /// Copied back at the end; zero at the beginning, as in WebGL.
    Out,
    /// Copied in, and back at the end.
    InOut,
}

/// The uniforms of `ShaderToy`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Input {
    /// `vec3 iResolution`: pixels, pixels, pixel aspect (1).
    Resolution,
    /// `float iTime`: seconds.
    Time,
    /// `float iTimeDelta`: seconds.
    TimeDelta,
    /// `float iFrameRate`: frames a second.
    FrameRate,
    /// `int iFrame`: from 0.
    Frame,
    /// `float iChannelTime[4]`: seconds.
    ChannelTime,
    /// `vec3 iChannelResolution[4]`: texels.
    ChannelResolution,
    /// `vec4 iMouse`: pixels.
    Mouse,
    /// `vec4 iDate`: year, month from 0, day, seconds.
    Date,
    /// `float iSampleRate`: hertz.
    SampleRate,
    /// `iChannel0` to `iChannel3`.
    Channel(u8),
}

/// The variables that every fragment shader has (§7.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BuiltInVariable {
    /// `vec4 gl_FragCoord`.
    FragCoord,
    /// `bool gl_FrontFacing`.
    FrontFacing,
    /// `vec2 gl_PointCoord`.
    PointCoord,
    /// `float gl_FragDepth`: written.
    FragDepth,
}
