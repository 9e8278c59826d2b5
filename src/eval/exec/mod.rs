//! Execution: instructions for one number type and frame, the functions that execute them, and the tiles of
//! an image.

pub(crate) mod batch;
pub(crate) mod counter;
pub(crate) mod evaluate;
pub(crate) mod frame;
pub(crate) mod isel;
pub(crate) mod lanes;
pub(crate) mod limits;
pub(crate) mod native;
pub(crate) mod number;
pub(crate) mod observe;
pub(crate) mod ops;
pub(crate) mod places;
pub(crate) mod recorder;
pub(crate) mod settings;
pub(crate) mod texture;
pub(crate) mod tile;
pub(crate) mod wide;
