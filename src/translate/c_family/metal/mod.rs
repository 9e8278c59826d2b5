//! Metal Shading Language, where it differs from HLSL: the structure that contains what reads inputs and
//! global variables, constructors, operators of matrices, integers that wrap, and lookups.

mod construct;
mod lookup;
mod operator;
mod state;
#[cfg(test)]
mod tests;
mod wrapping;
