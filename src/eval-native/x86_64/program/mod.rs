//! Programs: a step becomes part of a vector region, scalar code, a call of its handler, or a jump.

mod entry;
mod region;

use std::ops::Range;

use toyproof_eval::native::{Location, LoweredCode, NativeInput, Step};

use super::assemble::{Arithmetic, Assembler, Condition, Label, Memory, RDX, RSI, Source, Vectors};
use super::emit::{self, Frame, WORD_SCALARS};
use super::lift::Lifter;
use super::node::{Pool, Precision};
use super::plan::{Class, Plan, plan};

/// Assembles a program; none if it has no machine code.
pub(super) fn assemble(input: NativeInput<'_>, vectors: Vectors, precision: Precision) -> Option<Vec<u8>> {
    let plan = plan(input.lowered)?;
    let mut code = Assembler::new(vectors);
    let labels = plan
        .targets
        .iter()
        .map(|&is_target| is_target.then(|| code.label()));
    let labels: Vec<Option<Label>> = labels.collect();
    let [exit, call, refuel, note] = [(); 4].map(|()| code.label());
    let mut writer = Writer {
        lowered: input.lowered,
        plan: &plan,
        positions: input.positions,
        pool: Pool::default(),
        frame: Frame {
            precision,
            vectors,
            width: input.width as u32,
            slots: 0,
            notes: Vec::new(),
        },
        code,
        labels,
        exit,
        call,
        refuel,
        refuels: Vec::new(),
    };
    let frame_size_at = writer.prologue();
    writer.steps()?;
    writer.epilogue(note);
    let stack = writer.frame.stack_bytes();
    writer.code.patch(frame_size_at, stack);
    Some(writer.code.finish(&writer.pool.constants))
}

/// Emits a program.
struct Writer<'a> {
    lowered: &'a LoweredCode,
    plan: &'a Plan,
    /// The first instruction of each step.
    positions: &'a [u32],
    pool: Pool,
    frame: Frame,
    code: Assembler,
    /// The labels of the steps that are jumped to.
    labels: Vec<Option<Label>>,
    /// The end of the program.
    exit: Label,
    /// Calls the handlers of a range of instructions.
    call: Label,
    /// Calls the check of the limits.
    refuel: Label,
    refuels: Vec<Refuel>,
}

/// A check of the limits: code after the steps, so that they are contiguous.
struct Refuel {
    /// Where the check begins.
    entry: Label,
    /// Where the program continues if no limit is exceeded.
    back: Label,
    /// The instruction at which the limits are checked.
    instruction: u32,
}

impl Writer<'_> {
    fn class(&self, at: u32) -> Option<Class> {
        self.plan.classes.get(at as usize).copied()
    }

    fn mask(&self, at: u32) -> Option<u32> {
        let step = self.lowered.linear.steps.get(at as usize);
        step.map(|(_, mask)| u32::from(mask.0))
    }

    fn steps(&mut self) -> Option<()> {
        let mut at = 0;
        loop {
            if let Some(label) = self.labels[at as usize] {
                self.code.bind(label);
            }
            let Some(class) = self.class(at) else { break };
            at = match class {
                Class::Nothing => at + 1,
                Class::Vector | Class::Branch => self.region(at)?,
                Class::Scalar | Class::ScalarStore => {
                    let end = self.end_of_run(at, [Class::Scalar, Class::ScalarStore]);
                    self.scalars(at..end)?;
                    end
                }
                Class::Call | Class::ScalarCall => {
                    let end = self.end_of_run(at, [Class::Call, Class::ScalarCall]);
                    self.calls(at..end);
                    end
                }
                Class::Control => self.control(at)?,
            };
        }
        Some(())
    }

    /// Returns the end of the consecutive steps, from one on, that are executed alike.
    fn end_of_run(&self, start: u32, classes: [Class; 2]) -> u32 {
        let mut at = start + 1;
        while !self.plan.targets[at as usize]
            && self
                .class(at)
                .is_some_and(|class| class == Class::Nothing || classes.contains(&class))
        {
            at += 1;
        }
        at
    }

    /// Emits steps on scalars.
    fn scalars(&mut self, steps: impl Iterator<Item = u32>) -> Option<()> {
        let plan = self.plan;
        let mut lifter = Lifter::new(self.lowered, plan, self.frame.precision, true, &mut self.pool);
        steps
            .filter(|&at| plan.classes[at as usize] != Class::Nothing)
            .for_each(|at| lifter.step(at));
        let region = lifter.finish(0, None);
        emit::emit_scalars(&mut self.code, &mut self.frame, &region)
    }

    /// Emits calls of the handlers of steps.
    fn calls(&mut self, steps: Range<u32>) {
        self.code.immediate32(RSI, self.positions[steps.start as usize]);
        self.code.immediate32(RDX, self.positions[steps.end as usize]);
        self.code.call(self.call);
    }

    fn label(&self, at: u32) -> Label {
        self.labels[at as usize].unwrap_or(self.exit)
    }

    fn control(&mut self, at: u32) -> Option<u32> {
        match self.lowered.linear.steps[at as usize].0 {
            Step::Jump(to) => self.code.jump(self.label(to)),
            Step::JumpIf { condition, when, to } => {
                let Some(Location::Scalar(scalar)) = self.lowered.locations.value(condition) else {
                    return None;
                };
                let word = Source::Memory(Memory::at(WORD_SCALARS, scalar as i32 * 4));
                self.code.arithmetic_immediate32(Arithmetic::Compare, word, 0);
                let condition = if when { Condition::NotZero } else { Condition::Zero };
                self.code.jump_if(condition, self.label(to));
            }
            Step::Iterate(_) => return self.region(at),
            _ => return None,
        }
        Some(at + 1)
    }
}
