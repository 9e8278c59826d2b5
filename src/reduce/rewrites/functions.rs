//! Functions with trivial bodies, with fewer parameters, and in place of their calls.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use toyproof_glsl::tree::{
    Direction, Expr, ExprId, ExprKind, FunctionId, Item, StatementKind, Tree, Type, VariableId, VariableKind,
    walk,
};

use super::{Source, constant};
use crate::outline::{self, Outline};
use crate::rewrite::{Rewrite, apply};

/// The largest number of tokens that a function may have to take the place of its calls.
const MAX_INLINED_TOKENS: usize = 200;

/// A function definition in the tree and in the text.
struct Definition<'s> {
    id: FunctionId,
    item: &'s outline::Item,
    function: &'s outline::Function,
}

/// The definitions of functions that the shader itself calls, from the last to the first.
fn definitions<'s>(source: &'s Source, tree: &Tree) -> Vec<Definition<'s>> {
    let outline = &source.outline;
    let entry = source.checked.as_ref().map(|checked| checked.main_image);
    let by_name: HashMap<usize, FunctionId> = tree
        .items
        .iter()
        .filter_map(|item| match *item {
            Item::Function(id) if Some(id) != entry && !tree[id].at.is_expanded() => {
                Some((tree[id].at.span.start as usize, id))
            }
            _ => None,
        })
        .collect();
    let definitions = outline.functions().filter_map(|(item, function)| {
        let name = outline.tokens.get(function.open.checked_sub(1)?)?;
        Some(Definition {
            id: *by_name.get(&name.start)?,
            item,
            function,
        })
    });
    let mut definitions: Vec<_> = definitions.collect();
    definitions.reverse();
    definitions
}

/// Functions whose bodies only return 0.
pub(super) fn stubs(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let outline = &source.outline;
    let stub = |definition: Definition| {
        let text = match tree[definition.id].return_type {
            Type::Void => "{}".to_owned(),
            ty => format!("{{ return {}; }}", constant::zero(tree, ty)?),
        };
        Some(Rewrite::replace(outline.bytes(&definition.function.body), text))
    };
    definitions(source, tree).into_iter().filter_map(stub).collect()
}

/// Functions whose results nothing uses, without results.
pub(super) fn without_results(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let outline = &source.outline;
    let mut used: HashSet<FunctionId> = HashSet::new();
    for (_, expr) in tree.exprs.iter() {
        expr.kind
            .for_each_operand(|operand| used.extend(called(tree, operand)));
    }
    for (_, function) in tree.functions.iter() {
        walk::each(function.body.as_deref().unwrap_or_default(), &mut |statement| {
            if !matches!(statement.kind, StatementKind::Expression(_)) {
                let roots = walk::own_expressions(tree, statement).into_iter();
                used.extend(roots.filter_map(|root| called(tree, root)));
            }
        });
    }
    let unused = |definition: Definition| {
        let name = definition.function.open.checked_sub(1)?;
        let result = definition.item.tokens.start..name;
        let mut rewrite = Rewrite::replace(outline.bytes(&result), "void ");
        walk::each(tree[definition.id].body.as_deref()?, &mut |statement| {
            if let (StatementKind::Return(Some(_)), false) = (&statement.kind, statement.at.is_expanded()) {
                let at = statement.at.span;
                rewrite = std::mem::take(&mut rewrite).and(at.start as usize..at.end as usize, "return;");
            }
        });
        let is_void = tree[definition.id].return_type == Type::Void;
        (!is_void && !used.contains(&definition.id)).then_some(rewrite)
    };
    definitions(source, tree).into_iter().filter_map(unused).collect()
}

/// The function that an expression calls itself.
fn called(tree: &Tree, expr: ExprId) -> Option<FunctionId> {
    match tree[expr].kind {
        ExprKind::Call { function, .. } => Some(function),
        _ => None,
    }
}

/// The places of the calls of each function, as tokens; `None` if one is in a macro.
fn calls(outline: &Outline, tree: &Tree) -> HashMap<FunctionId, Option<Vec<usize>>> {
    let mut calls: HashMap<FunctionId, Option<Vec<usize>>> = HashMap::new();
    for (_, expr) in tree.exprs.iter() {
        if let ExprKind::Call { function, .. } = expr.kind {
            let all = calls.entry(function).or_insert_with(|| Some(Vec::new()));
            match outline_call(outline, expr) {
                Some(at) => all.iter_mut().for_each(|all| all.push(at)),
                None => *all = None,
            }
        }
    }
    calls
}

/// The token of the name of a call.
fn outline_call(outline: &Outline, call: &Expr) -> Option<usize> {
    let mut at = outline.token_at(call.at.span.start as usize);
    // A call in parentheses includes them.
    while outline.token(at) == "(" {
        at += 1;
    }
    (!call.at.is_expanded() && outline.token(at + 1) == "(").then_some(at)
}

/// Deletions of one parameter of a function, with the arguments of its calls; 0 takes its place.
pub(super) fn without_parameters(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let outline = &source.outline;
    let calls = calls(outline, tree);
    let mut rewrites = Vec::new();
    for definition in definitions(source, tree) {
        let Some(calls) = calls.get(&definition.id).and_then(Option::as_ref) else {
            continue;
        };
        for (number, &parameter) in tree[definition.id].parameters.iter().enumerate() {
            let lists = calls
                .iter()
                .map(|call| call + 1)
                .chain([definition.function.open]);
            let deletions = lists.map(|open| element_with_comma(outline, open, number));
            let uses = super::variables::reads(tree, parameter);
            if let (Some(deletions), Some(uses)) = (deletions.collect::<Option<Vec<_>>>(), uses)
                && (uses.is_empty() || constant::zero(tree, tree[parameter].ty).is_some())
            {
                let zero = constant::zero(tree, tree[parameter].ty).unwrap_or_default();
                let deleted = deletions
                    .into_iter()
                    .fold(Rewrite::default(), |rewrite, range| rewrite.and(range, ""));
                rewrites.push(
                    uses.into_iter()
                        .fold(deleted, |rewrite, range| rewrite.and(range, zero.clone())),
                );
            }
        }
    }
    rewrites
}

/// The bytes of an element of the list at `open`, with one comma.
fn element_with_comma(outline: &Outline, open: usize, number: usize) -> Option<Range<usize>> {
    let elements = outline.elements(open)?;
    let element = elements.get(number)?;
    let with_comma = match number {
        0 if elements.len() > 1 => element.start..element.end + 1,
        0 => element.clone(),
        _ => element.start - 1..element.end,
    };
    Some(outline.bytes(&with_comma))
}

/// Deletions of a function whose calls become its result, or the statements of its body.
pub(super) fn inlined(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let outline = &source.outline;
    let calls = calls(outline, tree);
    let inline = |definition: Definition| {
        let calls = calls.get(&definition.id)?.as_ref()?;
        let mut rewrite = Rewrite::delete(outline.bytes(&definition.item.tokens));
        for &call in calls {
            let close = outline.partner(call + 1)?;
            let text = Inlining { outline, tree }.text(&definition, call)?;
            rewrite = rewrite.and(outline.bytes(&(call..close + 1)), text);
        }
        (definition.item.tokens.len() <= MAX_INLINED_TOKENS).then_some(rewrite)
    };
    definitions(source, tree).into_iter().filter_map(inline).collect()
}

/// Puts the body of a function in place of a call.
struct Inlining<'a> {
    outline: &'a Outline<'a>,
    tree: &'a Tree,
}

impl Inlining<'_> {
    /// The text in place of the call whose name is the token `call`. Names may get another meaning in it;
    /// then it does not show the fault.
    fn text(&self, definition: &Definition, call: usize) -> Option<String> {
        let (outline, tree) = (self.outline, self.tree);
        let function = &tree[definition.id];
        let arguments = outline.elements(call + 1)?;
        let is_nested = (call + 1..outline.partner(call + 1)?).any(|at| outline.token(at) == function.name);
        if is_nested || arguments.len() != function.parameters.len() {
            return None;
        }
        let body = function.body.as_ref()?;
        let (range, is_value) = match &body[..] {
            [only] if matches!(only.kind, StatementKind::Return(Some(_))) => {
                let StatementKind::Return(Some(value)) = only.kind else {
                    return None;
                };
                let at = tree[value].at;
                (!at.is_expanded()).then_some((at.span.start as usize..at.span.end as usize, true))?
            }
            _ if function.return_type == Type::Void => (outline.bytes(&definition.function.body), false),
            _ => return None,
        };
        let mut substitutions = Rewrite::default();
        for (&parameter, argument) in function.parameters.iter().zip(&arguments) {
            let is_read_only = matches!(
                tree[parameter].kind,
                VariableKind::Parameter(Direction::In | Direction::ConstIn)
            );
            let text = &outline.text[outline.bytes(argument)];
            for range in mentions(tree, parameter)? {
                let text = if argument.len() == 1 || !is_read_only {
                    text.to_owned()
                } else {
                    format!("({text})")
                };
                substitutions = substitutions.and(range, text);
            }
        }
        // Only the pieces inside of the function count.
        let (start, end) = (range.start, range.end);
        let substituted = apply(&outline.text[..end], [&substitutions])?;
        let text = &substituted[start..];
        Some(if is_value {
            format!("({text})")
        } else {
            text.to_owned()
        })
    }
}

/// The bytes at which a variable is named, apart from its declaration; `None` if one is in a macro.
pub(super) fn mentions(tree: &Tree, variable: VariableId) -> Option<Vec<Range<usize>>> {
    let named = tree.exprs.iter().filter(|(_, expr)| is_variable(expr, variable));
    named.map(|(id, _)| plain(tree, id)).collect()
}

fn is_variable(expr: &Expr, variable: VariableId) -> bool {
    matches!(expr.kind, ExprKind::Variable(named) if named == variable)
}

/// The bytes of an expression; `None` if it is in a macro.
pub(super) fn plain(tree: &Tree, expr: ExprId) -> Option<Range<usize>> {
    let at = tree[expr].at;
    (!at.is_expanded()).then_some(at.span.start as usize..at.span.end as usize)
}
