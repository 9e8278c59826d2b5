//! The ends of scopes: a `return` that nothing follows needs no jump, and what follows `if (c) return x;` stands in its `else`.

use crate::ir::function::{Block, Node, Scope};

/// How deep what follows may come to stand.
const MAX_NESTING: usize = 100;

/// Takes out what leaves a scope at its end, after moving code so that there is more of it.
pub(super) fn shorten(body: &mut Block, scope: Scope) {
    shorten_at(body, scope, 0);
}

fn shorten_at(body: &mut Block, scope: Scope, depth: usize) {
    if depth > MAX_NESTING {
        return;
    }
    let splits = body.iter().position(|node| match node {
        Node::If { yes, no, .. } => ends_in(yes, scope) || ends_in(no, scope),
        _ => false,
    });
    if let Some(at) = splits {
        let rest = body.split_off(at + 1);
        if let Some(Node::If { yes, no, .. }) = body.last_mut() {
            match (ends_in(yes, scope), ends_in(no, scope)) {
                (true, false) => no.extend(rest),
                (false, true) => yes.extend(rest),
                // Nothing comes there.
                _ => {}
            }
        }
    }
    match body.last_mut() {
        Some(Node::Leave(left)) if *left == scope => {
            body.pop();
        }
        Some(Node::If { yes, no, .. }) => {
            shorten_at(yes, scope, depth + 1);
            shorten_at(no, scope, depth + 1);
        }
        _ => {}
    }
}

fn ends_in(block: &Block, scope: Scope) -> bool {
    matches!(block.last(), Some(Node::Leave(left)) if *left == scope)
}

/// Whether nothing runs off the end of a block.
pub(super) fn never_ends(block: &Block) -> bool {
    match block.last() {
        Some(Node::Leave(_)) => true,
        Some(Node::If { yes, no, .. }) => never_ends(yes) && never_ends(no),
        _ => false,
    }
}

/// Whether something in a block leaves a scope.
pub(super) fn leaves(block: &Block, scope: Scope) -> bool {
    block.iter().any(|node| match node {
        Node::Leave(left) | Node::LeaveIf { scope: left, .. } => *left == scope,
        Node::If { yes, no, .. } => leaves(yes, scope) || leaves(no, scope),
        Node::Scope { body, .. } | Node::Loop { body, .. } => leaves(body, scope),
        _ => false,
    })
}
