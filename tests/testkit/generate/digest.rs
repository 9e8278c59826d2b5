//! Helper functions of generated programs: reducing floats to a range, and hashing the value of a variable.

use std::fmt::Write;

use super::expr::{Expr, Level, Range};
use super::types::{Base, Scalar, Type};
use super::{Arithmetic, Generator, Mode, dimension};

impl Generator<'_> {
    /// Reduces the floats of an expression to the range of variables.
    pub(super) fn tamed(&mut self, ty: Type, value: Expr) -> Expr {
        const WILD: Range = Range::new(f64::INFINITY, i32::MAX);
        if self.is_wild() || !ty.is_float() || value.range.fits(Range::VARIABLE) {
            return value;
        }
        if self.mode == Mode::Constant {
            let text = format!(
                "clamp(floor({} * 16.0) / 16.0, -64.0, 64.0)",
                value.at(Level::Product)
            );
            return Expr::primary(text, Range::VARIABLE);
        }
        let name = ty.base.name();
        let body = match ty.base {
            Base::Matrix(columns, rows) => {
                let column = Type::of(Base::Vector(Scalar::Float, rows));
                let columns: Vec<_> = (0..columns)
                    .map(|number| {
                        self.tamed(column, Expr::primary(format!("x[{number}]"), WILD))
                            .text
                    })
                    .collect();
                format!("{name}({})", columns.join(", "))
            }
            _ => "clamp(floor(x * 16.0) / 16.0, -64.0, 64.0)".to_owned(),
        };
        self.helper(format!("{name} tame({name} x) {{ return {body}; }}\n"));
        Expr::call("tame", &[value], Range::VARIABLE)
    }

    /// An expression of type `uint` that distinguishes values of that type.
    pub(super) fn digest(&mut self, ty: Type, value: &str) -> String {
        let parts: Vec<String> = match (ty.length, ty.base) {
            (Some(length), base) => (0..length)
                .map(|element| self.digest(Type::of(base), &format!("x[{element}]")))
                .collect(),
            (None, Base::Struct(number)) => {
                let fields = self.structs[usize::from(number)].fields.clone();
                fields
                    .into_iter()
                    .map(|(name, ty)| self.digest(ty, &format!("x.{name}")))
                    .collect()
            }
            (None, Base::Matrix(columns, rows)) => {
                let column = Type::of(Base::Vector(Scalar::Float, rows));
                (0..columns)
                    .map(|number| self.digest(column, &format!("x[{number}]")))
                    .collect()
            }
            (None, Base::Vector(scalar, size)) => (0..size)
                .map(|component| number(scalar, &format!("x[{component}]"), self.arithmetic))
                .collect(),
            (None, Base::Scalar(scalar)) => vec![number(scalar, "x", self.arithmetic)],
        };
        let mut steps = String::new();
        for part in parts {
            let _ = write!(steps, " h = (h ^ {part}) * 747796405u; h ^= h >> 15;");
        }
        let parameter = format!("{} x{}", ty.base.name(), dimension(ty));
        self.helper(format!(
            "uint digest({parameter}) {{ uint h = 7u;{steps} return h; }}\n"
        ));
        format!("digest({value})")
    }

    fn helper(&mut self, text: String) {
        if !self.helpers.contains(&text) {
            self.helpers.push(text);
        }
    }
}

/// Converts a scalar to `uint`: the bits of a float, unless it is NaN or, on drivers, zero; or a multiple of 1/16 in the
/// range of variables.
fn number(scalar: Scalar, value: &str, arithmetic: Arithmetic) -> String {
    match scalar {
        Scalar::Float if arithmetic == Arithmetic::Any => {
            format!("(isnan({value}) ? 1u : floatBitsToUint({value}))")
        }
        Scalar::Float if arithmetic == Arithmetic::AnyOnDrivers => {
            format!("(isnan({value}) ? 1u : {value} == 0.0 ? 0u : floatBitsToUint({value}))")
        }
        Scalar::Float => format!("uint(int({value} * 16.0))"),
        _ => format!("uint({value})"),
    }
}
