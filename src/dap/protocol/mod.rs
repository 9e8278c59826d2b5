//! The protocol: the framing of messages, the requests that are understood, and what is sent.
//!
//! The types follow the specification of the Debug Adapter Protocol, version 1.70
//! (<https://microsoft.github.io/debug-adapter-protocol/specification>), as far as they are used.

pub(crate) mod framing;
pub(crate) mod reply;
pub(crate) mod request;
