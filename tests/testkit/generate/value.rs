//! Values of operators, constructors and built-in functions.

use super::expr::{Expr, Level, Range};
use super::types::{BOOL, Base, FLOAT, INT, SCALARS, Scalar, Type, UINT};
use super::{Generator, Mode};

impl Generator<'_> {
    /// An operation with that result type.
    pub(super) fn value(&mut self, ty: Type) -> Expr {
        match (ty.length, ty.base) {
            (Some(_), _) | (None, Base::Struct(_)) => self.constructed(ty),
            (None, Base::Matrix(columns, rows)) => self.matrix(columns, rows),
            (None, base) => {
                if self.choices.chance(70) {
                    return self.converted(base);
                }
                match base.scalar() {
                    Some(Scalar::Float) => self.float(base),
                    Some(Scalar::Bool) => self.truth(base),
                    _ => self.integer(ty),
                }
            }
        }
    }

    /// The other operand for one of this type: of the same type, or a scalar.
    fn beside(&mut self, ty: Type) -> Expr {
        let scalar = ty.base.scalar().unwrap_or(Scalar::Float);
        if self.choices.chance(60) {
            self.expr(Type::of(Base::Scalar(scalar)))
        } else {
            self.expr(ty)
        }
    }

    /// Two operands, one of which has the type, in either order.
    pub(super) fn operands(&mut self, ty: Type) -> (Expr, Expr) {
        if self.choices.chance(40) {
            let left = self.beside(ty);
            return (left, self.expr(ty));
        }
        let left = self.expr(ty);
        (left, self.beside(ty))
    }

    /// A constructor of a scalar or vector, from one of other components, or from parts.
    fn converted(&mut self, base: Base) -> Expr {
        let scalar = base.scalar().unwrap_or(Scalar::Float);
        let size = base.size();
        if size > 1 && self.choices.chance(128) {
            let mut left = size;
            let mut parts = Vec::new();
            while left > 0 {
                let most = left.min(if left == size { size - 1 } else { left });
                let part = 1 + self.choices.below(usize::from(most)) as u8;
                parts.push(self.storable(Type::of(Base::sized(scalar, part))));
                left -= part;
            }
            return Expr::call(&base.name(), &parts, Range::VARIABLE);
        }
        let from = self.choices.pick(&SCALARS);
        // A longer vector may be truncated, a scalar repeated.
        let from_size = if self.choices.chance(128) || size == 1 {
            size.max(self.choices.pick(&[1, 2, 3, 4]))
        } else {
            1
        };
        let source = Type::of(Base::sized(from, from_size));
        let mut operand = self.expr(source);
        let mut range = Range::new(1.0, 0);
        match (from, scalar) {
            _ if self.is_wild() => {}
            // Exact in a float, and in the range of variables.
            (Scalar::Int | Scalar::Uint, Scalar::Float) => {
                let mask = if from == Scalar::Uint { "63u" } else { "63" };
                operand = Expr::plain(format!("{} & {mask}", operand.at(Level::And)), Level::And);
                range = Range::new(64.0, 0);
            }
            // Converting a negative float to an unsigned integer is undefined.
            (Scalar::Float, Scalar::Uint) => operand = Expr::call("abs", &[operand], Range::VARIABLE),
            (Scalar::Float, Scalar::Float) => range = operand.range,
            _ => {}
        }
        Expr::call(&base.name(), &[operand], range)
    }

    /// Two float operands whose product of `count` terms is exact.
    fn factors(&mut self, left: Type, right: Type, count: u8) -> (Expr, Expr, Range) {
        let mut factors = [self.expr(left), self.expr(right)];
        let mut range = factors[0].range.products(factors[1].range, count);
        if !range.is_exact() {
            factors = [(left, 0), (right, 1)].map(|(ty, index)| self.tamed(ty, factors[index].clone()));
            range = factors[0].range.products(factors[1].range, count);
        }
        let [left, right] = factors;
        (left, right, range)
    }

    fn float(&mut self, base: Base) -> Expr {
        if self.is_wild() && self.choices.chance(100) {
            return self.inexact(base);
        }
        let ty = Type::of(base);
        let binary = |op, left: &Expr, right: &Expr| {
            Expr::binary(left, op, right, Level::Sum, left.range.sum(right.range))
        };
        match self.choices.below(17) {
            0..=2 => {
                let (left, right) = self.operands(ty);
                let op = self.choices.pick(&["+", "-"]);
                binary(op, &left, &right)
            }
            3 | 4 => {
                let scalar = self.choices.chance(60);
                let (left, right, range) = self.factors(ty, if scalar { FLOAT } else { ty }, 1);
                Expr::binary(&left, "*", &right, Level::Product, range)
            }
            5 => {
                let left = self.storable(ty);
                let right = self.choices.pick(&["2.0", "0.5", "4.", "-0.25"]);
                let right = Expr::plain(right, Level::Unary);
                Expr::binary(&left, "/", &right, Level::Product, Range::new(256.0, 6))
            }
            6 => Expr::unary("-", &self.expr(ty)),
            7 => {
                let name = self
                    .choices
                    .pick(&["abs", "floor", "ceil", "trunc", "sign", "fract"]);
                let operand = self.expr(ty);
                let range = operand.range.or(Range::new(1.0, 0));
                Expr::call(name, &[operand], range.sum(Range::new(1.0, 0)))
            }
            8 => {
                let name = self.choices.pick(&["min", "max", "step"]);
                let (left, right) = (self.expr(ty), self.expr(ty));
                let range = left.range.or(right.range).or(Range::new(1.0, 0));
                Expr::call(name, &[left, right], range)
            }
            9 => {
                let truths = self.expr(Type::of(Base::sized(Scalar::Bool, base.size())));
                let (left, right) = (self.expr(ty), self.expr(ty));
                let range = left.range.or(right.range);
                Expr::call("mix", &[left, right, truths], range)
            }
            10 => {
                let (left, right) = (self.storable(ty), self.storable(ty));
                let share = Expr::primary(self.choices.pick(&["0.5", "0.0", "1.", "0.25"]), Range::VARIABLE);
                Expr::call("mix", &[left, right, share], Range::new(128.0, 6))
            }
            11 => {
                let left = self.expr(ty);
                let right = Expr::primary(self.choices.pick(&["4.0", "0.5", "1."]), Range::VARIABLE);
                let range = left.range.or(Range::new(4.0, 1));
                Expr::call("mod", &[left, right], range)
            }
            12 if base.size() == 1 => {
                let vector = Type::of(Base::Vector(Scalar::Float, self.size()));
                let (left, right, range) = self.factors(vector, vector, vector.base.size());
                Expr::call("dot", &[left, right], range)
            }
            12 if base.size() == 3 => {
                let (left, right, range) = self.factors(ty, ty, 2);
                Expr::call("cross", &[left, right], range)
            }
            13 if base.size() > 1 && self.mode != Mode::Constant => {
                // The matrix has as many columns as the vector has components.
                let other = self.size();
                let vector = Type::of(Base::Vector(Scalar::Float, other));
                let (matrix, left) = if self.choices.chance(128) {
                    (Base::Matrix(other, base.size()), true)
                } else {
                    (Base::Matrix(base.size(), other), false)
                };
                let matrix = Type::of(matrix);
                let (a, b) = if left { (matrix, vector) } else { (vector, matrix) };
                let (a, b, range) = self.factors(a, b, other);
                Expr::binary(&a, "*", &b, Level::Product, range)
            }
            14 if self.mode == Mode::Any => self.stepped(ty),
            15 => {
                let wide = Type::of(Base::Vector(Scalar::Float, base.size().max(self.size())));
                let operand = self.expr(wide);
                let letters = self.swizzle(wide.base.size(), base.size(), false);
                Expr::primary(format!("{}.{letters}", operand.at(Level::Primary)), operand.range)
            }
            _ => {
                let (left, right) = (self.expr(ty), self.expr(ty));
                binary("+", &left, &right)
            }
        }
    }

    /// `++` and `--` of floats: the variable is reduced to range before anything else happens.
    fn stepped(&mut self, ty: Type) -> Expr {
        let Some(place) = self.steady_place(ty) else {
            return self.leaf(ty);
        };
        let op = self.choices.pick(&["++", "--"]);
        let back = self.tamed(ty, Expr::primary(place.as_str(), Range::new(65.0, 4)));
        let text = format!("{place}{op}, {place} = {}", back.text);
        Expr::plain(text, Level::Sequence)
    }

    fn integer(&mut self, ty: Type) -> Expr {
        let unsigned = ty.base.scalar() == Some(Scalar::Uint);
        let number = |value: u32| format!("{value}{}", if unsigned { "u" } else { "" });
        let is_wild = self.is_wild() && self.choices.chance(60);
        if is_wild && ty == UINT && self.choices.chance(40) {
            return self.packed();
        }
        let mask = |operand: &Expr, bits: u32| {
            if is_wild {
                return operand.clone();
            }
            Expr::plain(
                format!("{} & {}", operand.at(Level::And), number(bits)),
                Level::And,
            )
        };
        let join = |left: &Expr, op: &str, right: &Expr, level| {
            Expr::binary(left, op, right, level, Range::VARIABLE)
        };
        match self.choices.below(16) {
            0..=2 => {
                let (left, right) = self.operands(ty);
                let op = self.choices.pick(&["+", "-"]);
                join(&left, op, &right, Level::Sum)
            }
            3 => {
                let (left, right) = self.operands(ty);
                join(&left, "*", &right, Level::Product)
            }
            4 | 5 => {
                let (left, right) = self.operands(ty);
                let (op, level) =
                    self.choices
                        .pick(&[("&", Level::And), ("|", Level::Or), ("^", Level::Xor)]);
                join(&left, op, &right, level)
            }
            6 => {
                // Positive divisors; no negative operand of a remainder, which would leave it undefined.
                let (left, right) = self.operands_first(ty);
                let divisor = mask(&right, 7);
                let one = Expr::primary(number(1), Range::VARIABLE);
                let divisor = if is_wild {
                    divisor
                } else {
                    join(&divisor, "+", &one, Level::Sum)
                };
                if self.choices.chance(128) {
                    join(&mask(&left, 0xffff), "%", &divisor, Level::Product)
                } else {
                    join(&left, "/", &divisor, Level::Product)
                }
            }
            7 => self.shift(ty, is_wild),
            8 => {
                let op = self.choices.pick(&["-", "~", "+"]);
                Expr::unary(op, &self.expr(ty))
            }
            9 => {
                let (left, right) = (self.expr(ty), self.expr(ty));
                let name = self.choices.pick(&["min", "max"]);
                Expr::call(name, &[left, right], Range::VARIABLE)
            }
            10 if !unsigned => {
                let name = self.choices.pick(&["abs", "sign"]);
                Expr::call(name, &[self.expr(ty)], Range::VARIABLE)
            }
            10 | 11 => {
                let operand = self.expr(ty);
                let bounds = [3, 12].map(|bound| Expr::primary(number(bound), Range::VARIABLE));
                let [low, high] = bounds;
                Expr::call("clamp", &[operand, low, high], Range::VARIABLE)
            }
            12 | 13 if self.mode == Mode::Any => self.changed(ty),
            14 if ty == INT => {
                let (left, right) = (self.expr(INT), self.expr(INT));
                Expr::expanded("MAD", &[left, right], Range::VARIABLE)
            }
            15 if self.mode != Mode::Constant && !self.is_wild() => {
                let operand = self.storable(Type::of(Base::sized(Scalar::Float, ty.base.size())));
                // The sign of a zero may differ.
                let operand = Expr::plain(format!("{} + 0.5", operand.at(Level::Sum)), Level::Sum);
                let name = if unsigned {
                    "floatBitsToUint"
                } else {
                    "floatBitsToInt"
                };
                Expr::call(name, &[operand], Range::VARIABLE)
            }
            _ => {
                let wide = Type::of(Base::Vector(
                    ty.base.scalar().unwrap_or(Scalar::Int),
                    ty.base.size().max(self.size()),
                ));
                let operand = self.expr(wide);
                let letters = self.swizzle(wide.base.size(), ty.base.size(), false);
                Expr::plain(
                    format!("{}.{letters}", operand.at(Level::Primary)),
                    Level::Primary,
                )
            }
        }
    }

    /// A shift, whose amount is signed or unsigned, and a vector or a scalar.
    fn shift(&mut self, ty: Type, is_wild: bool) -> Expr {
        let left = self.expr(ty);
        let kind = self.choices.pick(&[Scalar::Int, Scalar::Uint]);
        let size = if self.choices.chance(100) {
            1
        } else {
            ty.base.size()
        };
        let amount = self.expr(Type::of(Base::sized(kind, size)));
        let bits = if kind == Scalar::Uint { "31u" } else { "31" };
        let amount = if is_wild {
            amount
        } else {
            Expr::plain(format!("{} & {bits}", amount.at(Level::And)), Level::And)
        };
        let op = self.choices.pick(&["<<", ">>"]);
        Expr::binary(&left, op, &amount, Level::Shift, Range::VARIABLE)
    }

    /// Two operands, the left of which has the type.
    fn operands_first(&mut self, ty: Type) -> (Expr, Expr) {
        let left = self.expr(ty);
        (left, self.beside(ty))
    }

    /// Assignments and steps of integers, with anything on either side.
    pub(super) fn changed(&mut self, ty: Type) -> Expr {
        let Some((_, place)) = self.place(ty, true, &[]) else {
            return self.leaf(ty);
        };
        let place = place.text;
        match self.choices.below(6) {
            0 => Expr::plain(format!("{place}++"), Level::Primary),
            1 => Expr::plain(format!("--{place}"), Level::Unary),
            2 => Expr::plain(format!("BUMP({place})"), Level::Primary),
            _ => {
                let op = self.choices.pick(&["+=", "-=", "*=", "^=", "|=", "&="]);
                let value = self.beside(ty);
                let text = format!("{place} {op} {}", value.at(Level::Assignment));
                Expr::plain(text, Level::Assignment)
            }
        }
    }

    fn truth(&mut self, base: Base) -> Expr {
        if let Base::Vector(_, size) = base {
            let kind = self.choices.pick(&[Scalar::Int, Scalar::Float, Scalar::Uint]);
            let operand = Type::of(Base::Vector(kind, size));
            let name = self.choices.pick(&[
                "lessThan",
                "lessThanEqual",
                "greaterThan",
                "greaterThanEqual",
                "equal",
                "notEqual",
            ]);
            if self.choices.chance(50) {
                return Expr::call("not", &[self.expr(Type::of(base))], Range::VARIABLE);
            }
            let (left, right) = (self.expr(operand), self.expr(operand));
            return Expr::call(name, &[left, right], Range::VARIABLE);
        }
        match self.choices.below(8) {
            0..=2 => {
                let ty = self.choices.pick(&[INT, FLOAT, UINT]);
                let (left, right) = (self.expr(ty), self.expr(ty));
                let op = self.choices.pick(&["<", ">", "<=", ">="]);
                Expr::binary(&left, op, &right, Level::Relation, Range::VARIABLE)
            }
            3 | 4 => {
                let (left, right) = (self.expr(BOOL), self.expr(BOOL));
                let (op, level) = self.choices.pick(&[
                    ("&&", Level::LogicalAnd),
                    ("||", Level::LogicalOr),
                    ("^^", Level::LogicalXor),
                ]);
                Expr::binary(&left, op, &right, level, Range::VARIABLE)
            }
            5 => {
                let ty = self.ty();
                let (left, right) = (self.expr(ty), self.expr(ty));
                let op = self.choices.pick(&["==", "!="]);
                Expr::binary(&left, op, &right, Level::Equality, Range::VARIABLE)
            }
            6 => {
                let name = self.choices.pick(&["any", "all"]);
                let vector = Type::of(Base::Vector(Scalar::Bool, self.size()));
                Expr::call(name, &[self.expr(vector)], Range::VARIABLE)
            }
            _ => Expr::unary("!", &self.expr(BOOL)),
        }
    }

    fn matrix(&mut self, columns: u8, rows: u8) -> Expr {
        let ty = Type::of(Base::Matrix(columns, rows));
        let name = ty.name();
        let choice = if self.mode == Mode::Constant {
            0
        } else {
            self.choices.below(9)
        };
        match choice {
            1 => {
                let (left, right) = self.operands(ty);
                let op = self.choices.pick(&["+", "-"]);
                let range = left.range.sum(right.range);
                Expr::binary(&left, op, &right, Level::Sum, range)
            }
            2 => {
                let inner = self.size();
                let left = Type::of(Base::Matrix(inner, rows));
                let right = Type::of(Base::Matrix(columns, inner));
                let (left, right, range) = self.factors(left, right, inner);
                Expr::binary(&left, "*", &right, Level::Product, range)
            }
            3 => {
                let (left, right, range) = self.factors(ty, FLOAT, 1);
                Expr::binary(&left, "*", &right, Level::Product, range)
            }
            4 => {
                let operand = self.expr(Type::of(Base::Matrix(rows, columns)));
                let range = operand.range;
                Expr::call("transpose", &[operand], range)
            }
            5 => {
                let [column, row] = [rows, columns].map(|size| Type::of(Base::Vector(Scalar::Float, size)));
                let (column, row, range) = self.factors(column, row, 1);
                Expr::call("outerProduct", &[column, row], range)
            }
            6 => {
                let (left, right, range) = self.factors(ty, ty, 1);
                Expr::call("matrixCompMult", &[left, right], range)
            }
            7 => {
                let other = Type::of(Base::Matrix(self.size(), self.size()));
                let operand = self.expr(other);
                let range = operand.range.or(Range::new(1.0, 0));
                Expr::call(&name, &[operand], range)
            }
            0 if self.is_wild() && columns == rows && self.mode != Mode::Constant => {
                let operand = self.expr(ty);
                Expr::call("inverse", &[operand], Range::VARIABLE)
            }
            8 => {
                let diagonal = self.expr(FLOAT);
                let range = diagonal.range;
                Expr::call(&name, &[diagonal], range)
            }
            _ => {
                let column = Type::of(Base::Vector(Scalar::Float, rows));
                let columns: Vec<_> = (0..columns).map(|_| self.storable(column)).collect();
                Expr::call(&name, &columns, Range::VARIABLE)
            }
        }
    }
}
