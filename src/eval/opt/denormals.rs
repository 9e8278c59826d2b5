//! Denormal operands. Processors that flush denormal results also take denormal operands for zeros where they
//! compute, but move them unchanged. Results are flushed, so only constants and bit patterns can be denormal,
//! and values that are selected or loaded from these. Where an operation computes with such a value, the
//! value is multiplied by 1 first, which flushes it in f32 and is exact in every other number type.

use crate::ir::{AliasGroups, Block, Cell, Function, NONE, Node, Operation, Value, ValueDef};

/// Flushes the operands that may be denormal.
pub(crate) fn flush_operands(function: &mut Function) {
    let mut denormal = MayBeDenormal::new(function);
    if !denormal.values.contains(&true) {
        return;
    }
    let body = std::mem::take(&mut function.body);
    while denormal.propagate(&body, function) {}
    let one = push(function, ValueDef::Float(1.0f64.to_bits()));
    function.body = flushed(body, function, &denormal.values, one);
}

/// Whether an operation computes with its float operands: neither moves them nor looks at their bits.
fn computes(operation: Operation) -> bool {
    use Operation as O;
    !matches!(
        operation,
        O::Neg | O::Abs | O::Select | O::ToBits | O::IsNan | O::IsInf
    )
}

/// The values and the cells that may hold denormals.
struct MayBeDenormal {
    values: Vec<bool>,
    /// By the first cell of their group.
    cells: Vec<bool>,
    groups: AliasGroups,
}

impl MayBeDenormal {
    /// Only constants and bit patterns at first.
    fn new(function: &Function) -> Self {
        let is_source = |def: &ValueDef| match *def {
            ValueDef::Float(bits) => (f64::from_bits(bits) as f32).is_subnormal(),
            ValueDef::Operation(operation, _) => operation == Operation::FromBits,
            _ => false,
        };
        Self {
            values: function.defs.iter().map(is_source).collect(),
            cells: vec![false; function.cells.len()],
            groups: AliasGroups::new(function),
        }
    }

    /// Follows the values of a block to where they are moved; returns whether there were any.
    fn propagate(&mut self, block: &Block, function: &Function) -> bool {
        let mut has_changed = false;
        for node in block {
            match *node {
                Node::Let(value) if self.is_moved_to(function.def(value)) => {
                    has_changed |= !std::mem::replace(&mut self.values[value.0 as usize], true);
                }
                Node::Store { cell, value } => has_changed |= self.store(cell, value),
                Node::StoreAt { cells, value, .. } => has_changed |= self.store(Cell(cells.first), value),
                _ => {}
            }
            node.for_each_block(|block| has_changed |= self.propagate(block, function));
        }
        has_changed
    }

    fn store(&mut self, cell: Cell, value: Value) -> bool {
        let unit = self.groups.representative(cell).index();
        self.values[value.0 as usize] && !std::mem::replace(&mut self.cells[unit], true)
    }

    /// Whether a definition moves a value that may be denormal.
    fn is_moved_to(&self, def: ValueDef) -> bool {
        match def {
            ValueDef::Operation(Operation::Neg | Operation::Abs | Operation::Select, operands) => operands
                .iter()
                .any(|value| self.values.get(value.0 as usize).is_some_and(|&is| is)),
            ValueDef::Load(cell) => self.cells[self.groups.representative(cell).index()],
            ValueDef::LoadAt { cells, .. } => {
                self.cells[self.groups.representative(Cell(cells.first)).index()]
            }
            _ => false,
        }
    }
}

/// Inserts the products in a block.
fn flushed(block: Block, function: &mut Function, denormal: &[bool], one: Value) -> Block {
    let mut out = Block::with_capacity(block.len());
    for mut node in block {
        match &mut node {
            Node::Let(value) => {
                if let ValueDef::Operation(operation, operands) = function.def(*value)
                    && computes(operation)
                {
                    let operands = operands.map(|operand| flush(operand, function, denormal, one, &mut out));
                    function.defs[value.0 as usize] = ValueDef::Operation(operation, operands);
                }
            }
            Node::Check { values, .. } => {
                *values = values.map(|value| flush(value, function, denormal, one, &mut out));
            }
            _ => {}
        }
        node.for_each_block_mut(|block| {
            *block = flushed(std::mem::take(block), function, denormal, one);
        });
        out.push(node);
    }
    out
}

/// Appends the product of 1 and an operand that may be denormal, and returns it; returns other operands
/// unchanged.
fn flush(operand: Value, function: &mut Function, denormal: &[bool], one: Value, out: &mut Block) -> Value {
    if !denormal.get(operand.0 as usize).is_some_and(|&is| is) {
        return operand;
    }
    let product = push(
        function,
        ValueDef::Operation(Operation::Mul, [operand, one, NONE]),
    );
    out.push(Node::Let(product));
    product
}

fn push(function: &mut Function, def: ValueDef) -> Value {
    function.defs.push(def);
    Value(function.defs.len() as u32 - 1)
}
