//! What everything is called: as the author called it, unless WGSL has another use for the word. WGSL has no overloads:
//! of several functions with one name all but the first are also called by the types of their parameters.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{ExprKind, FunctionId, Item, StructId, Type, VariableId, walk};

use super::style::Style;
use super::word;
use super::writer::type_name;
use crate::lower::Draft;
use crate::print::{Numbering, Order};

/// The names of a draft's things.
#[derive(Default)]
pub(super) struct Names {
    pub(super) variables: HashMap<VariableId, String>,
    /// What a parameter is called that its function works on in a copy.
    pub(super) arguments: HashMap<VariableId, String>,
    pub(super) functions: HashMap<FunctionId, String>,
    pub(super) structs: HashMap<StructId, String>,
    pub(super) members: HashMap<(StructId, usize), String>,
    /// Every word that is in use somewhere.
    pub(super) all: HashSet<String>,
}

impl Names {
    pub(super) fn of(draft: &Draft, order: &Order, style: Style) -> Self {
        let tree = &draft.tree;
        let mut names = Self::default();
        let mut taken: HashSet<String> = style.words().map(str::to_owned).collect();
        let mut numbering = Numbering::default();
        let taken_at = |taken: &HashSet<String>, name: &str| word::is_taken(name) || taken.contains(name);
        for item in &order.items {
            if let Item::Struct(id) = *item {
                let own = if tree[id].name.is_empty() {
                    "Struct"
                } else {
                    &tree[id].name
                };
                let name = numbering.free(word::stem(own), |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.structs.insert(id, name);
                let mut members = HashSet::new();
                for (at, member) in tree[id].members.iter().enumerate() {
                    let is_taken = |name: &str| word::is_reserved(name) || members.contains(name);
                    let name = word::free(&member.name, is_taken);
                    members.insert(name.clone());
                    names.members.insert((id, at), name);
                }
            }
        }
        for item in &order.items {
            if let Item::Variable(id) = *item {
                let stem = word::stem(&tree[id].name);
                let name = numbering.free(stem, |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.variables.insert(id, name);
            }
        }
        for item in &order.items {
            if let Item::Function(id) = *item {
                let own = author_s(&tree[id].name);
                let name = if taken_at(&taken, own) && !word::is_taken(own) {
                    let types = tree[id]
                        .parameters
                        .iter()
                        .map(|&parameter| label(draft, &names, tree[parameter].ty));
                    format!("{own}_{}", types.collect::<Vec<_>>().join("_"))
                } else {
                    own.to_owned()
                };
                let name = numbering.free(word::stem(&name), |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.functions.insert(id, name);
            }
        }
        names.all.clone_from(&taken);
        for item in &order.items {
            if let Item::Function(id) = *item {
                names.name_locals(draft, id, &taken);
            }
        }
        names
    }

    /// Locals may hide what stands outside, as in GLSL, but nothing that is printed by another name than the author's.
    fn name_locals(&mut self, draft: &Draft, function: FunctionId, global: &HashSet<String>) {
        let tree = &draft.tree;
        let mut locals = tree[function].parameters.clone();
        if let Some(body) = &tree[function].body {
            walk::each(body, &mut |statement| locals.extend(walk::declared(statement)));
        }
        let theirs: HashSet<&str> = locals.iter().map(|&id| &*tree[id].name).collect();
        let own = |id: VariableId| {
            let name = &*tree[id].name;
            let short = author_s(name);
            if theirs.contains(short) { name } else { short }
        };
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for &id in &locals {
            *counts.entry(own(id)).or_default() += 1;
        }
        let mut taken: HashSet<String> = counts.keys().map(|&name| name.to_owned()).collect();
        let called = called(draft, function);
        let mut numbering = Numbering::default();
        for &id in &locals {
            let own = own(id);
            let meets = draft.moved.contains(&id) && counts.get(own).is_some_and(|&count| count > 1);
            let clashes = word::is_taken(own) && (!word::may_be_hidden(own) || called.contains(own));
            let name = if own.is_empty() || meets || clashes || global.contains(own) {
                numbering.free(word::stem(own), |name| {
                    word::is_taken(name) || global.contains(name) || taken.contains(name)
                })
            } else {
                own.to_owned()
            };
            taken.insert(name.clone());
            self.variables.insert(id, name);
        }
        for &id in &tree[function].parameters {
            let name = self.variables[&id].clone() + "_in";
            let name = numbering.free(word::stem(&name), |name| {
                word::is_taken(name) || global.contains(name) || taken.contains(name)
            });
            taken.insert(name.clone());
            self.arguments.insert(id, name);
        }
        self.all.extend(taken);
    }
}

/// A name without the prefix that keeps lowering's own apart from the author's: here nothing else is called so.
fn author_s(name: &str) -> &str {
    name.strip_prefix("toyproof_").unwrap_or(name)
}

/// The built-in functions that a function calls.
fn called(draft: &Draft, function: FunctionId) -> HashSet<&'static str> {
    let tree = &draft.tree;
    let roots = tree[function]
        .body
        .iter()
        .flat_map(|body| walk::roots(tree, body));
    roots
        .flat_map(|root| tree.postorder(root))
        .filter_map(|id| match tree[id].kind {
            ExprKind::BuiltIn { function, .. } => Some(function.name()),
            _ => None,
        })
        .collect()
}

/// A type as part of a name.
fn label(draft: &Draft, names: &Names, ty: Type) -> String {
    let name = type_name(draft, names, ty);
    let parts = name.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    parts
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("_")
}
