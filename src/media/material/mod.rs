//! Images of the materials that `ShaderToy`'s photographs show.
//!
//! Each is computed, and resembles its photograph only in the kind of the material, in size, and in the mean
//! and standard deviation of each component, which were measured on the site's files. All continue across
//! their sides.

mod cat;
mod fabric;
mod rock;
mod soil;
mod street;

pub(crate) use self::cat::running_cat;
pub(crate) use self::fabric::{glass_stones, wood, woven_straw};
pub(crate) use self::rock::{blue_stone, lichen, pebbles, rock_tiles, rose_marble};
pub(crate) use self::soil::{bark, blotches, pitted_rust, rusty_metal, stars};
pub(crate) use self::street::street;
