//! What machine code accesses in memory.

use std::ffi::c_void;
use std::mem::offset_of;

use toyproof_eval::native::{Active, BatchTables, LANES};

/// What the code accesses in memory.
#[repr(C)]
pub(super) struct Context {
    pub(super) tables: BatchTables,
    /// The address of a `&dyn NativeBatch`, for the functions below.
    pub(super) batch: *const c_void,
    pub(super) call: *const u8,
    pub(super) refuel: *const u8,
    pub(super) note: *const u8,
    /// MXCSR of the caller.
    pub(super) caller_mxcsr: u32,
    /// MXCSR of the code.
    pub(super) own_mxcsr: u32,
    /// The status bits of MXCSR that the code has set.
    pub(super) status: u32,
    pub(super) scratch: u32,
    /// Vector registers while a function is called.
    pub(super) vectors: [[u8; 64]; 16],
    /// The pixels to note.
    pub(super) hit: [u32; LANES],
}

/// The offset of a field.
macro_rules! offset {
    ($($field:ident).+) => {
        std::mem::offset_of!(crate::x86_64::context::Context, $($field).+) as i32
    };
}
pub(super) use offset;

/// The layout that the code relies on: a word of chunks, then a flag.
const _: () =
    assert!(size_of::<Active>() == 8 && offset_of!(Active, chunks) == 0 && offset_of!(Active, all) == 4);
