//! The samples of a sound, which a shader computes as the pixels of an image.

use std::ops::Range;

use toyproof_image::Frame;

use crate::exec::evaluate::Number;
use crate::exec::limits::Failure;
use crate::exec::settings::Settings;
use crate::program::Program;

/// The number of samples in a row of the image.
pub const SOUND_COLUMNS: u32 = 512;

impl Program {
    /// Evaluates rows of samples, [`SOUND_COLUMNS`] in each: left and right, nominally in [−1, 1]. The
    /// function that is called computes the samples of blocks of 512 rows, one block above the other. Of the
    /// frame, the date and the channels count.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn sound<N: Number>(
        &self,
        frame: &Frame,
        rows: Range<u32>,
        settings: &Settings<'_, N>,
    ) -> Result<Vec<[f32; 2]>, Failure> {
        let frame = Frame {
            size: [SOUND_COLUMNS, rows.end],
            ..frame.clone()
        };
        let rendered = self.render_rows(&frame, rows, settings)?;
        let samples = rendered.image.pixels().iter();
        Ok(samples.map(|&[left, right, ..]| [left, right]).collect())
    }
}
