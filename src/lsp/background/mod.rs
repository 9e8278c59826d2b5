//! What the program itself finds in the background: the verdict of a check after each save, and the values of
//! a pixel. The server starts its own executable, which renders, searches and has limits of its own; ending
//! that process ends everything.

mod check;
mod pixel;
mod process;

pub(crate) use self::check::{CHECK_COMMAND, CheckResult, Checks, has_reference};
pub(crate) use self::pixel::{PixelValues, Pixels};
pub(crate) use self::process::{Job, Output};
