//! Compiled shaders and their variants.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use toyproof_diagnostic::Deadline;
use toyproof_glsl::Checked;

use crate::build::{BuildOptions, Refusal, Substitute, TraceDetail, UndefinedPolicy};
use crate::compile::compile;
use crate::exec::native::{Executable, NativeCompiler};
use crate::lower::LoweredCode;

/// A shader compiled for the CPU, for any number type, frame and size.
#[derive(Debug)]
pub struct Program {
    checked: Arc<Checked>,
    native: Option<&'static dyn NativeCompiler>,
    /// The variant that records undefined operations.
    observing: OnceLock<Result<Executable, Refusal>>,
    /// The variants that substitute a number, or NaN, for undefined results; compiled on first use.
    substituted: [OnceLock<Result<Executable, Refusal>>; Substitute::ALL.len()],
    /// The variant without records; compiled on first use.
    plain: OnceLock<Result<Executable, Refusal>>,
    /// The variant that records traces; compiled on first use.
    traced: OnceLock<Result<Executable, Refusal>>,
    /// The variant that records traces with all steps, and undefined operations; compiled on first use.
    stepping: OnceLock<Result<Executable, Refusal>>,
    /// The variant that counts operations; compiled on first use.
    counting: OnceLock<Result<Executable, Refusal>>,
    /// The time limit for compiling the first variant. The others are about as large, and what they are
    /// compiled for must not depend on the load of the machine.
    limit: Option<Duration>,
}

impl Program {
    /// Compiles a shader, without machine code.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn new(checked: &Checked) -> Result<Self, Refusal> {
        Self::compile(checked, UndefinedPolicy::Observed, None, None)
    }

    /// Compiles one variant of a shader, with an optional time limit; the others are compiled on first use. A
    /// compiler to machine code gives images of many pixels faster; the results are the same.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn compile(
        checked: &Checked,
        variant: UndefinedPolicy,
        limit: Option<Duration>,
        native: Option<&'static dyn NativeCompiler>,
    ) -> Result<Self, Refusal> {
        let mut program = Self {
            native,
            checked: Arc::new(checked.clone()),
            observing: OnceLock::new(),
            substituted: Default::default(),
            plain: OnceLock::new(),
            traced: OnceLock::new(),
            stepping: OnceLock::new(),
            counting: OnceLock::new(),
            limit,
        };
        program.executable(variant)?;
        program.limit = None;
        Ok(program)
    }

    /// Returns the code of a variant.
    pub(crate) fn executable(&self, variant: UndefinedPolicy) -> Result<&Executable, Refusal> {
        let slot = match variant {
            UndefinedPolicy::Observed => &self.observing,
            UndefinedPolicy::Plain => &self.plain,
            UndefinedPolicy::Substitute(other) => &self.substituted[other as usize],
        };
        let options = BuildOptions {
            undefined: variant,
            ..BuildOptions::default()
        };
        self.variant(slot, options)
    }

    fn variant<'a>(
        &self,
        slot: &'a OnceLock<Result<Executable, Refusal>>,
        options: BuildOptions,
    ) -> Result<&'a Executable, Refusal> {
        let deadline = self.limit.map_or_else(Deadline::default, Deadline::after);
        let executable = slot.get_or_init(|| {
            Ok(Executable {
                lowered: compile(&self.checked, &[], options, &deadline)?,
                native: self.native.map(NativeCompiler::program),
            })
        });
        executable.as_ref().map_err(|&refusal| refusal)
    }

    /// Returns the code that records traces.
    pub(crate) fn traced(&self) -> Result<&LoweredCode, Refusal> {
        let options = BuildOptions {
            trace: TraceDetail::Values,
            ..BuildOptions::default()
        };
        Ok(&self.variant(&self.traced, options)?.lowered)
    }

    /// Returns the code that records traces with all steps.
    pub(crate) fn stepping(&self) -> Result<&LoweredCode, Refusal> {
        let options = BuildOptions {
            undefined: UndefinedPolicy::Observed,
            trace: TraceDetail::Steps,
            ..BuildOptions::default()
        };
        Ok(&self.variant(&self.stepping, options)?.lowered)
    }

    /// Returns the code that counts operations.
    pub(crate) fn counting(&self) -> Result<&LoweredCode, Refusal> {
        let options = BuildOptions {
            trace: TraceDetail::Counts,
            ..BuildOptions::default()
        };
        Ok(&self.variant(&self.counting, options)?.lowered)
    }

    /// Returns the checked shader.
    #[must_use]
    pub fn checked(&self) -> &Checked {
        &self.checked
    }
}
