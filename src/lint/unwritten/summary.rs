//! What callers ask of a function that was looked at before.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use toyproof_glsl::tree::{FunctionId, Tree, VariableId, VariableKind};

use super::flow::{Event, Flow};
use super::part::Parts;

/// What callers ask of a function that was looked at before.
#[derive(Debug, Clone, Default)]
pub(super) struct Summary {
    /// By parameter: what of the argument is read, of an `inout` before it is written.
    pub(super) reads: Vec<Parts>,
    /// By parameter: what of it is written on any way.
    pub(super) writes: Vec<Parts>,
    /// The globals that it, or what it calls, changes.
    pub(super) globals: Rc<[VariableId]>,
}

/// What a function's own text reads of its parameters, and what it writes of them.
pub(super) fn summary(tree: &Tree, flow: &Flow, function: FunctionId) -> Summary {
    let parameters = &tree[function].parameters;
    let index: HashMap<VariableId, usize> = parameters.iter().copied().zip(0..).collect();
    let mut summary = Summary {
        reads: vec![0; parameters.len()],
        writes: vec![0; parameters.len()],
        globals: globals(tree, flow),
    };
    for event in flow.nodes.iter().flat_map(|node| &node.events) {
        let (part, sum) = match event {
            Event::Read { part, .. } => (part, &mut summary.reads),
            Event::Write(part) => (part, &mut summary.writes),
            _ => continue,
        };
        if let Some(&index) = index.get(&part.variable) {
            sum[index] |= part.parts;
        }
    }
    summary
}

fn globals(tree: &Tree, flow: &Flow) -> Rc<[VariableId]> {
    let mut all = BTreeSet::new();
    for event in flow.nodes.iter().flat_map(|node| &node.events) {
        match event {
            Event::Write(part) if tree[part.variable].kind == VariableKind::Global => {
                all.insert(part.variable);
            }
            Event::Called(globals) => all.extend(globals.iter().copied()),
            _ => {}
        }
    }
    all.into_iter().collect()
}
