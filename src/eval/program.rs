//! Compiled shaders and their variants.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use toyproof_diagnostic::Deadline;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{Place, VariableId};
use toyproof_image::Frame;

use crate::build::{self, BuildOptions, Refusal, UndefinedMode, compile, with_stack};
use crate::frame::target_color;
use crate::ir::AliasGroups;
use crate::ir::Function;
use crate::lower::isel::Prepared;
use crate::lower::linearize::{LinearCode, linearize};
use crate::lower::regalloc::{Allocation, allocate_registers};
use crate::native;
use crate::number::{Number, RandomRounding};
use crate::observe::{Observations, Site};
use crate::opt::dce::eliminate_dead_code;
use crate::opt::denormals::flush_operands;
use crate::opt::divergence::Divergence;
use crate::opt::fuse::fuse;
use crate::opt::gvn::number_values;
use crate::opt::pair::pair;
use crate::render::{Failure, Part, Settings, Substitute, UndefinedPolicy};
use crate::trace::{ExecutionTrace, ForcedPrefix, PixelDebugger, TraceSchema};

/// A shader compiled for the CPU, for any number type, frame and size.
#[derive(Debug)]
pub struct Program {
    checked: Arc<Checked>,
    /// The variant that records undefined operations.
    observing: OnceLock<Result<Compiled, Refusal>>,
    /// The variants that substitute a number, or NaN, for undefined results; compiled on first use.
    substituted: [OnceLock<Result<Compiled, Refusal>>; Substitute::ALL.len()],
    /// The variant without records; compiled on first use.
    plain: OnceLock<Result<Compiled, Refusal>>,
    /// The variant that records traces; compiled on first use.
    traced: OnceLock<Result<Compiled, Refusal>>,
    /// The time limit for compiling the first variant. The others are about as large, and what they are compiled
    /// for must not depend on the load of the machine.
    limit: Option<Duration>,
}

impl Program {
    /// Compiles a shader.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn new(checked: &Checked) -> Result<Self, Refusal> {
        Self::prepared(checked, UndefinedPolicy::Observed)
    }

    /// Compiles a shader with a time limit.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn within(checked: &Checked, limit: Duration) -> Result<Self, Refusal> {
        Self::prepared_within(checked, UndefinedPolicy::Observed, Some(limit))
    }

    /// Compiles one variant of a shader; the others are compiled on first use.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn prepared(checked: &Checked, variant: UndefinedPolicy) -> Result<Self, Refusal> {
        Self::prepared_within(checked, variant, None)
    }

    /// Compiles one variant of a shader, with an optional time limit; the others are compiled on first use.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn prepared_within(
        checked: &Checked,
        variant: UndefinedPolicy,
        limit: Option<Duration>,
    ) -> Result<Self, Refusal> {
        let mut program = Self {
            checked: Arc::new(checked.clone()),
            observing: OnceLock::new(),
            substituted: Default::default(),
            plain: OnceLock::new(),
            traced: OnceLock::new(),
            limit,
        };
        program.code(variant)?;
        program.limit = None;
        Ok(program)
    }

    /// Returns the code of a variant.
    pub(crate) fn code(&self, variant: UndefinedPolicy) -> Result<&Compiled, Refusal> {
        match variant {
            UndefinedPolicy::Observed => self.compiled(
                &self.observing,
                BuildOptions {
                    undefined: UndefinedMode::Observed,
                    ..BuildOptions::default()
                },
            ),
            UndefinedPolicy::Plain => self.compiled(&self.plain, BuildOptions::default()),
            UndefinedPolicy::Substitute(other) => self.compiled(
                &self.substituted[other as usize],
                BuildOptions {
                    undefined: UndefinedMode::Substitute(other),
                    ..BuildOptions::default()
                },
            ),
        }
    }

    fn compiled<'a>(
        &self,
        slot: &'a OnceLock<Result<Compiled, Refusal>>,
        options: BuildOptions,
    ) -> Result<&'a Compiled, Refusal> {
        let deadline = self.limit.map_or_else(Deadline::default, Deadline::after);
        let compiled = slot.get_or_init(|| Compiled::new(&self.checked, &[], options, &deadline));
        compiled.as_ref().map_err(|&refusal| refusal)
    }

    /// Returns the code that records traces.
    pub(crate) fn traced(&self) -> Result<&Compiled, Refusal> {
        let options = BuildOptions {
            trace: true,
            ..BuildOptions::default()
        };
        self.compiled(&self.traced, options)
    }

    /// Returns the checked shader.
    #[must_use]
    pub fn checked(&self) -> &Checked {
        &self.checked
    }
}

/// The number types that code is generated for. The code is instantiated in this crate once, not in each
/// crate that uses it.
pub trait Backend: Sized {
    /// Generates code for a frame in this number type.
    #[doc(hidden)]
    fn prepare(compiled: &Compiled, frame: &Frame) -> Prepared<Self>
    where
        Self: Number;

    /// Renders a part of a frame, rounded to f32.
    #[doc(hidden)]
    fn fill_rounded(
        program: &Program,
        frame: &Frame,
        part: Part<'_>,
        settings: &Settings<'_, Self>,
        pixels: &mut [[f32; 4]],
        flags: &mut [u8],
    ) -> Result<Observations, Failure>
    where
        Self: Number;

    /// Renders a part of a frame in this number type.
    #[doc(hidden)]
    fn fill(
        program: &Program,
        frame: &Frame,
        part: Part<'_>,
        settings: &Settings<'_, Self>,
        pixels: &mut [[Self; 4]],
        flags: &mut [u8],
    ) -> Result<Observations, Failure>
    where
        Self: Number;

    /// Records the trace of a pixel.
    #[doc(hidden)]
    fn trace(
        debugger: &PixelDebugger<'_, Self>,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>,
    ) -> Result<ExecutionTrace, Failure>
    where
        Self: Number;
}

macro_rules! backends {
    ($($number:ty),*) => {$(
        impl Backend for $number {
            fn prepare(compiled: &Compiled, frame: &Frame) -> Prepared<Self> {
                compiled.prepare(frame)
            }

            fn fill_rounded(
                program: &Program,
                frame: &Frame,
                part: Part<'_>,
                settings: &Settings<'_, Self>,
                pixels: &mut [[f32; 4]],
                flags: &mut [u8],
            ) -> Result<Observations, Failure> {
                program.fill(frame, part, settings, pixels, flags, target_color)
            }

            fn fill(
                program: &Program,
                frame: &Frame,
                part: Part<'_>,
                settings: &Settings<'_, Self>,
                pixels: &mut [[Self; 4]],
                flags: &mut [u8],
            ) -> Result<Observations, Failure> {
                program.fill(frame, part, settings, pixels, flags, |color, _| color)
            }

            fn trace(
                debugger: &PixelDebugger<'_, Self>,
                pixel: [u32; 2],
                prefix: Option<ForcedPrefix<'_>>,
            ) -> Result<ExecutionTrace, Failure> {
                debugger.run(pixel, prefix)
            }
        }
    )*};
}
backends!(f32, f64, RandomRounding);

/// Compiled code for any number type.
#[derive(Debug)]
pub struct Compiled {
    pub(crate) function: Function,
    pub(crate) linear: LinearCode,
    pub(crate) locations: Allocation,
    /// Whether stores to a cell must preserve the values of inactive pixels.
    pub(crate) shared: Vec<bool>,
    pub(crate) sites: Vec<Site>,
    pub(crate) schema: TraceSchema,
    pub(crate) native: native::Cache,
}

impl Compiled {
    pub(crate) fn new(
        checked: &Checked,
        parameters: &[VariableId],
        options: BuildOptions,
        deadline: &Deadline,
    ) -> Result<Self, Refusal> {
        with_stack(|| {
            let build::Program {
                mut function,
                sites,
                schema,
            } = compile(checked, parameters, options, deadline)?;
            deadline.check()?;
            flush_operands(&mut function);
            number_values(&mut function, options.trace);
            deadline.check()?;
            eliminate_dead_code(&mut function);
            let groups = AliasGroups::of(&function);
            deadline.check()?;
            let divergence = Divergence::of(&function, &groups);
            fuse(&mut function, &divergence);
            pair(&mut function);
            deadline.check()?;
            let linear = linearize(&function, &divergence, options.trace);
            deadline.check()?;
            let locations = allocate_registers(&function, &linear, &divergence, &groups);
            let cells = (0..function.cells.len() as u32).map(crate::ir::Cell);
            let shared = cells.map(|cell| divergence.is_shared(cell)).collect();
            function.body.clear();
            Ok(Self {
                function,
                linear,
                locations,
                shared,
                sites,
                schema,
                native: native::Cache::default(),
            })
        })?
    }

    /// Returns the source location of a loop.
    pub(crate) fn loop_at(&self, id: u32) -> Place {
        self.function.loops[id as usize]
    }
}
