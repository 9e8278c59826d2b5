//! Constructors (§5.4).

use super::{Checker, Specifier};
use crate::codes::Code;
use crate::tree::{Constructor, ExprId, ExprKind, Place, Scalar, StructId, Type};

/// The constructor that converts a scalar or vector to a type of the same shape.
pub(super) fn conversion(to: Type) -> Constructor {
    match to {
        Type::Vector(..) => Constructor::Vector,
        _ => Constructor::Scalar,
    }
}

impl Checker<'_> {
    /// `type(arguments)`.
    pub(crate) fn construct(&mut self, specifier: &Specifier, arguments: Vec<ExprId>, at: Place) -> ExprId {
        if !specifier.sizes.is_empty() {
            return self.construct_array(specifier, arguments, at);
        }
        match specifier.base {
            Type::Struct(id) => self.construct_struct(id, arguments, at),
            Type::Error => self.broken(at),
            ty => match self.numeric_constructor(ty, &arguments) {
                Ok(constructor) => self.constructed(constructor, ty, arguments, at),
                Err(_) if self.types(&arguments).contains(&Type::Error) => self.broken(at),
                Err(message) => {
                    let diagnostic = Code::BadConstructor.at(at, message);
                    let mend = match arguments[..] {
                        [only] if matches!(ty, Type::Vector(..)) => self.mend(only, ty),
                        _ => None,
                    };
                    let diagnostic = match mend {
                        Some(mend) => diagnostic.label(mend),
                        None => diagnostic,
                    };
                    self.refuse_with(diagnostic, at)
                }
            },
        }
    }

    pub(super) fn construct_struct(&mut self, id: StructId, arguments: Vec<ExprId>, at: Place) -> ExprId {
        let types: Vec<_> = self.tree[id].members.iter().map(|member| member.ty).collect();
        if self.incomplete.contains(&id) {
            return self.broken(at);
        }
        if types.len() != arguments.len() {
            let name = self.said(Type::Struct(id));
            let message = format!(
                "{name} has {} members and is given {}",
                types.len(),
                arguments.len()
            );
            return self.refuse(Code::BadConstructor, at, message);
        }
        let arguments = arguments
            .into_iter()
            .zip(types)
            .map(|(argument, ty)| self.expect(argument, ty, "this member"))
            .collect();
        self.constructed(Constructor::Struct, Type::Struct(id), arguments, at)
    }

    fn construct_array(&mut self, specifier: &Specifier, arguments: Vec<ExprId>, at: Place) -> ExprId {
        if arguments.is_empty() {
            return self.refuse(Code::BadConstructor, at, "an array has at least one element");
        }
        // What `[]` leaves open, the arguments tell.
        let first = self.ty(arguments[0]);
        let given = match first {
            Type::Error => Type::Error,
            _ => self.tree.array_of(first, arguments.len() as u32),
        };
        let ty = self.array_type(specifier.base, &specifier.sizes, Some(given), specifier.at);
        let Type::Array(id) = ty else {
            return self.broken(at);
        };
        let array = self.tree.array(id);
        if array.size as usize != arguments.len() {
            let message = format!(
                "{} has {} elements and is given {}",
                self.said(ty),
                array.size,
                arguments.len()
            );
            return self.refuse(Code::BadConstructor, at, message);
        }
        let arguments = arguments
            .into_iter()
            .map(|argument| self.expect(argument, array.element, "this element"))
            .collect();
        self.constructed(Constructor::Array, ty, arguments, at)
    }

    fn constructed(
        &mut self,
        constructor: Constructor,
        ty: Type,
        arguments: Vec<ExprId>,
        at: Place,
    ) -> ExprId {
        let constant = arguments.iter().all(|&argument| self.tree[argument].constant);
        let kind = ExprKind::Construct {
            constructor,
            arguments,
        };
        self.push(kind, ty, constant, at)
    }

    /// How a scalar, vector or matrix is made of these arguments (§5.4.1, §5.4.2).
    fn numeric_constructor(&self, ty: Type, arguments: &[ExprId]) -> Result<Constructor, String> {
        let Some(wanted) = ty.component_count() else {
            return Err(format!("there is no constructor of {}", self.said(ty)));
        };
        let types = self.types(arguments);
        if let Some(&other) = types.iter().find(|ty| ty.component_count().is_none()) {
            return Err(format!(
                "{} cannot be made of {}",
                self.said(ty),
                self.said(other)
            ));
        }
        match (ty, &types[..]) {
            (_, []) => return Err(format!("{} needs an argument", self.said(ty))),
            (Type::Scalar(_), [_]) => return Ok(Constructor::Scalar),
            (Type::Scalar(_), _) => return Err(format!("{} takes one argument", self.said(ty))),
            (Type::Vector(..), [Type::Scalar(_)]) => return Ok(Constructor::Splat),
            (Type::Matrix { .. }, [Type::Scalar(_)]) => return Ok(Constructor::Diagonal),
            (Type::Matrix { .. }, [Type::Matrix { .. }]) => return Ok(Constructor::Resize),
            (Type::Matrix { .. }, several) if several.iter().any(|ty| matches!(ty, Type::Matrix { .. })) => {
                return Err("a matrix is made of one matrix, or of scalars and vectors".to_owned());
            }
            _ => {}
        }
        // Every argument must give at least one component.
        let mut have = 0;
        for &given in &types {
            if have >= usize::from(wanted) {
                return Err(format!(
                    "{} has {wanted} components and is given more",
                    self.said(ty)
                ));
            }
            have += given.component_count().map_or(0, usize::from);
        }
        if have < usize::from(wanted) {
            return Err(format!(
                "{} has {wanted} components and is given {have}",
                self.said(ty)
            ));
        }
        Ok(match ty.scalar() {
            Some(Scalar::Float) if matches!(ty, Type::Matrix { .. }) => Constructor::Matrix,
            _ => Constructor::Vector,
        })
    }
}
