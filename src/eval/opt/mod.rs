//! Optimization passes on the intermediate representation; none changes a bit of the image.

pub(crate) mod dce;
pub(crate) mod divergence;
pub(crate) mod fuse;
pub(crate) mod gvn;
pub(crate) mod pair;
