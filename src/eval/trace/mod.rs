//! What single pixels compute, step by step.

pub(crate) mod story;
pub(crate) mod teller;

pub use story::{Call, CallId, Event, EventId, Happened, Lead, Plot, Story, Told, What};
pub use teller::Teller;
