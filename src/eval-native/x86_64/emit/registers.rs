//! Assignment of registers to the nodes of a region.
//!
//! Nodes are kept in fifteen of the vector registers (the sixteenth is scratch); if none of these is free,
//! the node whose next use is farthest away is moved to the stack (Belady, “A Study of Replacement Algorithms
//! for a Virtual-Storage Computer”, IBM Systems Journal 5(2), 1966).

use toyproof_eval::native::{Kind, Map};

use super::frame::{FLOAT_SCALARS, Frame, MAX_SLOTS, Note, REGISTERS, SCRATCH, SPILLED, WORD_SCALARS, place};
use super::guard::Snapshot;
use crate::x86_64::assemble::{Assembler, Condition, Memory, RSP, Source, Vector};
use crate::x86_64::node::{Action, Item, NO_NODE, NodeId, Region, Table, TableRow};
use crate::x86_64::op;

pub(super) const NO_REGISTER: u8 = u8::MAX;
pub(super) const NO_SLOT: u32 = u32::MAX;
const NEVER: u32 = u32::MAX;

pub(super) struct Registers<'a> {
    pub(super) code: &'a mut Assembler,
    pub(super) frame: &'a mut Frame,
    pub(super) region: &'a Region,
    pub(super) scalar: bool,
    /// The node in each register.
    pub(super) held: [NodeId; REGISTERS],
    /// The register of each node.
    pub(super) register_of: Vec<u8>,
    /// The place of each spilled node on the stack.
    pub(super) slots: Vec<u32>,
    pub(super) free_slots: Vec<u32>,
    /// Slots that are free after the item, which may still read them.
    pub(super) pending_slots: Vec<u32>,
    pub(super) slot_count: u32,
    /// The items that use each node, in order, node by node.
    pub(super) uses: Vec<u32>,
    /// The index in `uses` at which the items of each node begin.
    pub(super) first_use: Vec<u32>,
    /// The use of each node that comes next.
    pub(super) next_use: Vec<u32>,
    /// Whether a node cannot be loaded again although it is lazy, since its row has changed.
    pub(super) stale: Vec<bool>,
    /// The nodes that load each row, in order, latest first.
    pub(super) row_nodes: Map<TableRow, Vec<NodeId>>,
    pub(super) guards: Vec<Snapshot>,
    /// The register that is best for each node.
    pub(super) hints: Vec<Vector>,
    /// The set of registers that are best for nodes to come.
    pub(super) reserved: u16,
}

impl<'a> Registers<'a> {
    pub(super) fn new(
        code: &'a mut Assembler,
        frame: &'a mut Frame,
        region: &'a Region,
        scalar: bool,
    ) -> Self {
        let count = region.nodes.len();
        let live = region.live_nodes();
        let for_each_use = |visit: &mut dyn FnMut(NodeId, u32)| {
            for (at, item) in (0..).zip(&region.items) {
                region.for_each_operand(item, &live, &mut |node| visit(node, at));
            }
        };
        let mut first_use = vec![0; count + 1];
        for_each_use(&mut |node, _| first_use[node as usize + 1] += 1);
        for node in 0..count {
            first_use[node + 1] += first_use[node];
        }
        let mut uses = vec![0; first_use[count] as usize];
        let mut next_use = first_use.clone();
        for_each_use(&mut |node, at| {
            uses[next_use[node as usize] as usize] = at;
            next_use[node as usize] += 1;
        });
        next_use.copy_from_slice(&first_use);
        let mut row_nodes: Map<TableRow, Vec<NodeId>> = Map::default();
        for (id, node) in region.nodes.iter().enumerate().rev() {
            if let Action::Row(row) = node.action {
                row_nodes.entry(row).or_default().push(id as NodeId);
            }
        }
        Self {
            code,
            frame,
            region,
            scalar,
            held: [NO_NODE; REGISTERS],
            register_of: vec![NO_REGISTER; count],
            slots: vec![NO_SLOT; count],
            free_slots: Vec::new(),
            pending_slots: Vec::new(),
            slot_count: 0,
            uses,
            first_use,
            next_use,
            stale: vec![false; count],
            row_nodes,
            guards: Vec::new(),
            hints: vec![NO_REGISTER; count],
            reserved: 0,
        }
    }

    pub(super) fn items(mut self) -> Option<()> {
        for (at, item) in (0..).zip(&self.region.items) {
            self.free_slots.append(&mut self.pending_slots);
            match item {
                Item::Compute(node) => {
                    // Nodes without uses are not computed.
                    if self.next(*node) != NEVER {
                        self.compute(*node, at);
                    }
                }
                Item::Store(row, node, before) => {
                    let register = self.load(*node, 0);
                    self.keep_old(*row, *before, at, 1 << register);
                    self.store(*row, *node, register);
                    self.used(*node, at);
                }
                Item::Guard(guard) => self.begin_guard(guard, at),
                Item::EndGuard(start) => self.end_guard(self.region.merges(*start), at),
                Item::Note(node, site) => self.note(*node, *site, at),
            }
            if self.slot_count > MAX_SLOTS {
                return None;
            }
        }
        self.frame.slots = self.frame.slots.max(self.slot_count);
        Some(())
    }

    /// The item that uses a node next.
    pub(super) fn next(&self, node: NodeId) -> u32 {
        let node = node as usize;
        if self.next_use[node] < self.first_use[node + 1] {
            self.uses[self.next_use[node] as usize]
        } else {
            NEVER
        }
    }

    /// Whether a node is used after an item.
    pub(super) fn is_used_after(&self, node: NodeId, at: u32) -> bool {
        let end = self.first_use[node as usize + 1] as usize;
        self.uses[self.next_use[node as usize] as usize..end]
            .last()
            .is_some_and(|&last| last > at)
    }

    /// Passes the uses of a node by an item; frees what it occupies if there are no more.
    pub(super) fn used(&mut self, node: NodeId, at: u32) {
        let index = node as usize;
        while self.next(node) <= at {
            self.next_use[index] += 1;
        }
        if self.next(node) == NEVER {
            if self.register_of[index] != NO_REGISTER {
                self.held[usize::from(self.register_of[index])] = NO_NODE;
                self.register_of[index] = NO_REGISTER;
            }
            self.free_slot(node);
        }
    }

    pub(super) fn drop_operands(&mut self, node: NodeId, at: u32) {
        for operand in self.region.nodes[node as usize].operands {
            if operand != NO_NODE {
                self.used(operand, at);
            }
        }
    }

    pub(super) fn free_slot(&mut self, node: NodeId) {
        let slot = std::mem::replace(&mut self.slots[node as usize], NO_SLOT);
        if slot != NO_SLOT {
            self.pending_slots.push(slot);
        }
    }

    pub(super) fn slot(&self, slot: u32) -> Memory {
        Memory::at(RSP, SPILLED + slot as i32 * self.frame.vectors.bytes())
    }

    /// Whether a node can be loaded again at any time.
    pub(super) fn is_reloadable(&self, node: NodeId) -> bool {
        self.slots[node as usize] != NO_SLOT
            || (self.region.nodes[node as usize].is_lazy() && !self.stale[node as usize])
    }

    /// Returns a register that is not among those of a set, and makes it free.
    pub(super) fn free_register(&mut self, keep: u16) -> Vector {
        let is_free = |register: &usize| self.held[*register] == NO_NODE && keep >> register & 1 == 0;
        let is_reserved = |register: &usize| self.reserved >> register & 1 != 0;
        let mut free = (0..REGISTERS).filter(is_free);
        if let Some(register) = free
            .clone()
            .find(|register| !is_reserved(register))
            .or(free.next())
        {
            return register as Vector;
        }
        let mut best = (0, 0);
        for register in (0..REGISTERS).filter(|register| keep >> register & 1 == 0) {
            let node = self.held[register];
            let next = self.next(node);
            if next >= best.1 {
                best = (register, next);
            }
        }
        let (register, _) = best;
        let node = self.held[register];
        if !self.is_reloadable(node) {
            let slot = self.free_slots.pop().unwrap_or_else(|| {
                self.slot_count += 1;
                self.slot_count - 1
            });
            self.slots[node as usize] = slot;
            let to = Source::Memory(self.slot(slot));
            self.code.unary(op::VMOVAPS_STORE, true, register as Vector, to);
        }
        self.register_of[node as usize] = NO_REGISTER;
        self.held[register] = NO_NODE;
        register as Vector
    }

    pub(super) fn hold(&mut self, node: NodeId, register: Vector) {
        self.held[usize::from(register)] = node;
        self.register_of[node as usize] = register;
    }

    /// Returns the register of a node, and loads it if it is in none.
    pub(super) fn load(&mut self, node: NodeId, keep: u16) -> Vector {
        let register = self.register_of[node as usize];
        if register != NO_REGISTER {
            return register;
        }
        let register = self.free_register(keep);
        self.load_into(node, register);
        self.hold(node, register);
        register
    }

    pub(super) fn load_into(&mut self, node: NodeId, register: Vector) {
        let slot = self.slots[node as usize];
        let wide = self.region.nodes[node as usize].wide;
        if slot != NO_SLOT {
            let from = Source::Memory(self.slot(slot));
            self.code.unary(op::VMOVAPS, true, register, from);
            return;
        }
        match self.region.nodes[node as usize].action {
            Action::Row(row) if self.scalar => {
                let (memory, is_long) = self.scalar_place(row);
                let opcode = if is_long { op::VMOVSD } else { op::VMOVSS };
                self.code.unary(opcode, false, register, Source::Memory(memory));
            }
            Action::Row(row) => {
                let from = Source::Memory(place(self.frame, row));
                self.code.unary(op::VMOVAPS, wide, register, from);
            }
            Action::Scalar(kind, scalar) => {
                let table = match kind {
                    Kind::Float => Table::Float,
                    Kind::Word => Table::Word,
                };
                let (memory, is_long) = self.scalar_place((table, scalar));
                let opcode = if is_long {
                    op::VBROADCASTSD
                } else {
                    op::VBROADCASTSS
                };
                self.code.unary(opcode, wide, register, Source::Memory(memory));
            }
            Action::Constant(constant) => {
                let from = Source::Memory(Memory::Constant(constant));
                self.code.unary(op::VMOVAPS, wide, register, from);
            }
            _ => {}
        }
    }

    /// The place of a scalar, and whether it has 64 bits.
    pub(super) fn scalar_place(&self, (table, scalar): TableRow) -> (Memory, bool) {
        let is_long = table == Table::Float && self.frame.precision.is_double();
        let base = if table == Table::Float {
            FLOAT_SCALARS
        } else {
            WORD_SCALARS
        };
        let size = if is_long { 8 } else { 4 };
        (Memory::at(base, scalar as i32 * size), is_long)
    }

    /// Returns an operand that may stay in memory, if it is used only once more.
    pub(super) fn source(&mut self, node: NodeId, at: u32, keep: u16) -> Source {
        let index = node as usize;
        if self.register_of[index] == NO_REGISTER {
            let slot = self.slots[index];
            let is_last = !self.is_used_after(node, at);
            let memory = match self.region.nodes[index].action {
                Action::Constant(constant) => Some(Memory::Constant(constant)),
                _ if slot != NO_SLOT && is_last => Some(self.slot(slot)),
                Action::Row(row) if is_last && !self.scalar && !self.stale[index] => {
                    Some(place(self.frame, row))
                }
                _ => None,
            };
            if let Some(memory) = memory {
                return Source::Memory(memory);
            }
        }
        Source::Register(self.load(node, keep))
    }

    pub(super) fn compute(&mut self, id: NodeId, at: u32) {
        let node = self.region.nodes[id as usize];
        let [a, b, c] = node.operands;
        let wide = node.wide;
        let bit = |register: Vector| 1_u16 << register;
        match node.action {
            Action::Unary(opcode) => {
                let source = self.source(a, at, 0);
                let to = self.result(id, at);
                self.code.unary(opcode, wide, to, source);
            }
            Action::UnaryImmediate(opcode, immediate) => {
                let source = self.source(a, at, 0);
                let to = self.result(id, at);
                self.code.unary_immediate(opcode, wide, to, source, immediate);
            }
            Action::Binary(opcode) => {
                let first = self.load(a, self.bit_held(b));
                let second = self.source(b, at, bit(first));
                let to = self.result(id, at);
                self.code.binary(opcode, wide, to, first, second);
            }
            Action::BinaryImmediate(opcode, immediate) => {
                let first = self.load(a, self.bit_held(b));
                let second = self.source(b, at, bit(first));
                let to = self.result(id, at);
                self.code
                    .binary_immediate(opcode, wide, to, first, second, immediate);
            }
            Action::Blend(opcode) => {
                let no = self.load(a, self.bit_held(b) | self.bit_held(c));
                let mask = self.load(c, bit(no) | self.bit_held(b));
                let yes = self.source(b, at, bit(no) | bit(mask));
                let to = self.result(id, at);
                self.code.blend(opcode, wide, to, no, yes, mask);
            }
            Action::ShiftRight(count) => {
                let from = self.load(a, 0);
                let to = self.result(id, at);
                self.code.shift(wide, op::SHIFT_RIGHT, to, from, count);
            }
            Action::Narrow => {
                let from = self.load(a, 0);
                let to = self.result(id, at);
                self.code.narrow(to, from, SCRATCH);
            }
            Action::Merge => {
                let source = self.source(a, at, 0);
                self.drop_operands(id, at);
                let to = self.hinted(id).unwrap_or_else(|| match source {
                    Source::Register(from) if self.held[usize::from(from)] == NO_NODE => from,
                    _ => self.free_register(0),
                });
                self.hold(id, to);
                self.copy(wide, to, source);
            }
            Action::Row(_) | Action::Scalar(..) | Action::Constant(_) => {}
        }
    }

    pub(super) fn copy(&mut self, wide: bool, to: Vector, source: Source) {
        if !matches!(source, Source::Register(from) if from == to) {
            self.code.unary(op::VMOVAPS, wide, to, source);
        }
    }

    /// The set of the register of a node.
    pub(super) fn bit_held(&self, node: NodeId) -> u16 {
        match self.register_of[node as usize] {
            NO_REGISTER => 0,
            register => 1 << register,
        }
    }

    /// Passes the operands of a node, and returns a register for its result, which may be that of an operand.
    pub(super) fn result(&mut self, id: NodeId, at: u32) -> Vector {
        self.drop_operands(id, at);
        let register = self.hinted(id).unwrap_or_else(|| self.free_register(0));
        self.hold(id, register);
        register
    }

    /// Returns the register that is best for a node, if it is free.
    pub(super) fn hinted(&self, node: NodeId) -> Option<Vector> {
        let hint = self.hints[node as usize];
        (hint != NO_REGISTER && self.held[usize::from(hint)] == NO_NODE).then_some(hint)
    }

    /// Loads the nodes that need the content of a row which is about to change.
    pub(super) fn keep_old(&mut self, row: TableRow, before: NodeId, at: u32, keep: u16) {
        let Some(mut nodes) = self.row_nodes.remove(&row) else {
            return;
        };
        while let Some(node) = nodes.pop_if(|node| *node < before) {
            if self.is_used_after(node, at) && !self.stale[node as usize] {
                if self.slots[node as usize] == NO_SLOT {
                    self.load(node, keep);
                }
                self.stale[node as usize] = true;
            }
        }
        self.row_nodes.insert(row, nodes);
    }

    pub(super) fn store(&mut self, row: TableRow, node: NodeId, register: Vector) {
        if self.scalar {
            let (memory, is_long) = self.scalar_place(row);
            let opcode = if is_long {
                op::VMOVSD_STORE
            } else {
                op::VMOVSS_STORE
            };
            self.code.unary(opcode, false, register, Source::Memory(memory));
            return;
        }
        let wide = self.region.nodes[node as usize].wide;
        // Conversions from f64 have half the width of their operand.
        let wide = if row.0 == Table::Float {
            wide
        } else {
            !self.frame.precision.is_double()
        };
        let to = Source::Memory(place(self.frame, row));
        self.code.unary(op::VMOVAPS_STORE, wide, register, to);
    }

    pub(super) fn note(&mut self, node: NodeId, site: u32, at: u32) {
        let register = self.load(node, 0);
        let wide = self.region.nodes[node as usize].wide;
        let (entry, back) = (self.code.label(), self.code.label());
        self.code.test(wide, register);
        self.code.jump_if(Condition::NotZero, entry);
        self.code.bind(back);
        self.frame.notes.push(Note {
            entry,
            back,
            register,
            site,
        });
        self.used(node, at);
    }
}
