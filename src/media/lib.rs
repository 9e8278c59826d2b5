//! `ShaderToy`'s media: computed stand-ins for those of the site, which may not be distributed, and images,
//! films, volumes and sounds from files. Everything has the same bits on every machine.
//!
//! ```
//! use toyproof_media::{Content, StandIn};
//!
//! let bayer = StandIn::find("Xdf3zn").unwrap();
//! let Content::Texture(compute) = bayer.content else { unreachable!("a texture") };
//! let image = compute();
//! assert_eq!(image.size(), [8, 8]);
//! assert_eq!(image.get(0, 7), [0.0, 0.0, 0.0, 1.0]);
//! ```
//!
//! Stand-ins use only integers, operations that IEEE 754 rounds exactly, and the functions of
//! `toyproof_math`, in an order that does not depend on the number of threads.
//!
//! # Parts
//!
//! - `stand_in`: the table of stand-ins.
//! - `field`: periodic grids of numbers, and noise; `color`: tones and levels; `material`: materials made of
//!   them.
//! - `blue_noise`, `font`, `film`: further textures; `cube`: environments and their cube maps, and those from
//!   files.
//! - `animation`, `volume`: films and volumes from files; `folder`: a folder of copies of the site's media.
//! - `music`: the spectrum and the wave of a sound file; `sound`: sounds of shaders as files.

mod animation;
mod blue_noise;
mod color;
mod cube;
mod error;
mod field;
mod film;
mod folder;
mod font;
mod material;
mod music;
mod sound;
mod stand_in;
mod volume;

pub use self::animation::{Film, sequence_files};
pub use self::cube::read_cube;
pub use self::error::MediaError;
pub use self::folder::{MediaFolder, MediumNames, with_components};
pub use self::music::{Music, silent_music};
pub use self::sound::{SAMPLE_RATE, SOUND_SECONDS, sample_level, wav};
pub use self::stand_in::{Content, StandIn};
pub use self::volume::read_volume;

#[cfg(test)]
mod tests;
