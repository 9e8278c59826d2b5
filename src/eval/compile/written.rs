//! Which components of a variable have been written, kept beside it where that is not known from the start.

use super::{Builder, Choice};
use crate::eval::flow::{Cell, Cells, NONE, Node, Origin, Value};
use crate::eval::observe::{Fault, Predicate};
use crate::eval::operation::{Kind, Operation};
use crate::glsl::tree::{Place, Type, VariableId};

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

impl Builder<'_> {
    /// A variable begins that nothing has been written to, in these cells.
    pub(super) fn begin_unwritten(&mut self, variable: VariableId, cells: Cells) {
        let Some(at) = self.tree[variable].at else { return };
        if self.extras.choice != Choice::Noted || cells.count > MAX_COMPONENTS {
            return;
        }
        let known = self.written.get(&cells.first).map(|known| known.flags);
        let flags = known.unwrap_or_else(|| {
            let first = self.cells.len() as u32;
            self.cells.extend((0..cells.count).map(|_| Kind::Word));
            Cells {
                first,
                count: cells.count,
            }
        });
        self.written.insert(cells.first, Written { flags, at });
        let no = self.truth(false);
        for flag in flags.first..flags.first + flags.count {
            self.store(Cell(flag), no);
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

    /// The flag of a cell, and where its variable is declared.
    fn flag(&self, cell: u32) -> Option<(u32, Place)> {
        let (&first, &Written { flags, at }) = self.written.range(..=cell).next_back()?;
        (cell - first < flags.count).then(|| (flags.first + cell - first, at))
    }
}
