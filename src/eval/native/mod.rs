//! Machine code for AVX2 and AVX-512: what the handlers of [`ops`](crate::ops) do, without their traffic to
//! memory.
//!
//! A handler reads and writes rows of 256 pixels for each operation. Machine code keeps values in registers
//! over a whole *region*, a part of the program without loops, for one vector of pixels after the other
//! (`plan`: which steps form regions; `lift` and `operation`: their `node`s; `emit`: registers and
//! instructions; `assemble`, `evex`: bytes; `run`: memory, and calls). What has no form there is executed by
//! its handler. The bits are the same: tests compare both.
//!
//! In f32, the processor flushes denormal results. Rust code must not change MXCSR, but machine code may, as
//! long as it restores it. The processor decides after rounding whether a result is denormal, and
//! [`flush`](toyproof_math::native::flush) looks at the rounded number, so that they differ for results just
//! below the smallest normal number. Therefore a batch with a denormal result is computed again by code that
//! flushes like the handlers.

mod assemble;
mod emit;
mod evex;
mod lift;
mod node;
mod operation;
mod plan;
mod run;
#[cfg(test)]
mod tests;

use std::any::TypeId;
use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use self::assemble::{
    Arithmetic, Assembler, CONSTANT_BYTES, Condition, Label, Memory, R8, R12, R13, R14, R15, RAX, RBP, RBX,
    RCX, RDI, RDX, RSI, RSP, Source, Vectors, op,
};
use self::emit::{CONTEXT, FLOAT_SCALARS, FLOATS, Frame, MASKS, SAVED_STACK, WORD_SCALARS, WORDS};
use self::lift::Lifter;
use self::node::{Pool, Precision};
use self::plan::{Class, Plan, plan};
use self::run::{Executable, offsets};
use crate::batch::Batch;
use crate::lower::isel::Prepared;
use crate::lower::linearize::Step;
use crate::lower::regalloc::Location;
use crate::number::Number;
use crate::program::Compiled;
use crate::render::Engine;

/// The machine code of a program for each kind of vectors and each [`Precision`], made when it is first
/// needed.
#[derive(Debug, Default)]
pub(crate) struct Cache([[OnceLock<Option<Executable>>; 3]; 2]);

#[cfg(test)]
impl Cache {
    /// Whether no machine code was made.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().flatten().all(|code| code.get().is_none())
    }
}

/// The machine code of a program for a number type.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Native<'a> {
    compiled: &'a Compiled,
    vectors: Vectors,
    precision: Precision,
    code: &'a Executable,
}

/// Programs with more steps are left to the handlers.
const MAX_STEPS: usize = 60_000;

/// A region ends after this number of nodes.
const MAX_NODES: usize = 8_000;

/// The most bytes of a table of rows.
const MAX_TABLE: usize = 1 << 30;

impl Compiled {
    /// Returns the machine code for a number type and an engine; none if there is none for it, or on this
    /// processor.
    pub(crate) fn native<N: Number>(&self, prepared: &Prepared<N>, engine: Engine) -> Option<Native<'_>> {
        let precision = if TypeId::of::<N>() == TypeId::of::<f32>() {
            Precision::Single
        } else if TypeId::of::<N>() == TypeId::of::<f64>() {
            Precision::Double
        } else {
            return None;
        };
        let best = Vectors::detect()?;
        let vectors = match engine {
            Engine::Handlers => return None,
            Engine::Avx2 => Vectors::Avx2,
            Engine::Fastest | Engine::Native => best,
        };
        let code = self.executable(vectors, precision, prepared)?;
        Some(Native {
            compiled: self,
            vectors,
            precision,
            code,
        })
    }

    fn executable<N: Number>(
        &self,
        vectors: Vectors,
        precision: Precision,
        prepared: &Prepared<N>,
    ) -> Option<&Executable> {
        let code = self.native.0[vectors as usize][precision as usize].get_or_init(|| {
            let rows = prepared.float_rows.max(prepared.word_rows).max(prepared.masks);
            let is_small = self.linear.steps.len() <= MAX_STEPS
                && rows * prepared.width * size_of::<[f64; crate::batch::LANES]>() <= MAX_TABLE;
            if !is_small {
                return None;
            }
            Executable::new(&assemble(self, vectors, precision, prepared)?)
        });
        code.as_ref()
    }
}

/// Batches whose results were denormal, and the others, of a frame.
#[derive(Debug, Default)]
pub(crate) struct Underflows {
    with: AtomicU32,
    without: AtomicU32,
}

impl Native<'_> {
    /// Runs the code for a batch. `begin` initializes the batch, and is called again if it is computed again.
    pub(crate) fn run<N: Number>(
        self,
        batch: &mut Batch<'_, N>,
        prepared: &Prepared<N>,
        underflows: &Underflows,
        begin: impl Fn(&mut Batch<'_, N>),
    ) {
        let load = |counter: &AtomicU32| counter.load(Ordering::Relaxed);
        let is_frequent = load(&underflows.with) > 4 + load(&underflows.without) / 4;
        if self.precision != Precision::Single || !is_frequent {
            begin(batch);
            if !self.code.run(batch, &prepared.code) || self.precision != Precision::Single {
                underflows.without.fetch_add(1, Ordering::Relaxed);
                return;
            }
            underflows.with.fetch_add(1, Ordering::Relaxed);
            batch.stopped.set(None);
            batch.notes.borrow_mut().sites.clear();
        }
        begin(batch);
        match self
            .compiled
            .executable(self.vectors, Precision::SingleExact, prepared)
        {
            Some(code) => {
                code.run(batch, &prepared.code);
            }
            None => {
                crate::ops::run(batch, &prepared.code);
            }
        }
    }
}

/// Assembles a program; none if it has no machine code.
fn assemble<N: Number>(
    compiled: &Compiled,
    vectors: Vectors,
    precision: Precision,
    prepared: &Prepared<N>,
) -> Option<Vec<u8>> {
    let plan = plan(compiled)?;
    let mut code = Assembler::new(vectors);
    let labels = plan
        .targets
        .iter()
        .map(|&is_target| is_target.then(|| code.label()));
    let labels: Vec<Option<Label>> = labels.collect();
    let [exit, call, refuel, note] = [(); 4].map(|()| code.label());
    let mut writer = Writer {
        compiled,
        plan: &plan,
        positions: &prepared.positions,
        pool: Pool::default(),
        frame: Frame {
            precision,
            vectors,
            width: prepared.width as u32,
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
    let frame_size = writer.prologue();
    writer.steps()?;
    writer.epilogue(note);
    let stack = writer.frame.stack_bytes();
    writer.code.patch(frame_size, stack);
    Some(writer.code.finish(&writer.pool.constants))
}

/// Emits a program.
struct Writer<'a> {
    compiled: &'a Compiled,
    plan: &'a Plan,
    /// The first instruction of each step.
    positions: &'a [u32],
    pool: Pool,
    frame: Frame,
    code: Assembler,
    /// The labels of the steps that are jumped to.
    labels: Vec<Option<Label>>,
    exit: Label,
    call: Label,
    refuel: Label,
    /// The places where the limits are checked, those after it, and the instruction.
    refuels: Vec<(Label, Label, u32)>,
}

/// The registers that belong to the caller.
const PRESERVED: [assemble::Gpr; 6] = [RBX, RBP, R12, R13, R14, R15];

/// Bits of MXCSR: flush denormal results to zero; the status.
const FLUSH_TO_ZERO: u32 = 1 << 15;
const STATUS: u32 = 0x3F;

impl Writer<'_> {
    /// Returns the position of the size of the stack frame.
    fn prologue(&mut self) -> usize {
        let code = &mut self.code;
        for register in PRESERVED {
            code.push(register);
        }
        code.copy64(CONTEXT, RDI);
        code.copy64(RAX, RSP);
        code.arithmetic_immediate64(Arithmetic::Sub, RSP, 0);
        let frame_size = code.len() - 4;
        // Vectors are aligned.
        code.arithmetic_immediate64(Arithmetic::And, RSP, -(CONSTANT_BYTES as i32));
        code.store64(Memory::at(RSP, SAVED_STACK), RAX);
        for (register, offset) in [
            (FLOATS, offsets::FLOATS),
            (WORDS, offsets::WORDS),
            (MASKS, offsets::MASKS),
            (FLOAT_SCALARS, offsets::FLOAT_SCALARS),
            (WORD_SCALARS, offsets::WORD_SCALARS),
        ] {
            code.load64(register, Memory::at(CONTEXT, offset));
        }
        if self.flushes() {
            let code = &mut self.code;
            code.store_mxcsr(Memory::at(CONTEXT, offsets::CALLER_MXCSR));
            code.load32(RAX, Memory::at(CONTEXT, offsets::CALLER_MXCSR));
            code.arithmetic_immediate32(Arithmetic::And, Source::Register(RAX.0), !STATUS);
            code.arithmetic_immediate32(Arithmetic::Or, Source::Register(RAX.0), FLUSH_TO_ZERO);
            code.store32(Memory::at(CONTEXT, offsets::OWN_MXCSR), RAX);
            code.load_mxcsr(Memory::at(CONTEXT, offsets::OWN_MXCSR));
        }
        frame_size
    }

    /// Whether the processor flushes denormals.
    fn flushes(&self) -> bool {
        self.frame.precision == Precision::Single
    }

    /// Collects the status bits and restores the caller's MXCSR.
    fn leave_mxcsr(&mut self) {
        if self.flushes() {
            let code = &mut self.code;
            code.store_mxcsr(Memory::at(CONTEXT, offsets::SCRATCH));
            code.load32(RAX, Memory::at(CONTEXT, offsets::SCRATCH));
            code.arithmetic_memory32(Arithmetic::Or, Memory::at(CONTEXT, offsets::STATUS), RAX);
            code.load_mxcsr(Memory::at(CONTEXT, offsets::CALLER_MXCSR));
        }
        self.code.vzeroupper();
    }

    /// Sets the code's own MXCSR again.
    fn enter_mxcsr(&mut self) {
        if self.flushes() {
            self.code.load_mxcsr(Memory::at(CONTEXT, offsets::OWN_MXCSR));
        }
    }

    /// Emits what follows the steps.
    fn epilogue(&mut self, note: Label) {
        self.code.bind(self.exit);
        self.leave_mxcsr();
        self.code.load64(RSP, Memory::at(RSP, SAVED_STACK));
        for register in PRESERVED.into_iter().rev() {
            self.code.pop(register);
        }
        self.code.ret();
        for (label, offset) in [(self.call, offsets::CALL), (self.refuel, offsets::REFUEL)] {
            self.code.bind(label);
            self.code.arithmetic_immediate64(Arithmetic::Sub, RSP, 8);
            self.leave_mxcsr();
            self.code.copy64(RDI, CONTEXT);
            self.code.call_memory(Memory::at(CONTEXT, offset));
            self.enter_mxcsr();
            self.code.arithmetic_immediate64(Arithmetic::Add, RSP, 8);
            self.code.ret();
        }
        for (entry, back, instruction) in std::mem::take(&mut self.refuels) {
            self.code.bind(entry);
            self.code.immediate32(RSI, instruction);
            self.code.call(self.refuel);
            self.code
                .arithmetic32(Arithmetic::Or, RAX, Source::Register(RAX.0));
            self.code.jump_if(Condition::NotZero, self.exit);
            self.code.jump(back);
        }
        for emit::Note {
            entry,
            back,
            register,
            site,
        } in std::mem::take(&mut self.frame.notes)
        {
            self.code.bind(entry);
            let hit = Source::Memory(Memory::at(CONTEXT, offsets::HIT));
            self.code.unary(op::VMOVUPS_STORE, true, register, hit);
            self.code.immediate32(RAX, site);
            self.code.call(note);
            self.code.jump(back);
        }
        self.note(note);
    }

    /// Emits the function that notes pixels, which keeps all registers.
    fn note(&mut self, label: Label) {
        // The offset, the end of the chunk, the chunks that are left, and the base of iterations.
        const KEPT: [assemble::Gpr; 4] = [RCX, RDX, R8, RSI];
        self.code.bind(label);
        for register in KEPT {
            self.code.push(register);
        }
        self.code.arithmetic_immediate64(Arithmetic::Sub, RSP, 8);
        let bytes = self.frame.vectors.bytes();
        let vectors =
            |vector: u8| Source::Memory(Memory::at(CONTEXT, offsets::VECTORS + bytes * i32::from(vector)));
        for vector in 0..16 {
            self.code.unary(op::VMOVUPS_STORE, true, vector, vectors(vector));
        }
        self.code.copy64(RSI, RAX);
        self.code.copy64(RDX, RCX);
        self.leave_mxcsr();
        self.code.copy64(RDI, CONTEXT);
        self.code.call_memory(Memory::at(CONTEXT, offsets::NOTE));
        self.enter_mxcsr();
        for vector in 0..16 {
            self.code.unary(op::VMOVUPS, true, vector, vectors(vector));
        }
        self.code.arithmetic_immediate64(Arithmetic::Add, RSP, 8);
        for register in KEPT.into_iter().rev() {
            self.code.pop(register);
        }
        self.code.ret();
    }

    fn class(&self, at: u32) -> Option<Class> {
        self.plan.classes.get(at as usize).copied()
    }

    fn mask(&self, at: u32) -> Option<u32> {
        let step = self.compiled.linear.steps.get(at as usize);
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
                    let end = self.run(at, [Class::Scalar, Class::ScalarStore]);
                    self.scalars(at..end)?;
                    end
                }
                Class::Call | Class::ScalarCall => {
                    let end = self.run(at, [Class::Call, Class::ScalarCall]);
                    self.calls(at..end);
                    end
                }
                Class::Control => self.control(at)?,
            };
        }
        Some(())
    }

    /// Returns the end of the consecutive steps, from one on, that are executed alike.
    fn run(&self, start: u32, classes: [Class; 2]) -> u32 {
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
        let mut lifter = Lifter::new(self.compiled, plan, self.frame.precision, true, &mut self.pool);
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
        match self.compiled.linear.steps[at as usize].0 {
            Step::Jump(to) => self.code.jump(self.label(to)),
            Step::JumpIf { condition, when, to } => {
                let Some(Location::Scalar(scalar)) = self.compiled.locations.value(condition) else {
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

    /// Checks the limits from time to time, and counts an iteration of all pixels.
    fn iterate(&mut self, at: u32) {
        let (entry, back) = (self.code.label(), self.code.label());
        let instruction = self.positions[at as usize];
        self.refuels.push((entry, back, instruction));
        self.code.load64(RAX, Memory::at(CONTEXT, offsets::FUEL));
        let fuel = Source::Memory(Memory::at(RAX, 0));
        self.code.arithmetic_immediate32(Arithmetic::Sub, fuel, 1);
        self.code.jump_if(Condition::Below, entry);
        self.code.bind(back);
        if self.mask(at) == Some(0) {
            self.code.load64(RAX, Memory::at(CONTEXT, offsets::ITERATIONS));
            let iterations = Source::Memory(Memory::at(RAX, 0));
            self.code.arithmetic_immediate32(Arithmetic::Add, iterations, 1);
        }
    }

    /// Emits a region and the jump at its end; returns the next step.
    fn region(&mut self, start: u32) -> Option<u32> {
        let (compiled, plan) = (self.compiled, self.plan);
        let base = self.mask(start)?;
        let mut lifter = Lifter::new(compiled, plan, self.frame.precision, false, &mut self.pool);
        let (mut hoisted, mut iterations) = (Vec::new(), Vec::new());
        let mut branch = None;
        let mut at = start;
        while lifter.size() <= MAX_NODES && (at == start || !plan.targets[at as usize]) {
            let Some((_, mask)) = compiled.linear.steps.get(at as usize) else {
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
                Class::Control if matches!(compiled.linear.steps[at as usize].0, Step::Iterate(_)) => {
                    iterations.push(at);
                    if mask.0 != 0 {
                        lifter.step(at);
                    }
                    at += 1;
                }
                Class::Control | Class::ScalarStore | Class::Call => break,
            }
        }
        let jump = branch.and_then(|branch| jump_of(compiled, branch));
        let mask_at = |at: u32| {
            let step = compiled.linear.steps.get(at as usize);
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
            self.code.load64(RAX, Memory::at(CONTEXT, offsets::ACTIVE));
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
fn jump_of(compiled: &Compiled, at: u32) -> Option<(u32, u32)> {
    let (step, mask) = &compiled.linear.steps[at as usize];
    match *step {
        Step::Split { yes, empty, .. } => Some((u32::from(yes.0), empty)),
        Step::Remove { empty, .. } | Step::JumpIfEmpty(empty) => Some((u32::from(mask.0), empty)),
        _ => None,
    }
}
