//! Names of all items: the author's names wherever naga accepts them.
//!
//! naga has one scope for types and looks for a type first, whatever the name denotes (`ray ray;`);
//! identifiers of ES 3.00 are keywords in 450 (`sample`, `buffer`); and declarations moved by lowering may
//! clash with others of the same name.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{ExprKind, FunctionId, Input, Item, StructId, Type, VariableId, walk};

use super::order::Order;
use crate::lower::context::LoweringContext;
use crate::print::{UNIFORM_BLOCK, keyword};

/// The names of the shader's output, of its color in `main` and of its blocks. naga treats a name as a type
/// wherever a type of that name exists.
const GENERATED_NAMES: [&str; 4] = [
    "toyproof_color",
    "toyproof_image_color",
    "ToyproofFrame",
    UNIFORM_BLOCK,
];

/// The prefix of generated names.
const GENERATED_PREFIX: &str = "toyproof_";

/// The names of a shader's items.
#[derive(Default)]
pub(super) struct Names {
    pub(super) variables: HashMap<VariableId, String>,
    pub(super) functions: HashMap<FunctionId, String>,
    pub(super) structs: HashMap<StructId, String>,
    pub(super) members: HashMap<(StructId, usize), String>,
}

impl Names {
    pub(super) fn new(cx: &LoweringContext, order: &Order) -> Self {
        let mut names = Self::default();
        let mut types = HashSet::new();
        // Names at global scope, which must be unique.
        let mut taken: HashSet<String> = Input::ALL.iter().map(|input| input.name().to_owned()).collect();
        for channel in 0..4 {
            taken.extend([format!("iChannel{channel}"), format!("iChannel{channel}_sampler")]);
        }
        taken.extend(GENERATED_NAMES.map(str::to_owned));
        let mut surroundings = taken.clone();
        for &input in &order.inputs {
            names.variables.insert(input, cx.tree[input].name.clone());
        }
        let tree = &cx.tree;
        let mut numbering = Numbering::default();
        for item in &order.items {
            if let Item::Struct(id) = *item {
                let name = if tree[id].name.is_empty() {
                    "Struct"
                } else {
                    &tree[id].name
                };
                let is_taken = |name: &str| keyword::is_reserved(name) || taken.contains(name);
                let name = numbering.free(&keyword::with_free_stem(name), is_taken);
                types.insert(name.clone());
                taken.insert(name.clone());
                names.structs.insert(id, name);
                names.name_members(cx, id);
            }
        }
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for (_, variable) in tree.variables.iter() {
            *counts.entry(variable.name.as_str()).or_default() += 1;
        }
        for item in &order.items {
            if let Item::Variable(id) = *item {
                // A variable moved out of a function may clash with any local.
                let moved = cx.moved.contains(&id);
                let own = tree[id].name.as_str();
                let name = numbering.free(&keyword::with_free_stem(own), |name| {
                    keyword::is_reserved(name)
                        || keyword::is_function(name)
                        || taken.contains(name)
                        || (moved && name != own && counts.contains_key(name))
                        || (moved && name == own && counts.get(name).is_some_and(|&count| count > 1))
                });
                taken.insert(name.clone());
                names.variables.insert(id, name);
            }
        }
        names.name_functions(cx, order, &taken);
        let own = names
            .functions
            .values()
            .filter(|name| name.starts_with(GENERATED_PREFIX));
        surroundings.extend(own.cloned());
        for item in &order.items {
            if let Item::Function(id) = *item {
                names.name_locals(cx, id, &types, &surroundings);
            }
        }
        names
    }

    fn name_members(&mut self, cx: &LoweringContext, id: StructId) {
        let mut taken = HashSet::new();
        for (at, member) in cx.tree[id].members.iter().enumerate() {
            let name = free(&member.name, |name| {
                keyword::is_reserved(name) || taken.contains(name)
            });
            taken.insert(name.clone());
            self.members.insert((id, at), name);
        }
    }

    /// Overloads share a name unless lowering or naga makes their parameters equal.
    fn name_functions(&mut self, cx: &LoweringContext, order: &Order, taken: &HashSet<String>) {
        let firsts = self.equal_structs(cx, order);
        let mut defined: HashSet<(String, Vec<Type>)> = HashSet::new();
        for item in &order.items {
            let Item::Function(id) = *item else {
                continue;
            };
            let types: Vec<Type> = cx.tree[id]
                .parameters
                .iter()
                .map(|&id| match cx.tree[id].ty {
                    Type::Struct(id) => Type::Struct(firsts[&id]),
                    ty => ty,
                })
                .collect();
            let name = free(&cx.tree[id].name, |name| {
                keyword::is_reserved(name)
                    || keyword::is_function(name)
                    || taken.contains(name)
                    || defined.contains(&(name.to_owned(), types.clone()))
            });
            defined.insert((name.clone(), types));
            self.functions.insert(id, name);
        }
    }

    /// Maps each structure to the first with the same members: naga does not distinguish overloads by
    /// structure names.
    fn equal_structs(&self, cx: &LoweringContext, order: &Order) -> HashMap<StructId, StructId> {
        let mut by_members = HashMap::new();
        let mut firsts = HashMap::new();
        for item in &order.items {
            let Item::Struct(id) = *item else {
                continue;
            };
            let members: Vec<(&str, Type)> = cx.tree[id]
                .members
                .iter()
                .enumerate()
                .map(|(at, member)| (self.members[&(id, at)].as_str(), member.ty))
                .collect();
            firsts.insert(id, *by_members.entry(members).or_insert(id));
        }
        firsts
    }

    /// Names locals so that none shadows a name in `surroundings`, which lowering or the printer uses in its
    /// scope.
    fn name_locals(
        &mut self,
        cx: &LoweringContext,
        function: FunctionId,
        types: &HashSet<String>,
        surroundings: &HashSet<String>,
    ) {
        let tree = &cx.tree;
        let mut locals = tree[function].parameters.clone();
        let mut globals = HashSet::new();
        if let Some(body) = &tree[function].body {
            walk::each(body, &mut |statement| locals.extend(walk::declared(statement)));
            for id in walk::roots(tree, body)
                .into_iter()
                .flat_map(|root| tree.postorder(root))
            {
                if let ExprKind::Variable(variable) = tree[id].kind {
                    globals.extend(self.variables.get(&variable).cloned());
                }
            }
        }
        let clashes = |name: &str| {
            keyword::is_reserved(name)
                || types.contains(name)
                || globals.contains(name)
                || surroundings.contains(name)
        };
        let mut taken: HashSet<String> = locals.iter().map(|&id| tree[id].name.clone()).collect();
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for &id in &locals {
            *counts.entry(tree[id].name.as_str()).or_default() += 1;
        }
        let mut numbering = Numbering::default();
        for &id in &locals {
            let own = tree[id].name.as_str();
            let is_ambiguous = cx.moved.contains(&id) && counts.get(own).is_some_and(|&count| count > 1);
            let name = if own.is_empty() || is_ambiguous || clashes(own) {
                let stem = if own.is_empty() {
                    "unused".to_owned()
                } else {
                    keyword::with_free_stem(own)
                };
                numbering.next(&stem, |name| clashes(name) || taken.contains(name))
            } else {
                own.to_owned()
            };
            taken.insert(name.clone());
            self.variables.insert(id, name);
        }
    }
}

/// Appends numbers to names that are taken. Counters never restart: thousands of temporaries share a stem,
/// and a name once taken is never free again.
#[derive(Debug, Default)]
pub(crate) struct Numbering(HashMap<String, usize>);

impl Numbering {
    /// The name itself if it is free, or the next numbered one.
    pub(crate) fn free(&mut self, name: &str, is_taken: impl Fn(&str) -> bool) -> String {
        if is_taken(name) {
            self.next(name, is_taken)
        } else {
            name.to_owned()
        }
    }

    /// The next free numbered name.
    fn next(&mut self, name: &str, is_taken: impl Fn(&str) -> bool) -> String {
        let counter = self.0.entry(name.to_owned()).or_default();
        loop {
            *counter += 1;
            let numbered = format!("{name}_{counter}");
            if !is_taken(&numbered) {
                return numbered;
            }
        }
    }
}

/// The name itself if it is free, or the first numbered one.
fn free(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let name = &keyword::with_free_stem(name);
    let numbered = (1_usize..).map(|number| format!("{name}_{number}"));
    std::iter::once(name.to_owned())
        .chain(numbered)
        .find(|name| !is_taken(name))
        .unwrap_or_default()
}
