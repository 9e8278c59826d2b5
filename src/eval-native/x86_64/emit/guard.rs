//! Registers hold the same values whether a guard is taken or skipped; its end assigns the merges (phis).

use super::frame::{REGISTERS, SCRATCH};
use super::registers::{NO_REGISTER, NO_SLOT, Registers};
use crate::x86_64::assemble::{Condition, Label, Source, Vector};
use crate::x86_64::node::{Guard, NO_NODE, NodeId};
use crate::x86_64::op;

/// The state at the start of a guard, which its end restores.
pub(super) struct Snapshot {
    held: [NodeId; REGISTERS],
    slots: [u32; REGISTERS],
    reserved: u16,
    end: Label,
}

/// A node to be moved to a register, from another or [`NO_REGISTER`].
#[derive(Debug, Clone, Copy)]
struct Move {
    to: Vector,
    from: Vector,
    node: NodeId,
}

impl Registers<'_> {
    /// Skips the items up to the end of a guard if its mask is empty.
    pub(super) fn begin_guard(&mut self, guard: &Guard, at: u32) {
        let register = self.load(guard.mask, 0);
        for &row in &guard.rows {
            self.keep_old(row, guard.before, at, 1 << register);
        }
        let end = self.code.label();
        let wide = self.region.nodes[guard.mask as usize].wide;
        self.code.test(wide, register);
        self.code.jump_if(Condition::Zero, end);
        self.used(guard.mask, at);
        let slots = self.held.map(|node| match node {
            NO_NODE => NO_SLOT,
            node => self.slots[node as usize],
        });
        self.guards.push(Snapshot {
            held: self.held,
            slots,
            reserved: self.reserved,
            end,
        });
        // The registers of merges are free until the end assigns to them, and best used for what it assigns.
        for &[merge, last] in &guard.merges {
            let register = self.register_of[merge as usize];
            if register != NO_REGISTER {
                self.held[usize::from(register)] = NO_NODE;
                self.register_of[merge as usize] = NO_REGISTER;
                self.hints[last as usize] = register;
                self.reserved |= 1 << register;
            }
        }
    }

    /// Ends the last guard: assigns its merges, and restores the registers that it began with.
    pub(super) fn end_guard(&mut self, merges: &[[NodeId; 2]], at: u32) {
        let Some(Snapshot {
            held,
            slots,
            reserved,
            end,
        }) = self.guards.pop()
        else {
            return;
        };
        self.reserved = reserved;
        let needed = merges.iter().filter(|[merge, _]| self.is_used_after(*merge, at));
        let needed: Vec<[NodeId; 2]> = needed.copied().collect();
        let mut moves = Vec::new();
        for &[merge, last] in &needed {
            let from = self.register_of[last as usize];
            if let Some(to) = held.iter().position(|&node| node == merge) {
                moves.push(Move {
                    to: to as Vector,
                    from,
                    node: last,
                });
            } else {
                let from = if from == NO_REGISTER {
                    self.load_into(last, SCRATCH);
                    SCRATCH
                } else {
                    from
                };
                let to = Source::Memory(self.slot(self.slots[merge as usize]));
                self.code.unary(op::VMOVAPS_STORE, true, from, to);
            }
        }
        for Move { to, from, node } in in_order(moves) {
            if from == NO_REGISTER {
                self.load_into(node, to);
            } else {
                self.copy(true, to, Source::Register(from));
            }
        }
        let mut current = std::mem::replace(&mut self.held, [NO_NODE; REGISTERS]);
        for node in current.into_iter().filter(|&node| node != NO_NODE) {
            self.register_of[node as usize] = NO_REGISTER;
        }
        for &[merge, last] in &needed {
            if let Some(register) = held.iter().position(|&node| node == merge) {
                current[register] = merge;
                self.free_slot(merge);
            }
            self.used(last, at);
            self.used(merge, at);
        }
        for register in 0..REGISTERS {
            let node = held[register];
            if node == NO_NODE || !self.is_used_after(node, at) {
                continue;
            }
            if current[register] != node {
                self.load_into(node, register as Vector);
            }
            self.hold(node, register as Vector);
            // Where the guard was skipped, nothing was spilled in it.
            if slots[register] == NO_SLOT {
                self.free_slot(node);
            }
        }
        self.code.bind(end);
    }
}

/// Orders moves so that no register is overwritten before it has been moved. Cycles are cut by a move to
/// [`SCRATCH`].
fn in_order(mut moves: Vec<Move>) -> Vec<Move> {
    let mut ordered = Vec::with_capacity(moves.len() + 1);
    while let Some(&first) = moves.first() {
        let is_free = |to: Vector| moves.iter().all(|other| other.to == to || other.from != to);
        if let Some(ready) = moves.iter().position(|one| is_free(one.to)) {
            ordered.push(moves.swap_remove(ready));
            continue;
        }
        // All are in cycles.
        let from = first.to;
        ordered.push(Move {
            to: SCRATCH,
            from,
            ..first
        });
        for other in moves.iter_mut().filter(|other| other.from == from) {
            other.from = SCRATCH;
        }
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallel_moves_equal_simultaneous_assignment() {
        for case in 0..4_u32.pow(4) {
            let sources = [0, 1, 2, 3].map(|at: u32| (case / 4_u32.pow(at) % 4) as Vector);
            let moves = (0..).zip(sources).map(|(to, from)| Move { to, from, node: 0 });
            let mut registers: Vec<Vector> = (0..=SCRATCH).collect();
            for Move { to, from, .. } in in_order(moves.collect()) {
                registers[usize::from(to)] = registers[usize::from(from)];
            }
            assert_eq!(registers[..4], sources);
        }
    }
}
