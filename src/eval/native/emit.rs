//! Emission of a region: registers are assigned to nodes, and items become instructions.
//!
//! Nodes are kept in the sixteen vector registers; if none is free, the node whose next use is farthest away
//! is moved to the stack (Belady, “A Study of Replacement Algorithms for a Virtual-Storage Computer”, IBM
//! Systems Journal 5(2), 1966).

mod guard;

use self::guard::Snapshot;
use super::assemble::{
    Arithmetic, Assembler, Condition, Gpr, Label, Memory, R8, R9, R12, R13, R14, R15, RAX, RBP, RBX, RCX,
    RDX, RSI, RSP, Source, Vector, Vectors, op,
};
use super::node::{Action, Bank, Item, NO_NODE, NodeId, Precision, Region, Row};
use super::run::offsets;
use crate::ir::Kind;
use crate::opt::gvn::log::Map;

/// The base registers of the tables in memory, which stay the same.
pub(super) const FLOATS: Gpr = RBX;
pub(super) const WORDS: Gpr = RBP;
pub(super) const MASKS: Gpr = R12;
pub(super) const FLOAT_SCALARS: Gpr = R13;
pub(super) const WORD_SCALARS: Gpr = R14;
pub(super) const CONTEXT: Gpr = R15;

/// The offset of the vector's words from the start of their row.
const OFFSET: Gpr = RCX;
/// The offset at which the chunk ends.
const CHUNK_END: Gpr = RDX;
/// A bit for each chunk that is left.
const CHUNKS: Gpr = R8;
const ITERATIONS: Gpr = RSI;

/// The bytes of the words of a chunk.
const CHUNK_BYTES: i32 = 64;

/// The stack frame: accumulators of masks, then the caller's stack pointer, then spilled vectors.
pub(super) const SAVED_STACK: i32 = 248;
const SPILLED: i32 = 256;
/// The number of accumulators.
const MAX_MASKS: usize = 62;
/// The number of vectors that may be spilled.
const MAX_SLOTS: u32 = 512;

/// The number of registers that nodes may take; the last one is for sequences of instructions.
const REGISTERS: usize = 15;
const SCRATCH: Vector = 15;

/// A vector with pixels to note.
pub(super) struct Note {
    pub(super) entry: Label,
    pub(super) back: Label,
    pub(super) register: Vector,
    pub(super) site: u32,
}

/// What regions of a program share.
pub(super) struct Frame {
    pub(super) precision: Precision,
    pub(super) vectors: Vectors,
    /// The number of chunks in a row.
    pub(super) width: u32,
    /// The number of vectors that were spilled at once.
    pub(super) slots: u32,
    pub(super) notes: Vec<Note>,
}

impl Frame {
    /// The bytes of the stack frame.
    pub(super) fn stack_bytes(&self) -> i32 {
        SPILLED + self.slots as i32 * self.vectors.bytes()
    }

    /// The bytes of the words of a vector.
    fn step(&self) -> i32 {
        let bytes = self.vectors.bytes();
        if self.precision.is_double() {
            bytes / 2
        } else {
            bytes
        }
    }
}

/// Emits the loop over the vectors of a region, for the chunks of a mask. None if it needs too much memory.
pub(super) fn emit_region(code: &mut Assembler, frame: &mut Frame, region: &Region, base: u32) -> Option<()> {
    if region.items.is_empty() {
        return Some(());
    }
    if region.masks.len() > MAX_MASKS {
        return None;
    }
    let (done, next_chunk, next_vector, skip) = (code.label(), code.label(), code.label(), code.label());
    for at in 0..region.masks.len() {
        code.store_immediate32(Memory::at(RSP, 4 * at as i32), 0);
    }
    let uses_iterations = |item: &Item| matches!(item, Item::Store((Bank::Iterations, _), ..));
    if region.items.iter().any(uses_iterations) {
        code.load64(ITERATIONS, Memory::at(CONTEXT, offsets::OWN_ITERATIONS));
    }
    if base == 0 {
        code.immediate32(CHUNKS, u32::MAX >> (32 - frame.width));
    } else {
        code.load64(RAX, Memory::at(CONTEXT, offsets::ACTIVE));
        code.load32(CHUNKS, Memory::at(RAX, 8 * base as i32));
        code.arithmetic32(Arithmetic::Or, CHUNKS, Source::Register(CHUNKS.0));
        code.jump_if(Condition::Zero, done);
    }
    code.bind(next_chunk);
    code.lowest_bit32(OFFSET, CHUNKS);
    code.shift_left32(OFFSET, 6);
    code.address(CHUNK_END, Memory::at(OFFSET, CHUNK_BYTES));
    code.bind(next_vector);
    // Vectors without active pixels leave no trace, unless masks are made from nothing.
    if base != 0 && region.items.len() > 12 && region.masks.iter().all(|&mask| mask <= base) {
        let row = place(frame, (Bank::Mask, base));
        let wide = !frame.precision.is_double();
        code.unary(op::VMOVAPS, wide, SCRATCH, Source::Memory(row));
        code.test(wide, SCRATCH);
        code.jump_if(Condition::Zero, skip);
    }
    Registers::new(code, frame, region, false).items()?;
    code.bind(skip);
    let step = frame.step();
    code.arithmetic_immediate32(Arithmetic::Add, Source::Register(OFFSET.0), step as u32);
    code.arithmetic32(Arithmetic::Compare, OFFSET, Source::Register(CHUNK_END.0));
    code.jump_if(Condition::NotZero, next_vector);
    // Which masks have pixels in this chunk.
    if !region.masks.is_empty() {
        code.arithmetic32(Arithmetic::Xor, R9, Source::Register(R9.0));
        code.arithmetic32(Arithmetic::Sub, R9, Source::Register(CHUNKS.0));
        code.arithmetic32(Arithmetic::And, R9, Source::Register(CHUNKS.0));
    }
    for (at, &mask) in (0..).zip(&region.masks) {
        // By vectors as long as those that were stored: longer ones would wait until these are in the cache.
        let wide = !frame.precision.is_double();
        let end = mask as i32 * CHUNK_BYTES * frame.width as i32;
        for (at, start) in (end - CHUNK_BYTES..end).step_by(step as usize).enumerate() {
            let part = Source::Memory(place_at(MASKS, 0, start));
            if at == 0 {
                code.unary(op::VMOVAPS, wide, SCRATCH, part);
            } else {
                code.binary(op::VPOR, wide, SCRATCH, SCRATCH, part);
            }
        }
        code.arithmetic32(Arithmetic::Xor, RAX, Source::Register(RAX.0));
        code.test(wide, SCRATCH);
        code.copy_if(Condition::NotZero, RAX, R9);
        code.arithmetic_memory32(Arithmetic::Or, Memory::at(RSP, 4 * at), RAX);
    }
    // Clears the lowest bit.
    code.address(RAX, Memory::at(CHUNKS, -1));
    code.arithmetic32(Arithmetic::And, CHUNKS, Source::Register(RAX.0));
    code.jump_if(Condition::NotZero, next_chunk);
    code.bind(done);
    if !region.masks.is_empty() {
        code.load64(RDX, Memory::at(CONTEXT, offsets::ACTIVE));
        if base == 0 {
            code.immediate32(R9, u32::MAX >> (32 - frame.width));
        } else {
            code.load32(R9, Memory::at(RDX, 8 * base as i32));
        }
        code.not32(R9);
    }
    // Masks around the base may be changed, so that it is read before.
    for (at, &mask) in (0..).zip(&region.masks) {
        let chunks = Memory::at(RDX, 8 * mask as i32);
        code.load32(RAX, Memory::at(RSP, 4 * at));
        if mask <= base {
            code.load32(OFFSET, chunks);
            code.arithmetic32(Arithmetic::And, OFFSET, Source::Register(R9.0));
            code.arithmetic32(Arithmetic::Or, RAX, Source::Register(OFFSET.0));
        } else {
            code.store_immediate32(Memory::at(RDX, 8 * mask as i32 + 4), 0);
        }
        code.store32(chunks, RAX);
    }
    Some(())
}

/// Emits a sequence of operations on scalars.
pub(super) fn emit_scalars(code: &mut Assembler, frame: &mut Frame, region: &Region) -> Option<()> {
    Registers::new(code, frame, region, true).items()
}

fn place_at(base: Gpr, scale: u8, displacement: i32) -> Memory {
    Memory::At {
        base,
        index: Some((OFFSET, scale)),
        displacement,
    }
}

/// The place of a vector in a row.
fn place(frame: &Frame, (bank, row): Row) -> Memory {
    let row = row as i32 * CHUNK_BYTES * frame.width as i32;
    match bank {
        Bank::Float if frame.precision.is_double() => place_at(FLOATS, 1, 2 * row),
        Bank::Float => place_at(FLOATS, 0, row),
        Bank::Word => place_at(WORDS, 0, row),
        Bank::Mask => place_at(MASKS, 0, row),
        Bank::Iterations => place_at(ITERATIONS, 0, row),
    }
}

const NO_REGISTER: u8 = u8::MAX;
const NO_SLOT: u32 = u32::MAX;
const NEVER: u32 = u32::MAX;

struct Registers<'a> {
    code: &'a mut Assembler,
    frame: &'a mut Frame,
    region: &'a Region,
    scalar: bool,
    /// The node in each register.
    held: [NodeId; REGISTERS],
    /// The register of each node.
    register_of: Vec<u8>,
    /// The place of each spilled node on the stack.
    slots: Vec<u32>,
    free_slots: Vec<u32>,
    /// Slots that are free after the item, which may still read them.
    pending_slots: Vec<u32>,
    slot_count: u32,
    /// The items that use each node, in order; those of node `n` begin at `first_use[n]`.
    uses: Vec<u32>,
    first_use: Vec<u32>,
    /// The use of each node that comes next.
    next_use: Vec<u32>,
    /// Whether a node cannot be loaded again, although it is lazy: its row has changed.
    stale: Vec<bool>,
    /// The nodes that load each row, in order, latest first.
    row_nodes: Map<Row, Vec<NodeId>>,
    guards: Vec<Snapshot>,
    /// The register that is best for each node.
    hints: Vec<Vector>,
    /// The set of registers that are best for nodes to come.
    reserved: u16,
}

impl<'a> Registers<'a> {
    fn new(code: &'a mut Assembler, frame: &'a mut Frame, region: &'a Region, scalar: bool) -> Self {
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
        let mut row_nodes: Map<Row, Vec<NodeId>> = Map::default();
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

    fn items(mut self) -> Option<()> {
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
    fn next(&self, node: NodeId) -> u32 {
        let node = node as usize;
        if self.next_use[node] < self.first_use[node + 1] {
            self.uses[self.next_use[node] as usize]
        } else {
            NEVER
        }
    }

    /// Whether a node is used after an item.
    fn is_used_after(&self, node: NodeId, at: u32) -> bool {
        let end = self.first_use[node as usize + 1] as usize;
        self.uses[self.next_use[node as usize] as usize..end]
            .last()
            .is_some_and(|&last| last > at)
    }

    /// Passes the uses of a node by an item; frees what it occupies if there are no more.
    fn used(&mut self, node: NodeId, at: u32) {
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

    fn drop_operands(&mut self, node: NodeId, at: u32) {
        for operand in self.region.nodes[node as usize].operands {
            if operand != NO_NODE {
                self.used(operand, at);
            }
        }
    }

    fn free_slot(&mut self, node: NodeId) {
        let slot = std::mem::replace(&mut self.slots[node as usize], NO_SLOT);
        if slot != NO_SLOT {
            self.pending_slots.push(slot);
        }
    }

    fn slot(&self, slot: u32) -> Memory {
        Memory::at(RSP, SPILLED + slot as i32 * self.frame.vectors.bytes())
    }

    /// Whether a node can be loaded again at any time.
    fn is_reloadable(&self, node: NodeId) -> bool {
        self.slots[node as usize] != NO_SLOT
            || (self.region.nodes[node as usize].is_lazy() && !self.stale[node as usize])
    }

    /// Returns a register that is not among those of a set, and makes it free.
    fn free_register(&mut self, keep: u16) -> Vector {
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

    fn hold(&mut self, node: NodeId, register: Vector) {
        self.held[usize::from(register)] = node;
        self.register_of[node as usize] = register;
    }

    /// Returns the register of a node, and loads it if it is in none.
    fn load(&mut self, node: NodeId, keep: u16) -> Vector {
        let register = self.register_of[node as usize];
        if register != NO_REGISTER {
            return register;
        }
        let register = self.free_register(keep);
        self.load_into(node, register);
        self.hold(node, register);
        register
    }

    fn load_into(&mut self, node: NodeId, register: Vector) {
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
                let bank = match kind {
                    Kind::Float => Bank::Float,
                    Kind::Word => Bank::Word,
                };
                let (memory, is_long) = self.scalar_place((bank, scalar));
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
    fn scalar_place(&self, (bank, scalar): Row) -> (Memory, bool) {
        let is_long = bank == Bank::Float && self.frame.precision.is_double();
        let base = if bank == Bank::Float {
            FLOAT_SCALARS
        } else {
            WORD_SCALARS
        };
        let size = if is_long { 8 } else { 4 };
        (Memory::at(base, scalar as i32 * size), is_long)
    }

    /// Returns an operand that may stay in memory, if it is used only once more.
    fn source(&mut self, node: NodeId, at: u32, keep: u16) -> Source {
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

    fn compute(&mut self, id: NodeId, at: u32) {
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

    fn copy(&mut self, wide: bool, to: Vector, source: Source) {
        if !matches!(source, Source::Register(from) if from == to) {
            self.code.unary(op::VMOVAPS, wide, to, source);
        }
    }

    /// The set of the register of a node.
    fn bit_held(&self, node: NodeId) -> u16 {
        match self.register_of[node as usize] {
            NO_REGISTER => 0,
            register => 1 << register,
        }
    }

    /// Passes the operands of a node, and returns a register for its result, which may be that of an operand.
    fn result(&mut self, id: NodeId, at: u32) -> Vector {
        self.drop_operands(id, at);
        let register = self.hinted(id).unwrap_or_else(|| self.free_register(0));
        self.hold(id, register);
        register
    }

    /// Returns the register that is best for a node, if it is free.
    fn hinted(&self, node: NodeId) -> Option<Vector> {
        let hint = self.hints[node as usize];
        (hint != NO_REGISTER && self.held[usize::from(hint)] == NO_NODE).then_some(hint)
    }

    /// Loads the nodes that need the content of a row which is about to change.
    fn keep_old(&mut self, row: Row, before: NodeId, at: u32, keep: u16) {
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

    fn store(&mut self, row: Row, node: NodeId, register: Vector) {
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
        let wide = if row.0 == Bank::Float {
            wide
        } else {
            !self.frame.precision.is_double()
        };
        let to = Source::Memory(place(self.frame, row));
        self.code.unary(op::VMOVAPS_STORE, wide, register, to);
    }

    fn note(&mut self, node: NodeId, site: u32, at: u32) {
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
