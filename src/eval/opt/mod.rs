//! Passes on the intermediate representation. All but `denormals` optimize, and change no bit of the image.

pub(crate) mod dce;
pub(crate) mod denormals;
pub(crate) mod divergence;
pub(crate) mod fuse;
pub(crate) mod gvn;
pub(crate) mod pair;
pub(crate) mod rollback;
