//! Names of all items: the author's names wherever the language accepts them.
//!
//! naga has one scope for types and looks for a type first, whatever the name denotes (`ray ray;`);
//! identifiers of ES 3.00 are keywords in 450 (`sample`, `buffer`); and declarations moved by lowering may
//! clash with others of the same name.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{ExprKind, FunctionId, Input, Item, StructId, Tree, Type, VariableId, walk};

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

/// The names that are not free in a language.
pub(crate) trait Vocabulary {
    /// Whether nothing may have the name.
    fn is_reserved(&self, word: &str) -> bool;
    /// Whether the name is a function's that code may call.
    fn is_function(&self, word: &str) -> bool;
    /// The names that the code around the shader declares.
    fn declared(&self) -> Vec<String>;
    /// Whether a declaration's own initializer is in the scope of its name, and functions share their names
    /// with variables, as in C.
    fn has_scopes_of_c(&self) -> bool;
    /// Whether a function that is called may have the name of a local: those of lowering have no prefix.
    fn may_hide_functions(&self) -> bool {
        self.has_scopes_of_c()
    }
    /// Whether no local may have the name of a global constant.
    fn keeps_constants_visible(&self) -> bool {
        false
    }
    /// A stem for `word` such that `{stem}_1` is not reserved.
    fn with_free_stem(&self, word: &str) -> String;

    /// The name itself if it is free, or the first numbered one.
    fn free(&self, name: &str, is_taken: impl Fn(&str) -> bool) -> String
    where
        Self: Sized,
    {
        let name = &self.with_free_stem(name);
        let numbered = (1_usize..).map(|number| format!("{name}_{number}"));
        std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|name| !is_taken(name))
            .unwrap_or_default()
    }
}

/// GLSL 450 as naga reads it.
pub(super) struct NagasGlsl;

impl Vocabulary for NagasGlsl {
    fn is_reserved(&self, word: &str) -> bool {
        keyword::is_reserved(word)
    }

    fn is_function(&self, word: &str) -> bool {
        keyword::is_function(word)
    }

    fn declared(&self) -> Vec<String> {
        let inputs = Input::ALL.iter().map(|input| input.name().to_owned());
        let channels =
            (0..4).flat_map(|number| [format!("iChannel{number}"), format!("iChannel{number}_sampler")]);
        let generated = GENERATED_NAMES.map(str::to_owned);
        inputs.chain(channels).chain(generated).collect()
    }

    fn has_scopes_of_c(&self) -> bool {
        false
    }

    fn with_free_stem(&self, word: &str) -> String {
        keyword::with_free_stem(word)
    }
}

/// The names of a shader's items.
#[derive(Default)]
pub(crate) struct Names {
    pub(crate) variables: HashMap<VariableId, String>,
    pub(crate) functions: HashMap<FunctionId, String>,
    pub(crate) structs: HashMap<StructId, String>,
    pub(crate) members: HashMap<(StructId, usize), String>,
}

impl Names {
    pub(crate) fn new(cx: &LoweringContext, order: &Order, vocabulary: &impl Vocabulary) -> Self {
        let mut names = Self::default();
        let mut types = HashSet::new();
        // Names at global scope, which must be unique.
        let mut taken: HashSet<String> = vocabulary.declared().into_iter().collect();
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
                let is_taken = |name: &str| {
                    vocabulary.is_reserved(name)
                        || vocabulary.has_scopes_of_c() && vocabulary.is_function(name)
                        || taken.contains(name)
                };
                let name = numbering.free(&vocabulary.with_free_stem(name), is_taken);
                types.insert(name.clone());
                taken.insert(name.clone());
                names.structs.insert(id, name);
                names.name_members(cx, id, vocabulary);
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
                let name = numbering.free(&vocabulary.with_free_stem(own), |name| {
                    vocabulary.is_reserved(name)
                        || vocabulary.is_function(name)
                        || taken.contains(name)
                        || (moved && name != own && counts.contains_key(name))
                        || (moved && name == own && counts.get(name).is_some_and(|&count| count > 1))
                });
                taken.insert(name.clone());
                names.variables.insert(id, name);
            }
        }
        if vocabulary.keeps_constants_visible() {
            surroundings.extend(order.items.iter().filter_map(|item| match item {
                Item::Variable(id) => names.variables.get(id).cloned(),
                _ => None,
            }));
        }
        names.name_functions(cx, order, &taken, vocabulary);
        let own = names
            .functions
            .values()
            .filter(|name| name.starts_with(GENERATED_PREFIX));
        surroundings.extend(own.cloned());
        for item in &order.items {
            if let Item::Function(id) = *item {
                names.name_locals(cx, id, &types, &surroundings, vocabulary);
            }
        }
        names
    }

    fn name_members(&mut self, cx: &LoweringContext, id: StructId, vocabulary: &impl Vocabulary) {
        // Macros of the code around the shader replace members, too.
        let mut taken: HashSet<String> = if vocabulary.has_scopes_of_c() {
            vocabulary.declared().into_iter().collect()
        } else {
            HashSet::new()
        };
        for (at, member) in cx.tree[id].members.iter().enumerate() {
            let name = vocabulary.free(&member.name, |name| {
                vocabulary.is_reserved(name) || taken.contains(name)
            });
            taken.insert(name.clone());
            self.members.insert((id, at), name);
        }
    }

    /// Overloads share a name unless lowering or naga makes their parameters equal.
    fn name_functions(
        &mut self,
        cx: &LoweringContext,
        order: &Order,
        taken: &HashSet<String>,
        vocabulary: &impl Vocabulary,
    ) {
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
            let name = vocabulary.free(&cx.tree[id].name, |name| {
                vocabulary.is_reserved(name)
                    || vocabulary.is_function(name)
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
        vocabulary: &impl Vocabulary,
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
                match tree[id].kind {
                    ExprKind::Variable(variable) => globals.extend(self.variables.get(&variable).cloned()),
                    ExprKind::Call { function, .. } if vocabulary.may_hide_functions() => {
                        globals.extend(self.functions.get(&function).cloned());
                    }
                    _ => {}
                }
            }
        }
        let clashes = |name: &str| {
            vocabulary.is_reserved(name)
                || vocabulary.has_scopes_of_c() && vocabulary.is_function(name)
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
            let is_ambiguous = cx.moved.contains(&id) && counts.get(own).is_some_and(|&count| count > 1)
                || vocabulary.has_scopes_of_c() && names_its_equal(tree, id);
            let name = if own.is_empty() || is_ambiguous || clashes(own) {
                let stem = if own.is_empty() {
                    "unused".to_owned()
                } else {
                    vocabulary.with_free_stem(own)
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

/// Whether the initializer of a variable names another variable of the same name.
fn names_its_equal(tree: &Tree, id: VariableId) -> bool {
    let variable = &tree[id];
    variable.initializer.is_some_and(|value| {
        walk::any(
            tree,
            value,
            |kind| matches!(kind, ExprKind::Variable(other) if tree[*other].name == variable.name),
        )
    })
}
