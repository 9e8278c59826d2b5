//! Globals without an initialiser that nothing writes, or a part of which nothing writes.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_glsl::Code;
use toyproof_glsl::tree::{ExprId, VariableId, VariableKind};

use super::super::Found;
use super::super::program::Program;
use super::flow::{Event, Flow};
use super::part::{Layout, Part, Parts};

/// What all functions together write of globals, and where they read them.
#[derive(Default)]
pub(super) struct Written {
    writes: BTreeMap<VariableId, Parts>,
    reads: Vec<(Part, ExprId)>,
}

impl Written {
    pub(super) fn add(&mut self, flow: &Flow) {
        for event in flow.nodes.iter().flat_map(|node| &node.events) {
            match event {
                Event::Write(part) => *self.writes.entry(part.variable).or_default() |= part.parts,
                Event::Read { part, expr } => self.reads.push((part.clone(), *expr)),
                _ => {}
            }
        }
    }

    pub(super) fn tell(self, program: &Program, layout: &Layout, found: &mut Found) {
        let tree = program.tree;
        let mut told = BTreeSet::new();
        for (part, expr) in self.reads {
            let variable = &tree[part.variable];
            if variable.kind != VariableKind::Global || variable.initialiser.is_some() {
                continue;
            }
            let missing = part.parts & !self.writes.get(&part.variable).copied().unwrap_or(0);
            if missing == 0 || (part.one_of && missing != part.parts) || !told.insert(part.variable) {
                continue;
            }
            let name = layout.name(part.variable, missing);
            let message = format!("`{name}` is read here, and nothing that runs ever writes it");
            found.tell(Code::Unwritten, tree[expr].at, message, |diagnostic| {
                let diagnostic = match variable.at {
                    Some(at) => diagnostic.related(at.span, "declared here, without a value"),
                    None => diagnostic,
                };
                diagnostic.note("WebGL makes it zero; is the function called that should fill it?")
            });
        }
    }
}
