//! Operations whose results are rounded, undefined, or different from driver to driver: not for programs of
//! [`Arithmetic::Exact`].

use super::expr::{Expr, Level, Range};
use super::types::{Base, FLOAT, Scalar, Type};
use super::{Arithmetic, Generator, Mode};

/// Functions of one operand.
const FUNCTIONS: [&str; 23] = [
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
    "exp",
    "log",
    "exp2",
    "log2",
    "sqrt",
    "inversesqrt",
    "radians",
    "degrees",
    "round",
    "roundEven",
    "normalize",
];

impl Generator<'_> {
    /// A value of floats.
    pub(super) fn inexact(&mut self, base: Base) -> Expr {
        let ty = Type::of(base);
        let call = |name: &str, arguments: &[Expr]| Expr::call(name, arguments, Range::VARIABLE);
        match self.choices.below(15) {
            14 if self.mode != Mode::Constant => {
                let name = self.choices.pick(&["dFdx", "dFdy", "fwidth"]);
                let operand = self.expr(ty);
                call(name, &[operand])
            }
            0..=3 => {
                let name = self.choices.pick(&FUNCTIONS);
                let operand = self.expr(ty);
                call(name, &[operand])
            }
            4 | 5 => {
                let (left, right) = self.operands(ty);
                Expr::binary(&left, "/", &right, Level::Product, Range::VARIABLE)
            }
            6 => {
                let name = self
                    .choices
                    .pick(&["pow", "atan", "mod", "reflect", "min", "step"]);
                let operands = [self.expr(ty), self.expr(ty)];
                call(name, &operands)
            }
            7 => {
                let name = self.choices.pick(&["smoothstep", "mix", "clamp", "faceforward"]);
                let operands = [self.expr(ty), self.expr(ty), self.expr(ty)];
                call(name, &operands)
            }
            8 => {
                let operands = [self.expr(ty), self.expr(ty), self.expr(FLOAT)];
                let name = self.choices.pick(&["refract", "mix"]);
                call(name, &operands)
            }
            9 => {
                let (scalar, name) = self
                    .choices
                    .pick(&[(Scalar::Int, "intBitsToFloat"), (Scalar::Uint, "uintBitsToFloat")]);
                let operand = self.expr(Type::of(Base::sized(scalar, base.size())));
                call(name, &[operand])
            }
            10 if base.size() == 2 => {
                let name = self
                    .choices
                    .pick(&["unpackHalf2x16", "unpackSnorm2x16", "unpackUnorm2x16"]);
                let operand = self.expr(Type::of(Base::Scalar(Scalar::Uint)));
                call(name, &[operand])
            }
            11 if base.size() == 1 => {
                let side = self.size();
                let matrix = self.expr(Type::of(Base::Matrix(side, side)));
                call("determinant", &[matrix])
            }
            12 if base.size() == 1 => {
                let vector = Type::of(Base::Vector(Scalar::Float, self.size()));
                let name = self.choices.pick(&["distance", "dot", "length"]);
                let mut operands = vec![self.expr(vector)];
                if name != "length" {
                    operands.push(self.expr(vector));
                }
                call(name, &operands)
            }
            _ => {
                let number = self.choices.pick(&[
                    "0.1",
                    "1e-30",
                    "3.3e9",
                    "1e38",
                    "1.1754944e-38",
                    "-0.0",
                    "0.0",
                    "16777217.",
                ]);
                call(&base.name(), &[Expr::plain(number, Level::Unary)])
            }
        }
    }

    /// A packed vector.
    pub(super) fn packed(&mut self) -> Expr {
        let mut name = self
            .choices
            .pick(&["packHalf2x16", "packSnorm2x16", "packUnorm2x16"]);
        // A half keeps the sign of zero and the bits of NaN.
        if self.arithmetic == Arithmetic::AnyOnDrivers && name == "packHalf2x16" {
            name = "packSnorm2x16";
        }
        let operand = self.expr(Type::of(Base::Vector(Scalar::Float, 2)));
        Expr::call(name, &[operand], Range::VARIABLE)
    }
}
