//! Completions behind a `.`: members of structures, and components of vectors.

use lsp_types::CompletionItemKind;
use toyproof_glsl::Resolution;
use toyproof_glsl::tree::Type;

use super::{Completer, Item, Rank};
use crate::{describe, scope};

/// The sets of names of components; a swizzle has names of one set only.
const SETS: [&str; 3] = ["xyzw", "rgba", "stpq"];

/// Swizzles of several components that are common, for vectors of 2, 3 and 4 components.
const COMMON: [&[&str]; 3] = [
    &["xy", "yx"],
    &["xyz", "rgb", "xy", "xz", "yz", "yzx", "zxy"],
    &["xyzw", "rgba", "xyz", "rgb", "xy", "zw"],
];

impl Completer<'_> {
    /// Completes behind the `.` that is the last token in front of the word.
    pub(super) fn complete_member(&mut self) {
        let Some(end) = self.before.checked_sub(2) else {
            return;
        };
        match scope::operand_type(self.snapshot, &self.tokens, end, self.at) {
            Some(Type::Struct(structure)) => {
                let tree = self.snapshot.tree();
                for (index, member) in tree[structure].members.iter().enumerate() {
                    let mut item = Item::new(&member.name, CompletionItemKind::Field, Rank::Local);
                    item.detail = Some(tree.type_name(member.ty));
                    let resolution = Resolution::Member(structure, index);
                    item.documentation =
                        describe::documentation(self.snapshot, resolution, &mut self.comments);
                    self.add(item);
                }
            }
            Some(ty @ Type::Vector(_, size)) => self.complete_swizzle(ty, size),
            Some(Type::Array(array)) => {
                let size = self.snapshot.tree().array(array).size;
                let mut item = Item::new("length()", CompletionItemKind::Method, Rank::Local);
                item.detail = Some("int".to_owned());
                item.documentation = Some(format!("The number of elements: {size}."));
                self.add(item);
            }
            _ => {}
        }
    }

    fn complete_swizzle(&mut self, ty: Type, size: u8) {
        let count = usize::from(size);
        let sets = SETS.map(|set| &set[..count]);
        let mut offered: Vec<(String, Rank)> = Vec::new();
        let mut offer = |swizzle: String, rank| {
            if offered.iter().all(|(other, _)| *other != swizzle) {
                offered.push((swizzle, rank));
            }
        };
        for (set, rank) in sets.into_iter().zip([Rank::Local, Rank::Global, Rank::BuiltIn]) {
            for component in set.chars() {
                offer(component.to_string(), rank);
            }
        }
        for swizzle in COMMON.get(count - 2).copied().unwrap_or_default() {
            offer((*swizzle).to_owned(), Rank::Parameter);
        }
        // What is written, and with one more component.
        let set = sets
            .into_iter()
            .find(|set| self.prefix.chars().all(|c| set.contains(c)));
        if let Some(set) = set.filter(|_| (1..=4).contains(&self.prefix.len())) {
            offer(self.prefix.to_owned(), Rank::Parameter);
            for component in set.chars().filter(|_| self.prefix.len() < 4) {
                offer(format!("{}{component}", self.prefix), Rank::Function);
            }
        }
        self.is_incomplete = true;
        let scalar = ty.scalar();
        for (swizzle, rank) in offered {
            let components = swizzle.len() as u8;
            let mut item = Item::new(swizzle, CompletionItemKind::Field, rank);
            item.detail =
                scalar.map(|scalar| self.snapshot.tree().type_name(Type::vector(scalar, components)));
            self.add(item);
        }
    }
}
