//! Running machine code: memory that can be executed, and the functions that the code calls.
//!
//! All unsafe code of the compiler is here. What it relies on:
//!
//! - The memory is written first and made executable then, never both at once.
//! - The code follows the System V calling convention, keeps the registers that belong to the caller, and
//!   restores MXCSR before it returns or calls. Its instructions were detected on this processor.
//! - It reads and writes the rows, scalars and masks of the [`Batch`] it is started with, whose numbers are
//!   those that the program's own handlers use: they were assigned by the same allocation.

use std::ffi::c_void;
use std::mem::{offset_of, transmute};
use std::ptr;

use memmap2::{Mmap, MmapOptions};

use crate::batch::{Active, Batch, LANES};
use crate::number::Number;
use crate::observe::SiteId;
use crate::ops::{self, Instruction};

/// What the code accesses in memory.
#[repr(C)]
struct Context {
    floats: *const u8,
    words: *const u8,
    masks: *const u8,
    float_scalars: *const u8,
    word_scalars: *const u8,
    own_iterations: *const u8,
    active: *const u8,
    fuel: *const u8,
    iterations: *const u8,
    /// The batch and its instructions, for the functions below.
    batch: *const c_void,
    code: *const c_void,
    code_len: usize,
    call: *const u8,
    refuel: *const u8,
    note: *const u8,
    /// MXCSR of the caller, that of the code, and the status bits that the code has set.
    caller_mxcsr: u32,
    own_mxcsr: u32,
    status: u32,
    scratch: u32,
    /// Vector registers while a function is called.
    vectors: [[u8; 64]; 16],
    /// The pixels to note.
    hit: [u32; LANES],
}

/// The places of the fields.
pub(super) mod offsets {
    use super::{Context, offset_of};

    macro_rules! offsets {
        ($($name:ident: $field:ident,)*) => {
            $(pub(crate) const $name: i32 = offset_of!(Context, $field) as i32;)*
        };
    }
    offsets! {
        FLOATS: floats,
        WORDS: words,
        MASKS: masks,
        FLOAT_SCALARS: float_scalars,
        WORD_SCALARS: word_scalars,
        OWN_ITERATIONS: own_iterations,
        ACTIVE: active,
        FUEL: fuel,
        ITERATIONS: iterations,
        CALL: call,
        REFUEL: refuel,
        NOTE: note,
        CALLER_MXCSR: caller_mxcsr,
        OWN_MXCSR: own_mxcsr,
        STATUS: status,
        SCRATCH: scratch,
        VECTORS: vectors,
        HIT: hit,
    }
}

/// The layout that the code relies on: a word of chunks, then a flag.
const _: () =
    assert!(size_of::<Active>() == 8 && offset_of!(Active, chunks) == 0 && offset_of!(Active, all) == 4);

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

    /// Runs the code for a batch, whose handlers' instructions are also given. Returns whether a result was
    /// denormal before the processor flushed it.
    pub(super) fn run<N: Number>(&self, batch: &Batch<'_, N>, code: &[Instruction<N>]) -> bool {
        let mut context = Context {
            floats: batch.floats.as_ptr().cast(),
            words: batch.words.as_ptr().cast(),
            masks: batch.masks.as_ptr().cast(),
            float_scalars: batch.float_scalars.as_ptr().cast(),
            word_scalars: batch.word_scalars.as_ptr().cast(),
            own_iterations: batch.own_iterations.as_ptr().cast(),
            active: batch.active.as_ptr().cast(),
            fuel: batch.fuel.as_ptr().cast(),
            iterations: batch.iterations.as_ptr().cast(),
            batch: ptr::from_ref(batch).cast(),
            code: code.as_ptr().cast(),
            code_len: code.len(),
            call: call::<N> as *const u8,
            refuel: refuel::<N> as *const u8,
            note: note::<N> as *const u8,
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

/// Returns the batch and the instructions that code runs with.
#[expect(
    unsafe_code,
    reason = "machine code passes what it was started with as an address"
)]
unsafe fn parts<'a, N: Number>(context: *const Context) -> (&'a Batch<'a, N>, &'a [Instruction<N>]) {
    // SAFETY: `Executable::run` took both addresses from references that outlive the code's run.
    unsafe {
        let context = &*context;
        (
            &*context.batch.cast::<Batch<'_, N>>(),
            std::slice::from_raw_parts(context.code.cast::<Instruction<N>>(), context.code_len),
        )
    }
}

/// Executes instructions by their handlers.
extern "sysv64" fn call<N: Number>(context: *const Context, from: u32, to: u32) {
    #[expect(unsafe_code, reason = "see `parts`")]
    // SAFETY: see `parts`.
    let (batch, code) = unsafe { parts::<N>(context) };
    ops::run(batch, &code[from as usize..to as usize]);
}

/// Checks the limits; returns whether the run must stop.
extern "sysv64" fn refuel<N: Number>(context: *const Context, at: u32) -> u32 {
    #[expect(unsafe_code, reason = "see `parts`")]
    // SAFETY: see `parts`.
    let (batch, code) = unsafe { parts::<N>(context) };
    ops::refuel(batch, &code[at as usize], 0);
    u32::from(batch.stopped.get().is_some())
}

/// Notes the pixels in [`Context::hit`] for a site. `offset` is that of the first one's word in its row.
extern "sysv64" fn note<N: Number>(context: *const Context, site: u32, offset: u32) {
    #[expect(unsafe_code, reason = "see `parts`")]
    // SAFETY: see `parts`; the context is the one of the run.
    let (hit, (batch, _)) = unsafe { ((*context).hit, parts::<N>(context)) };
    let word = offset as usize / size_of::<u32>();
    let mut lanes = [0; LANES];
    // In double precision, the upper half is zero.
    for (lane, hit) in lanes[word % LANES..].iter_mut().zip(hit) {
        *lane = hit;
    }
    batch.notes.borrow_mut().add(SiteId(site), word / LANES, &lanes);
}
