//! Constructors in Metal: lists in braces for structures and arrays, and columns for matrices.

use toyproof_glsl::tree::{Constructor, ExprId, Scalar, Type};

use crate::c_family::Unprintable;
use crate::c_family::construct::first;
use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

impl Writer<'_> {
    pub(in super::super) fn construct_in_metal(
        &mut self,
        constructor: Constructor,
        arguments: &[ExprId],
        ty: Type,
    ) -> PrintResult<Parts> {
        let only = arguments.first().copied();
        let only = only.ok_or(Unprintable::Construct("a constructor without arguments"))?;
        let from = self.cx.tree[only].ty;
        match constructor {
            Constructor::Struct | Constructor::Array => {
                let mut parts = vec![Part::Token(format!("{}{{ ", self.type_name(ty)?))];
                parts.extend(Self::list(arguments));
                parts.push(Part::token(" }"));
                Ok((parts, level::POSTFIX))
            }
            Constructor::Scalar => self.scalar(only, from, ty),
            Constructor::Splat | Constructor::Diagonal => {
                Ok((Self::call(self.type_name(ty)?, arguments), level::POSTFIX))
            }
            Constructor::Vector => self.vector_in_metal(arguments, ty),
            Constructor::Matrix => self.matrix_in_metal(arguments, ty),
            Constructor::Resize => self.resize(only, from, ty),
        }
    }

    /// `float4(v, 1.0)`; parts have the scalar type of the whole, or are scalars.
    fn vector_in_metal(&self, arguments: &[ExprId], ty: Type) -> PrintResult<Parts> {
        let Type::Vector(scalar, size) = ty else {
            return Err(Unprintable::Construct("this vector constructor"));
        };
        // A vector's first components.
        if let &[only] = arguments
            && let Type::Vector(from, has) = self.cx.tree[only].ty
        {
            if has == size && from != scalar {
                return Ok((Self::call(self.type_name(ty)?, arguments), level::POSTFIX));
            }
            let components = if has == size { "" } else { first(size) };
            let mut parts = vec![
                Part::Print(only, level::POSTFIX),
                Part::Token(components.to_owned()),
            ];
            if from != scalar {
                parts.insert(0, Part::Token(format!("{}(", self.type_name(ty)?)));
                parts.push(Part::token(")"));
            }
            return Ok((parts, level::POSTFIX));
        }
        let mut room = size;
        let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
        for (position, &argument) in arguments.iter().enumerate() {
            let (count, converts) = match self.cx.tree[argument].ty {
                Type::Scalar(_) => (1, false),
                Type::Vector(from, count) => (count, from != scalar),
                _ => return Err(Unprintable::Construct("a vector constructed from a matrix")),
            };
            if position > 0 {
                parts.push(Part::token(", "));
            }
            let taken = count.min(room);
            if converts {
                let part = self.type_name(Type::vector(scalar, taken))?;
                parts.push(Part::Token(format!("{part}(")));
            }
            if count > room {
                parts.extend([Part::Print(argument, level::POSTFIX), Part::token(first(room))]);
            } else {
                parts.push(Part::Print(argument, level::ASSIGN));
            }
            if converts {
                parts.push(Part::token(")"));
            }
            room -= taken;
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }

    /// `float2x2(float2(a, b), c)`: a matrix of its columns.
    fn matrix_in_metal(&self, arguments: &[ExprId], ty: Type) -> PrintResult<Parts> {
        const MIXED: Unprintable =
            Unprintable::Construct("a matrix whose columns are made of parts of vectors");
        let Type::Matrix { rows, .. } = ty else {
            return Err(MIXED);
        };
        let count = |argument: ExprId| match self.cx.tree[argument].ty {
            Type::Scalar(_) => Ok(1),
            Type::Vector(_, count) => Ok(count),
            _ => Err(MIXED),
        };
        let column = Type::vector(Scalar::Float, rows);
        let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
        let mut rest = arguments;
        while !rest.is_empty() {
            if rest.len() < arguments.len() {
                parts.push(Part::token(", "));
            }
            let (mut filled, mut taken) = (0, 0);
            while filled < rows {
                filled += count(*rest.get(taken).ok_or(MIXED)?)?;
                taken += 1;
            }
            let (own, others) = rest.split_at(taken);
            match own {
                _ if filled != rows => return Err(MIXED),
                &[only] if self.cx.tree[only].ty == column => parts.push(Part::Print(only, level::ASSIGN)),
                _ => parts.extend(self.vector_in_metal(own, column)?.0),
            }
            rest = others;
        }
        parts.push(Part::token(")"));
        Ok((parts, level::POSTFIX))
    }
}
