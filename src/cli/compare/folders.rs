//! `toyproof compare` of two folders of images.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_image as image;
use toyproof_report::{ComparedImages, ComparisonReport, ImageStatus};
use toyproof_verify::Quantization;
use toyproof_verify::compare::Criteria;

use super::Args;
use super::images::compare_files;
use crate::cli::{CliError, Terminal};

/// Compares the images that have the same path in both folders; others are reported.
pub(super) fn compare(
    args: &Args,
    criteria: &Criteria,
    terminal: &Terminal,
) -> Result<ComparisonReport, CliError> {
    let folders = [&*args.a, &*args.b];
    let mut found: BTreeMap<PathBuf, [bool; 2]> = BTreeMap::new();
    for (at, folder) in folders.into_iter().enumerate() {
        let mut paths = Vec::new();
        let searched = find_images(folder, &mut paths);
        searched.map_err(|error| format!("{}: {error}", path_name(folder)))?;
        for path in paths {
            let relative = path.strip_prefix(folder).unwrap_or(&path);
            found.entry(relative.to_owned()).or_default()[at] = true;
        }
    }
    if found.is_empty() {
        let [a, b] = args.names();
        return Err(CliError::new(format_args!(
            "there are no images (.png, .exr) in {a} and {b}"
        )));
    }
    let bar = terminal.bar(found.len() as u64, "images");
    let mut images = Vec::with_capacity(found.len());
    for (relative, is_in) in found {
        let compared = match is_in {
            [true, true] => pair(
                args,
                &folders.map(|folder| folder.join(&relative)),
                &relative,
                criteria,
                terminal,
            )?,
            [is_in_first, _] => ComparedImages::alone(is_in_first),
        };
        images.push(compared.at_path(path_name(&relative)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(ComparisonReport::of_images(args.names(), criteria, images))
}

/// Compares two images, and writes the image of their differences if there are any.
fn pair(
    args: &Args,
    paths: &[PathBuf; 2],
    relative: &Path,
    criteria: &Criteria,
    terminal: &Terminal,
) -> Result<ComparedImages, CliError> {
    let [a, b] = paths.each_ref().map(|path| image::read(path));
    let (a, b) = match (a, b) {
        (Ok(a), Ok(b)) => (a, b),
        (Err(error), _) | (_, Err(error)) => return Ok(ComparedImages::failed(error)),
    };
    let difference = match compare_files(paths.each_ref().map(|path| &**path), [&a, &b], criteria) {
        Ok(difference) => difference,
        Err(error) => return Ok(ComparedImages::failed(error)),
    };
    let compared = ComparedImages::new(&difference, criteria);
    if let Some(folder) = &args.diff
        && compared.status() != ImageStatus::Equal
    {
        let path = folder.join(difference_name(relative));
        let bytes = image::encode_shown(&difference.image(), &path)?;
        terminal.write_output(folder, &path, &bytes)?;
    }
    Ok(compared)
}

/// The name of the image of the differences: `a.png` for `a.png`, and `a.exr.png` for `a.exr`, which may be
/// beside it.
fn difference_name(relative: &Path) -> PathBuf {
    if Quantization::of_file(relative) == Some(Quantization::EightBit) {
        return relative.to_owned();
    }
    let mut name = relative.as_os_str().to_owned();
    name.push(".png");
    name.into()
}

/// Finds the images in a folder and below it. Folders that are links are not entered.
fn find_images(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let path = entry.path();
        if entry.file_type()?.is_dir() {
            find_images(&path, found)?;
        } else if Quantization::of_file(&path).is_some() && path.is_file() {
            found.push(path);
        }
    }
    Ok(())
}
