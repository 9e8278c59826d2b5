//! What everything is called: as the author called it, wherever naga takes that.
//!
//! naga knows one scope for types and looks for a type first, whatever the name stands for (`ray ray;`); words that are
//! free in ES 3.00 are keywords in 450 (`sample`, `buffer`); what lowering moved may meet another of its name.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{BuiltInVariable, ExprKind, FunctionId, Item, StructId, Type, VariableId, walk};

use super::order::Order;
use super::word;
use crate::lower::Draft;

/// The members of the uniform block, in order, with their types in it.
pub(super) const BLOCK: [(&str, &str); 10] = [
    ("vec3", "iResolution"),
    ("float", "iTime"),
    ("float", "iTimeDelta"),
    ("int", "iFrame"),
    ("float", "iFrameRate"),
    ("vec4[4]", "iChannelTime"),
    ("vec3[4]", "iChannelResolution"),
    ("vec4", "iMouse"),
    ("vec4", "iDate"),
    ("float", "iSampleRate"),
];

/// What the shader's output, its colour in `main` and its block are called. naga takes a name for a type wherever there is such a type.
const SURROUNDINGS: [&str; 3] = ["toyproof_colour", "toyproof_painted", "ToyproofFrame"];

/// How names begin that lowering gives.
const OWN: &str = "toyproof_";

/// Whether naga knows that variable under its own name.
pub(super) fn is_known(variable: BuiltInVariable) -> bool {
    variable == BuiltInVariable::FragCoord
}

/// The names of a draft's things.
#[derive(Default)]
pub(super) struct Names {
    pub(super) variables: HashMap<VariableId, String>,
    pub(super) functions: HashMap<FunctionId, String>,
    pub(super) structs: HashMap<StructId, String>,
    pub(super) members: HashMap<(StructId, usize), String>,
}

impl Names {
    pub(super) fn of(draft: &Draft, order: &Order) -> Self {
        let mut names = Self::default();
        let mut types = HashSet::new();
        // What stands at global scope, and cannot be called twice.
        let mut taken: HashSet<String> = BLOCK.iter().map(|&(_, name)| name.to_owned()).collect();
        for channel in 0..4 {
            taken.extend([format!("iChannel{channel}"), format!("iChannel{channel}_sampler")]);
        }
        taken.extend(SURROUNDINGS.map(str::to_owned));
        let mut surroundings = taken.clone();
        for &input in &order.inputs {
            names.variables.insert(input, draft.tree[input].name.clone());
        }
        let tree = &draft.tree;
        let mut numbering = Numbering::default();
        for item in &order.items {
            if let Item::Struct(id) = *item {
                let name = if tree[id].name.is_empty() {
                    "Struct"
                } else {
                    &tree[id].name
                };
                let is_taken = |name: &str| word::is_reserved(name) || taken.contains(name);
                let name = numbering.free(&word::mended(name), is_taken);
                types.insert(name.clone());
                taken.insert(name.clone());
                names.structs.insert(id, name);
                names.name_members(draft, id);
            }
        }
        let mut authors: HashMap<&str, usize> = HashMap::new();
        for (_, variable) in tree.variables.iter() {
            *authors.entry(variable.name.as_str()).or_default() += 1;
        }
        for item in &order.items {
            if let Item::Variable(id) = *item {
                // What was moved out of a function meets every local that it is used among.
                let moved = draft.moved.contains(&id);
                let own = tree[id].name.as_str();
                let name = numbering.free(&word::mended(own), |name| {
                    word::is_reserved(name)
                        || word::is_function(name)
                        || taken.contains(name)
                        || (moved && name != own && authors.contains_key(name))
                        || (moved && name == own && authors.get(name).is_some_and(|&count| count > 1))
                });
                taken.insert(name.clone());
                names.variables.insert(id, name);
            }
        }
        names.name_functions(draft, order, &taken);
        let own = names.functions.values().filter(|name| name.starts_with(OWN));
        surroundings.extend(own.cloned());
        for item in &order.items {
            if let Item::Function(id) = *item {
                names.name_locals(draft, id, &types, &surroundings);
            }
        }
        names
    }

    fn name_members(&mut self, draft: &Draft, id: StructId) {
        let mut taken = HashSet::new();
        for (at, member) in draft.tree[id].members.iter().enumerate() {
            let name = free(&member.name, |name| {
                word::is_reserved(name) || taken.contains(name)
            });
            taken.insert(name.clone());
            self.members.insert((id, at), name);
        }
    }

    /// Overloads keep one name, unless lowering took away what told them apart, or naga does not see it.
    fn name_functions(&mut self, draft: &Draft, order: &Order, taken: &HashSet<String>) {
        let alike = self.structs_alike(draft, order);
        let mut defined: HashSet<(String, Vec<Type>)> = HashSet::new();
        for item in &order.items {
            let Item::Function(id) = *item else {
                continue;
            };
            let types: Vec<Type> = draft.tree[id]
                .parameters
                .iter()
                .map(|&id| match draft.tree[id].ty {
                    Type::Struct(id) => Type::Struct(alike[&id]),
                    ty => ty,
                })
                .collect();
            let name = free(&draft.tree[id].name, |name| {
                word::is_reserved(name)
                    || word::is_function(name)
                    || taken.contains(name)
                    || defined.contains(&(name.to_owned(), types.clone()))
            });
            defined.insert((name.clone(), types));
            self.functions.insert(id, name);
        }
    }

    /// For each structure the first with the same members: naga cannot tell overloads by their names.
    fn structs_alike(&self, draft: &Draft, order: &Order) -> HashMap<StructId, StructId> {
        let mut firsts = HashMap::new();
        let mut alike = HashMap::new();
        for item in &order.items {
            let Item::Struct(id) = *item else {
                continue;
            };
            let members: Vec<(&str, Type)> = draft.tree[id]
                .members
                .iter()
                .enumerate()
                .map(|(at, member)| (self.members[&(id, at)].as_str(), member.ty))
                .collect();
            alike.insert(id, *firsts.entry(members).or_insert(id));
        }
        alike
    }

    /// No local may hide what lowering or the printer says within its scope: `surroundings`.
    fn name_locals(
        &mut self,
        draft: &Draft,
        function: FunctionId,
        types: &HashSet<String>,
        surroundings: &HashSet<String>,
    ) {
        let tree = &draft.tree;
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
            word::is_reserved(name)
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
            let meets = draft.moved.contains(&id) && counts.get(own).is_some_and(|&count| count > 1);
            let name = if own.is_empty() || meets || clashes(own) {
                let stem = if own.is_empty() {
                    "unused".to_owned()
                } else {
                    word::mended(own)
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

/// Numbers names that are taken. It counts on for each: thousands of temporaries share one, and what was taken once is not free
/// later.
#[derive(Debug, Default)]
pub(crate) struct Numbering(HashMap<String, usize>);

impl Numbering {
    /// The name itself, or the first free one that is made of it.
    pub(crate) fn free(&mut self, name: &str, is_taken: impl Fn(&str) -> bool) -> String {
        if is_taken(name) {
            self.next(name, is_taken)
        } else {
            name.to_owned()
        }
    }

    /// The next free name that is made of it.
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

/// The name itself, or the first free one that is made of it.
fn free(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let name = &word::mended(name);
    let numbered = (1_usize..).map(|number| format!("{name}_{number}"));
    std::iter::once(name.to_owned())
        .chain(numbered)
        .find(|name| !is_taken(name))
        .unwrap_or_default()
}
