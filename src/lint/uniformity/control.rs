//! Where and why pixels may have gone different ways.

use toyproof_glsl::tree::ExprId;

/// Why control may differ between pixels here.
#[derive(Clone, Copy)]
pub(super) struct Control {
    /// Something in this function.
    pub(super) own: Option<ExprId>,
    /// Something in a caller.
    pub(super) callers: Option<ExprId>,
}

/// Where control may have parted for the rest of what encloses a statement.
#[derive(Default)]
pub(super) struct Parted {
    /// Until the function ends.
    pub(super) function: Option<ExprId>,
    /// Until the loop or `switch` ends.
    pub(super) exit: Option<ExprId>,
    /// Until the round of the loop ends.
    pub(super) round: Option<ExprId>,
}

impl Parted {
    /// Any of them.
    pub(super) fn cause(&self) -> Option<ExprId> {
        self.function.or(self.exit).or(self.round)
    }
}
