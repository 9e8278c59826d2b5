//! Operations on components, with the kinds of their operands and results.

/// The representation of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A float, in the number type of the run.
    Float,
    /// A 32-bit word: an `int`, a `uint`, or a `bool` as 0 or all bits.
    Word,
}

macro_rules! kind {
    (F) => {
        Kind::Float
    };
    (W) => {
        Kind::Word
    };
}

/// Calls `$then!` with every operation: `Name(kinds of operands) kind of result`.
macro_rules! for_each_operation {
    ($then:ident) => {
        $then! {
            // Arithmetic.
            Add(F, F) F, Sub(F, F) F, Mul(F, F) F, Div(F, F) F,
            // Unfused: two roundings. a·b + c, a·b − c, c − a·b.
            MulAdd(F, F, F) F, MulSub(F, F, F) F, SubMul(F, F, F) F,
            Min(F, F) F, Max(F, F) F,
            Neg(F) F, Abs(F) F, Sqrt(F) F, Floor(F) F, Ceil(F) F, Trunc(F) F, RoundEven(F) F,
            // Elementary functions.
            Sin(F) F, Cos(F) F, Tan(F) F, Asin(F) F, Acos(F) F, Atan(F) F, Atan2(F, F) F,
            Sinh(F) F, Cosh(F) F, Tanh(F) F, Asinh(F) F, Acosh(F) F, Atanh(F) F,
            Exp(F) F, Exp2(F) F, Log(F) F, Log2(F) F, Pow(F, F) F,
            // Comparisons of floats; all but `NotEqual` are false for NaN.
            Less(F, F) W, LessEqual(F, F) W, Equal(F, F) W, NotEqual(F, F) W, IsNan(F) W, IsInf(F) W,
            // Conversions between floats and words. Bits are those of the nearest f32.
            FromInt(W) F, FromUint(W) F, ToInt(F) W, ToUint(F) W, FromBits(W) F, ToBits(F) W,
            PackHalf(F, F) W, UnpackLow(W) F, UnpackHigh(W) F,
            // Operations on words.
            AddWord(W, W) W, SubWord(W, W) W, MulWord(W, W) W,
            DivInt(W, W) W, DivUint(W, W) W, RemInt(W, W) W, RemUint(W, W) W,
            And(W, W) W, Or(W, W) W, Xor(W, W) W, Not(W) W, NegWord(W) W,
            ShiftLeft(W, W) W, ShiftRightInt(W, W) W, ShiftRightUint(W, W) W,
            MinInt(W, W) W, MaxInt(W, W) W, MinUint(W, W) W, MaxUint(W, W) W,
            EqualWord(W, W) W, LessInt(W, W) W, LessUint(W, W) W,
            // Selections: the second operand where the first is all bits, the third where it is 0.
            Select(W, F, F) F, SelectWord(W, W, W) W,
            // Differences within a quad.
            DFdx(F) F, DFdy(F) F,
        }
    };
}
pub(crate) use for_each_operation;

macro_rules! define {
    ($($name:ident($($operand:ident),+) $value:ident,)*) => {
        /// An operation on components.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[doc(hidden)]
        pub enum Operation {
            $(
                $name,
            )*
        }

        impl Operation {
            /// All operations, in the order of their discriminants.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Returns the kinds of the operands, one to three.
            #[must_use]
            pub fn operands(self) -> &'static [Kind] {
                match self {
                    $(Self::$name => &[$(kind!($operand)),+],)*
                }
            }

            /// Returns the kind of the result.
            #[must_use]
            pub fn kind(self) -> Kind {
                match self {
                    $(Self::$name => kind!($value),)*
                }
            }
        }
    };
}
for_each_operation!(define);
