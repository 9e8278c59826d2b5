//! A shader that is ready to be evaluated.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use toyproof_diagnostic::Deadline;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::Place;
use toyproof_image::Frame;

use super::number::{Jittered, Number};
use crate::build::{self, Choice, Extras, Refusal, compile, with_stack};
use crate::ir::alias::Groups;
use crate::ir::function::Flow;
use crate::lower::isel::Prepared;
use crate::lower::linearize::{Flat, flatten};
use crate::lower::regalloc::{Homes, allocate};
use crate::observe::Site;
use crate::opt::dce::prune;
use crate::opt::divergence::Varying;
use crate::opt::fuse::fuse;
use crate::opt::gvn::forward;
use crate::render::{Other, Variant};
use crate::trace::story::Plot;

/// A shader, compiled for the CPU: for any number type, frame and size.
#[derive(Debug)]
pub struct Program {
    checked: Arc<Checked>,
    /// With notes of undefined operations.
    observing: OnceLock<Result<Compiled, Refusal>>,
    /// With another number where GLSL leaves open what comes, or with NaN; made when it is first asked for.
    otherwise: [OnceLock<Result<Compiled, Refusal>>; 2],
    /// Without; made when it is first asked for.
    plain: OnceLock<Result<Compiled, Refusal>>,
    /// With what each pixel does; made when it is first asked for.
    telling: OnceLock<Result<Compiled, Refusal>>,
    /// How long each of them may take to make.
    limit: Option<Duration>,
}

impl Program {
    /// Compiles a shader.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn new(checked: &Checked) -> Result<Self, Refusal> {
        Self::prepared(checked, Variant::Observed)
    }

    /// The same; none of a shader's variants may take longer to compile than that.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn within(checked: &Checked, limit: Duration) -> Result<Self, Refusal> {
        Self::prepared_within(checked, Variant::Observed, Some(limit))
    }

    /// The same of a shader that is to be painted in that variant; others are compiled when they are first asked for.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn prepared(checked: &Checked, variant: Variant) -> Result<Self, Refusal> {
        Self::prepared_within(checked, variant, None)
    }

    /// The same; if there is a limit, none of a shader's variants may take longer to compile.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn prepared_within(
        checked: &Checked,
        variant: Variant,
        limit: Option<Duration>,
    ) -> Result<Self, Refusal> {
        let program = Self {
            checked: Arc::new(checked.clone()),
            observing: OnceLock::new(),
            otherwise: Default::default(),
            plain: OnceLock::new(),
            telling: OnceLock::new(),
            limit,
        };
        program.code(variant)?;
        Ok(program)
    }

    /// The code of a variant.
    pub(crate) fn code(&self, variant: Variant) -> Result<&Compiled, Refusal> {
        match variant {
            Variant::Observed => self.made(
                &self.observing,
                Extras {
                    choice: Choice::Noted,
                    ..Extras::default()
                },
            ),
            Variant::Plain => self.made(&self.plain, Extras::default()),
            Variant::Otherwise(other) => self.made(
                &self.otherwise[usize::from(other == Other::NotANumber)],
                Extras {
                    choice: Choice::Other(other),
                    ..Extras::default()
                },
            ),
        }
    }

    fn made<'a>(
        &self,
        kept: &'a OnceLock<Result<Compiled, Refusal>>,
        extras: Extras,
    ) -> Result<&'a Compiled, Refusal> {
        let deadline = self.limit.map_or_else(Deadline::default, Deadline::after);
        let made = kept.get_or_init(|| Compiled::new(&self.checked, extras, &deadline));
        made.as_ref().map_err(|&refusal| refusal)
    }

    /// The code that tells what a pixel does.
    pub(crate) fn telling(&self) -> Result<&Compiled, Refusal> {
        let extras = Extras {
            story: true,
            ..Extras::default()
        };
        self.made(&self.telling, extras)
    }

    /// The shader.
    #[must_use]
    pub fn checked(&self) -> &Checked {
        &self.checked
    }
}

/// The number types that there is code for. It is made here, once, and not in each crate that asks for it.
pub trait Backend: Sized {
    /// Code for a frame in this number type.
    #[doc(hidden)]
    fn prepare(compiled: &Compiled, frame: &Frame) -> Prepared<Self>
    where
        Self: Number;
}

macro_rules! backends {
    ($($number:ty),*) => {$(
        impl Backend for $number {
            fn prepare(compiled: &Compiled, frame: &Frame) -> Prepared<Self> {
                compiled.prepare(frame)
            }
        }
    )*};
}
backends!(f32, f64, Jittered);

/// Code for any number type.
#[derive(Debug)]
pub struct Compiled {
    pub(crate) flow: Flow,
    pub(crate) flat: Flat,
    pub(crate) homes: Homes,
    /// Whether stores to a cell leave alone the pixels that are elsewhere.
    pub(crate) shared: Vec<bool>,
    pub(crate) sites: Vec<Site>,
    pub(crate) plot: Plot,
}

impl Compiled {
    fn new(checked: &Checked, extras: Extras, deadline: &Deadline) -> Result<Self, Refusal> {
        with_stack(|| {
            let build::Program {
                mut flow,
                sites,
                plot,
            } = compile(checked, extras, deadline)?;
            deadline.check()?;
            forward(&mut flow, extras.story);
            deadline.check()?;
            prune(&mut flow);
            let groups = Groups::of(&flow);
            deadline.check()?;
            let varying = Varying::of(&flow, &groups);
            fuse(&mut flow, &varying);
            deadline.check()?;
            let flat = flatten(&flow, &varying, extras.story);
            deadline.check()?;
            let homes = allocate(&flow, &flat, &varying, &groups);
            let cells = (0..flow.cells.len() as u32).map(crate::ir::function::Cell);
            let shared = cells.map(|cell| varying.is_shared(cell)).collect();
            flow.body.clear();
            Ok(Self {
                flow,
                flat,
                homes,
                shared,
                sites,
                plot,
            })
        })?
    }

    /// Where a loop stands.
    pub(crate) fn loop_at(&self, id: u32) -> Place {
        self.flow.loops[id as usize]
    }
}
