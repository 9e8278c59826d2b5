//! The images that `--out` keeps of a shader, and those that the report page shows.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use toyproof_diagnostic::path_name;
use toyproof_explain::Findings;
use toyproof_explain::departure::ValueImages;
use toyproof_image::{self as image, ImageError, Rgb8Image, input, output};
use toyproof_project::files;
use toyproof_report::{
    Exhibit, Gallery, Hints, MAX_IMAGE_BYTES, Rubric, StudentImages, Thumbnails, subsample,
};
use toyproof_verify::CheckResult;
use toyproof_verify::compare::{DiffLevel, IN_BITS, Legend, SEEN_BY_EYE};
use toyproof_verify::contain::{Part, contain};

use super::outcome::Log;
use super::submission::Submission;
use crate::cli::names::with_suffix;

/// A kind of image, which a shader may lack.
pub(super) struct ImageKind {
    /// The suffix of the image's file name.
    pub(super) suffix: &'static str,
    /// Creates the image, if the findings have it. Images are large, so each is made only when it is written.
    pub(super) make: fn(&Findings) -> Option<Cow<'_, Rgb8Image>>,
}

/// The image after the fix of a wrong shader.
pub(super) const FIXED: ImageKind = ImageKind {
    suffix: "-fixed.png",
    make: |findings| {
        let fix = findings.search.as_ref()?.repairs.first()?;
        Some(Cow::Borrowed(&fix.image))
    },
};

/// The rendered image, the reference, their difference, the image after the fix of a wrong shader, an image
/// for each check that finds a difference, and the values in which a wrong shader departs from its reference.
pub(super) const IMAGES: [ImageKind; 9] = [
    ImageKind {
        suffix: "-actual.png",
        make: |findings| Some(Cow::Borrowed(&findings.results.actual)),
    },
    ImageKind {
        suffix: "-reference.png",
        make: |findings| findings.results.reference.as_ref().map(Cow::Borrowed),
    },
    ImageKind {
        suffix: "-difference.png",
        make: |findings| {
            let (_, marks) = findings.results.comparison.as_ref()?;
            Some(difference(findings, marks, SEEN_BY_EYE))
        },
    },
    FIXED,
    ImageKind {
        suffix: "-algorithm.png",
        make: |findings| check(findings, findings.results.algorithm.as_ref(), SEEN_BY_EYE),
    },
    ImageKind {
        suffix: "-precision.png",
        make: |findings| check(findings, findings.results.precision.as_ref(), SEEN_BY_EYE),
    },
    ImageKind {
        suffix: "-toolchain.png",
        make: |findings| check(findings, findings.results.toolchain.as_ref(), IN_BITS),
    },
    ImageKind {
        suffix: "-value.png",
        make: |findings| value_images(findings)?.own.as_ref().map(Cow::Borrowed),
    },
    ImageKind {
        suffix: "-reference-value.png",
        make: |findings| value_images(findings)?.reference.as_ref().map(Cow::Borrowed),
    },
];

/// The values in which a wrong shader without a fix departs from its reference.
fn value_images(findings: &Findings) -> Option<&ValueImages> {
    let is_repaired = findings
        .search
        .as_ref()
        .is_some_and(|search| !search.repairs.is_empty());
    let departure = findings.departure.as_ref().filter(|_| !is_repaired)?;
    departure.images.as_ref()
}

fn check<'a>(findings: &Findings, check: Option<&CheckResult>, legend: Legend) -> Option<Cow<'a, Rgb8Image>> {
    let check = check.filter(|check| !check.summary.is_same())?;
    Some(difference(findings, &check.diff_levels, legend))
}

fn difference<'a>(findings: &Findings, marks: &[DiffLevel], legend: Legend) -> Cow<'a, Rgb8Image> {
    Cow::Owned(toyproof_verify::compare::difference(
        findings.results.actual.size(),
        marks,
        legend,
    ))
}

/// Writes images of these kinds, and removes stale ones of an earlier run.
pub(super) fn keep(out: &Path, stem: &Path, kinds: &[ImageKind], findings: Option<&Findings>, log: &mut Log) {
    for kind in kinds {
        let path = with_suffix(stem, kind.suffix);
        let kept = contain(Part::Image, || match findings.and_then(kind.make) {
            Some(shown) => output::stream_inside(out, &path, |file| image::write_png(&shown, file)),
            None => output::remove_inside(out, &path),
        });
        let is_made = kept.is_ok();
        let kept =
            kept.unwrap_or_else(|panic| Err(io::Error::other(format!("{}: {panic}", path_name(&path)))));
        if let Err(error) = kept {
            log.fail(format!("cannot write {error}"));
            log.lacks_image |= is_made;
        }
    }
}

// The parts of a shader on the report page: its text, and the images that were written.

/// Which images of shaders a page has.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shown {
    /// All, for teachers.
    All,
    /// Those that the rubric and the hints permit, for the author of the shaders.
    Student(StudentImages, Hints),
}

impl Shown {
    /// Whether a page has the image with this suffix.
    fn has(self, suffix: &str) -> bool {
        match self {
            Self::All => true,
            Self::Student(StudentImages::None, _) => false,
            Self::Student(StudentImages::Rendered, _) => suffix == "-actual.png",
            Self::Student(StudentImages::All, hints) => match suffix {
                // What the reference computes on the way to its image.
                "-reference-value.png" => false,
                "-fixed.png" | "-value.png" => hints >= Hints::Line,
                _ => true,
            },
        }
    }
}

/// Builds the gallery of the shaders of a page, subsampling the images until it fits [`MAX_IMAGE_BYTES`].
pub(super) fn gallery(submissions: &[&Submission], shown: Shown) -> Gallery {
    let mut step = 1;
    loop {
        let mut gallery = Gallery::new(step);
        for submission in submissions {
            let exhibit = exhibit(submission, step, shown, &mut gallery);
            gallery.add_exhibit(exhibit);
        }
        if gallery.bytes() <= MAX_IMAGE_BYTES {
            return gallery;
        }
        // The number of pixels falls with the square of the step.
        let too_large = gallery.bytes() as f64 / MAX_IMAGE_BYTES as f64;
        step = (step + 1).max((f64::from(step) * too_large.sqrt()) as u32);
    }
}

fn exhibit(submission: &Submission, step: u32, shown: Shown, gallery: &mut Gallery) -> Exhibit {
    let mut exhibit = Exhibit::default();
    // Unreadable files are not shown: the record holds the reason.
    if let Ok(found) = &submission.input
        && let Ok(texts) = files::read(found)
        && let [file] = texts.files()[..]
    {
        exhibit.source = Some(file.text().to_owned());
    }
    let Some(stem) = &submission.output_stem else {
        return exhibit;
    };
    let paths = IMAGES.map(|kind| with_suffix(stem, kind.suffix));
    let is_shown = |path: &Path| {
        let kind = IMAGES.iter().zip(&paths).find(|(_, known)| *known == path);
        kind.is_some_and(|(kind, _)| shown.has(kind.suffix))
    };
    let [actual, reference, _, fixed, checks @ .., value, reference_value] = &paths;
    // The images of checks have a legend at the bottom, which the page does not show.
    let size = if step == 1 {
        None
    } else {
        image::read_shown(actual).ok().map(|actual| actual.size())
    };
    let mut add = |path: &Path| {
        if !is_shown(path) {
            return None;
        }
        let png = match size {
            None => input::read(path).ok(),
            Some(size) => subsampled_png(path, step, size).ok(),
        };
        png.map(|png| gallery.add_image(png))
    };
    exhibit.actual = add(actual);
    exhibit.reference = add(reference);
    exhibit.fixed = add(fixed);
    exhibit.checks = checks.each_ref().map(|path| add(path));
    exhibit.values = [value, reference_value].map(|path| add(path));
    exhibit
}

fn subsampled_png(path: &Path, step: u32, size: [u32; 2]) -> Result<Vec<u8>, ImageError> {
    image::encode_shown(&subsample(step, &image::read_shown(path)?, size), path)
}

// The images that students see next to their marks.

/// The largest number of shaders whose images are shown: those of one student, not of a class.
const MAX_SHADERS_OF_STUDENT: usize = 4;

/// The largest width that is shown, in pixels: three images stand side by side.
const MAX_THUMBNAIL_WIDTH: u32 = 320;

/// The largest size of all PNGs, in bytes, which base64 enlarges by a third. The format states no limit; a
/// page of this size opens quickly.
const MAX_THUMBNAIL_BYTES: usize = 400_000;

/// The images of a student's shaders, subsampled until they fit.
pub(super) fn thumbnails(submissions: &[&Submission], rubric: &Rubric) -> Thumbnails {
    let captions: &[&str] = match rubric.images {
        StudentImages::All => &["your image", "the reference", "the difference"],
        StudentImages::Rendered => &["your image"],
        StudentImages::None => &[],
    };
    if submissions.len() > MAX_SHADERS_OF_STUDENT {
        return Thumbnails::default();
    }
    let mut width = MAX_THUMBNAIL_WIDTH;
    loop {
        let mut thumbnails = Thumbnails::default();
        for submission in submissions {
            let images = IMAGES.iter().zip(captions);
            let images = images.filter_map(|(kind, &caption)| {
                let path = with_suffix(submission.output_stem.as_ref()?, kind.suffix);
                let image = image::read_shown(&path).ok()?;
                let step = image.size()[0].div_ceil(width);
                let png = subsampled_png(&path, step, image.size()).ok()?;
                Some((caption, png))
            });
            thumbnails.add(submission.name.clone(), images.collect());
        }
        if thumbnails.bytes() <= MAX_THUMBNAIL_BYTES || width == 1 {
            return thumbnails;
        }
        width /= 2;
    }
}
