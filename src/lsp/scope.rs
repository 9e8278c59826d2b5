//! What is visible at a byte of the analyzed text, and the types of text that may be half-typed.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::Resolution;
use toyproof_glsl::tree::{BuiltIn, FunctionId, Sampler, StructId, Tree, Type};

use crate::snapshot::Snapshot;
use crate::tokens::{OpenCall, TokenKind, Tokens};

/// The name of a declared entity; `None` for a member.
fn name_of(tree: &Tree, resolution: Resolution) -> Option<&str> {
    Some(match resolution {
        Resolution::Variable(id) => &tree[id].name,
        Resolution::Struct(id) => &tree[id].name,
        Resolution::Function(id) => &tree[id].name,
        Resolution::BuiltIn(function) => function.name(),
        Resolution::Member(..) => return None,
    })
}

/// What the author declared and can be named at a byte: of each name, what no inner declaration hides. All
/// overloads of a function.
pub(crate) fn visible(snapshot: &Snapshot, at: u32) -> Vec<Resolution> {
    let tree = snapshot.tree();
    let mut by_name: BTreeMap<&str, (usize, BTreeSet<Resolution>)> = BTreeMap::new();
    for declared in &snapshot.analysis().visibilities {
        if !(declared.start <= at && at <= declared.end) {
            continue;
        }
        let Some(name) = name_of(tree, declared.resolution).filter(|name| !name.is_empty()) else {
            continue;
        };
        let entry = by_name.entry(name).or_insert((declared.depth, BTreeSet::new()));
        if declared.depth > entry.0 {
            *entry = (declared.depth, BTreeSet::new());
        }
        if declared.depth == entry.0 {
            entry.1.insert(declared.resolution);
        }
    }
    by_name.into_values().flat_map(|(_, found)| found).collect()
}

/// What a name denotes at a byte, of the author's declarations.
pub(crate) fn named(snapshot: &Snapshot, name: &str, at: u32) -> Vec<Resolution> {
    let mut found = visible(snapshot, at);
    found.retain(|&resolution| name_of(snapshot.tree(), resolution) == Some(name));
    found
}

/// The structure of that name.
pub(crate) fn structure(snapshot: &Snapshot, name: &str, at: u32) -> Option<StructId> {
    let found = named(snapshot, name, at).into_iter();
    let mut structures = found.filter_map(|resolution| match resolution {
        Resolution::Struct(id) => Some(id),
        _ => None,
    });
    structures.next()
}

/// The overloads of the author's function of that name.
pub(crate) fn functions(snapshot: &Snapshot, name: &str, at: u32) -> Vec<FunctionId> {
    let found = named(snapshot, name, at).into_iter();
    let functions = found.filter_map(|resolution| match resolution {
        Resolution::Function(id) => Some(id),
        _ => None,
    });
    functions.collect()
}

/// The type of the operand that ends with the token at `last`, in a text that may be half-typed.
pub(crate) fn operand_type(snapshot: &Snapshot, tokens: &Tokens<'_>, last: usize, at: u32) -> Option<Type> {
    let start = tokens.operand_start(last)?;
    let end = tokens.code()[last].end();
    expression_type(snapshot, start, end).or_else(|| path_type(snapshot, tokens, start, last, at))
}

/// The type of the largest expression within bytes of the document.
pub(crate) fn expression_type(snapshot: &Snapshot, start: u32, end: u32) -> Option<Type> {
    let (start, end) = (snapshot.analyzed_byte(start)?, snapshot.analyzed_byte(end)?);
    let within = |span: Span| start <= span.start && span.end <= end;
    let exprs = snapshot.tree().exprs.iter();
    let inside = exprs.filter(|(_, expr)| within(expr.at.span) && expr.ty != Type::Error);
    // Of several with one span, the last is made of the others.
    let largest = inside.max_by_key(|(_, expr)| expr.at.span.end - expr.at.span.start);
    let (_, expr) = largest?;
    // Without its ends, it is another operand.
    let covered = snapshot
        .analyzed_text()
        .get(start as usize..expr.at.span.start as usize)?;
    covered
        .chars()
        .all(|c| c == '(' || c.is_whitespace())
        .then_some(expr.ty)
}

/// The type of `a.b.c`, from the names alone.
fn path_type(snapshot: &Snapshot, tokens: &Tokens<'_>, start: u32, last: usize, at: u32) -> Option<Type> {
    let tree = snapshot.tree();
    let first = tokens.count_before(start);
    let mut words = tokens.code()[first..=last].iter().filter(|token| !token.is("."));
    let root = words.next()?;
    let found = named(snapshot, root.text, at);
    let mut ty = found
        .into_iter()
        .find_map(|resolution| match resolution {
            Resolution::Variable(id) => Some(tree[id].ty),
            _ => None,
        })
        .or_else(|| {
            let mut variables = tree.variables.iter();
            let is_one = |name: &str| name == root.text;
            variables
                .find(|(_, variable)| variable.at.is_none() && is_one(&variable.name))
                .map(|(_, variable)| variable.ty)
        })?;
    for word in words {
        if word.kind != TokenKind::Word {
            return None;
        }
        ty = match ty {
            Type::Struct(id) => {
                let mut members = tree[id].members.iter();
                members.find(|member| member.name == word.text)?.ty
            }
            Type::Vector(scalar, _) if (1..=4).contains(&word.text.len()) => {
                Type::vector(scalar, word.text.len() as u8)
            }
            _ => return None,
        };
    }
    Some(ty)
}

/// The types of the arguments of an open call up to a byte, [`Type::Error`] where they are unknown. Of the
/// last one, only what is complete counts.
pub(crate) fn argument_types(snapshot: &Snapshot, tokens: &Tokens<'_>, call: &OpenCall) -> Vec<Type> {
    let code = tokens.code();
    let ends = call.arguments.iter().skip(1).map(|&next| next - 1);
    let arguments = call.arguments.iter().zip(ends);
    arguments
        .map(|(&first, end)| {
            let (Some(first), Some(end)) = (code.get(first), code.get(end)) else {
                return Type::Error;
            };
            expression_type(snapshot, first.start, end.start).unwrap_or_default()
        })
        .collect()
}

/// The type of the parameter whose argument is being written.
pub(crate) fn parameter_type(
    snapshot: &Snapshot,
    tokens: &Tokens<'_>,
    call: &OpenCall,
    at: u32,
) -> Option<Type> {
    let tree = snapshot.tree();
    let name = tokens.code()[call.name].text;
    let index = call.arguments.len() - 1;
    if let Some(id) = structure(snapshot, name, at) {
        return Some(tree[id].members.get(index)?.ty);
    }
    let given = argument_types(snapshot, tokens, call);
    let fits = |parameters: &[Type]| {
        let mut pairs = parameters.iter().zip(&given);
        pairs.all(|(wanted, given)| *given == Type::Error || wanted == given)
    };
    for function in functions(snapshot, name, at) {
        let parameters = tree[function].parameters.iter();
        let parameters: Vec<Type> = parameters.map(|&parameter| tree[parameter].ty).collect();
        if fits(&parameters) && parameters.len() > index {
            return Some(parameters[index]);
        }
    }
    let version = snapshot.analysis().version;
    let mut known = version.functions(snapshot.options().lenient);
    let (_, function) = known.find(|(known, _)| *known == name)?;
    match index {
        0 => function.is_texture().then_some(Type::Sampler(Sampler::D2)),
        _ if function.is_texture() => None,
        // The first argument determines the type of most others.
        _ if function != BuiltIn::Refract => given.first().copied().filter(|&ty| ty != Type::Error),
        _ => None,
    }
}
