//! Constructors. HLSL has casts for a single argument, and structures are made by functions; the other
//! languages make matrices of their columns.

use toyproof_glsl::tree::{Constructor, ExprId, ExprKind, Scalar, Type, Value};

use super::Unprintable;
use super::expression::{Part, Parts, level};
use super::language::Language;
use super::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(super) fn construct(
        &mut self,
        constructor: Constructor,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        if self.language() == Language::Msl {
            return self.construct_in_metal(constructor, arguments, ty);
        }
        let only = arguments.first().copied();
        let only = only.ok_or(Unprintable::Construct("a constructor without arguments"))?;
        let from = self.cx.tree[only].ty;
        let primary = |parts| Ok((parts, level::POSTFIX));
        if self.language() != Language::Hlsl
            && let Some(literal) = self.converted_literal(constructor, only, ty)
        {
            return primary(literal);
        }
        if self.language() == Language::Glsl {
            let scalar = match constructor {
                Constructor::Struct | Constructor::Array => None,
                _ => ty.scalar(),
            };
            let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
            for (at, &argument) in arguments.iter().enumerate() {
                if at > 0 {
                    parts.push(Part::token(", "));
                }
                match scalar {
                    Some(scalar) if arguments.len() > 1 => parts.extend(self.component(argument, scalar)?),
                    _ => parts.push(Part::Print(argument, level::ASSIGN)),
                }
            }
            parts.push(Part::token(")"));
            return primary(parts);
        }
        match constructor {
            Constructor::Struct => {
                let Type::Struct(id) = ty else {
                    return Err(Unprintable::Construct("this constructor"));
                };
                if self.language() != Language::Hlsl {
                    return primary(Self::call(self.structure_name(id), arguments));
                }
                self.made.insert(id);
                primary(Self::call(self.maker_name(id), arguments))
            }
            Constructor::Array => Err(Unprintable::Construct("an array outside a declaration")),
            Constructor::Scalar => self.scalar(only, from, ty),
            Constructor::Splat | Constructor::Diagonal if self.language() != Language::Hlsl => {
                let scalar = ty.scalar().unwrap_or(Scalar::Float);
                let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
                parts.extend(self.component(only, scalar)?);
                parts.push(Part::token(")"));
                primary(parts)
            }
            Constructor::Splat => {
                if self.is_short(only) {
                    let size = usize::from(ty.component_count().unwrap_or(1));
                    return primary(Self::call(self.type_name(ty)?, &vec![only; size]));
                }
                self.cast(only, ty)
            }
            Constructor::Vector => self.vector(arguments, ty),
            Constructor::Matrix => self.matrix(arguments, ty),
            Constructor::Diagonal => self.diagonal(only, ty),
            Constructor::Resize if from == ty => primary(vec![Part::Print(only, level::POSTFIX)]),
            Constructor::Resize => self.resize(only, from, ty),
        }
    }

    /// `(float3)x`, which also converts a scalar to a vector.
    fn cast(&self, value: ExprId, ty: Type) -> PrintResult<Parts> {
        let cast = format!("({})", self.type_name(ty)?);
        Ok((
            vec![Part::Token(cast), Part::Print(value, level::POSTFIX)],
            level::UNARY,
        ))
    }

    /// Whether a value may be repeated: a literal or a variable.
    fn is_short(&self, id: ExprId) -> bool {
        matches!(
            self.cx.tree[id].kind,
            ExprKind::Literal(_) | ExprKind::Variable(_)
        )
    }

    /// An argument of a constructor with several, whose components become those of the vector or matrix: Godot
    /// converts none.
    fn component(&self, argument: ExprId, scalar: Scalar) -> PrintResult<Vec<Part>> {
        let from = self.cx.tree[argument].ty;
        if self.language() == Language::Hlsl || from.scalar() == Some(scalar) {
            return Ok(vec![Part::Print(argument, level::ASSIGN)]);
        }
        let ty = match from {
            Type::Vector(_, size) => Type::Vector(scalar, size),
            _ => Type::Scalar(scalar),
        };
        if let Some(literal) = self.converted_literal(Constructor::Scalar, argument, ty) {
            return Ok(literal);
        }
        Ok(Self::call(self.type_name(ty)?, &[argument]))
    }

    /// The float that an integer literal becomes, unless it is a macro's.
    fn converted_literal(&self, constructor: Constructor, value: ExprId, ty: Type) -> Option<Vec<Part>> {
        let ExprKind::Literal(literal) = &self.cx.tree[value].kind else {
            return None;
        };
        let Value::Int(number) = literal.value else {
            return None;
        };
        let is_float = constructor == Constructor::Scalar && ty == Type::FLOAT;
        let is_macro = self.source.macro_name(self.cx.tree[value].at).is_some();
        let exact = number.unsigned_abs() < 1 << 24;
        (is_float && !is_macro && exact).then(|| vec![Part::Token(format!("{number}.0"))])
    }

    pub(super) fn scalar(&self, value: ExprId, from: Type, ty: Type) -> PrintResult<Parts> {
        let part = match from {
            Type::Vector(..) => ".x",
            Type::Matrix { .. } => "[0].x",
            _ => "",
        };
        let name = self.type_name(ty)?;
        let converts = from.scalar() != ty.scalar();
        Ok(match (converts, part) {
            (false, "") => (vec![Part::Print(value, level::UNARY)], level::UNARY),
            (false, part) => (
                vec![Part::Print(value, level::POSTFIX), Part::token(part)],
                level::POSTFIX,
            ),
            (true, "") => (Self::call(name, &[value]), level::POSTFIX),
            (true, part) => (
                vec![
                    Part::Token(format!("{name}(")),
                    Part::Print(value, level::POSTFIX),
                    Part::Token(format!("{part})")),
                ],
                level::POSTFIX,
            ),
        })
    }

    fn vector(&self, arguments: &[ExprId], ty: Type) -> PrintResult<Parts> {
        let Type::Vector(scalar, size) = ty else {
            return Err(Unprintable::Construct("this vector constructor"));
        };
        // A vector's first components.
        if let &[only] = arguments
            && let Type::Vector(from, has) = self.cx.tree[only].ty
            && has > size
        {
            let mut parts = vec![Part::Print(only, level::POSTFIX), Part::token(first(size))];
            if from != scalar {
                parts.insert(0, Part::Token(format!("{}(", self.type_name(ty)?)));
                parts.push(Part::token(")"));
            }
            return Ok((parts, level::POSTFIX));
        }
        let mut room = size;
        let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
        for (position, &argument) in arguments.iter().enumerate() {
            let count = match self.cx.tree[argument].ty {
                Type::Scalar(_) => 1,
                Type::Vector(_, count) => count,
                _ => return Err(Unprintable::Construct("a vector constructed from a matrix")),
            };
            if position > 0 {
                parts.push(Part::token(", "));
            }
            if count > room {
                parts.extend([Part::Print(argument, level::POSTFIX), Part::token(first(room))]);
            } else if arguments.len() > 1 {
                parts.extend(self.component(argument, scalar)?);
            } else {
                parts.push(Part::Print(argument, level::ASSIGN));
            }
            room = room.saturating_sub(count);
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    /// A matrix of its components or columns, which are rows here. Components that are mixed with vectors are
    /// grouped into columns: Slang takes either.
    fn matrix(&self, arguments: &[ExprId], ty: Type) -> PrintResult<Parts> {
        const MIXED: Unprintable =
            Unprintable::Construct("a matrix whose columns are made of parts of vectors");
        let Type::Matrix { columns, rows } = ty else {
            return Err(MIXED);
        };
        let count = |argument: ExprId| match self.cx.tree[argument].ty {
            Type::Scalar(_) => Ok(1),
            Type::Vector(_, count) => Ok(count),
            _ => Err(MIXED),
        };
        let name = self.type_name(ty)?;
        if let &[only] = arguments {
            let fits = count(only)? == columns * rows;
            return match self.language() {
                Language::Hlsl if fits => self.cast(only, ty),
                _ => Err(MIXED),
            };
        }
        let counts = arguments.iter().map(|&argument| count(argument));
        let counts = counts.collect::<PrintResult<Vec<u8>>>()?;
        let takes_components = self.language() == Language::Hlsl && counts.iter().all(|&count| count == 1);
        if takes_components || counts.iter().all(|&count| count == rows) {
            return Ok((Self::call(name, arguments), level::POSTFIX));
        }
        let column_type = self.type_name(Type::Vector(Scalar::Float, rows))?;
        let mut parts = vec![Part::Token(format!("{name}("))];
        let mut rest = arguments;
        while !rest.is_empty() {
            let mut filled = 0;
            let parts_of_column = rest.iter().take_while(|&&argument| {
                let is_inside = filled < rows;
                filled += count(argument).unwrap_or(0);
                is_inside
            });
            let (column, others) = rest.split_at(parts_of_column.count());
            let size: u8 = column.iter().map(|&argument| count(argument).unwrap_or(0)).sum();
            if size != rows {
                return Err(MIXED);
            }
            if rest.len() < arguments.len() {
                parts.push(Part::token(", "));
            }
            if let &[only] = column {
                parts.push(Part::Print(only, level::ASSIGN));
            } else {
                for (at, &component) in column.iter().enumerate() {
                    let before = if at == 0 {
                        format!("{column_type}(")
                    } else {
                        ", ".to_owned()
                    };
                    parts.push(Part::Token(before));
                    parts.extend(self.component(component, Scalar::Float)?);
                }
                parts.push(Part::token(")"));
            }
            rest = others;
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    fn diagonal(&self, value: ExprId, ty: Type) -> PrintResult<Parts> {
        let Type::Matrix { columns, rows } = ty else {
            return Err(Unprintable::Construct("this matrix constructor"));
        };
        if !self.is_short(value) {
            return Err(Unprintable::Construct("a diagonal matrix of a computed number"));
        }
        let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
        for column in 0..columns {
            for row in 0..rows {
                if (column, row) != (0, 0) {
                    parts.push(Part::token(", "));
                }
                parts.push(if column == row {
                    Part::Print(value, level::ASSIGN)
                } else {
                    Part::token("0.0")
                });
            }
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    /// The first columns and rows of a matrix; a larger matrix is completed by the identity's components.
    pub(super) fn resize(&mut self, matrix: ExprId, from: Type, ty: Type) -> PrintResult<Parts> {
        let (
            Type::Matrix { columns, rows },
            Type::Matrix {
                columns: has,
                rows: long,
            },
        ) = (ty, from)
        else {
            return Err(Unprintable::Construct("this matrix constructor"));
        };
        if columns <= has && rows <= long && self.language() == Language::Hlsl {
            return self.cast(matrix, ty);
        }
        let name = self.type_name(ty)?;
        let vector = self.type_name(Type::Vector(Scalar::Float, rows))?;
        let column = |column: u8| {
            let own = if column < has { rows.min(long) } else { 0 };
            let components = if own < long { first(own) } else { "" };
            let part = (own > 0).then(|| format!("x[{column}]{components}"));
            let identity = (own..rows).map(|row| if row == column { "1.0" } else { "0.0" }.to_owned());
            let parts: Vec<String> = part.into_iter().chain(identity).collect();
            match &parts[..] {
                [only] => only.clone(),
                _ => format!("{vector}({})", parts.join(", ")),
            }
        };
        let columns: Vec<String> = (0..columns).map(column).collect();
        let body = format!("return {name}({});", columns.join(", "));
        let function = self.helper_function(&format!("to_{name}"), &[from], ty, "", &body)?;
        Ok((Self::call(function, &[matrix]), level::POSTFIX))
    }
}

/// The swizzle of a vector's first components.
pub(super) fn first(size: u8) -> &'static str {
    [".x", ".xy", ".xyz", ".xyzw"][usize::from(size.clamp(1, 4)) - 1]
}
