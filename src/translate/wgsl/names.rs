//! Names of all items: the author's names unless WGSL reserves them. WGSL has no overloads: all but the first
//! of several functions with the same name get the types of their parameters as a suffix.

use std::collections::{HashMap, HashSet};

use naga::keywords::wgsl::RESERVED_SET;
use toyproof_glsl::tree::{BuiltIn, ExprKind, FunctionId, Item, StructId, Type, VariableId, walk};

use super::style::Style;
use super::writer::type_name;
use crate::lower::context::LoweringContext;
use crate::print::keyword::lists;
use crate::print::{Numbering, Order};

/// The names of a shader's items.
#[derive(Default)]
pub(super) struct Names {
    pub(super) variables: HashMap<VariableId, String>,
    /// The names of parameters that their functions copy to a variable.
    pub(super) arguments: HashMap<VariableId, String>,
    pub(super) functions: HashMap<FunctionId, String>,
    pub(super) structs: HashMap<StructId, String>,
    pub(super) members: HashMap<(StructId, usize), String>,
    /// All names in use.
    pub(super) all: HashSet<String>,
}

impl Names {
    pub(super) fn new(cx: &LoweringContext, order: &Order, style: Style) -> Self {
        let tree = &cx.tree;
        let mut names = Self::default();
        let mut taken: HashSet<String> = style.reserved_names().map(str::to_owned).collect();
        let mut numbering = Numbering::default();
        let taken_at = |taken: &HashSet<String>, name: &str| is_taken(name) || taken.contains(name);
        for item in &order.items {
            if let Item::Struct(id) = *item {
                let own = if tree[id].name.is_empty() {
                    "Struct"
                } else {
                    &tree[id].name
                };
                let name = numbering.free(stem(own), |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.structs.insert(id, name);
                let mut members = HashSet::new();
                for (at, member) in tree[id].members.iter().enumerate() {
                    let is_taken = |name: &str| is_reserved(name) || members.contains(name);
                    let name = free(&member.name, is_taken);
                    members.insert(name.clone());
                    names.members.insert((id, at), name);
                }
            }
        }
        for item in &order.items {
            if let Item::Variable(id) = *item {
                let stem = stem(&tree[id].name);
                let name = numbering.free(stem, |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.variables.insert(id, name);
            }
        }
        for item in &order.items {
            if let Item::Function(id) = *item {
                let own = without_prefix(&tree[id].name);
                let name = if taken_at(&taken, own) && !is_taken(own) {
                    let types = tree[id]
                        .parameters
                        .iter()
                        .map(|&parameter| type_label(cx, &names, tree[parameter].ty));
                    format!("{own}_{}", types.collect::<Vec<_>>().join("_"))
                } else {
                    own.to_owned()
                };
                let name = numbering.free(stem(&name), |name| taken_at(&taken, name));
                taken.insert(name.clone());
                names.functions.insert(id, name);
            }
        }
        names.all.clone_from(&taken);
        for item in &order.items {
            if let Item::Function(id) = *item {
                names.name_locals(cx, id, &taken);
            }
        }
        names
    }

    /// Names locals. They may shadow outer names, as in GLSL, but no name that differs from the author's.
    fn name_locals(&mut self, cx: &LoweringContext, function: FunctionId, global: &HashSet<String>) {
        let tree = &cx.tree;
        let mut locals = tree[function].parameters.clone();
        if let Some(body) = &tree[function].body {
            walk::each(body, &mut |statement| locals.extend(walk::declared(statement)));
        }
        let theirs: HashSet<&str> = locals.iter().map(|&id| &*tree[id].name).collect();
        let own = |id: VariableId| {
            let name = &*tree[id].name;
            let short = without_prefix(name);
            if theirs.contains(short) { name } else { short }
        };
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for &id in &locals {
            *counts.entry(own(id)).or_default() += 1;
        }
        let mut taken: HashSet<String> = counts.keys().map(|&name| name.to_owned()).collect();
        let called = called(cx, function);
        let mut numbering = Numbering::default();
        for &id in &locals {
            let own = own(id);
            let is_ambiguous = cx.moved.contains(&id) && counts.get(own).is_some_and(|&count| count > 1);
            let clashes = is_taken(own) && (!may_be_hidden(own) || called.contains(own));
            let name = if own.is_empty() || is_ambiguous || clashes || global.contains(own) {
                numbering.free(stem(own), |name| {
                    is_taken(name) || global.contains(name) || taken.contains(name)
                })
            } else {
                own.to_owned()
            };
            taken.insert(name.clone());
            self.variables.insert(id, name);
        }
        for &id in &tree[function].parameters {
            let name = self.variables[&id].clone() + "_in";
            let name = numbering.free(stem(&name), |name| {
                is_taken(name) || global.contains(name) || taken.contains(name)
            });
            taken.insert(name.clone());
            self.arguments.insert(id, name);
        }
        self.all.extend(taken);
    }
}

/// A generated name without its prefix, which distinguishes it from the author's names in GLSL only.
fn without_prefix(name: &str) -> &str {
    name.strip_prefix("toyproof_").unwrap_or(name)
}

/// The built-in functions that a function calls.
fn called(cx: &LoweringContext, function: FunctionId) -> HashSet<&'static str> {
    let tree = &cx.tree;
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

/// A type's name as part of an identifier.
fn type_label(cx: &LoweringContext, names: &Names, ty: Type) -> String {
    let name = type_name(cx, names, ty);
    let parts = name.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    parts
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("_")
}

/// Types and functions that WGSL predeclares and that printed code may use. Authors may redeclare all others
/// of `naga::keywords::wgsl::BUILTIN_IDENTIFIERS`, which also lacks the aliases such as `vec2f`;
/// `binding_array` is naga's extension.
const PREDECLARED: &str = "\
    abs acos acosh all any array asin asinh atan atan2 atanh atomic binding_array bitcast bool ceil clamp \
    cos cosh cross degrees determinant distance dot dpdx dpdy exp exp2 f16 f32 faceForward floor fract \
    fwidth i32 inverseSqrt length log log2 mat2x2f mat2x3f mat2x4f mat3x2f mat3x3f mat3x4f mat4x2f mat4x3f \
    mat4x4f max min mix normalize pack2x16float pack2x16snorm pack2x16unorm pow ptr radians reflect \
    refract round sampler select sign sin sinh smoothstep sqrt step tan tanh texture_2d texture_3d \
    texture_cube textureDimensions textureLoad textureSample textureSampleBias textureSampleGrad \
    textureSampleLevel transpose trunc u32 unpack2x16float unpack2x16snorm unpack2x16unorm vec2 vec2f \
    vec2i vec2u vec3 vec3f vec3i vec3u vec4 vec4f vec4i vec4u";

/// Whether the name is unavailable to variables, functions and structures.
pub(super) fn is_taken(word: &str) -> bool {
    is_reserved(word) || lists(PREDECLARED, word)
}

/// Whether a local variable may shadow a built-in function, if it is not called in the variable's scope. The
/// writer itself generates calls of some functions.
pub(super) fn may_be_hidden(word: &str) -> bool {
    const PRINTED: [&str; 4] = ["all", "any", "floor", "round"];
    BuiltIn::ALL.iter().any(|function| function.name() == word) && !PRINTED.contains(&word)
}

/// Whether the name is unavailable to members too, which clash with nothing after a dot: a keyword or
/// reserved word (§15).
pub(super) fn is_reserved(word: &str) -> bool {
    RESERVED_SET.contains(word) || word == "_" || word.starts_with("__")
}

/// The word itself if it is free, or the first free numbered one.
pub(super) fn free(word: &str, is_taken: impl Fn(&str) -> bool) -> String {
    Numbering::default().free(stem(word), is_taken)
}

/// The word without leading underscores: WGSL forbids two of them at the start.
pub(super) fn stem(word: &str) -> &str {
    match word.trim_start_matches("__") {
        "" | "_" => "unused",
        stem => stem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_get_a_number() {
        assert_eq!(free("loop", is_taken), "loop_1");
        assert_eq!(free("near", is_taken), "near");
        assert_eq!(free("__x", is_taken), "x");
        assert!(may_be_hidden("distance") && !may_be_hidden("select") && !may_be_hidden("floor"));
    }
}
