//! Types in declarations: arrays, structures, and their limits (§4.1).

use std::collections::HashMap;

use toyproof_diagnostic::{Code, grouped};

use super::Checker;
use super::scope::Entity;
use crate::MAX_NESTING;
use crate::analysis::Resolution;
use crate::token::Symbol;
use crate::tree::{ExprId, ExprKind, Member, Place, Struct, StructId, Type, VariableKind};

/// Maximum number of elements of an array in WebGL.
const MAX_ARRAY_SIZE: i64 = 65_536;

/// The size of one dimension of an array.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Size {
    /// `[n]`.
    Of(u32),
    /// `[]`: taken from the initializer.
    Inferred(Place),
    /// A size whose error has been reported.
    Broken,
}

/// A type specifier: `float`, `vec3[2]`.
#[derive(Debug, Clone)]
pub(crate) struct Specifier {
    pub(crate) base: Type,
    /// The sizes that follow it, outermost first.
    pub(crate) sizes: Vec<Size>,
    pub(crate) at: Place,
}

/// The members of a structure parsed so far.
#[derive(Default)]
pub(crate) struct Members {
    pub(crate) all: Vec<Member>,
    /// The first place of each name.
    places: HashMap<Symbol, Place>,
}

impl Checker<'_> {
    /// Checks `[expr]`: a constant integral expression of at least 1 (§4.1.9).
    pub(crate) fn array_size(&mut self, expr: ExprId) -> Size {
        let (ty, at) = (self.ty(expr), self.tree[expr].at);
        if ty == Type::Error {
            return Size::Broken;
        }
        let problem = if !matches!(ty, Type::INT | Type::UINT) {
            format!(
                "the array size must be `int` or `uint`, not {}",
                self.quoted_type(ty)
            )
        } else if !self.tree[expr].constant {
            "the array size must be a constant expression".to_owned()
        } else {
            match self.integer(expr) {
                Some(size @ 1..=MAX_ARRAY_SIZE) => return Size::Of(size as u32),
                Some(size @ ..=0) => format!("the array size must be at least 1, not {size}"),
                Some(size) => {
                    let [size, limit] = [size, MAX_ARRAY_SIZE].map(|count| grouped(count.unsigned_abs()));
                    format!("array too large: {size} elements, the limit of WebGL is {limit}")
                }
                None => "the array size cannot be evaluated".to_owned(),
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
            diagnostic = diagnostic.help(format!("make `{name}` a constant: `const {ty} {name} = …;`"));
        }
        self.report(diagnostic);
        Size::Broken
    }

    /// The array type of the given sizes, outermost first. `given` is the type of the initializer, which
    /// determines the sizes that are omitted.
    pub(super) fn array_type(&mut self, base: Type, sizes: &[Size], given: Option<Type>, at: Place) -> Type {
        if sizes.len() > 1 && !self.language.has_arrays_of_arrays() {
            self.error(
                Code::ArrayOfArrays,
                at,
                format!(
                    "arrays of arrays are not supported in {}",
                    self.language.version.name()
                ),
            );
            return Type::Error;
        }
        if !sizes.is_empty() && base == Type::Void {
            self.error(Code::BadType, at, "an array cannot have elements of type `void`");
            return Type::Error;
        }
        if !self.check_dimensions(base, sizes.len(), at) {
            return Type::Error;
        }
        // The initializer's size in each dimension.
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
                    self.error(Code::BadArraySize, at, "missing array size");
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

    /// The type of a specifier whose sizes must all be given.
    pub(super) fn complete_type(&mut self, specifier: &Specifier) -> Type {
        self.array_type(specifier.base, &specifier.sizes, None, specifier.at)
    }

    /// Declares `struct name { members }` (§4.1.8). The name is declared after the members are parsed: a
    /// structure cannot contain itself.
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
        if let Some(name) = name {
            self.declared(at, Resolution::Struct(id));
            for index in 0..self.tree[id].members.len() {
                self.declared(self.tree[id].members[index].at, Resolution::Member(id, index));
            }
            if self.check_declarable(name, at) {
                self.scopes.declare(name, Entity::Struct(id));
                self.visible_after(at.span.end, Resolution::Struct(id));
            }
        }
        id
    }

    /// Records that some members of the structure could not be parsed.
    pub(crate) fn mark_incomplete(&mut self, id: StructId) {
        self.incomplete.push(id);
    }

    /// Adds one declarator of a member list.
    pub(crate) fn member(
        &mut self,
        members: &mut Members,
        specifier: &Specifier,
        name: Symbol,
        sizes: &[Size],
        at: Place,
    ) {
        let text = self.text(name);
        self.check_reserved_name(text, at);
        let all: Vec<_> = sizes.iter().chain(&specifier.sizes).copied().collect();
        let ty = self.array_type(specifier.base, &all, None, at);
        if ty == Type::Void {
            self.error(Code::BadType, at, "a structure member cannot be `void`");
            return;
        }
        if let Some(first) = members.places.get(&name) {
            let diagnostic = Code::Redeclared
                .at(at, format!("duplicate member `{text}`"))
                .related(first.span, "previously declared here");
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

// Limits on the size and nesting of types.

/// Maximum nesting depth of structures in WebGL.
const MAX_STRUCT_NESTING: usize = 4;

/// Maximum number of scalars of a variable in WebGL: 16 MB.
const MAX_SCALARS: u64 = 1 << 22;

/// The cached size and nesting of a type.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    pub(super) holds_sampler: bool,
    /// Nesting depth of structures, including the type itself.
    structs: usize,
    /// Nesting depth of structures and arrays.
    depth: usize,
    scalars: u64,
}

impl Checker<'_> {
    /// The extent of a type. Takes constant time for structures, whose extent is stored at their declaration.
    pub(super) fn extent(&self, ty: Type) -> Extent {
        match ty {
            Type::Array(id) => {
                let array = self.tree.array(id);
                let element = self.extent(array.element);
                Extent {
                    depth: element.depth + 1,
                    scalars: element.scalars.saturating_mul(u64::from(array.size)),
                    ..element
                }
            }
            Type::Struct(id) => self.struct_extents[id.index()],
            _ => Extent {
                holds_sampler: matches!(ty, Type::Sampler(_)),
                scalars: u64::from(ty.component_count().unwrap_or(1)),
                ..Extent::default()
            },
        }
    }

    /// The extent of a structure with the given members; reports an error if it nests too deep.
    fn struct_extent(&mut self, members: &[Member], at: Place) -> Extent {
        let mut whole = Extent::default();
        for member in members {
            let extent = self.extent(member.ty);
            whole.holds_sampler |= extent.holds_sampler;
            whole.structs = whole.structs.max(extent.structs);
            whole.depth = whole.depth.max(extent.depth);
            whole.scalars = whole.scalars.saturating_add(extent.scalars);
        }
        whole.structs += 1;
        whole.depth += 1;
        let limit = if self.language.is_desktop() {
            MAX_NESTING
        } else {
            MAX_STRUCT_NESTING
        };
        if whole.structs > limit || whole.depth > MAX_NESTING {
            let message = format!("structures nested more than {limit} levels deep");
            self.error(Code::TooDeep, at, message);
            // Reported once: outer structures get an empty extent for this one.
            return Extent {
                holds_sampler: whole.holds_sampler,
                ..Extent::default()
            };
        }
        whole
    }

    /// Whether a type is or contains a sampler: such values cannot be compared, selected or assigned
    /// (§4.1.7).
    pub(super) fn holds_sampler(&self, ty: Type) -> bool {
        self.extent(ty).holds_sampler
    }

    /// Returns the type if a variable can be that large, otherwise reports an error.
    pub(super) fn check_size_limit(&mut self, ty: Type, at: Place) -> Type {
        if self.extent(ty).scalars <= MAX_SCALARS {
            return ty;
        }
        let message = format!(
            "{} exceeds 16 MB, the limit of WebGL for a variable",
            self.quoted_type(ty)
        );
        self.error(Code::BadArraySize, at, message);
        Type::Error
    }

    /// Checks that an array of such elements does not have too many dimensions.
    fn check_dimensions(&mut self, element: Type, dimensions: usize, at: Place) -> bool {
        let fits = self.extent(element).depth + dimensions <= MAX_NESTING;
        if !fits {
            self.error(Code::TooDeep, at, "too many array dimensions");
        }
        fits
    }
}
