//! Expressions that exist for every type. Operators and built-in functions are in `value`.

use super::expr::{Expr, Level, Range};
use super::types::{BOOL, Base, Scalar, Type};
use super::{Effects, Function, Generator, MAX_OPERANDS, MAX_WORK, Mode, Passing};

/// The maximum nesting depth of operands.
const MAX_DEPTH: usize = 5;

/// An access to a part of a value.
#[derive(Debug, Clone, Copy)]
enum Part {
    Field(&'static str),
    /// An index below this number of elements, columns or components.
    Element(u8),
    /// A swizzle of this number of components.
    Swizzle(u8),
}

impl Generator<'_> {
    /// An expression of that type.
    pub(super) fn expr(&mut self, ty: Type) -> Expr {
        self.depth += 1;
        self.operands += 1;
        let deepest = if self.mode == Mode::Constant { 2 } else { MAX_DEPTH };
        let ends = self.depth > deepest || self.operands > MAX_OPERANDS || self.choices.is_over();
        let expr = if ends || !self.choices.chance(190) {
            self.leaf(ty)
        } else {
            self.general(ty).unwrap_or_else(|| self.value(ty))
        };
        self.depth -= 1;
        if self.choices.chance(16) {
            return Expr::primary(format!("({})", expr.text), expr.range);
        }
        expr
    }

    /// An expression whose floats are in the range of variables.
    pub(super) fn storable(&mut self, ty: Type) -> Expr {
        let expr = self.expr(ty);
        self.tamed(ty, expr)
    }

    /// Expressions of every type: calls, conditionals, assignments, sequences.
    fn general(&mut self, ty: Type) -> Option<Expr> {
        match self.choices.below(16) {
            0 | 1 => self.called(Some(ty)),
            2 if ty.is_basic() => {
                let condition = self.expr(BOOL);
                let (yes, no) = (self.expr(ty), self.expr(ty));
                let text = format!(
                    "{} ? {} : {}",
                    condition.at(Level::LogicalOr),
                    yes.text,
                    no.at(Level::Assignment)
                );
                Some(Expr::new(text, Level::Conditional, yes.range.or(no.range)))
            }
            3 if self.mode == Mode::Any => {
                let (_, place) = self.place(ty, true, &[])?;
                let value = self.storable(ty);
                let text = format!("{} = {}", place.text, value.at(Level::Assignment));
                Some(Expr::plain(text, Level::Assignment))
            }
            4 if self.mode == Mode::Any => {
                let first = self.ty();
                let (first, second) = (self.expr(first), self.expr(ty));
                let text = format!("{}, {}", first.text, second.at(Level::Assignment));
                Some(Expr::new(text, Level::Sequence, second.range))
            }
            5 if ty.length.is_none() => {
                // Indexing a value that is not a variable.
                let length = 2 + self.choices.below(3) as u8;
                let parts: Vec<_> = (0..length).map(|_| self.storable(ty)).collect();
                let array = Type {
                    length: Some(length),
                    ..ty
                };
                let index = self.index(length);
                let array = Expr::call(&array.name(), &parts, Range::VARIABLE);
                Some(Expr::primary(format!("{}[{index}]", array.text), Range::VARIABLE))
            }
            6..=8 => self.part(ty),
            _ => None,
        }
    }

    /// A part with that type of any value: a member, an element, a column, a component or a swizzle.
    fn part(&mut self, ty: Type) -> Option<Expr> {
        let mut wholes = Vec::new();
        for (number, structure) in (0..).zip(&self.structs) {
            let fields = structure.fields.iter().filter(|&&(_, field)| field == ty);
            wholes.extend(fields.map(|&(name, _)| (Type::of(Base::Struct(number)), Part::Field(name))));
        }
        if ty.length.is_none() {
            let length = 1 + self.choices.below(4) as u8;
            let array = Type {
                length: Some(length),
                ..ty
            };
            wholes.push((array, Part::Element(length)));
            let size = self.size();
            match ty.base {
                Base::Vector(Scalar::Float, rows) => {
                    wholes.push((Type::of(Base::Matrix(size, rows)), Part::Element(size)));
                }
                Base::Scalar(scalar) => {
                    wholes.push((Type::of(Base::Vector(scalar, size)), Part::Element(size)));
                }
                _ => {}
            }
            if let Some(scalar) = ty.base.scalar()
                && !matches!(ty.base, Base::Matrix(..))
            {
                wholes.push((Type::of(Base::Vector(scalar, size)), Part::Swizzle(size)));
            }
        }
        if wholes.is_empty() {
            return None;
        }
        let (whole, part) = self.choices.pick(&wholes);
        let whole = self.expr(whole);
        let step = match part {
            Part::Field(name) => format!(".{name}"),
            Part::Element(length) => format!("[{}]", self.index(length)),
            Part::Swizzle(of) => format!(".{}", self.swizzle(of, ty.base.size(), false)),
        };
        let text = format!("{}{step}", whole.at(Level::Primary));
        Some(Expr::primary(text, whole.range))
    }

    /// A call of a function with that result; none if none can be called here.
    pub(super) fn called(&mut self, result: Option<Type>) -> Option<Expr> {
        if self.mode != Mode::Any {
            return None;
        }
        let fitting: Vec<_> = self
            .functions
            .iter()
            .filter(|function| function.result == result && function.work * self.runs <= MAX_WORK)
            .cloned()
            .collect();
        if fitting.is_empty() {
            return None;
        }
        let index = self.choices.below(fitting.len());
        self.call(&fitting[index])
    }

    /// A call of that function; none if it has no variable to write to.
    pub(super) fn call(&mut self, function: &Function) -> Option<Expr> {
        let hands_out = function
            .parameters
            .iter()
            .any(|&(passing, _)| passing != Passing::In);
        let wild = self.effects == Effects::Anywhere;
        let mode = if hands_out && !wild { Mode::Pure } else { Mode::Any };
        let mut taken = Vec::new();
        let mut arguments = Vec::new();
        for &(passing, ty) in &function.parameters {
            arguments.push(self.within(mode, |this| {
                if passing == Passing::In {
                    return Some(this.storable(ty));
                }
                let (name, place) = this.place(ty, true, &taken)?;
                if !wild {
                    taken.push(name);
                }
                Some(place)
            })?);
        }
        self.work = self.work.max(function.work * self.runs);
        Some(Expr::call(&function.name, &arguments, Range::VARIABLE))
    }

    /// A constructor of a structure or an array.
    pub(super) fn constructed(&mut self, ty: Type) -> Expr {
        let (name, parts): (_, Vec<Type>) = match (ty.length, ty.base) {
            (Some(length), base) => {
                let name = if self.choices.chance(100) {
                    format!("{}[]", base.name())
                } else {
                    ty.name()
                };
                (name, vec![Type::of(base); usize::from(length)])
            }
            (None, Base::Struct(number)) => {
                let fields = &self.structs[usize::from(number)].fields;
                (ty.name(), fields.iter().map(|&(_, ty)| ty).collect())
            }
            (None, base) => (ty.name(), vec![Type::of(base)]),
        };
        let parts: Vec<_> = parts.into_iter().map(|part| self.storable(part)).collect();
        Expr::call(&name, &parts, Range::VARIABLE)
    }
}
