//! Regions of a program, and the jumps at their ends.

use toyproof_eval::native::{LoweredCode, Step};

use super::{Refuel, Writer};
use crate::x86_64::assemble::{Arithmetic, Condition, Memory, RAX, Source};
use crate::x86_64::context::offset;
use crate::x86_64::emit::{self, CONTEXT};
use crate::x86_64::lift::Lifter;
use crate::x86_64::plan::Class;

/// A region ends after this number of nodes.
const MAX_NODES: usize = 8_000;

impl Writer<'_> {
    /// Checks the limits from time to time, and counts an iteration of all pixels.
    fn iterate(&mut self, at: u32) {
        let (entry, back) = (self.code.label(), self.code.label());
        let instruction = self.positions[at as usize];
        self.refuels.push(Refuel {
            entry,
            back,
            instruction,
        });
        self.code.load64(RAX, Memory::at(CONTEXT, offset!(tables.fuel)));
        let fuel = Source::Memory(Memory::at(RAX, 0));
        self.code.arithmetic_immediate32(Arithmetic::Sub, fuel, 1);
        self.code.jump_if(Condition::Below, entry);
        self.code.bind(back);
        if self.mask(at) == Some(0) {
            self.code
                .load64(RAX, Memory::at(CONTEXT, offset!(tables.iterations)));
            let iterations = Source::Memory(Memory::at(RAX, 0));
            self.code.arithmetic_immediate32(Arithmetic::Add, iterations, 1);
        }
    }

    /// Emits a region and the jump at its end; returns the next step.
    pub(super) fn region(&mut self, start: u32) -> Option<u32> {
        let (lowered, plan) = (self.lowered, self.plan);
        let base = self.mask(start)?;
        let mut lifter = Lifter::new(lowered, plan, self.frame.precision, false, &mut self.pool);
        let (mut hoisted, mut iterations) = (Vec::new(), Vec::new());
        let mut branch = None;
        let mut at = start;
        while lifter.size() <= MAX_NODES && (at == start || !plan.targets[at as usize]) {
            let Some((_, mask)) = lowered.linear.steps.get(at as usize) else {
                break;
            };
            match plan.classes[at as usize] {
                Class::Nothing => at += 1,
                Class::Scalar | Class::ScalarCall => {
                    hoisted.push(at);
                    at += 1;
                }
                _ if u32::from(mask.0) < base => break,
                Class::Vector => {
                    let next = lifter.lift(at);
                    hoisted.extend((at + 1..next).filter(|&inner| {
                        matches!(plan.classes[inner as usize], Class::Scalar | Class::ScalarCall)
                    }));
                    at = next;
                }
                Class::Branch => {
                    lifter.step(at);
                    branch = Some(at);
                    at += 1;
                    break;
                }
                // Iterations of all pixels are counted before the region, those of some in it.
                Class::Control if matches!(lowered.linear.steps[at as usize].0, Step::Iterate(_)) => {
                    iterations.push(at);
                    if mask.0 != 0 {
                        lifter.step(at);
                    }
                    at += 1;
                }
                Class::Control | Class::ScalarStore | Class::Call => break,
            }
        }
        let jump = branch.and_then(|branch| jump_of(lowered, branch));
        let mask_at = |at: u32| {
            let step = lowered.linear.steps.get(at as usize);
            step.map(|(_, mask)| u32::from(mask.0))
        };
        let last_mask = mask_at(at).max(jump.and_then(|(_, to)| mask_at(to)));
        let region = lifter.finish(at, last_mask);
        for at in iterations {
            self.iterate(at);
        }
        self.hoisted(&hoisted)?;
        emit::emit_region(&mut self.code, &mut self.frame, &region, base)?;
        if let Some((mask, to)) = jump {
            self.code.load64(RAX, Memory::at(CONTEXT, offset!(tables.active)));
            let chunks = Source::Memory(Memory::at(RAX, 8 * mask as i32));
            self.code.arithmetic_immediate32(Arithmetic::Compare, chunks, 0);
            self.code.jump_if(Condition::Zero, self.label(to));
        }
        Some(at)
    }

    /// Emits the steps on scalars of a region.
    fn hoisted(&mut self, steps: &[u32]) -> Option<()> {
        let is_call = |&at: &u32| self.plan.classes[at as usize] == Class::ScalarCall;
        let runs: Vec<&[u32]> = steps.chunk_by(|a, b| is_call(a) == is_call(b)).collect();
        for run in runs {
            if is_call(&run[0]) {
                for &at in run {
                    self.calls(at..at + 1);
                }
            } else {
                self.scalars(run.iter().copied())?;
            }
        }
        Some(())
    }
}

/// Returns the mask that a jump tests, and its target.
fn jump_of(lowered: &LoweredCode, at: u32) -> Option<(u32, u32)> {
    let (step, mask) = &lowered.linear.steps[at as usize];
    match *step {
        Step::Split { first, if_empty, .. } => Some((u32::from(first.0), if_empty)),
        Step::Remove { if_empty, .. } | Step::JumpIfEmpty(if_empty) => Some((u32::from(mask.0), if_empty)),
        _ => None,
    }
}
