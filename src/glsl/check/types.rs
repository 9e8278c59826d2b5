//! Types as declarations spell them: arrays, structures, and what may be where (§4.1).

use std::collections::HashMap;

use super::Checker;
use super::scope::Entity;
use crate::codes::Code;
use crate::token::Symbol;
use crate::tree::{ExprId, ExprKind, Member, Place, Struct, StructId, Type, VariableKind};

/// The largest array that WebGL takes.
const MAX_ARRAY_SIZE: i64 = 65_536;

/// The size of one dimension of an array.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Size {
    /// `[n]`.
    Of(u32),
    /// `[]`: what the initialiser has.
    Inferred(Place),
    /// One whose mistake has been told.
    Broken,
}

/// A type as it stands before names: `float`, `vec3[2]`.
#[derive(Debug, Clone)]
pub(crate) struct Specifier {
    pub(crate) base: Type,
    /// The sizes that follow it, the outermost first.
    pub(crate) sizes: Vec<Size>,
    pub(crate) at: Place,
}

/// The members of a structure, as far as they are read.
#[derive(Default)]
pub(crate) struct Members {
    pub(crate) all: Vec<Member>,
    /// Where each name stands first.
    places: HashMap<Symbol, Place>,
}

impl Checker<'_> {
    /// `[expr]`: a constant integral expression of at least 1 (§4.1.9).
    pub(crate) fn array_size(&mut self, expr: ExprId) -> Size {
        let (ty, at) = (self.ty(expr), self.tree[expr].at);
        if ty == Type::Error {
            return Size::Broken;
        }
        let problem = if !matches!(ty, Type::INT | Type::UINT) {
            format!(
                "the size of an array must be `int` or `uint`, and this is {}",
                self.said(ty)
            )
        } else if !self.tree[expr].constant {
            "the size of an array must be a constant expression".to_owned()
        } else {
            match self.integer(expr) {
                Some(size @ 1..=MAX_ARRAY_SIZE) => return Size::Of(size as u32),
                Some(size @ ..=0) => format!("an array cannot have {size} elements"),
                Some(size) => {
                    format!("an array of {size} elements is more than WebGL takes: {MAX_ARRAY_SIZE}")
                }
                None => "the size of this array cannot be told".to_owned(),
            }
        };
        let mut diagnostic = Code::BadArraySize.at(at, problem);
        if let ExprKind::Variable(variable) = self.tree[expr].kind
            && matches!(
                self.tree[variable].kind,
                VariableKind::Local | VariableKind::Global
            )
        {
            let (ty, name) = (self.tree.type_name(ty), &self.tree[variable].name);
            diagnostic = diagnostic.note(format!("`const {ty} {name} = …;` makes it one"));
        }
        self.report(diagnostic);
        Size::Broken
    }

    /// The array type of those sizes, the outermost first. `given` is what an initialiser has where a size is left open.
    pub(super) fn array_type(&mut self, base: Type, sizes: &[Size], given: Option<Type>, at: Place) -> Type {
        if sizes.len() > 1 && !self.lenient {
            self.error(Code::ArrayOfArrays, at, "GLSL ES 3.00 has no arrays of arrays");
            return Type::Error;
        }
        if !sizes.is_empty() && base == Type::Void {
            self.error(Code::BadType, at, "there are no arrays of `void`");
            return Type::Error;
        }
        if !self.may_have_dimensions(base, sizes.len(), at) {
            return Type::Error;
        }
        // What the initialiser has at each dimension.
        let mut inferred = Vec::new();
        let mut rest = given;
        for _ in sizes {
            let array = match rest {
                Some(Type::Array(id)) => Some(self.tree.array(id)),
                _ => None,
            };
            inferred.push(array.map(|array| array.size));
            rest = array.map(|array| array.element);
        }
        let mut ty = base;
        for (size, inferred) in sizes.iter().zip(inferred).rev() {
            let size = match (*size, inferred) {
                (Size::Of(size), _) | (Size::Inferred(_), Some(size)) => size,
                (Size::Inferred(_), None) if given == Some(Type::Error) => return Type::Error,
                (Size::Inferred(at), None) => {
                    self.error(Code::BadArraySize, at, "this array has no size");
                    return Type::Error;
                }
                (Size::Broken, _) => return Type::Error,
            };
            if ty != Type::Error {
                ty = self.tree.array_of(ty, size);
            }
        }
        ty
    }

    /// The type that a specifier spells, all of its sizes told.
    pub(super) fn complete_type(&mut self, specifier: &Specifier) -> Type {
        self.array_type(specifier.base, &specifier.sizes, None, specifier.at)
    }

    /// `struct name { members }` (§4.1.8). The name is declared once the members are read: a structure cannot hold itself.
    pub(crate) fn declare_struct(
        &mut self,
        name: Option<Symbol>,
        members: Vec<Member>,
        at: Place,
    ) -> StructId {
        let text = name.map_or("", |name| self.text(name));
        let extent = self.struct_extent(&members, at);
        let id = self.tree.structs.push(Struct {
            name: text.to_owned(),
            members,
            at,
        });
        self.struct_extents.push(extent);
        if let Some(name) = name
            && self.may_declare(name, at)
        {
            self.scopes.declare(name, Entity::Struct(id));
        }
        id
    }

    /// Some members of this structure could not be read.
    pub(crate) fn lacks_members(&mut self, id: StructId) {
        self.incomplete.push(id);
    }

    /// One declarator of a member list.
    pub(crate) fn member(
        &mut self,
        members: &mut Members,
        specifier: &Specifier,
        name: Symbol,
        sizes: &[Size],
        at: Place,
    ) {
        let text = self.text(name);
        self.may_name(text, at);
        let all: Vec<_> = sizes.iter().chain(&specifier.sizes).copied().collect();
        let ty = self.array_type(specifier.base, &all, None, at);
        if ty == Type::Void {
            self.error(Code::BadType, at, "a member cannot be `void`");
            return;
        }
        if let Some(first) = members.places.get(&name) {
            let diagnostic = Code::Redeclared
                .at(at, format!("this structure has two members `{text}`"))
                .related(first.span, "the first");
            self.report(diagnostic);
        } else {
            members.places.insert(name, at);
        }
        members.all.push(Member {
            name: text.to_owned(),
            ty,
            at,
        });
    }
}
