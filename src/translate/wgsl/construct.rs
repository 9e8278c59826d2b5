//! Constructors. WGSL's take exactly what they need: components of one type, no more of them than there is room for, and of matrices
//! either all numbers or all columns.

use toyproof_glsl::tree::{Constructor, ExprId, Scalar, Type};

use super::Unprintable;
use super::text::{Class, Printed, Text};
use super::writer::{Writer, scalar_name};

impl Writer<'_> {
    pub(super) fn construct(&mut self, constructor: Constructor, arguments: &[ExprId], ty: Type) -> Printed {
        let types: Vec<Type> = arguments
            .iter()
            .map(|&argument| self.draft.tree[argument].ty)
            .collect();
        let texts = self.values(arguments)?;
        let name = self.type_name(ty);
        let words = match constructor {
            Constructor::Struct | Constructor::Array => Self::list(texts),
            Constructor::Scalar => match (types.first(), texts.into_iter().next()) {
                (Some(&from), Some(text)) => return as_scalar(text, from, ty),
                _ => return Err(Unprintable("a constructor of nothing")),
            },
            Constructor::Splat => match (types.first(), texts.into_iter().next()) {
                (Some(&from), Some(text)) => {
                    let scalar = Type::Scalar(ty.scalar().unwrap_or(Scalar::Float));
                    as_scalar(text, from, scalar)?.words
                }
                _ => return Err(Unprintable("a constructor of nothing")),
            },
            Constructor::Vector => self.vector(texts, &types, ty)?,
            Constructor::Matrix => self.matrix(texts, &types, ty)?,
            Constructor::Diagonal => {
                let Type::Matrix { columns, rows } = ty else {
                    return Err(Unprintable("that matrix"));
                };
                let from = types.first().copied().unwrap_or_default();
                let text = texts
                    .into_iter()
                    .next()
                    .ok_or(Unprintable("a constructor of nothing"))?;
                let number = as_scalar(text, from, Type::FLOAT)?;
                let is_short = number
                    .words
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
                let number = if is_short {
                    number
                } else {
                    self.keep_as("diagonal", &number)
                }
                .words;
                let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| column == row));
                let cells = cells.map(|diagonal| if diagonal { number.as_str() } else { "0.0" });
                cells.collect::<Vec<_>>().join(", ")
            }
            Constructor::Resize => self.resize(texts, &types, ty)?,
        };
        Ok(Text::primary(format!("{name}({words})")))
    }

    /// A whole value with components of another type; those beyond `room` are cut off.
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
                    return Ok(text.words);
                }
                Ok(format!(
                    "{}({})",
                    self.type_name(Type::vector(scalar, size)),
                    text.words
                ))
            }
            Type::Scalar(_) => Ok(as_scalar(text, from, Type::Scalar(scalar))?.words),
            _ => Err(Unprintable("a vector of a matrix")),
        }
    }

    fn vector(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let Type::Vector(scalar, size) = ty else {
            return Err(Unprintable("that vector"));
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
            let words = match from {
                Type::Vector(_, own) if single && own == size => text.words,
                _ => self.converted(text, from, scalar, room)?,
            };
            parts.push(Text { words, class });
            room -= count;
        }
        Ok(Self::list(parts))
    }

    fn matrix(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let Type::Matrix { columns, rows } = ty else {
            return Err(Unprintable("that matrix"));
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
                            .words
                            .chars()
                            .all(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
                    let base = if is_name {
                        text
                    } else {
                        self.keep_as("column", &text)
                    }
                    .words;
                    for letter in ["x", "y", "z", "w"].into_iter().take(size.into()) {
                        let cell = Text::primary(format!("{base}.{letter}"));
                        cells.push(as_scalar(cell, Type::Scalar(own), Type::FLOAT)?.words);
                    }
                }
                Type::Scalar(_) => cells.push(as_scalar(text, from, Type::FLOAT)?.words),
                _ => return Err(Unprintable("a matrix of matrices")),
            }
        }
        cells.truncate(usize::from(columns) * usize::from(rows));
        Ok(cells.join(", "))
    }

    /// The components that the other matrix has, the identity's elsewhere.
    fn resize(&mut self, texts: Vec<Text>, types: &[Type], ty: Type) -> Result<String, Unprintable> {
        let (
            Type::Matrix { columns, rows },
            Some(&Type::Matrix {
                columns: has,
                rows: long,
            }),
        ) = (ty, types.first())
        else {
            return Err(Unprintable("that matrix"));
        };
        let text = texts
            .into_iter()
            .next()
            .ok_or(Unprintable("a constructor of nothing"))?;
        let base = if text.class == Class::Primary && !text.words.contains('(') {
            text
        } else {
            self.keep_as("matrix", &text)
        }
        .words;
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

/// The first component of a value, as a scalar of another type.
pub(super) fn as_scalar(text: Text, from: Type, to: Type) -> Printed {
    let text = match from {
        Type::Vector(..) => Text::primary(format!("{}.x", text.operand())),
        Type::Matrix { .. } => Text::primary(format!("{}[0].x", text.operand())),
        _ => text,
    };
    let (Some(from), Some(scalar)) = (from.scalar(), to.scalar()) else {
        return Err(Unprintable("a number of what is none"));
    };
    if from == scalar {
        return Ok(text);
    }
    // A number of its own with the suffix of 32 bits, or without.
    let suffixed = text.words.strip_suffix('i');
    if let (Scalar::Int, Ok(number)) = (from, suffixed.unwrap_or(&text.words).parse::<i64>()) {
        match scalar {
            Scalar::Float if suffixed.is_none() => {
                let words = format!("{number}.0");
                return Ok(Text { words, ..text });
            }
            Scalar::Uint if number >= 0 => return Ok(Text::primary(format!("{number}u"))),
            _ => {}
        }
    }
    Ok(Text::primary(format!("{}({})", scalar_name(scalar), text.words)))
}
