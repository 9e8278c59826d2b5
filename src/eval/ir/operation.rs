//! What instructions compute: operations on single components, each with the kinds of its operands and of its value.

/// How a component is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Kind {
    /// In the number type that the program runs in.
    Float,
    /// 32 bits: an `int`, a `uint`, or a `bool` as no bits or all.
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

/// Calls `$then!` with every operation: `Name(kinds of operands) kind of value`.
macro_rules! for_each_operation {
    ($then:ident) => {
        $then! {
            // Arithmetic: rounds, or is exact.
            Add(F, F) F, Sub(F, F) F, Mul(F, F) F, Div(F, F) F,
            // Two roundings, as apart from each other: a·b + c, a·b − c, c − a·b.
            MulAdd(F, F, F) F, MulSub(F, F, F) F, SubMul(F, F, F) F,
            Min(F, F) F, Max(F, F) F,
            Neg(F) F, Abs(F) F, Sqrt(F) F, Floor(F) F, Ceil(F) F, Trunc(F) F, RoundEven(F) F,
            // Elementary functions.
            Sin(F) F, Cos(F) F, Tan(F) F, Asin(F) F, Acos(F) F, Atan(F) F, Atan2(F, F) F,
            Sinh(F) F, Cosh(F) F, Tanh(F) F, Asinh(F) F, Acosh(F) F, Atanh(F) F,
            Exp(F) F, Exp2(F) F, Log(F) F, Log2(F) F, Pow(F, F) F,
            // Comparisons of floats; all but `NotEqual` are false of NaN.
            Less(F, F) W, LessEqual(F, F) W, Equal(F, F) W, NotEqual(F, F) W, IsNan(F) W, IsInf(F) W,
            // Between floats and words. Bits are those of the f32 nearest to the number.
            FromInt(W) F, FromUint(W) F, ToInt(F) W, ToUint(F) W, FromBits(W) F, ToBits(F) W,
            PackHalf(F, F) W, UnpackLow(W) F, UnpackHigh(W) F,
            // Words.
            AddWord(W, W) W, SubWord(W, W) W, MulWord(W, W) W,
            DivInt(W, W) W, DivUint(W, W) W, RemInt(W, W) W, RemUint(W, W) W,
            And(W, W) W, Or(W, W) W, Xor(W, W) W, Not(W) W, NegWord(W) W,
            ShiftLeft(W, W) W, ShiftRightInt(W, W) W, ShiftRightUint(W, W) W,
            MinInt(W, W) W, MaxInt(W, W) W, MinUint(W, W) W, MaxUint(W, W) W,
            EqualWord(W, W) W, LessInt(W, W) W, LessUint(W, W) W,
            // Choices: the first where all bits are set, the second where none is.
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
        pub(crate) enum Operation {
            $(
                $name,
            )*
        }

        impl Operation {
            /// The kinds of the operands, one to three.
            pub(crate) fn operands(self) -> &'static [Kind] {
                match self {
                    $(Self::$name => &[$(kind!($operand)),+],)*
                }
            }

            /// The kind of the value.
            pub(crate) fn kind(self) -> Kind {
                match self {
                    $(Self::$name => kind!($value),)*
                }
            }
        }
    };
}
for_each_operation!(define);
