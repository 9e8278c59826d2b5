//! Replaces variables by constants or by their initial values, and deletes their declarations.

use std::collections::HashSet;
use std::ops::Range;

use toyproof_glsl::tree::{ExprId, ExprKind, Statement, StatementKind, Tree, VariableId, VariableKind, walk};

use super::functions::{mentions, plain};
use super::{Source, constant};
use crate::rewrite::Rewrite;

/// The bytes at which a variable is read; `None` if it is written, or named in a macro.
pub(super) fn reads(tree: &Tree, variable: VariableId) -> Option<Vec<Range<usize>>> {
    let is_written = tree.exprs.ids().any(|expr| {
        let mut is_written = false;
        tree.each_write(expr, |target, _| {
            is_written |= tree.root_variable(target) == Some(variable);
        });
        is_written
    });
    if is_written {
        None
    } else {
        mentions(tree, variable)
    }
}

/// A local or global variable that one statement or declaration declares alone.
struct Declared {
    variable: VariableId,
    declaration: Range<usize>,
}

/// Variables replaced by 0: without their declarations and the statements that assign to them.
pub(super) fn constant(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let statements = statements(tree);
    let replaced = |declared: Declared| {
        let variable = declared.variable;
        let zero = constant::zero(tree, tree[variable].ty)?;
        let mut rewrite = Rewrite::replace(declared.declaration, ";");
        // What is assigned is not kept, and neither are the parts of what it is assigned to.
        let mut targets: HashSet<ExprId> = HashSet::new();
        for &(statement, root) in &statements {
            if let Some(target) = assigned(tree, root)
                && tree.root_variable(target) == Some(variable)
            {
                rewrite = rewrite.and(range(statement)?, ";");
                targets.extend(tree.postorder(root));
            }
        }
        for (id, expr) in tree.exprs.iter() {
            let mut is_written = false;
            tree.each_write(id, |target, _| {
                is_written |= tree.root_variable(target) == Some(variable);
            });
            if is_written && !targets.contains(&id) {
                return None;
            }
            let is_read = matches!(expr.kind, ExprKind::Variable(read) if read == variable);
            if is_read && !targets.contains(&id) {
                rewrite = rewrite.and(plain(tree, id)?, zero.clone());
            }
        }
        Some(rewrite)
    };
    declared(source, tree).into_iter().filter_map(replaced).collect()
}

/// Variables that nothing assigns to, replaced by their initial values.
pub(super) fn inlined(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let replaced = |declared: Declared| {
        let initializer = tree[declared.variable].initializer?;
        let value = plain(tree, initializer)?;
        let is_primary = !matches!(
            tree[initializer].kind,
            ExprKind::Unary { .. }
                | ExprKind::Binary { .. }
                | ExprKind::Conditional { .. }
                | ExprKind::Assign { .. }
                | ExprKind::Sequence { .. }
        );
        let text = &source.outline.text[value];
        let text = if is_primary || text.starts_with('(') && text.ends_with(')') {
            text.to_owned()
        } else {
            format!("({text})")
        };
        let uses = reads(tree, declared.variable)?.into_iter();
        Some(
            uses.fold(Rewrite::replace(declared.declaration, ";"), |rewrite, range| {
                rewrite.and(range, text.clone())
            }),
        )
    };
    declared(source, tree).into_iter().filter_map(replaced).collect()
}

/// The variables that are declared alone, from the last to the first.
fn declared(source: &Source, tree: &Tree) -> Vec<Declared> {
    let mut found = Vec::new();
    let items = source.outline.items.iter().filter(|item| item.function.is_none());
    for item in items.filter(|item| item.names.len() == 1) {
        let name = source.outline.tokens[item.names[0]].start;
        let named = tree.global_variables().find(|&variable| {
            let at = tree[variable].at;
            at.is_some_and(|at| !at.is_expanded() && at.span.start as usize == name)
        });
        found.extend(named.map(|variable| Declared {
            variable,
            declaration: source.outline.bytes(&item.tokens),
        }));
    }
    for (_, function) in tree.functions.iter() {
        declared_in(function.body.as_deref().unwrap_or_default(), &mut found);
    }
    let replaceable = |declared: &Declared| {
        matches!(
            tree[declared.variable].kind,
            VariableKind::Local | VariableKind::Const | VariableKind::Global
        )
    };
    found.retain(replaceable);
    found.reverse();
    found
}

/// Adds the variables of a block; those of the head of a `for` are not in a list of statements.
fn declared_in(block: &[Statement], found: &mut Vec<Declared>) {
    for (number, statement) in block.iter().enumerate() {
        let neighbors = [number.checked_sub(1), Some(number + 1)];
        let is_alone = neighbors
            .into_iter()
            .flatten()
            .filter_map(|at| block.get(at))
            .all(|other| other.at.span != statement.at.span);
        if let (StatementKind::Declare(variable), true, Some(declaration)) =
            (&statement.kind, is_alone, range(statement))
        {
            found.push(Declared {
                variable: *variable,
                declaration,
            });
        }
        let blocks = walk::child_blocks(statement).into_iter();
        let skipped = usize::from(matches!(statement.kind, StatementKind::For { .. }));
        blocks.skip(skipped).for_each(|inner| declared_in(inner, found));
    }
}

/// The statements that are an expression, with it.
fn statements(tree: &Tree) -> Vec<(&Statement, ExprId)> {
    let mut found = Vec::new();
    for (_, function) in tree.functions.iter() {
        walk::each(function.body.as_deref().unwrap_or_default(), &mut |statement| {
            if let StatementKind::Expression(root) = statement.kind {
                found.push((statement, root));
            }
        });
    }
    found
}

/// What a statement assigns to.
fn assigned(tree: &Tree, root: ExprId) -> Option<ExprId> {
    match tree[root].kind {
        ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => Some(target),
        _ => None,
    }
}

/// The bytes of a simple statement; `None` if it is in a macro.
fn range(statement: &Statement) -> Option<Range<usize>> {
    let at = statement.at;
    (!at.is_expanded()).then_some(at.span.start as usize..at.span.end as usize)
}
