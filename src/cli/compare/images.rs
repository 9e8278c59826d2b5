//! `toyproof compare` of two images.

use std::path::Path;

use toyproof_image::{self as image, Image};
use toyproof_report::{ComparedImages, ComparisonReport};
use toyproof_verify::Quantization;
use toyproof_verify::compare::{Criteria, PairDifference, PairError, compare_pair};

use super::Args;
use crate::cli::{CliError, Terminal};

pub(super) fn compare(
    args: &Args,
    criteria: &Criteria,
    terminal: &Terminal,
) -> Result<ComparisonReport, CliError> {
    let (a, b) = match (image::read(&args.a), image::read(&args.b)) {
        (Ok(a), Ok(b)) => (a, b),
        (Err(a), Err(b)) => {
            terminal.error(a);
            return Err(b.into());
        }
        (Err(error), _) | (_, Err(error)) => return Err(error.into()),
    };
    let difference = compare_files([&args.a, &args.b], [&a, &b], criteria)?;
    if let Some(path) = &args.diff {
        terminal.write(path, &image::encode_shown(&difference.image(), path)?)?;
    }
    let compared = ComparedImages::new(&difference, criteria);
    Ok(ComparisonReport::of_images(
        args.names(),
        criteria,
        vec![compared],
    ))
}

/// Compares the images of two files.
pub(super) fn compare_files(
    paths: [&Path; 2],
    images: [&Image; 2],
    criteria: &Criteria,
) -> Result<PairDifference, PairError> {
    // What was read is an image, whatever its extension.
    let quantization = paths.map(|path| Quantization::of_file(path).unwrap_or(Quantization::Float));
    compare_pair(images, quantization, criteria)
}
