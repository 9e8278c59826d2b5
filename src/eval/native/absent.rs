//! Machine code for processors that there is none for.

use crate::batch::Batch;
use crate::lower::isel::Prepared;
use crate::number::Number;
use crate::program::Compiled;
use crate::render::Engine;

/// No machine code.
#[derive(Debug, Default)]
pub(crate) struct Cache;

/// Machine code, which does not exist.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Native<'a>(std::convert::Infallible, std::marker::PhantomData<&'a ()>);

/// Nothing to count.
#[derive(Debug, Default)]
pub(crate) struct Underflows;

impl Compiled {
    /// Returns no machine code.
    #[expect(clippy::unused_self, reason = "the interface is the one of other processors")]
    pub(crate) fn native<N: Number>(&self, _: &Prepared<N>, _: Engine) -> Option<Native<'_>> {
        None
    }
}

impl Native<'_> {
    /// Cannot be called.
    pub(crate) fn run<N: Number>(
        self,
        _: &mut Batch<'_, N>,
        _: &Prepared<N>,
        _: &Underflows,
        _: impl Fn(&mut Batch<'_, N>),
    ) {
        match self.0 {}
    }
}
