//! The names of a shader: which are inputs of its host, and which must be replaced for another one.

use std::collections::{HashMap, HashSet};

use crate::Checked;
use crate::dialect::{Bound, Dialect, InputValue, Language, Version};
use crate::keywords::{Interner, Word};
use crate::source::Source;
use crate::token::Punctuator;
use crate::tree::{BuiltIn, ExprKind, Item, Type, VariableId, VariableKind};

/// The value of a name that the host sets, or that the author declares for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Known {
    Input(InputValue),
    /// A uniform with a value.
    Value(Type, Vec<f64>),
    /// A uniform or varying that nothing sets.
    Unset,
}

/// The names that a shader reads from its host, by their names in the text.
pub(super) fn known(checked: &Checked) -> HashMap<String, (VariableId, Known)> {
    let mut known = HashMap::new();
    for (id, variable) in checked.tree.variables.iter() {
        let value = match variable.kind {
            // The tree has ShaderToy's inputs whatever the host.
            VariableKind::Input(input) if checked.dialect.is_implicit() => {
                Known::Input(InputValue::Whole(input))
            }
            VariableKind::Channel(channel) if checked.dialect.is_implicit() => {
                Known::Input(InputValue::Texture(channel))
            }
            VariableKind::Uniform | VariableKind::Varying => match checked.bound.get(&id) {
                Some(Bound::Input(value)) => Known::Input(*value),
                Some(Bound::Value(ty, components)) => Known::Value(*ty, components.clone()),
                None => Known::Unset,
            },
            _ => continue,
        };
        known.insert(variable.name.clone(), (id, value));
    }
    known
}

/// The names that a shader declares, with the number of their declarations.
pub(super) fn declared(checked: &Checked) -> HashMap<&str, usize> {
    let tree = &checked.tree;
    let mut declared = HashMap::new();
    let mut add = |name| *declared.entry(name).or_default() += 1;
    for (_, variable) in tree
        .variables
        .iter()
        .filter(|(_, variable)| variable.at.is_some())
    {
        add(&*variable.name);
    }
    tree.functions
        .iter()
        .for_each(|(_, function)| add(&function.name));
    for (_, structure) in tree.structs.iter() {
        add(&structure.name);
        structure.members.iter().for_each(|member| add(&member.name));
    }
    declared
}

/// The words of a text.
pub(super) fn words<'a>(source: &Source<'a>) -> HashSet<&'a str> {
    let words = (0..source.len()).filter(|&index| source.symbol(index).is_some());
    words.map(|index| source.token_text(index)).collect()
}

/// The parameters of macros, which hide what has their names.
pub(super) fn macro_parameters<'a>(source: &Source<'a>) -> HashSet<&'a str> {
    let is_macro = |&index: &usize| {
        source.is_in_directive(index)
            && source.token_text(index) == "define"
            && source.is(index + 2, Punctuator::LeftParen)
            && source.span(index + 1).end == source.span(index + 2).start
    };
    let macros = (0..source.len()).filter(is_macro);
    let parameters = macros.flat_map(|index| {
        let all = index + 3..source.len();
        all.take_while(|&index| !source.is(index, Punctuator::RightParen))
    });
    parameters.map(|index| source.token_text(index)).collect()
}

/// A name that begins like this one, and that the text does not have.
pub(super) fn fresh(name: &str, words: &HashSet<&str>) -> String {
    let mut fresh = name.to_owned();
    while words.contains(&*fresh) {
        fresh.push('_');
    }
    fresh
}

/// Whether a declared name is a word of another version.
pub(super) fn is_word(name: &str, words: &Interner) -> bool {
    words
        .find(name)
        .is_some_and(|symbol| words.word(symbol) != Word::Name)
}

/// The names of a shader's functions and global variables that are those of built-in functions in another
/// version.
pub(super) fn built_in_names(checked: &Checked, version: Version) -> HashSet<&str> {
    let language = Language {
        version,
        is_lenient: false,
    };
    let tree = &checked.tree;
    let name = |item: &Item| match *item {
        Item::Variable(variable) => Some(&*tree[variable].name),
        Item::Function(function) | Item::Prototype(function) => Some(&*tree[function].name),
        Item::Struct(_) => None,
    };
    let is_built_in = |name: &&str| BuiltIn::named(name).is_some_and(|function| language.has(function));
    tree.items.iter().filter_map(name).filter(is_built_in).collect()
}

/// The first bytes of the names with which a shader's own functions are defined and called.
pub(super) fn own_calls(checked: &Checked) -> HashSet<u32> {
    let tree = &checked.tree;
    let definitions = tree.functions.iter().map(|(_, function)| function.at);
    let calls = tree.exprs.iter();
    let calls = calls.filter(|(_, expr)| matches!(expr.kind, ExprKind::Call { .. }));
    let calls = calls.map(|(_, expr)| expr.at);
    definitions.chain(calls).map(|at| at.spelling.start).collect()
}

/// The words of a version.
pub(super) fn language(version: Version) -> Interner {
    Interner::new(Language {
        version,
        is_lenient: false,
    })
}

/// The inputs that a host sets without a declaration, and that the tree has as constants.
pub(super) fn constants(dialect: Dialect, name: &str) -> Option<InputValue> {
    let values = dialect.input(name).filter(|_| dialect.is_implicit())?;
    values.first().copied()
}
