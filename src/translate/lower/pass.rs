//! The passes and their order.

use toyproof_diagnostic::{Deadline, Overdue};

use super::draft::Draft;

macro_rules! passes {
    ($($(#[$doc:meta])* $variant:ident = $run:path,)*) => {
        /// One construct that naga's GLSL front end gets wrong; in the order in which they are lowered.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Pass {
            $($(#[$doc])* $variant,)*
        }

        impl Pass {
            /// All of them, in order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            fn run(self, draft: &mut Draft) {
                match self {
                    $(Self::$variant => $run(draft),)*
                }
            }
        }
    };
}

passes! {
    /// Sampler parameters.
    Samplers = super::sampler::run,
    /// Built-in variables and uniforms that are not there.
    Surroundings = super::surroundings::run,
    /// `&&` and `||` with an effect on the right.
    ShortCircuit = super::short_circuit::run,
    /// Built-in functions whose last bits drivers choose; for strict shaders only.
    Elementary = super::elementary::run,
    /// `modf`, `matrixCompMult`, `outerProduct`, `inverse`.
    Missing = super::missing::run,
    /// `dot` and the like of floats.
    Geometric = super::geometric::run,
    /// `isnan` and `isinf`.
    IsNan = super::is_nan::run,
    /// Offsets of texture lookups.
    Texels = super::texel::run,
    /// Matrix constructors.
    Matrices = super::matrix::run,
    /// Vectors and numbers made of a `bool`.
    Booleans = super::boolean::run,
    /// Swizzles of swizzles and of matrix columns, assigned to.
    Swizzles = super::swizzle::run,
    /// Indices that do something, evaluated once.
    Indices = super::index::run,
    /// Compound assignments whose right side changes their target.
    Compounds = super::compound::run,
    /// Products of matrices, whose sums drivers order as they like; for strict shaders only.
    Products = super::elementary::products,
    /// `-x` of unsigned integers.
    Negations = super::negation::run,
    /// `%`.
    Remainders = super::remainder::run,
    /// `out` and `inout` arguments that are parts of variables.
    OutArguments = super::out_argument::run,
    /// `==` of structures and arrays.
    Equality = super::equality::run,
    /// `!=` of floats.
    Inequality = super::inequality::run,
    /// Members of structures that naga lays out in its own way.
    Members = super::member::run,
    /// Infinities and other constants that naga cannot evaluate.
    Constants = super::constant::run,
    /// Chains of thousands of operators.
    Depth = super::depth::run,
    /// Global initialisers and constant arrays.
    Globals = super::global::run,
    /// Variables that begin without a value.
    Uninitialised = super::uninitialised::run,
    /// Steps of `for` that Mesa takes once too often.
    Steps = super::for_step::run,
    /// Declarations in the heads of loops.
    LoopHeads = super::loop_head::run,
    /// `continue` in `do … while`.
    DoWhile = super::do_while::run,
    /// Calls of `void` functions in the heads of loops.
    LoopVoids = super::loop_void::run,
    /// Chains of hundreds of `else if`.
    ElseIfs = super::else_if::run,
    /// Statements that nothing runs.
    DeadCode = super::dead_code::run,
    /// Fall-through in `switch`.
    Switches = super::switch::run,
    /// What is nested deeper than lavapipe counts.
    Nesting = super::nesting::run,
    /// Sequences as statements.
    Sequences = super::sequence::run,
    /// Functions that may end without a `return`.
    MissingReturns = super::missing_return::run,
}

/// A set of passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passes(u64);

impl Passes {
    /// Every pass that naga and the drivers need.
    #[must_use]
    pub fn all() -> Self {
        Self::strict().without(Pass::Elementary).without(Pass::Products)
    }

    /// These, and those that make a shader's bits the same everywhere.
    #[must_use]
    pub fn strict() -> Self {
        Self(u64::MAX)
    }

    /// These without that one.
    #[must_use]
    pub fn without(self, pass: Pass) -> Self {
        Self(self.0 & !(1 << pass as u32))
    }

    /// Whether that one is among them.
    #[must_use]
    pub fn contains(self, pass: Pass) -> bool {
        self.0 & (1 << pass as u32) != 0
    }

    pub(crate) fn run(self, draft: &mut Draft, deadline: &Deadline) -> Result<(), Overdue> {
        for pass in Pass::ALL.iter().filter(|pass| self.contains(**pass)) {
            deadline.check()?;
            pass.run(draft);
        }
        Ok(())
    }
}
