//! Which components of a variable have been written, kept beside it where that is not known from the start.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{Direction, ExprKind, Place, Tree, Type, VariableId};

use super::call::direction;
use super::{Builder, Choice};
use crate::ir::function::{Cell, Cells, NONE, Node, Origin, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Fault, Predicate};

/// What is kept of a variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct Written {
    /// A word for each of its components: whether it has been written.
    flags: Cells,
    /// Where it is declared.
    at: Place,
}

/// Of larger variables it is not kept.
const MAX_COMPONENTS: u32 = 64;

/// The variables that are handed to a function which may leave them unwritten, also by way of others.
pub(super) fn handed_out(tree: &Tree) -> HashSet<VariableId> {
    let mut handed = HashSet::new();
    let mut pending = Vec::new();
    let mut given = HashMap::<VariableId, Vec<VariableId>>::new();
    for (_, expr) in tree.exprs.iter() {
        let ExprKind::Call {
            function,
            ref arguments,
        } = expr.kind
        else {
            continue;
        };
        for (&argument, &parameter) in arguments.iter().zip(&tree[function].parameters) {
            let Some(root) = tree.root_variable(argument) else {
                continue;
            };
            match direction(tree[parameter].kind) {
                Direction::Out => pending.push(root),
                Direction::InOut => given.entry(parameter).or_default().push(root),
                Direction::In | Direction::ConstIn => {}
            }
        }
    }
    while let Some(variable) = pending.pop() {
        if handed.insert(variable) {
            pending.extend(given.get(&variable).into_iter().flatten());
        }
    }
    handed
}

impl Builder<'_> {
    /// A variable begins in these cells, which nobody else has, with a value or without. Of one with a value it is kept what is written
    /// only if a function may take the value away.
    pub(super) fn begin(&mut self, variable: VariableId, cells: Cells, with_value: bool) {
        let Some(at) = self.tree[variable].at else { return };
        if self.extras.choice != Choice::Noted
            || cells.count > MAX_COMPONENTS
            || with_value && !self.handed_out.contains(&variable)
        {
            return;
        }
        let flags = Cells {
            first: self.cells.len() as u32,
            count: cells.count,
        };
        self.cells.extend((0..cells.count).map(|_| Kind::Word));
        self.written.insert(cells.first, Written { flags, at });
        self.mark(flags, with_value);
    }

    /// An `out` parameter begins, in cells of the variable that is handed to it, until [`Self::end_parts`].
    pub(super) fn begin_part(&mut self, parameter: VariableId, cells: Cells) {
        let (Some((first, _)), Some(at)) = (self.flag(cells.first), self.tree[parameter].at) else {
            return;
        };
        self.parts.push((cells, at));
        let count = cells.count;
        self.mark(Cells { first, count }, false);
    }

    /// All of those parameters end but so many.
    pub(super) fn end_parts(&mut self, left: usize) {
        self.parts.truncate(left);
    }

    fn mark(&self, flags: Cells, written: bool) {
        let value = self.truth(written);
        for flag in flags.first..flags.first + flags.count {
            self.store(Cell(flag), value);
        }
    }

    /// Something is written to a cell, or by an index from there.
    pub(super) fn note_written(&self, cell: u32, index: Option<(Value, Cells)>) {
        let Some((flag, _)) = self.flag(cell) else { return };
        let value = self.truth(true);
        self.push(match index {
            None => Node::Store {
                cell: Cell(flag),
                value,
            },
            Some((index, cells)) => Node::StoreAt {
                cells: Cells {
                    first: cells.first + flag - cell,
                    ..cells
                },
                offset: cell - cells.first,
                index,
                value,
            },
        });
    }

    /// Cells are read, or what lies by an index from there. To copy a whole structure is not to read it.
    pub(super) fn note_read(&mut self, ty: Type, of: &[u32], index: Option<(Value, Cells)>) {
        if matches!(ty, Type::Struct(_) | Type::Array(_)) {
            return;
        }
        let Some((_, at)) = of.first().and_then(|&cell| self.flag(cell)) else {
            return;
        };
        let flags = of.iter().filter_map(|&cell| {
            let (flag, _) = self.flag(cell)?;
            Some(match index {
                None => self.load(Cell(flag)),
                Some((index, cells)) => self.value(Origin::LoadAt {
                    cells: Cells {
                        first: cells.first + flag - cell,
                        ..cells
                    },
                    offset: cell - cells.first,
                    index,
                    kind: Kind::Word,
                }),
            })
        });
        let all = flags.reduce(|a, b| {
            if a == b {
                a
            } else {
                self.binary(Operation::And, a, b)
            }
        });
        if let Some(all) = all {
            self.check(Fault::NeverWritten, at, Predicate::Zero, [all, NONE]);
        }
    }

    /// The flag of a cell, and where that is declared which it is for now.
    fn flag(&self, cell: u32) -> Option<(u32, Place)> {
        let (&first, &Written { flags, at }) = self.written.range(..=cell).next_back()?;
        let holds = |(cells, _): &&(Cells, Place)| cell.wrapping_sub(cells.first) < cells.count;
        let part = self.parts.iter().rev().find(holds).map(|&(_, at)| at);
        (cell - first < flags.count).then(|| (flags.first + cell - first, part.unwrap_or(at)))
    }
}
