//! Parts of variables: components and members as bits, so that `v.x = 1.0;` leaves `v.y` uninitialized.

use std::collections::HashMap;

use toyproof_glsl::tree::{ExprId, ExprKind, StructId, Tree, Type, VariableId};

/// A set of parts of one variable. All elements of an array share the same bits; a type with more than 64
/// parts has a single bit.
pub(super) type Parts = u64;

/// An access to the parts that an lvalue names.
#[derive(Debug, Clone)]
pub(super) struct Access {
    pub(super) variable: VariableId,
    pub(super) parts: Parts,
    /// Whether only one of the parts is accessed, which a dynamic index selects.
    pub(super) is_one_of_parts: bool,
}

/// The number of parts of each type.
pub(super) struct Layout<'a> {
    tree: &'a Tree,
    structs: HashMap<StructId, u32>,
}

impl<'a> Layout<'a> {
    pub(super) fn new(tree: &'a Tree) -> Self {
        // Members have types declared earlier, so one pass over the arena suffices at any nesting.
        let mut layout = Self {
            tree,
            structs: HashMap::new(),
        };
        for id in tree.structs.ids() {
            let count: u32 = tree[id]
                .members
                .iter()
                .map(|member| layout.count(member.ty))
                .sum();
            layout
                .structs
                .insert(id, if count > Parts::BITS { 1 } else { count });
        }
        layout
    }

    fn count(&self, mut ty: Type) -> u32 {
        while let Type::Array(id) = ty {
            ty = self.tree.array(id).element;
        }
        match ty {
            Type::Struct(id) => self.structs.get(&id).copied().unwrap_or(1),
            ty => u32::from(ty.component_count().unwrap_or(1)),
        }
    }

    pub(super) fn whole(&self, ty: Type) -> Parts {
        Parts::MAX >> (Parts::BITS - self.count(ty))
    }

    /// The access to a variable or a part of one; `None` for other expressions.
    pub(super) fn access(&self, expr: ExprId) -> Option<Access> {
        let tree = self.tree;
        let mut chain: Vec<_> = tree.path(expr).collect();
        let ExprKind::Variable(variable) = tree[chain.pop()?].kind else {
            return None;
        };
        let mut ty = tree[variable].ty;
        let mut bits: Vec<u32> = (0..self.count(ty)).collect();
        let mut is_one_of_parts = false;
        // From the variable outward.
        for &selection in chain.iter().rev() {
            match &tree[selection].kind {
                // A single bit represents the whole variable.
                _ if bits.len() == 1 => {}
                ExprKind::Swizzle { components, .. } => {
                    bits = components
                        .components()
                        .iter()
                        .map(|&c| bits[usize::from(c)])
                        .collect();
                }
                ExprKind::Member { member, .. } => {
                    if let Type::Struct(id) = ty {
                        let counts = tree[id]
                            .members
                            .iter()
                            .map(|member| self.count(member.ty) as usize);
                        let start: usize = counts.clone().take(*member).sum();
                        let count = counts.clone().nth(*member).unwrap_or(0);
                        bits = bits[start..start + count].to_vec();
                    }
                }
                ExprKind::Index { index, .. } => {
                    let size = match ty {
                        Type::Vector(..) => 1,
                        Type::Matrix { rows, .. } => usize::from(rows),
                        // The elements of an array share their bits, so an index selects nothing.
                        _ => 0,
                    };
                    let constant = tree.value(*index).and_then(|index| index.integer());
                    match constant.and_then(|index| usize::try_from(index).ok()) {
                        Some(index) if size > 0 => {
                            bits = bits.iter().copied().skip(index * size).take(size).collect();
                        }
                        _ => is_one_of_parts |= size > 0,
                    }
                }
                _ => {}
            }
            ty = tree[selection].ty;
        }
        let parts = bits.iter().fold(0, |parts, bit| parts | 1 << bit);
        Some(Access {
            variable,
            parts,
            is_one_of_parts,
        })
    }

    /// The name of these parts in source code: `v.yz`, `hit.normal`.
    pub(super) fn name(&self, variable: VariableId, parts: Parts) -> String {
        let tree = self.tree;
        let name = &tree[variable].name;
        let ty = tree[variable].ty;
        if parts & self.whole(ty) == self.whole(ty) {
            return name.clone();
        }
        match ty {
            Type::Vector(..) => {
                let letters = "xyzw".chars().enumerate().filter(|(at, _)| parts >> at & 1 == 1);
                format!("{name}.{}", letters.map(|(_, letter)| letter).collect::<String>())
            }
            Type::Struct(id) if self.count(ty) > 1 => {
                let mut start = 0;
                let touched = tree[id].members.iter().find(|member| {
                    let own = self.whole(member.ty) << start;
                    start += self.count(member.ty);
                    own & parts != 0
                });
                touched.map_or_else(|| name.clone(), |member| format!("{name}.{}", member.name))
            }
            _ => name.clone(),
        }
    }
}
