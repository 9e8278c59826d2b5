//! Built-in functions (§8) as operations.

use toyproof_glsl::tree::{BuiltIn, ExprId, Place, Scalar, Type};

use super::lvalue::{LValue, component_count};
use super::{Builder, Result, Substitute, UndefinedPolicy};
use crate::ir::{Fault, Kind, NONE, Operation, Predicate, Value};

impl Builder<'_> {
    pub(super) fn built_in(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        call: ExprId,
    ) -> Result<Vec<Value>> {
        if function.is_texture() {
            return self.texture(function, arguments, call);
        }
        let mut values = Vec::with_capacity(arguments.len());
        let mut whole = None;
        for (at, &argument) in arguments.iter().enumerate() {
            if function.out_parameter() == Some(at) {
                whole = self.lvalue(argument)?;
                values.push(Vec::new());
            } else {
                values.push(self.expression(argument)?);
            }
        }
        let at = self.at(call);
        if let Some(values) = self.of_vectors(function, arguments, &values) {
            return Ok(values);
        }
        if function == BuiltIn::Modf {
            return Ok(self.modf(&values[0], whole.as_ref()));
        }
        let scalar = arguments
            .first()
            .and_then(|&first| self.ty(first).scalar())
            .unwrap_or(Scalar::Float);
        // All others work component by component; a scalar applies to every component.
        let count = component_count(self.tree, self.ty(call));
        let component = |index: usize| -> Vec<Value> {
            values
                .iter()
                .map(|argument| argument[if argument.len() == 1 { 0 } else { index }])
                .collect()
        };
        let operands: Vec<Vec<Value>> = (0..count).map(component).collect();
        let last = arguments.last().map(|&last| self.ty(last));
        Ok(operands
            .into_iter()
            .map(|operands| {
                let value = match operands[..] {
                    [x] => self.of_one(function, scalar, x, at),
                    [x, y] => self.of_two(function, scalar, [x, y], at),
                    [x, y, z] => {
                        let chooses = last.and_then(Type::scalar) == Some(Scalar::Bool);
                        self.of_three(function, scalar, chooses, [x, y, z], at)
                    }
                    _ => self.float(0.0),
                };
                self.substitute_undefined(value)
            })
            .collect())
    }

    /// Evaluates functions that do not work component by component.
    fn of_vectors(
        &self,
        function: BuiltIn,
        arguments: &[ExprId],
        values: &[Vec<Value>],
    ) -> Option<Vec<Value>> {
        use BuiltIn as B;
        match function {
            B::Any => return Some(vec![self.reduce(Operation::Or, &values[0])]),
            B::All => return Some(vec![self.reduce(Operation::And, &values[0])]),
            B::PackHalf2x16 => {
                return Some(vec![self.binary(Operation::PackHalf, values[0][0], values[0][1])]);
            }
            B::UnpackHalf2x16 => {
                return Some(
                    [Operation::UnpackLow, Operation::UnpackHigh]
                        .map(|half| self.unary(half, values[0][0]))
                        .to_vec(),
                );
            }
            B::PackSnorm2x16 => return Some(vec![self.pack(&values[0], -1.0, 32767.0)]),
            B::PackUnorm2x16 => return Some(vec![self.pack(&values[0], 0.0, 65535.0)]),
            B::UnpackSnorm2x16 => return Some(self.unpack(values[0][0], true)),
            B::UnpackUnorm2x16 => return Some(self.unpack(values[0][0], false)),
            _ => {}
        }
        let is_float = arguments
            .first()
            .is_some_and(|&first| self.ty(first).scalar() == Some(Scalar::Float));
        if !is_float {
            return None;
        }
        let terms: Vec<Vec<_>> = values.iter().map(|values| self.terms(values)).collect();
        let matrix = |at: usize| {
            let rows = match self.ty(arguments[at]) {
                Type::Matrix { rows, .. } => usize::from(rows),
                _ => 1,
            };
            toyproof_math::Matrix::new(&terms[at], rows)
        };
        let result = match (function, &terms[..]) {
            (B::Length, [v]) => vec![toyproof_math::length(v)],
            (B::Distance, [a, b]) => vec![toyproof_math::distance(a, b)],
            (B::Dot, [a, b]) => vec![toyproof_math::dot(a, b)],
            (B::Cross, [a, b]) => match (&a[..], &b[..]) {
                (&[a0, a1, a2], &[b0, b1, b2]) => toyproof_math::cross([a0, a1, a2], [b0, b1, b2]).to_vec(),
                _ => return None,
            },
            (B::Normalize, [v]) => toyproof_math::normalize(v),
            (B::Faceforward, [n, i, along]) => toyproof_math::faceforward(n, i, along),
            (B::Reflect, [i, n]) => toyproof_math::reflect(i, n),
            (B::Refract, [i, n, eta]) => toyproof_math::refract(i, n, eta[0]),
            (B::MatrixCompMult, [a, b]) => a.iter().zip(b).map(|(&a, &b)| a * b).collect(),
            (B::OuterProduct, [c, r]) => toyproof_math::outer_product(c, r).components(),
            (B::Transpose, [m]) => {
                let Type::Matrix { columns, rows } = self.ty(arguments[0]) else {
                    return None;
                };
                let (columns, rows) = (usize::from(columns), usize::from(rows));
                (0..rows)
                    .flat_map(|row| (0..columns).map(move |column| m[column * rows + row]))
                    .collect()
            }
            (B::Determinant, _) => vec![toyproof_math::determinant(&matrix(0))],
            (B::Inverse, _) => toyproof_math::inverse(&matrix(0)).components(),
            _ => return None,
        };
        Some(result.into_iter().map(|term| term.value).collect())
    }

    fn reduce(&self, operation: Operation, values: &[Value]) -> Value {
        let whole = values.iter().copied().reduce(|a, b| self.binary(operation, a, b));
        whole.unwrap_or_else(|| self.bool_value(false))
    }

    /// Splits into integral parts, which are stored to `whole`, and fractional parts.
    fn modf(&mut self, values: &[Value], whole: Option<&LValue>) -> Vec<Value> {
        let before: Vec<Value> = values.iter().map(|&x| self.unary(Operation::Trunc, x)).collect();
        if let Some(whole) = whole {
            self.write(whole, &before);
        }
        let pairs = values.iter().zip(&before);
        pairs
            .map(|(&x, &before)| self.binary(Operation::Sub, x, before))
            .collect()
    }

    fn of_one(&mut self, function: BuiltIn, scalar: Scalar, x: Value, at: Place) -> Value {
        use BuiltIn as B;
        use Operation as O;
        let operation = match (function, scalar) {
            (B::Abs, Scalar::Float) => O::Abs,
            (B::Abs, _) => {
                let negative = self.unary(O::NegWord, x);
                return self.binary(O::MaxInt, x, negative);
            }
            (B::Sign, Scalar::Float) => return toyproof_math::sign(self.term(x)).value,
            (B::Sign, _) => {
                let (one, minus) = (self.word(1), self.word(u32::MAX));
                let bounded = self.binary(O::MinInt, x, one);
                return self.binary(O::MaxInt, bounded, minus);
            }
            (B::Radians, _) => return toyproof_math::radians(self.term(x)).value,
            (B::Degrees, _) => return toyproof_math::degrees(self.term(x)).value,
            (B::Fract, _) => return toyproof_math::fract(self.term(x)).value,
            (B::InverseSqrt, _) => {
                self.check(Fault::RootDomain, at, Predicate::NotPositive, [x, NONE]);
                return toyproof_math::inverse_sqrt(self.term(x)).value;
            }
            (B::Sqrt, _) => {
                self.check(Fault::RootDomain, at, Predicate::Negative, [x, NONE]);
                O::Sqrt
            }
            (B::Log | B::Log2, _) => {
                self.check(Fault::LogDomain, at, Predicate::NotPositive, [x, NONE]);
                if function == B::Log { O::Log } else { O::Log2 }
            }
            (B::Asin | B::Acos, _) => {
                self.check(Fault::ArcDomain, at, Predicate::BeyondOne, [x, NONE]);
                if function == B::Asin { O::Asin } else { O::Acos }
            }
            (B::Acosh, _) => {
                self.check(Fault::ArcDomain, at, Predicate::BelowOne, [x, NONE]);
                O::Acosh
            }
            (B::Atanh, _) => {
                self.check(Fault::ArcDomain, at, Predicate::AtLeastOne, [x, NONE]);
                O::Atanh
            }
            (B::DFdx | B::DFdy | B::Fwidth, _) => {
                self.check(
                    Fault::NonUniformDerivative,
                    at,
                    Predicate::PartialQuad,
                    [NONE, NONE],
                );
                match function {
                    B::DFdx => O::DFdx,
                    B::DFdy => O::DFdy,
                    _ => {
                        let [dx, dy] = [O::DFdx, O::DFdy].map(|along| {
                            let difference = self.unary(along, x);
                            self.unary(O::Abs, difference)
                        });
                        return self.binary(O::Add, dx, dy);
                    }
                }
            }
            (B::Sin, _) => O::Sin,
            (B::Cos, _) => O::Cos,
            (B::Tan, _) => O::Tan,
            (B::Atan, _) => O::Atan,
            (B::Sinh, _) => O::Sinh,
            (B::Cosh, _) => O::Cosh,
            (B::Tanh, _) => O::Tanh,
            (B::Asinh, _) => O::Asinh,
            (B::Exp, _) => O::Exp,
            (B::Exp2, _) => O::Exp2,
            (B::Floor, _) => O::Floor,
            (B::Ceil, _) => O::Ceil,
            (B::Trunc, _) => O::Trunc,
            (B::Round | B::RoundEven, _) => O::RoundEven,
            (B::IsNan, _) => O::IsNan,
            (B::IsInf, _) => O::IsInf,
            (B::FloatBitsToInt | B::FloatBitsToUint, _) => O::ToBits,
            (B::IntBitsToFloat | B::UintBitsToFloat, _) => O::FromBits,
            (B::Not, _) => O::Not,
            // `dot` and the like with scalar operands are handled by `of_vectors`.
            _ => return x,
        };
        self.unary(operation, x)
    }

    fn of_two(&mut self, function: BuiltIn, scalar: Scalar, [x, y]: [Value; 2], at: Place) -> Value {
        use BuiltIn as B;
        use Operation as O;
        let operation = match (function, scalar) {
            (B::Atan, _) => {
                self.check(Fault::ArcOfNothing, at, Predicate::BothZero, [x, y]);
                O::Atan2
            }
            (B::Pow, _)
                if self.options.undefined == UndefinedPolicy::Substitute(Substitute::OtherImplementation) =>
            {
                let base = self.unary(O::Abs, x);
                return self.binary(O::Pow, base, y);
            }
            (B::Pow, _) => {
                self.check(Fault::PowDomain, at, Predicate::PowUndefined, [x, y]);
                O::Pow
            }
            (B::Mod, _) => return toyproof_math::modulo(self.term(x), self.term(y)).value,
            (B::Step, _) => return toyproof_math::step(self.term(x), self.term(y)).value,
            (B::Min | B::Max, Scalar::Float) => {
                self.check(Fault::NotANumber, at, Predicate::Unordered, [x, y]);
                if function == B::Min { O::Min } else { O::Max }
            }
            (B::Min, Scalar::Int) => O::MinInt,
            (B::Max, Scalar::Int) => O::MaxInt,
            (B::Min, _) => O::MinUint,
            (B::Max, _) => O::MaxUint,
            (B::LessThan, _) => return self.less(scalar, x, y),
            (B::GreaterThan, _) => return self.less(scalar, y, x),
            (B::LessThanEqual, _) => return self.less_equal(scalar, x, y),
            (B::GreaterThanEqual, _) => return self.less_equal(scalar, y, x),
            (B::Equal, Scalar::Float) => O::Equal,
            (B::NotEqual, Scalar::Float) => O::NotEqual,
            (B::Equal, _) => O::EqualWord,
            (B::NotEqual, _) => {
                let equal = self.binary(O::EqualWord, x, y);
                return self.unary(O::Not, equal);
            }
            _ => return x,
        };
        self.binary(operation, x, y)
    }

    fn of_three(
        &mut self,
        function: BuiltIn,
        scalar: Scalar,
        chooses: bool,
        [x, y, z]: [Value; 3],
        at: Place,
    ) -> Value {
        match (function, scalar) {
            (BuiltIn::Clamp, Scalar::Float) => {
                self.check(Fault::NotANumber, at, Predicate::Unordered, [x, y]);
                self.check(Fault::NotANumber, at, Predicate::Unordered, [z, z]);
                self.check(Fault::ReversedClamp, at, Predicate::Greater, [y, z]);
                self.clamp(x, y, z)
            }
            (BuiltIn::Clamp, Scalar::Int) => {
                let least = self.binary(Operation::MaxInt, x, y);
                self.binary(Operation::MinInt, least, z)
            }
            (BuiltIn::Clamp, _) => {
                let least = self.binary(Operation::MaxUint, x, y);
                self.binary(Operation::MinUint, least, z)
            }
            (BuiltIn::Mix, _) if chooses => self.select(z, y, x, Kind::Float),
            (BuiltIn::Mix, _) => toyproof_math::mix(self.term(x), self.term(y), self.term(z)).value,
            _ => {
                self.check(Fault::EqualEdges, at, Predicate::Equal, [x, y]);
                self.check(Fault::ReversedEdges, at, Predicate::Greater, [x, y]);
                toyproof_math::smoothstep(self.term(x), self.term(y), self.term(z)).value
            }
        }
    }

    pub(super) fn clamp(&self, x: Value, least: Value, most: Value) -> Value {
        let bounded = self.binary(Operation::Max, x, least);
        self.binary(Operation::Min, bounded, most)
    }

    /// Packs two numbers from `least` to 1 into 16 bits each; 1 becomes `scale`.
    fn pack(&self, values: &[Value], least: f64, scale: f64) -> Value {
        use Operation as O;
        let (least, one, scale) = (self.float(least), self.float(1.0), self.float(scale));
        let halves = values.iter().map(|&x| {
            let bounded = self.clamp(x, least, one);
            let scaled = self.binary(O::Mul, bounded, scale);
            let rounded = self.unary(O::RoundEven, scaled);
            let whole = self.unary(O::ToInt, rounded);
            self.binary(O::And, whole, self.word(0xffff))
        });
        let halves: Vec<Value> = halves.collect();
        let high = self.binary(O::ShiftLeft, halves[1], self.word(16));
        self.binary(O::Or, halves[0], high)
    }

    fn unpack(&self, word: Value, signed: bool) -> Vec<Value> {
        use Operation as O;
        let sixteen = self.word(16);
        let low = self.binary(O::ShiftLeft, word, sixteen);
        [low, word]
            .map(|half| {
                if signed {
                    let whole = self.binary(O::ShiftRightInt, half, sixteen);
                    let float = self.unary(O::FromInt, whole);
                    let scaled = self.binary(O::Div, float, self.float(32767.0));
                    let [scaled, least, most] =
                        [scaled, self.float(-1.0), self.float(1.0)].map(|x| self.term(x));
                    toyproof_math::clamp(scaled, least, most).value
                } else {
                    let whole = self.binary(O::ShiftRightUint, half, sixteen);
                    let float = self.unary(O::FromUint, whole);
                    self.binary(O::Div, float, self.float(65535.0))
                }
            })
            .to_vec()
    }
}
