//! Lowering of structured code to linear code: jumps and masks, and the locations of values.

pub(crate) mod linearize;
pub(crate) mod regalloc;

use toyproof_glsl::tree::{Place, SamplerShape};

use self::linearize::LinearCode;
use self::regalloc::Allocation;
use crate::ir::{Function, ProfileSchema, Site, TraceSchema};

/// A lowered program, for any number type, frame and size.
#[derive(Debug)]
pub struct LoweredCode {
    /// The values and cells; its body is empty.
    pub function: Function,
    /// The steps.
    pub linear: LinearCode,
    /// The locations of values and cells.
    pub locations: Allocation,
    /// Whether stores to a cell must preserve the values of inactive pixels.
    pub shared: Vec<bool>,
    /// The shapes of the channels' textures, as they are declared.
    pub shapes: [SamplerShape; 4],
    pub(crate) sites: Vec<Site>,
    pub(crate) schema: TraceSchema,
    pub(crate) profile: ProfileSchema,
}

impl LoweredCode {
    /// Returns the source location of a loop.
    pub(crate) fn loop_at(&self, id: u32) -> Place {
        self.function.loops[id as usize]
    }
}
