//! Comparisons of folders of other authors' shaders.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use toyproof::convert::{Runner, compare_with_original, frames};
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{AdapterSelector, ShaderArtifact, Worker};
use toyproof::image::Frame;
use toyproof::translate::wgsl::Style;
use toyproof::verify::compare::CheckSummary;
use toyproof_testkit::toolchain::compare_bits;

/// The time limit of an image.
const TIMEOUT: Duration = Duration::from_secs(60);

/// The valid shaders of a folder, in an order independent of their names.
fn shaders(folder: &Path) -> impl Iterator<Item = (String, String, Checked)> {
    let entries = fs::read_dir(folder).expect("the folder is readable");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("it is readable").path())
        .collect();
    paths.sort_by_key(|path| {
        let name = path.as_os_str().as_encoded_bytes();
        name.iter().fold(0u32, |hash, &byte| {
            (hash ^ u32::from(byte)).wrapping_mul(16_777_619)
        })
    });
    paths.into_iter().filter_map(|path| {
        let name = path.file_stem()?.to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).ok()?;
        let mut files = Files::default();
        let file = files.add(File::new(&name, text.as_str()));
        let checked = check(&files, file, &Options::default()).ok()?;
        Some((name, text, checked))
    })
}

/// Compares a shader at two times and prints differences; fails with the reason if one of the two runs does.
fn compare(worker: &mut Worker, name: &str, checked: &Checked) -> Result<CheckSummary, String> {
    let mut sum = CheckSummary::default();
    for time in [0.7, 10.3] {
        let frame = Frame {
            size: [64, 36],
            time,
            frame: (time * 60.0) as i32,
            ..Frame::default()
        };
        let bits = compare_bits(worker, checked, &frame, TIMEOUT)?;
        if let Some(first) = bits.first {
            println!("{name}: {} differ at {time} s, first {first:?}", bits.differing);
        }
        sum.extend(&bits, 0);
    }
    Ok(sum)
}

/// Compares the bits of the evaluator and of the strict GPU run.
pub(super) fn compare_folder(folder: &Path, limit: usize) {
    let mut worker = super::worker(AdapterSelector::Auto, TIMEOUT);
    let (mut count, mut same, mut sum) = (0, 0, CheckSummary::default());
    for (name, text, checked) in shaders(folder) {
        if count == limit {
            break;
        }
        if text.contains("iChannel") {
            continue;
        }
        match compare(&mut worker, &name, &checked) {
            Ok(bits) => {
                count += 1;
                same += usize::from(bits.differing == 0);
                sum.extend(&bits, 0);
            }
            Err(why) => println!("{name}: {why}"),
        }
    }
    println!(
        "{count} shaders, {same} the same in every defined bit; of {} pixels {} undefined, {} differ",
        sum.pixels, sum.undefined, sum.differing
    );
}

/// Compares conversions by another program with their source shaders.
pub(super) fn compare_conversions(folder: &Path, converted: &Path) {
    let mut worker = super::worker(AdapterSelector::Auto, TIMEOUT);
    for (name, _, checked) in shaders(folder) {
        let Ok(text) = fs::read_to_string(converted.join(format!("{name}.wgsl"))) else {
            continue;
        };
        let written = ShaderArtifact::Wgsl(Style::Plain.hosted(&text));
        match compare_with_original(
            &mut Runner::Driver(&mut worker),
            &checked,
            vec![written],
            &frames(&checked),
            TIMEOUT,
            None,
        ) {
            Err(failure) => println!("{name}: {failure}"),
            Ok(proofs) => {
                for proof in proofs {
                    let (differing, pixels) = (proof.differing(), proof.pixels());
                    let result = if proof.holds() {
                        "proved".into()
                    } else {
                        format!("{differing} of {pixels} differ")
                    };
                    println!("{name}: {result}");
                }
            }
        }
    }
}
