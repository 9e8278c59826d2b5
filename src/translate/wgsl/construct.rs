//! Constructors. WGSL requires exact arguments: components of one type, no surplus, and for matrices either
//! all scalars or all columns.

use toyproof_glsl::tree::{Constructor, ExprId, Scalar, Type};

use super::Unprintable;
use super::writer::{Class, Text, TextResult, Writer, scalar_name};

impl Writer<'_> {
    pub(super) fn construct(
        &mut self,
        constructor: Constructor,
        arguments: &[ExprId],
        ty: Type,
    ) -> TextResult {
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.cx.tree[argument].ty)
            .collect();
        let texts = self.values(arguments)?;
        let name = self.type_name(ty);
        let code = match constructor {
            Constructor::Struct | Constructor::Array => Self::list(texts),
            Constructor::Scalar => match (types.first(), texts.into_iter().next()) {
                (Some(&from), Some(text)) => return as_scalar(text, from, ty),
                _ => return Err(Unprintable::Construct("a constructor without arguments")),
            },
            Constructor::Splat => match (types.first(), texts.into_iter().next()) {
                (Some(&from), Some(text)) => {
                    let scalar = Type::Scalar(ty.scalar().unwrap_or(Scalar::Float));
                    as_scalar(text, from, scalar)?.code
                }
                _ => return Err(Unprintable::Construct("a constructor without arguments")),
            },
            Constructor::Vector => self.vector(texts, &types, ty)?,
            Constructor::Matrix => self.matrix(texts, &types, ty)?,
            Constructor::Diagonal => {
                let Type::Matrix { columns, rows } = ty else {
                    return Err(Unprintable::Construct("this matrix constructor"));
                };
                let from = types.first().copied().unwrap_or_default();
                let text = texts
                    .into_iter()
                    .next()
                    .ok_or(Unprintable::Construct("a constructor without arguments"))?;
                let number = as_scalar(text, from, Type::FLOAT)?;
                let is_short = number
                    .code
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
                let number = if is_short {
                    number
                } else {
                    self.bind_as("diagonal", &number)
                }
                .code;
                let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| column == row));
                let cells = cells.map(|diagonal| if diagonal { number.as_str() } else { "0.0" });
                cells.collect::<Vec<_>>().join(", ")
            }
            Constructor::Resize => self.resize(texts, &types, ty)?,
        };
        Ok(Text::primary(format!("{name}({code})")))
    }

    /// Converts a value to another component type; components beyond `room` are cut off.
    fn converted(&self, text: Text, from: Type, scalar: Scalar, room: u8) -> Result<String, Unprintable> {
        match from {
            Type::Vector(own, size) => {
                let (text, size) = if size > room {
                    let letters = "xyzw".get(..usize::from(room)).unwrap_or("x");
                    (Text::primary(format!("{}.{letters}", text.operand())), room)
                } else {
                    (text, size)
                };
                if own == scalar {
                    return Ok(text.code);
                }
                Ok(format!(
                    "{}({})",
                    self.type_name(Type::vector(scalar, size)),
                    text.code
                ))
            }
            Type::Scalar(_) => Ok(as_scalar(text, from, Type::Scalar(scalar))?.code),
            _ => Err(Unprintable::Construct("a vector constructed from a matrix")),
        }
    }

    fn vector(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let Type::Vector(scalar, size) = ty else {
            return Err(Unprintable::Construct("this vector constructor"));
        };
        let mut room = size;
        let mut parts = Vec::new();
        let single = texts.len() == 1;
        for (text, &from) in texts.into_iter().zip(types) {
            if room == 0 {
                break;
            }
            let class = text.class;
            let count = from.component_count().unwrap_or(1).min(room);
            // `vec3f(v)` converts by itself.
            let code = match from {
                Type::Vector(_, own) if single && own == size => text.code,
                _ => self.converted(text, from, scalar, room)?,
            };
            parts.push(Text::new(code, class));
            room -= count;
        }
        Ok(Self::list(parts))
    }

    fn matrix(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let Type::Matrix { columns, rows } = ty else {
            return Err(Unprintable::Construct("this matrix constructor"));
        };
        let are_columns = types.len() == usize::from(columns)
            && types
                .iter()
                .all(|ty| matches!(ty, Type::Vector(_, size) if *size == rows));
        let are_numbers = types.iter().all(|ty| matches!(ty, Type::Scalar(_)));
        if are_columns || are_numbers {
            let parts = texts
                .into_iter()
                .zip(types)
                .map(|(text, &from)| self.converted(text, from, Scalar::Float, rows));
            return Ok(parts.collect::<Result<Vec<_>, _>>()?.join(", "));
        }
        let mut cells = Vec::new();
        for (text, &from) in texts.into_iter().zip(types) {
            match from {
                Type::Vector(own, size) => {
                    let is_name = text.class == Class::Primary
                        && text
                            .code
                            .chars()
                            .all(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
                    let base = if is_name {
                        text
                    } else {
                        self.bind_as("column", &text)
                    }
                    .code;
                    for letter in ["x", "y", "z", "w"].into_iter().take(size.into()) {
                        let cell = Text::primary(format!("{base}.{letter}"));
                        cells.push(as_scalar(cell, Type::Scalar(own), Type::FLOAT)?.code);
                    }
                }
                Type::Scalar(_) => cells.push(as_scalar(text, from, Type::FLOAT)?.code),
                _ => return Err(Unprintable::Construct("a matrix constructed from matrices")),
            }
        }
        cells.truncate(usize::from(columns) * usize::from(rows));
        Ok(cells.join(", "))
    }

    /// Prints a resized matrix: the components of the other matrix, and those of the identity elsewhere.
    fn resize(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let (
            Type::Matrix { columns, rows },
            Some(&Type::Matrix {
                columns: has,
                rows: long,
            }),
        ) = (ty, types.first())
        else {
            return Err(Unprintable::Construct("this matrix constructor"));
        };
        let text = texts
            .into_iter()
            .next()
            .ok_or(Unprintable::Construct("a constructor without arguments"))?;
        let base = if text.class == Class::Primary && !text.code.contains('(') {
            text
        } else {
            self.bind_as("matrix", &text)
        }
        .code;
        let identity = |column: u8, row: u8| if column == row { "1.0" } else { "0.0" };
        let column = |column: u8| {
            if column >= has {
                let cells: Vec<_> = (0..rows).map(|row| identity(column, row)).collect();
                return format!("vec{rows}f({})", cells.join(", "));
            }
            if rows == long {
                return format!("{base}[{column}]");
            }
            if rows < long {
                return format!(
                    "{base}[{column}].{}",
                    "xyzw".get(..usize::from(rows)).unwrap_or("x")
                );
            }
            let rest: Vec<_> = (long..rows).map(|row| identity(column, row)).collect();
            format!("vec{rows}f({base}[{column}], {})", rest.join(", "))
        };
        Ok((0..columns).map(column).collect::<Vec<_>>().join(", "))
    }
}

/// The first component of a value, converted to another scalar type.
pub(super) fn as_scalar(text: Text, from: Type, to: Type) -> TextResult {
    let text = match from {
        Type::Vector(..) => Text::primary(format!("{}.x", text.operand())),
        Type::Matrix { .. } => Text::primary(format!("{}[0].x", text.operand())),
        _ => text,
    };
    let (Some(from), Some(scalar)) = (from.scalar(), to.scalar()) else {
        return Err(Unprintable::Construct("a conversion of a non-numeric value"));
    };
    if from == scalar {
        return Ok(text);
    }
    // A bare literal, with or without a suffix.
    let suffixed = text.code.strip_suffix('i');
    if let (Scalar::Int, Ok(number)) = (from, suffixed.unwrap_or(&text.code).parse::<i64>()) {
        match scalar {
            Scalar::Float if suffixed.is_none() => {
                let code = format!("{number}.0");
                return Ok(Text { code, ..text });
            }
            Scalar::Uint if number >= 0 => return Ok(Text::primary(format!("{number}u"))),
            _ => {}
        }
    }
    Ok(Text::primary(format!("{}({})", scalar_name(scalar), text.code)))
}
