//! Executable memory, and the functions that machine code calls.
//!
//! All unsafe code of the compiler is here. What it relies on:
//!
//! - The memory is written first and made executable then, never both at once.
//! - The code follows the System V calling convention, keeps the registers that belong to the caller, and
//!   restores MXCSR before it returns or calls. Its instructions were detected on this processor.
//! - It reads and writes the tables of the batch it is started with, whose numbers of rows, scalars and masks
//!   are those that the program's own handlers use: they were assigned by the same allocation.

use std::mem::transmute;
use std::ptr;

use memmap2::{Mmap, MmapOptions};
use toyproof_eval::native::{LANES, NativeBatch, SiteId};

use super::context::Context;

/// The bit of MXCSR that a result set which was too small for a normal number.
const UNDERFLOW: u32 = 1 << 4;

/// Executable memory.
#[derive(Debug)]
pub(super) struct Executable(Mmap);

impl Executable {
    /// Copies machine code to executable memory; none if the system refuses.
    pub(super) fn new(code: &[u8]) -> Option<Self> {
        let mut memory = MmapOptions::new().len(code.len()).map_anon().ok()?;
        memory.copy_from_slice(code);
        Some(Self(memory.make_exec().ok()?))
    }

    /// Runs the code for a batch. Returns whether a result was denormal before the processor flushed it.
    pub(super) fn run(&self, batch: &dyn NativeBatch) -> bool {
        let mut context = Context {
            tables: batch.tables(),
            batch: ptr::from_ref(&batch).cast(),
            call: call as *const u8,
            refuel: refuel as *const u8,
            note: note as *const u8,
            caller_mxcsr: 0,
            own_mxcsr: 0,
            status: 0,
            scratch: 0,
            vectors: [[0; 64]; 16],
            hit: [0; LANES],
        };
        #[expect(unsafe_code, reason = "the entry of machine code is an address")]
        // SAFETY: the memory holds a function with this signature, made for this processor and for batches
        // of the program; see the module's header.
        unsafe {
            let entry: extern "sysv64" fn(*mut Context) = transmute(self.0.as_ptr());
            entry(&raw mut context);
        }
        context.status & UNDERFLOW != 0
    }
}

/// Returns the batch that code runs for.
#[expect(
    unsafe_code,
    reason = "machine code passes what it was started with as an address"
)]
unsafe fn batch<'a>(context: *const Context) -> &'a dyn NativeBatch {
    // SAFETY: `Executable::run` took the address of a reference that outlives the code's run.
    unsafe { *(*context).batch.cast::<&dyn NativeBatch>() }
}

/// Executes instructions by their handlers.
extern "sysv64" fn call(context: *const Context, from: u32, to: u32) {
    #[expect(unsafe_code, reason = "see `batch`")]
    // SAFETY: see `batch`.
    let batch = unsafe { batch(context) };
    batch.execute(from..to);
}

/// Checks the limits; returns whether the run must stop.
extern "sysv64" fn refuel(context: *const Context, at: u32) -> u32 {
    #[expect(unsafe_code, reason = "see `batch`")]
    // SAFETY: see `batch`.
    let batch = unsafe { batch(context) };
    batch.refuel(at).into()
}

/// Notes the pixels in [`Context::hit`] for a site. `offset` is that of the first one's word in its row.
extern "sysv64" fn note(context: *const Context, site: u32, offset: u32) {
    #[expect(unsafe_code, reason = "see `batch`")]
    // SAFETY: see `batch`; the context is the one of the run.
    let (hit, batch) = unsafe { ((*context).hit, batch(context)) };
    let word = offset as usize / size_of::<u32>();
    let mut lanes = [0; LANES];
    // In double precision, the upper half is zero.
    for (lane, hit) in lanes[word % LANES..].iter_mut().zip(hit) {
        *lane = hit;
    }
    batch.note(SiteId(site), word / LANES, &lanes);
}
