//! Deletes statements, and replaces compound ones by what they contain.

use super::Source;
use crate::rewrite::Rewrite;

/// The deletions of the statements at a depth, from the last to the first: a use goes before its declaration.
pub(super) fn deleted(source: &Source, depth: usize) -> Option<Vec<Rewrite>> {
    let outline = &source.outline;
    let statements = outline.statements_at(depth);
    let deletions = statements.iter().rev().map(|(statement, is_in_list)| {
        let range = outline.bytes(&statement.tokens);
        Rewrite::replace(range, if *is_in_list { "" } else { ";" })
    });
    (!statements.is_empty()).then(|| deletions.collect())
}

/// Compound statements replaced by one of their bodies, and those without their `else`.
pub(super) fn unwrapped(source: &Source, depth: usize) -> Option<Vec<Rewrite>> {
    let outline = &source.outline;
    let mut rewrites = Vec::new();
    let statements = outline.statements_at(depth);
    for &(statement, is_in_list) in &statements {
        let whole = outline.bytes(&statement.tokens);
        for (number, body) in statement.bodies.iter().enumerate() {
            let inside = body.tokens.start + 1..body.tokens.end - 1;
            if body.is_list && is_in_list && !inside.is_empty() {
                rewrites.push(Rewrite::keep(&outline.bytes(&inside), &whole));
            }
            let kept = outline.bytes(&body.tokens);
            if kept == whole {
                continue;
            }
            if number == 0 && statement.bodies.len() == 2 {
                rewrites.push(Rewrite::delete(kept.end..whole.end));
            }
            match statement.init.as_ref().map(|init| outline.bytes(init)) {
                // The body of a `for` may need what its head declares.
                Some(init) if is_in_list => {
                    let kept_both = Rewrite::delete(whole.start..init.start).and(init.end..kept.start, " ");
                    rewrites.push(kept_both);
                }
                _ => {}
            }
            rewrites.push(Rewrite::keep(&kept, &whole));
        }
    }
    (!statements.is_empty()).then_some(rewrites)
}
