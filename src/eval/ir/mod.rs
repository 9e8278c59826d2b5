//! The intermediate representation: structured control flow over operations on single components.

pub(crate) mod alias;
pub(crate) mod function;
pub(crate) mod operation;
