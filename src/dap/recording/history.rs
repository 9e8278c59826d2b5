//! The values of cells over the execution.

use toyproof_eval::{Store, TraceValue};

/// No program has more cells.
const MAX_CELLS: usize = 1 << 20;

/// What was written to each cell, in the order of execution.
#[derive(Debug, Default)]
pub(crate) struct History {
    /// For each cell, the writes: the number of the event, and the value.
    cells: Vec<Vec<(u32, TraceValue)>>,
}

impl History {
    /// Adds the writes of an event, in execution order. Calls `each` with the cells and their new values.
    pub(crate) fn write(
        &mut self,
        event: u32,
        store: &Store,
        values: &[TraceValue],
        mut each: impl FnMut(u32, TraceValue),
    ) {
        let (offset, values) = match values {
            [TraceValue::Word(index), rest @ ..] if store.is_indexed => (*index, rest),
            _ => (0, values),
        };
        for (at, &cell) in store.cells.iter().enumerate() {
            // A zero of either kind is displayed by the variable's type.
            let zero = store.is_zero.then_some(TraceValue::Word(0));
            let Some(value) = values.get(at).copied().or(zero) else {
                continue;
            };
            let cell = cell.saturating_add(offset);
            let index = cell as usize;
            if index >= MAX_CELLS {
                continue;
            }
            if self.cells.len() <= index {
                self.cells.resize_with(index + 1, Vec::new);
            }
            self.cells[index].push((event, value));
            each(cell, value);
        }
    }

    /// The value of a cell before an event, zero if nothing was written.
    pub(crate) fn value(&self, cell: u32, before: u32) -> TraceValue {
        let writes = self.cells.get(cell as usize).map_or(&[][..], Vec::as_slice);
        let after = writes.partition_point(|&(event, _)| event < before);
        let last = after.checked_sub(1).map(|at| writes[at].1);
        last.unwrap_or(TraceValue::Word(0))
    }

    /// The events that write a cell.
    pub(crate) fn writes(&self, cell: u32) -> impl Iterator<Item = u32> {
        let writes = self.cells.get(cell as usize).map_or(&[][..], Vec::as_slice);
        writes.iter().map(|&(event, _)| event)
    }
}
