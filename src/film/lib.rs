//! Films of rendered frames. Finished frames are kept without loss beside the film until it is complete, so
//! that an interrupted rendering goes on; GIF, APNG, Y4M and raw frames are built in, and an installed ffmpeg
//! writes MP4 and `WebM`.
//!
//! ```
//! use toyproof_film::{FilmSettings, FilmWriter, Format, FrameRate};
//! use toyproof_image::Image;
//!
//! let path = std::env::temp_dir().join(format!("toyproof-film-{}.gif", std::process::id()));
//! let settings = FilmSettings::new(Format::Gif, [2, 2], FrameRate::nearest(25.0), 3);
//! let mut film = FilmWriter::open(&path, settings, "the same text for the same frames")?;
//! for frame in film.existing()..3 {
//!     film.add(&Image::new(2, 2, vec![[frame as f32 / 2.0, 0.0, 0.0, 1.0]; 4]))?;
//! }
//! let film = film.finish(&mut |_| true)?;
//! assert_eq!(film.shown, 3);
//! std::fs::remove_file(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Parts
//!
//! - `settings`: formats, frame rates and what else a film is made with; `error`: why there is none.
//! - `writer`: [`FilmWriter`], which collects frames and encodes them; [`StreamWriter`], for pipes.
//! - `store`: the file of finished frames.
//! - `frame`: a frame as displayed; `seam`: whether the end of a film leads into its start.
//! - `gif`: the encoder, with `palette` (the colors of a film) and `dither` (the mixing of them).
//! - `apng`, `raw` (Y4M and RGBA) and `ffmpeg` (MP4 and `WebM`): the other encoders; `yuv`: color conversion.

mod apng;
mod dither;
mod error;
mod ffmpeg;
mod frame;
mod gif;
mod palette;
mod raw;
mod seam;
mod settings;
mod store;
#[cfg(test)]
mod tests;
mod writer;
mod yuv;

pub use error::FilmError;
pub use ffmpeg::version as ffmpeg_version;
pub use seam::Seam;
pub use settings::{FilmSettings, Format, FrameRate, Plays};
pub use writer::{Film, FilmWriter, StreamWriter, check};
