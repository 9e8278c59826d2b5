//! The compiler: the machine code of a program for each kind of vectors and each [`Precision`], made when a
//! frame first needs it.
//!
//! In f32, the processor flushes denormal results. Rust code must not change MXCSR, but machine code may, as
//! long as it restores it. The processor decides after rounding whether a result is denormal, and
//! the handlers' `flush` looks at the rounded number, so that they differ for results just
//! below the smallest normal number. Therefore a batch with a denormal result is computed again by code that
//! flushes like the handlers.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use toyproof_eval::Engine;
use toyproof_eval::native::{
    FloatFormat, LANES, NativeBatch, NativeCompiler, NativeFrame, NativeInput, NativeProgram,
};

use super::assemble::Vectors;
use super::executable::Executable;
use super::node::Precision;
use super::program::assemble;

/// The compiler for this processor.
#[derive(Debug)]
pub(crate) struct Compiler;

impl NativeCompiler for Compiler {
    fn program(&self) -> Box<dyn NativeProgram> {
        Box::new(ProgramCode::default())
    }
}

/// The machine code of a program; none where it has none.
#[derive(Debug, Default)]
struct ProgramCode([[OnceLock<Option<Executable>>; 3]; 2]);

/// Programs with more steps are left to the handlers.
const MAX_STEPS: usize = 60_000;

/// The most bytes of a table of rows.
const MAX_TABLE: usize = 1 << 30;

impl ProgramCode {
    fn executable(
        &self,
        input: NativeInput<'_>,
        vectors: Vectors,
        precision: Precision,
    ) -> Option<&Executable> {
        let code = self.0[vectors as usize][precision as usize].get_or_init(|| {
            let is_small = input.lowered.linear.steps.len() <= MAX_STEPS
                && input.rows * input.width * size_of::<[f64; LANES]>() <= MAX_TABLE;
            if !is_small {
                return None;
            }
            Executable::new(&assemble(input, vectors, precision)?)
        });
        code.as_ref()
    }
}

impl NativeProgram for ProgramCode {
    fn frame<'a>(&'a self, input: NativeInput<'a>, engine: Engine) -> Option<Box<dyn NativeFrame + 'a>> {
        let best = Vectors::detect()?;
        let vectors = match engine {
            Engine::Handlers => return None,
            Engine::Avx2 => Vectors::Avx2,
            Engine::Fastest | Engine::Native => best,
        };
        let precision = match input.format {
            FloatFormat::Single => Precision::Single,
            FloatFormat::Double => Precision::Double,
        };
        Some(Box::new(FrameCode {
            code: self.executable(input, vectors, precision)?,
            program: self,
            input,
            vectors,
            precision,
            underflows: AtomicU32::new(0),
            others: AtomicU32::new(0),
        }))
    }
}

/// The machine code of a program for a frame.
#[derive(Debug)]
struct FrameCode<'a> {
    code: &'a Executable,
    program: &'a ProgramCode,
    input: NativeInput<'a>,
    vectors: Vectors,
    precision: Precision,
    /// The number of batches whose results were denormal.
    underflows: AtomicU32,
    /// The number of other batches.
    others: AtomicU32,
}

impl NativeFrame for FrameCode<'_> {
    fn run(&self, batch: &dyn NativeBatch) {
        let load = |counter: &AtomicU32| counter.load(Ordering::Relaxed);
        let is_frequent = load(&self.underflows) > 4 + load(&self.others) / 4;
        if self.precision != Precision::Single || !is_frequent {
            batch.begin();
            if !self.code.run(batch) || self.precision != Precision::Single {
                self.others.fetch_add(1, Ordering::Relaxed);
                return;
            }
            self.underflows.fetch_add(1, Ordering::Relaxed);
        }
        batch.begin();
        match self
            .program
            .executable(self.input, self.vectors, Precision::SingleExact)
        {
            Some(code) => {
                code.run(batch);
            }
            None => batch.execute(0..self.input.positions.last().copied().unwrap_or_default()),
        }
    }
}
