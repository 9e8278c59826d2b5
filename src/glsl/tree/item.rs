//! Declarations at global scope, variables of all scopes, and statements.

use super::{Constant, ExprId, Id, Input, Place, StructId, Type};

/// One declaration at global scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Item {
    /// A structure.
    Struct(StructId),
    /// A variable or constant.
    Variable(VariableId),
    /// `float f(float);`: a prototype of a function that is defined elsewhere, or never called.
    Prototype(FunctionId),
    /// A function with its body.
    Function(FunctionId),
}

/// The id of a function.
pub type FunctionId = Id<Function>;

/// A user function: one overload of its name.
#[derive(Debug, Clone)]
pub struct Function {
    /// The name.
    pub name: String,
    /// The return type; `void` if there is no result.
    pub return_type: Type,
    /// The parameters in order, each a [`VariableKind::Parameter`]; those of the definition, if there is one.
    pub parameters: Vec<VariableId>,
    /// None if it is declared but not defined; then it is never called.
    pub body: Option<Block>,
    /// The place of the function's name in the definition, otherwise in the first prototype.
    pub at: Place,
}

/// The id of a variable.
pub type VariableId = Id<Variable>;

/// A variable, a constant, a parameter, a uniform or a built-in variable.
#[derive(Debug, Clone)]
pub struct Variable {
    /// The name; empty for an unnamed parameter. Several variables may share a name: scopes are resolved.
    pub name: String,
    /// The type.
    pub ty: Type,
    /// The kind.
    pub kind: VariableKind,
    /// The initial value. A local or a global without one starts as zero, as in WebGL.
    pub initializer: Option<ExprId>,
    /// The value of a constant.
    pub value: Option<Constant>,
    /// The place of the variable's name; `None` for built-in variables.
    pub at: Option<Place>,
}

impl Variable {
    /// A variable without an initial value.
    pub fn new(name: impl Into<String>, ty: Type, kind: VariableKind, at: Option<Place>) -> Self {
        Self {
            name: name.into(),
            ty,
            kind,
            initializer: None,
            value: None,
            at,
        }
    }
}

/// The kind of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VariableKind {
    /// A global variable of the shader. Its initializer is a constant expression, except under `lenient`:
    /// then initializers run before `mainImage`, in source order.
    Global,
    /// `const` with an initializer, at any scope. [`Variable::value`] is known if the initializer is a
    /// constant expression, as it is except under `lenient`.
    Const,
    /// A local variable of a function.
    Local,
    /// A parameter of a function.
    Parameter(Direction),
    /// A uniform that `ShaderToy` sets.
    Input(Input),
    /// The sampler `iChannel0` to `iChannel3`.
    Channel(u8),
    /// A uniform that the shader declares; nothing sets it, so it is zero.
    Uniform,
    /// A varying that the shader declares with `in`; nothing sets it, so it is zero.
    Varying,
    /// An output that the shader declares with `out`; nothing reads it.
    Output,
    /// A built-in variable such as `gl_FragCoord`.
    BuiltIn(BuiltInVariable),
    /// A built-in constant such as `gl_MaxDrawBuffers`; its value is known.
    BuiltInConstant,
}

impl VariableKind {
    /// Whether `ShaderToy` sets the variable.
    pub fn is_input(self) -> bool {
        matches!(self, Self::Input(_) | Self::Channel(_))
    }
}

/// The direction in which a parameter is passed (§6.1.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Copied in; the function may modify its copy.
    In,
    /// `const in`: copied in, never changed.
    ConstIn,
    /// Copied back at the end; initially zero, as in WebGL.
    Out,
    /// Copied in, and back at the end.
    InOut,
}

/// The built-in variables of fragment shaders (§7.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BuiltInVariable {
    /// `vec4 gl_FragCoord`.
    FragCoord,
    /// `bool gl_FrontFacing`.
    FrontFacing,
    /// `vec2 gl_PointCoord`.
    PointCoord,
    /// `float gl_FragDepth`, an output.
    FragDepth,
}

// Statements (GLSL ES 3.00.6 §6).

/// A sequence of statements. Nesting is limited to [`MAX_NESTING`](crate::MAX_NESTING); `else if` chains do
/// not nest.
pub type Block = Vec<Statement>;

/// A statement.
#[derive(Debug, Clone)]
pub struct Statement {
    /// The kind of statement.
    pub kind: StatementKind,
    /// The place of the statement, up to the `;`; of a compound statement, the first keyword or `{`.
    pub at: Place,
}

impl Statement {
    /// A statement of that kind.
    pub fn new(kind: StatementKind, at: Place) -> Self {
        Self { kind, at }
    }
}

/// The kind of a statement.
#[derive(Debug, Clone)]
pub enum StatementKind {
    /// `f(x);`, `x = 1.;`.
    Expression(ExprId),
    /// Declares a local variable, in scope from here to the end of the enclosing block; its initializer, if
    /// any, runs each time. `float a, b;` becomes two statements.
    Declare(VariableId),
    /// Declares a structure inside a function.
    Struct(StructId),
    /// `{ … }`, which is a scope.
    Block(Block),
    /// `if (a) … else if (b) … else …`.
    If {
        /// The conditions with their bodies, in order; at least one.
        arms: Vec<Arm>,
        /// The body of the last `else`.
        otherwise: Option<Block>,
    },
    /// `switch`.
    Switch {
        /// An `int` or `uint`.
        selector: ExprId,
        /// The cases in order, with fallthrough (§6.2). All share one scope.
        cases: Vec<Case>,
    },
    /// `for (init; condition; step) …`.
    For {
        /// Declarations, or one expression. The declared variables are in scope in the loop only.
        init: Block,
        /// The loop is infinite if there is none.
        condition: Option<Condition>,
        /// Evaluated after each iteration and by `continue`.
        step: Option<ExprId>,
        /// The body.
        body: Block,
    },
    /// `while (condition) …`.
    While {
        /// Evaluated before each iteration.
        condition: Condition,
        /// The body.
        body: Block,
    },
    /// `do … while (condition);`.
    DoWhile {
        /// The body.
        body: Block,
        /// A `bool`, evaluated after each iteration and by `continue`.
        condition: ExprId,
    },
    /// `break;`.
    Break,
    /// `continue;`.
    Continue,
    /// `return;` or `return x;`, where `x` has exactly the function's return type.
    Return(Option<ExprId>),
    /// `discard;`.
    Discard,
}

/// One condition of an `if` with its body.
#[derive(Debug, Clone)]
pub struct Arm {
    /// A `bool`.
    pub condition: ExprId,
    /// Runs if the condition is true and no earlier one was.
    pub body: Block,
}

/// The condition of a `for` or `while`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// A `bool`.
    Expression(ExprId),
    /// `while (bool b = f())`: a `bool` with initializer, declared and tested before each iteration.
    Declare(VariableId),
}

/// A group of adjacent labels of a `switch` and the statements that follow them.
#[derive(Debug, Clone)]
pub struct Case {
    /// At least one: adjacent labels such as `case 0: case 1:` are grouped.
    pub labels: Vec<Label>,
    /// The statements up to the next label, without an implied `break`.
    pub body: Block,
    /// The place of the first label.
    pub at: Place,
}

/// A label of a `switch`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Label {
    /// `case x:`.
    Case {
        /// The expression, of the selector's type.
        expr: ExprId,
        /// The value; of an `int`, the bit pattern.
        value: u32,
    },
    /// `default:`.
    Default,
}

impl StatementKind {
    /// `if (condition) { body }`
    pub fn when(condition: ExprId, body: Block) -> Self {
        Self::If {
            arms: vec![Arm { condition, body }],
            otherwise: None,
        }
    }

    /// Whether the statement contains other statements.
    pub fn is_compound(&self) -> bool {
        matches!(
            self,
            Self::Block(_)
                | Self::If { .. }
                | Self::Switch { .. }
                | Self::For { .. }
                | Self::While { .. }
                | Self::DoWhile { .. }
        )
    }
}
