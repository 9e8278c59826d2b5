//! What a driver does where Vulkan or GLSL leaves the result open: denormals, NaN, conversions that are out
//! of range, divisions by zero, and contraction.

use toyproof::diagnostic::grouped;

use super::arguments::{Range, arguments};
use super::probe::{Case, Probe};

/// Results of several expressions, in one row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Behavior {
    /// What is measured.
    pub label: &'static str,
    /// The requirement of the specifications.
    pub requirement: &'static str,
    /// The expressions.
    pub questions: &'static [Question],
}

/// An expression with operands.
#[derive(Debug, Clone, Copy)]
pub struct Question {
    /// What is printed before the outcome.
    pub label: &'static str,
    /// A GLSL expression of `x`, `y` and `z`.
    pub expression: &'static str,
    /// The bits of the operands.
    pub operands: &'static [u32],
    /// The type of the result.
    pub kind: Kind,
}

/// The type of a result, and how it is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A float, which is printed.
    Float,
    /// A float with these bits if denormals are kept, and with those if they are flushed.
    Denormal(u32, u32),
    /// `int`.
    Int,
    /// `uint`.
    Uint,
    /// `bool`.
    Bool,
}

impl Kind {
    /// The expression as a `uint`.
    fn as_uint(self, expression: &str) -> String {
        match self {
            Self::Float | Self::Denormal(..) => format!("floatBitsToUint({expression})"),
            Self::Int | Self::Uint => format!("uint({expression})"),
            Self::Bool => format!("({expression}) ? 1u : 0u"),
        }
    }

    /// The outcome that these bits are.
    fn outcome(self, bits: u32) -> String {
        match self {
            Self::Float if f32::from_bits(bits).is_nan() => "NaN".to_owned(),
            Self::Float => format!("{:?}", f32::from_bits(bits)),
            Self::Denormal(kept, _) if bits == kept => "kept".to_owned(),
            // A zero of either sign.
            Self::Denormal(_, flushed) if bits == flushed || (bits | flushed) << 1 == 0 => {
                "flushed".to_owned()
            }
            Self::Denormal(..) => format!("{:e}", f32::from_bits(bits)),
            Self::Int => (bits as i32).to_string(),
            Self::Uint => bits.to_string(),
            Self::Bool => (bits != 0).to_string(),
        }
    }
}

impl Behavior {
    /// The probe of all its expressions.
    pub fn probe(&self) -> Probe {
        let questions = self.questions.iter();
        Probe {
            expressions: questions
                .clone()
                .map(|question| question.kind.as_uint(question.expression))
                .collect(),
            cases: questions
                .enumerate()
                .map(|(expression, question)| Case {
                    expression,
                    operands: question.operands.to_vec(),
                })
                .collect(),
        }
    }

    /// The outcomes that the results are.
    pub fn describe(&self, results: &[u32]) -> String {
        let outcomes = self.questions.iter().zip(results);
        let outcomes = outcomes.map(|(question, &bits)| {
            let outcome = question.kind.outcome(bits);
            let separator = if matches!(question.kind, Kind::Denormal(..)) {
                ":"
            } else {
                " ="
            };
            format!("`{}`{separator} {outcome}", question.label)
        });
        outcomes.collect::<Vec<_>>().join(", ")
    }
}

macro_rules! behaviors {
    ($($label:literal, $requirement:literal: [
        $($name:literal = $expression:literal ($($operand:expr),*) $kind:expr;)*
    ])*) => {
        /// All measured rows.
        pub static BEHAVIORS: &[Behavior] = &[$(Behavior {
            label: $label,
            requirement: $requirement,
            questions: &[$(Question {
                label: $name,
                expression: $expression,
                operands: &[$($operand),*],
                kind: $kind,
            }),*],
        }),*];
    };
}

const NAN: u32 = f32::NAN.to_bits();
const INFINITY: u32 = f32::INFINITY.to_bits();
const ZERO: u32 = 0;
const ONE: u32 = 1.0_f32.to_bits();
const TWO: u32 = 2.0_f32.to_bits();
const HALF: u32 = 0.5_f32.to_bits();
/// 2⁻¹²⁶, the smallest normal float.
const NORMAL: u32 = 0x0080_0000;
/// 1.5 · 2⁻¹²⁶.
const LARGER: u32 = 0x00c0_0000;
/// 2⁻¹²⁷, a denormal.
const DENORMAL: u32 = 0x0040_0000;
/// 2²⁴.
const SCALE: u32 = 16_777_216.0_f32.to_bits();
/// 2⁻¹⁰³ = 2⁻¹²⁷ · 2²⁴.
const SCALED: u32 = 0x0c00_0000;

behaviors! {
    "denormal results", "may be flushed": [
        "×" = "x * y" (NORMAL, HALF) Kind::Denormal(DENORMAL, ZERO);
        "−" = "x - y" (LARGER, NORMAL) Kind::Denormal(DENORMAL, ZERO);
        "÷" = "x / y" (NORMAL, TWO) Kind::Denormal(DENORMAL, ZERO);
        "mix" = "mix(x, y, z)" (NORMAL, ZERO, HALF) Kind::Denormal(DENORMAL, ZERO);
    ]
    "denormal operands", "may be flushed; not by copies": [
        "×" = "x * y" (DENORMAL, SCALE) Kind::Denormal(SCALED, ZERO);
        "+" = "x + y" (DENORMAL, NORMAL) Kind::Denormal(LARGER, NORMAL);
        "x > 0" = "x > 0.0 ? 1.0 : 0.0" (DENORMAL) Kind::Denormal(ONE, ZERO);
        "abs" = "abs(x)" (DENORMAL) Kind::Denormal(DENORMAL, ZERO);
        "max" = "max(x, y)" (DENORMAL, ZERO) Kind::Denormal(DENORMAL, ZERO);
        "copy" = "x" (DENORMAL) Kind::Denormal(DENORMAL, ZERO);
    ]
    "`min` and `max` of NaN", "either operand": [
        "min(NaN, 2)" = "min(x, y)" (NAN, TWO) Kind::Float;
        "min(2, NaN)" = "min(x, y)" (TWO, NAN) Kind::Float;
        "max(NaN, 2)" = "max(x, y)" (NAN, TWO) Kind::Float;
        "max(2, NaN)" = "max(x, y)" (TWO, NAN) Kind::Float;
    ]
    "`clamp` of NaN", "undefined": [
        "clamp(NaN, 0, 1)" = "clamp(x, y, z)" (NAN, ZERO, ONE) Kind::Float;
        "clamp(2, NaN, 1)" = "clamp(x, y, z)" (TWO, NAN, ONE) Kind::Float;
        "clamp(2, 0, NaN)" = "clamp(x, y, z)" (TWO, ZERO, NAN) Kind::Float;
    ]
    "tests of NaN and infinity¹", "NaN may be assumed not to occur": [
        "isnan(NaN)" = "isnan(x)" (NAN) Kind::Bool;
        "isinf(∞)" = "isinf(x)" (INFINITY) Kind::Bool;
        "NaN != NaN" = "x != x" (NAN) Kind::Bool;
        "NaN < 1" = "x < y" (NAN, ONE) Kind::Bool;
        "!(NaN < 1)" = "!(x < y)" (NAN, ONE) Kind::Bool;
    ]
    "operations that give NaN", "NaN may be assumed not to occur": [
        "0 / 0" = "x / y" (ZERO, ZERO) Kind::Float;
        "∞ − ∞" = "x - y" (INFINITY, INFINITY) Kind::Float;
        "0 · NaN" = "x * y" (ZERO, NAN) Kind::Float;
        "sqrt(−1)" = "sqrt(-x)" (ONE) Kind::Float;
        "log(−1)" = "log(-x)" (ONE) Kind::Float;
        "1 / 0" = "x / y" (ONE, ZERO) Kind::Float;
    ]
    "float to `int`, out of range¹", "undefined": [
        "3e9" = "int(x)" (3e9_f32.to_bits()) Kind::Int;
        "−3e9" = "int(x)" ((-3e9_f32).to_bits()) Kind::Int;
        "∞" = "int(x)" (INFINITY) Kind::Int;
        "NaN" = "int(x)" (NAN) Kind::Int;
    ]
    "float to `uint`, out of range¹", "undefined": [
        "−1" = "uint(x)" ((-1.0_f32).to_bits()) Kind::Uint;
        "5e9" = "uint(x)" (5e9_f32.to_bits()) Kind::Uint;
        "∞" = "uint(x)" (INFINITY) Kind::Uint;
        "NaN" = "uint(x)" (NAN) Kind::Uint;
    ]
    "integer division by zero¹", "undefined": [
        "7 / 0" = "floatBitsToInt(x) / floatBitsToInt(y)" (7, 0) Kind::Int;
        "7 % 0" = "floatBitsToInt(x) % floatBitsToInt(y)" (7, 0) Kind::Int;
        "7u / 0u" = "floatBitsToUint(x) / floatBitsToUint(y)" (7, 0) Kind::Uint;
        "−2³¹ / −1" = "floatBitsToInt(x) / floatBitsToInt(y)" (1 << 31, u32::MAX) Kind::Int;
    ]
    "shifts by 32 and more", "undefined": [
        "1 << 32" = "floatBitsToInt(x) << floatBitsToInt(y)" (1, 32) Kind::Int;
        "1 << 33" = "floatBitsToInt(x) << floatBitsToInt(y)" (1, 33) Kind::Int;
        "5u >> 32" = "floatBitsToUint(x) >> floatBitsToUint(y)" (5, 32) Kind::Uint;
        "−8 >> 32" = "floatBitsToInt(x) >> floatBitsToInt(y)" ((-8_i32) as u32, 32) Kind::Int;
    ]
}

/// The note to the rows that are marked with it.
pub const GUARDED: &str = "¹ naga guards divisions of integers and conversions, and toyproof writes `isnan` and \
                           `isinf` as tests of bits, so these results are not the driver's alone.";

/// The expression whose operations may be contracted to a fused one.
pub const CONTRACTED: &str = "x * y + z";

const OPERANDS: [Range; 3] = [(-2.0, 2.0), (-2.0, 2.0), (-2.0, 2.0)];

/// Whether multiplication and addition are fused.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Contraction {
    /// The cases in which one rounding and two roundings have different results.
    pub cases: usize,
    /// Those with the result of two roundings.
    pub separate: usize,
    /// Those with the result of one rounding.
    pub fused: usize,
}

impl Contraction {
    /// The arguments of [`CONTRACTED`].
    pub fn arguments(count: usize) -> Vec<Vec<f32>> {
        // Denormals would count as another result where they are flushed.
        let is_ordinary = |operands: &Vec<f32>| {
            let [a, b, c] = operands[..] else { return false };
            [a, b, c, a * b, a * b + c, a.mul_add(b, c)]
                .iter()
                .all(|value| value.is_normal())
        };
        arguments(&OPERANDS, count)
            .into_iter()
            .filter(is_ordinary)
            .collect()
    }

    /// Compares the bits of the results with both roundings.
    pub fn new(arguments: &[Vec<f32>], results: &[u32]) -> Self {
        let mut contraction = Self::default();
        for (operands, &bits) in arguments.iter().zip(results) {
            let (a, b, c) = (operands[0], operands[1], operands[2]);
            let (separate, fused) = (a * b + c, a.mul_add(b, c));
            if separate != fused {
                contraction.cases += 1;
                contraction.separate += usize::from(bits == separate.to_bits());
                contraction.fused += usize::from(bits == fused.to_bits());
            }
        }
        contraction
    }

    /// The result in one sentence.
    pub fn describe(self) -> String {
        let Self {
            cases,
            separate,
            fused,
        } = self;
        let other = cases - separate - fused;
        let [all, separate, fused, other] =
            [cases, separate, fused, other].map(|count| grouped(count as u64));
        if self.separate == cases {
            format!("not contracted, in all of {all} cases that show it")
        } else if self.fused == cases {
            format!("contracted to one rounding, in all of {all} cases that show it")
        } else {
            format!(
                "of {all} cases, {separate} with two roundings, {fused} with one, {other} with another result"
            )
        }
    }
}
