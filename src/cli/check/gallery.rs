//! What the page shows of each shader: its text, and its pictures as they lie in the folder.

use std::fs;
use std::path::Path;

use toyproof_image::{self as image, ImageError};

use super::judge::Submission;
use super::pictures::PICTURES;
use crate::cli::files;
use crate::cli::names::with_suffix;
use crate::report::{BUDGET, Exhibit, Gallery, every};

/// The gallery of all shaders, of whose pictures so many pixels are left out that it fits the page.
pub(super) fn gallery(submissions: &[&Submission]) -> Gallery {
    let mut step = 1;
    loop {
        let gallery = thinned(submissions, step);
        if gallery.bytes() <= BUDGET {
            return gallery;
        }
        // Twice the step leaves a quarter of the pixels.
        let too_large = gallery.bytes() as f64 / BUDGET as f64;
        step = (step + 1).max((f64::from(step) * too_large.sqrt()) as u32);
    }
}

fn thinned(submissions: &[&Submission], step: u32) -> Gallery {
    let mut gallery = Gallery::new(step);
    for submission in submissions {
        let exhibit = exhibit(submission, step, &mut gallery);
        gallery.show(exhibit);
    }
    gallery
}

/// What cannot be read is not shown: the record tells why there is no picture.
fn exhibit(submission: &Submission, step: u32, gallery: &mut Gallery) -> Exhibit {
    let mut exhibit = Exhibit::default();
    if let Ok(found) = &submission.input
        && let Ok(file) = files::read(found)
    {
        exhibit.source = Some(file.text().to_owned());
    }
    let Some(place) = &submission.place else {
        return exhibit;
    };
    let [actual, reference, _, questions @ ..] = PICTURES.map(|picture| with_suffix(place, picture.suffix));
    // The others have a legend below them, which the page does not show.
    let size = if step == 1 {
        None
    } else {
        image::read_shown(&actual).ok().map(|picture| picture.size())
    };
    let mut hang = |path: &Path| {
        let png = match size {
            None => fs::read(path).ok(),
            Some(size) => thin(path, step, size).ok(),
        };
        png.map(|png| gallery.hang(png))
    };
    exhibit.actual = hang(&actual);
    exhibit.reference = hang(&reference);
    exhibit.questions = questions.map(|path| hang(&path));
    exhibit
}

fn thin(path: &Path, step: u32, size: [u32; 2]) -> Result<Vec<u8>, ImageError> {
    image::encode_shown(&every(step, &image::read_shown(path)?, size), path)
}
