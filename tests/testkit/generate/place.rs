//! Places that can be read and written: variables and their parts.

use super::expr::{Expr, Level, Range};
use super::types::{Base, INT, Scalar, Type};
use super::{Generator, Mode, Variable};

/// An access to a part of a variable.
#[derive(Debug, Clone, Copy)]
enum Step {
    Field(&'static str),
    /// An index below this number of elements or columns.
    Element(u8),
    /// One of this number of components.
    Component(u8),
    /// A swizzle: the number of chosen components, and of all components.
    Swizzle {
        of: u8,
        to: u8,
    },
}

impl Generator<'_> {
    /// A place of that type, to read or to write. The name of its variable comes first.
    pub(super) fn place(&mut self, ty: Type, write: bool, except: &[String]) -> Option<(String, Expr)> {
        let mut seen: Vec<&str> = Vec::new();
        let mut found = Vec::new();
        for variable in self.scopes.iter().rev().flat_map(|scope| scope.iter().rev()) {
            let hidden = seen.contains(&variable.name.as_str());
            seen.push(&variable.name);
            let usable = (variable.writable || !write)
                && (variable.constant || self.mode != Mode::Constant)
                && !except.contains(&variable.name);
            if hidden || !usable {
                continue;
            }
            let mut paths = Vec::new();
            self.paths(variable.ty, ty, &mut Vec::new(), &mut paths);
            if !paths.is_empty() {
                found.push((variable.clone(), paths));
            }
        }
        if found.is_empty() {
            return None;
        }
        let index = self.choices.below(found.len().min(256));
        let (Variable { name, range, .. }, paths) = found.swap_remove(index);
        let path = &paths[self.choices.below(paths.len().min(256))];
        let text = self.walk(&name, path, write);
        Some((name, Expr::primary(text, range)))
    }

    fn paths(&self, from: Type, to: Type, path: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
        if from == to {
            found.push(path.clone());
        }
        let mut go = |step, inner| {
            path.push(step);
            self.paths(inner, to, path, found);
            path.pop();
        };
        if let Some(length) = from.length {
            return go(Step::Element(length), from.element());
        }
        match from.base {
            Base::Struct(number) => {
                for &(name, ty) in &self.structs[usize::from(number)].fields {
                    go(Step::Field(name), ty);
                }
            }
            Base::Matrix(columns, rows) => go(
                Step::Element(columns),
                Type::of(Base::Vector(Scalar::Float, rows)),
            ),
            Base::Vector(scalar, of) => match to.base {
                _ if to.length.is_some() => {}
                Base::Scalar(wanted) if wanted == scalar => {
                    path.push(Step::Component(of));
                    found.push(path.clone());
                    path.pop();
                }
                Base::Vector(wanted, size) if wanted == scalar && size <= of => {
                    path.push(Step::Swizzle { of, to: size });
                    found.push(path.clone());
                    path.pop();
                }
                _ => {}
            },
            Base::Scalar(_) => {}
        }
    }

    fn walk(&mut self, name: &str, path: &[Step], write: bool) -> String {
        let mut text = name.to_owned();
        for &step in path {
            let step = match step {
                Step::Field(name) => format!(".{name}"),
                Step::Element(length) => format!("[{}]", self.index(length)),
                Step::Component(of) if self.choices.chance(90) => format!("[{}]", self.index(of)),
                Step::Component(of) => format!(".{}", self.swizzle(of, 1, true)),
                Step::Swizzle { of, to } => format!(".{}", self.swizzle(of, to, write)),
            };
            text += &step;
        }
        text
    }

    /// Swizzle letters that pick `to` components of `of`, each at most once if `distinct`.
    pub(super) fn swizzle(&mut self, of: u8, to: u8, distinct: bool) -> String {
        let set = self.choices.pick(&["xyzw", "rgba", "stpq"]).as_bytes();
        let mut left: Vec<u8> = set[..usize::from(of)].to_vec();
        (0..to)
            .map(|_| {
                let at = self.choices.below(left.len());
                let letter = left[at];
                if distinct {
                    left.remove(at);
                }
                char::from(letter)
            })
            .collect()
    }

    /// An index from 0 to below `length`.
    pub(super) fn index(&mut self, length: u8) -> String {
        if self.mode == Mode::Constant || self.steady || !self.choices.chance(120) {
            return self.choices.below(usize::from(length)).to_string();
        }
        let index = self.expr(INT);
        if self.is_wild() && self.choices.chance(60) {
            // A constant index must be in bounds; `iFrame` is 7.
            return format!("{} - 7 + iFrame", index.at(Level::Sum));
        }
        let masked = |mask: &str| format!("{} & {mask}", index.at(Level::And));
        match length {
            1 => masked("0"),
            2 => masked("1"),
            4 => masked("3"),
            _ => format!("({}) % {length}", masked("255")),
        }
    }

    /// A literal, or a variable of that type.
    pub(super) fn leaf(&mut self, ty: Type) -> Expr {
        if self.choices.chance(200)
            && let Some((_, place)) = self.place(ty, false, &[])
        {
            return place;
        }
        self.literal_value(ty)
    }

    /// A literal value.
    fn literal_value(&mut self, ty: Type) -> Expr {
        if let Base::Scalar(_) = ty.base
            && ty.length.is_none()
        {
            let style = self.choices.below(6);
            let number = self.choices.below(256);
            return super::expr::literal(ty, number, style);
        }
        let parts: Vec<Type> = match (ty.length, ty.base) {
            (Some(length), _) => vec![ty.element(); usize::from(length)],
            (None, Base::Struct(number)) => {
                let fields = &self.structs[usize::from(number)].fields;
                fields.iter().map(|&(_, ty)| ty).collect()
            }
            (None, base) => {
                let scalar = base.scalar().unwrap_or(Scalar::Float);
                vec![Type::of(Base::Scalar(scalar))]
            }
        };
        let mut range = Range::new(0.0, 0);
        let parts: Vec<_> = parts
            .into_iter()
            .map(|part| {
                let part = self.literal_value(part);
                range = range.or(part.range);
                part
            })
            .collect();
        Expr::call(&ty.name(), &parts, range)
    }
}
