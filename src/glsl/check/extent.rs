//! How large and how deep types are.

use super::Checker;
use crate::MAX_NESTING;
use crate::codes::Code;
use crate::tree::{Member, Place, Type};

/// How deep WebGL lets structures stand in structures.
const MAX_STRUCT_NESTING: usize = 4;

/// How many scalars WebGL lets a variable have: 16 MB.
const MAX_SCALARS: u64 = 1 << 22;

/// What is known of a type without looking into it again.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    pub(super) holds_sampler: bool,
    /// How many structures stand inside of each other, the type itself included.
    structs: usize,
    /// The same with arrays.
    depth: usize,
    scalars: u64,
}

impl Checker<'_> {
    /// Takes constant time for structures: theirs is noted when they are declared.
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

    /// The extent of a structure with those members, if they nest no deeper than they may.
    pub(super) fn struct_extent(&mut self, members: &[Member], at: Place) -> Extent {
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
        let limit = if self.lenient {
            MAX_NESTING
        } else {
            MAX_STRUCT_NESTING
        };
        if whole.structs > limit || whole.depth > MAX_NESTING {
            let message = format!("structures stand more than {limit} deep in each other here");
            self.error(Code::TooDeep, at, message);
            // Told once; the structures around this one are not to blame.
            return Extent {
                holds_sampler: whole.holds_sampler,
                ..Extent::default()
            };
        }
        whole
    }

    /// Whether a type is a sampler or has one in it: such values cannot be compared, chosen or assigned (§4.1.7).
    pub(super) fn holds_sampler(&self, ty: Type) -> bool {
        self.extent(ty).holds_sampler
    }

    /// The type, if a variable can be that large.
    pub(super) fn bounded(&mut self, ty: Type, at: Place) -> Type {
        if self.extent(ty).scalars <= MAX_SCALARS {
            return ty;
        }
        let message = format!("{} is larger than WebGL takes: 16 MB", self.said(ty));
        self.error(Code::BadArraySize, at, message);
        Type::Error
    }

    /// Whether an array of that many dimensions can have such elements.
    pub(super) fn may_have_dimensions(&mut self, element: Type, dimensions: usize, at: Place) -> bool {
        let fits = self.extent(element).depth + dimensions <= MAX_NESTING;
        if !fits {
            self.error(Code::TooDeep, at, "this array has too many dimensions");
        }
        fits
    }
}
