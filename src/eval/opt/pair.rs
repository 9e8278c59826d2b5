//! Pairs: the sine and the cosine of an angle in one block are computed one after the other, so that one
//! instruction computes both, which takes little longer than one of them.

use crate::ir::{Block, Function, Node, Operation, Value, ValueDef};
use crate::opt::rollback::Map;

/// Moves the second function of each pair to the first.
pub(crate) fn pair(function: &mut Function) {
    let mut body = std::mem::take(&mut function.body);
    block(function, &mut body);
    function.body = body;
}

/// Returns the operation that makes a pair with another.
pub(crate) fn partner(operation: Operation) -> Option<Operation> {
    match operation {
        Operation::Sin => Some(Operation::Cos),
        Operation::Cos => Some(Operation::Sin),
        _ => None,
    }
}

fn block(function: &Function, nodes: &mut Block) {
    // The first function of each angle, and the second by the index of the first.
    let mut first: Map<(Operation, Value), usize> = Map::default();
    let mut second: Map<usize, Node> = Map::default();
    let mut moved = Vec::new();
    for (at, node) in nodes.iter_mut().enumerate() {
        node.for_each_block_mut(|inner| block(function, inner));
        let Node::Let(value) = *node else {
            continue;
        };
        let ValueDef::Operation(operation, [angle, ..]) = function.def(value) else {
            continue;
        };
        let Some(partner) = partner(operation) else {
            continue;
        };
        if let Some(before) = first.remove(&(partner, angle)) {
            second.insert(before, Node::Let(value));
            moved.push(at);
        } else {
            first.insert((operation, angle), at);
        }
    }
    if moved.is_empty() {
        return;
    }
    let mut moved = moved.into_iter().peekable();
    let old = std::mem::take(nodes);
    for (at, node) in old.into_iter().enumerate() {
        if moved.next_if_eq(&at).is_some() {
            continue;
        }
        nodes.push(node);
        nodes.extend(second.remove(&at));
    }
}
