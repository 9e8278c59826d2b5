//! Generates valid programs from bytes: every type and statement of the language. By default without undefined behavior
//! and with exact arithmetic, so that all implementations must render the same image to the bit; [`Arithmetic::Any`] is
//! for implementations of the same rounding.
//!
//! Operands with side effects are evaluated from left to right; a compound assignment reads its target after
//! its right side, but evaluates the target's indices before it; a function's `inout` arguments are copied in
//! when all arguments are evaluated. [`Effects`] states where such operands may occur. Indices are masked,
//! divisors positive, shifts below 32, loops bounded. A float in a variable is a multiple of 1/16 of at most
//! 64 (`Range::VARIABLE`); where an expression could exceed 24 bits, `tame` reduces it.

mod choices;
mod digest;
mod expr;
mod expression;
mod inexact;
mod place;
mod random;
mod statement;
mod types;
mod value;

use std::fmt::Write;

use choices::Choices;
use expr::Range;
pub use random::{effects, programs, rng};
use types::{Base, FLOAT, INT, SCALARS, Scalar, Struct, Type};

/// The maximum number of executions of a program's most deeply nested statement.
const MAX_WORK: u32 = 2_000;
/// The approximate maximum number of expressions in a statement.
const MAX_OPERANDS: u32 = 40;

/// A variable in scope.
#[derive(Debug, Clone)]
struct Variable {
    name: String,
    ty: Type,
    writable: bool,
    constant: bool,
    /// The range of its floats.
    range: Range,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Passing {
    In,
    Out,
    InOut,
}

/// A function that can be called.
#[derive(Debug, Clone)]
struct Function {
    name: String,
    parameters: Vec<(Passing, Type)>,
    result: Option<Type>,
    /// The number of executions of its most deeply nested statement.
    work: u32,
}

/// Where operands with side effects may occur.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effects {
    /// Wherever the specification defines the order: not next to an `out` argument.
    Ordered,
    /// Anywhere; and several `out` arguments may be parts of one variable.
    Anywhere,
}

/// The operations that occur.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// Those whose results are exact and defined.
    Exact,
    /// All: rounded and undefined ones, and functions whose last bits are implementation-defined.
    Any,
    /// All, but the image shows neither the sign of a zero nor the bits of NaN, which Vulkan leaves to the driver.
    AnyOnDrivers,
}

/// The kind of expression that is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Mode {
    /// Anything.
    Any,
    /// Without side effects.
    Pure,
    /// A constant expression.
    Constant,
}

/// The enclosing constructs that a jump may leave.
#[derive(Debug, Clone, Copy, Default)]
struct Around {
    in_loop: bool,
    in_switch: bool,
}

struct Generator<'a> {
    choices: Choices<'a>,
    text: String,
    indent: usize,
    structs: Vec<Struct>,
    functions: Vec<Function>,
    /// From the outermost to the innermost.
    scopes: Vec<Vec<Variable>>,
    /// Helper functions, each after those that it calls.
    helpers: Vec<String>,
    mode: Mode,
    effects: Effects,
    arithmetic: Arithmetic,
    /// Whether places must be the same each time they are evaluated.
    steady: bool,
    depth: usize,
    operands: u32,
    /// The number of executions of the current statement per call of its function.
    runs: u32,
    /// The maximum over all statements of the current function.
    work: u32,
    /// The current function's result type.
    result: Option<Type>,
    in_main: bool,
    around: Around,
}

/// Generates the program from bytes: an eighth of them decides the globals, three eighths the functions, the
/// rest `mainImage`.
#[must_use]
pub fn program(bytes: &[u8], effects: Effects, arithmetic: Arithmetic) -> String {
    let (globals, rest) = bytes.split_at(bytes.len() / 8);
    let (functions, main) = rest.split_at(bytes.len() * 3 / 8);
    let mut generator = Generator {
        choices: Choices::new(globals),
        text: String::new(),
        indent: 0,
        structs: Vec::new(),
        functions: Vec::new(),
        scopes: vec![inputs()],
        helpers: Vec::new(),
        mode: Mode::Any,
        effects,
        arithmetic,
        steady: false,
        depth: 0,
        operands: 0,
        runs: 1,
        work: 1,
        result: None,
        in_main: false,
        around: Around::default(),
    };
    generator.program(functions, main)
}

/// The inputs that ShaderToy provides.
fn inputs() -> Vec<Variable> {
    let input = |name: &str, ty, range| Variable {
        name: name.into(),
        ty,
        writable: false,
        constant: false,
        range,
    };
    vec![
        input("iTime", FLOAT, Range::new(2.5, 1)),
        input("iFrame", INT, Range::VARIABLE),
        input(
            "iResolution",
            Type::of(Base::Vector(Scalar::Float, 3)),
            Range::new(64.0, 0),
        ),
    ]
}

const MACROS: &str = "#define THREE (1 + 2)
#define MAD(a, b) ((a) * 3 + (b))
#define LOOP(i, n) for (int i = 0; i < (n); i++)
#define BUMP(x) x++
";

impl<'a> Generator<'a> {
    fn program(&mut self, functions: &'a [u8], main: &'a [u8]) -> String {
        let structs = self.choices.below(4);
        for _ in 0..structs {
            self.structure();
        }
        self.scopes.push(Vec::new());
        let globals = self.choices.below(6);
        for _ in 0..globals {
            self.global();
        }
        let count = functions.len() / 40;
        for part in functions.chunks(functions.len() / count.clamp(1, 4) + 1) {
            self.choices = Choices::new(part);
            self.function();
        }
        self.choices = Choices::new(main);
        self.main_image();
        let mut program = MACROS.to_owned();
        for (number, structure) in self.structs.iter().enumerate() {
            program += &declaration(number, structure);
        }
        for helper in &self.helpers {
            program += helper;
        }
        program + &self.text
    }

    fn structure(&mut self) {
        const NAMES: [&str; 6] = ["k", "xy", "f", "g", "m", "rgb"];
        let count = 1 + self.choices.below(4);
        let fields = (0..count)
            .map(|field| (NAMES[field], self.field_type()))
            .collect();
        self.structs.push(Struct { fields });
    }

    /// Any type.
    fn ty(&mut self) -> Type {
        let base = match self.choices.below(8) {
            0 | 1 => Base::Scalar(self.choices.pick(&SCALARS)),
            2..=4 => Base::Vector(self.choices.pick(&SCALARS), self.size()),
            5 => Base::Matrix(self.size(), self.size()),
            _ => match self.structs.len() {
                0 => Base::Scalar(Scalar::Float),
                count => Base::Struct(self.choices.below(count) as u8),
            },
        };
        let length = self.choices.chance(40).then(|| 1 + self.choices.below(4) as u8);
        // Structures nest twice and then no more: arrays of arrays of arrays are slow to compile.
        let length = match base {
            Base::Struct(_) => length.map(|length| length.min(2)),
            _ => length,
        };
        Type { base, length }
    }

    /// Arrays are more frequent in structures than elsewhere.
    fn field_type(&mut self) -> Type {
        let ty = self.ty();
        let length = self.choices.chance(80).then(|| 1 + self.choices.below(3) as u8);
        match ty.base {
            Base::Struct(_) => ty,
            _ => Type {
                length: ty.length.or(length),
                ..ty
            },
        }
    }

    fn size(&mut self) -> u8 {
        self.choices.pick(&[2, 3, 4])
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.text, "{:1$}{text}", "", 4 * self.indent);
    }

    /// A name that is not used in the innermost scope; often one that shadows another.
    fn name(&mut self) -> String {
        const NAMES: [&str; 10] = ["a", "b", "c", "d", "e", "sin", "p", "x", "iDate", "over"];
        let scope = self.scopes.last().map_or(&[][..], Vec::as_slice);
        let first = match NAMES[self.choices.below(NAMES.len())] {
            // Programs with any arithmetic call it.
            "sin" if self.is_wild() => "sine",
            first => first,
        };
        let mut name = first.to_owned();
        let mut number = 0;
        while scope.iter().any(|variable| variable.name == name) {
            number += 1;
            name = format!("{first}{number}");
        }
        name
    }

    /// A writable place of that type whose indices are literals, so that it can be repeated.
    fn steady_place(&mut self, ty: Type) -> Option<String> {
        self.steady = true;
        let place = self.place(ty, true, &[]);
        self.steady = false;
        Some(place?.1.text)
    }

    fn declare(&mut self, variable: Variable) {
        self.scopes.last_mut().expect("a scope is open").push(variable);
    }

    /// Whether undefined, rounded and implementation-defined operations occur.
    fn is_wild(&self) -> bool {
        self.arithmetic != Arithmetic::Exact
    }

    fn within<T>(&mut self, mode: Mode, work: impl FnOnce(&mut Self) -> T) -> T {
        let outer = self.mode;
        self.mode = outer.max(mode);
        let result = work(self);
        self.mode = outer;
        result
    }
}

fn declaration(number: usize, structure: &Struct) -> String {
    let mut text = format!("struct S{number} {{");
    for &(name, ty) in &structure.fields {
        let _ = write!(text, " {} {name}{};", ty.base.name(), dimension(ty));
    }
    text + " };\n"
}

/// The dimension after an array's name, such as `[3]`.
fn dimension(ty: Type) -> String {
    ty.length.map(|length| format!("[{length}]")).unwrap_or_default()
}
