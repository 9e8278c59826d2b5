//! `toyproof compare`

use std::path::PathBuf;

use toyproof_diagnostic::{grouped, magnitude, path_name, plural};
use toyproof_image::{self as image};
use toyproof_project::files;
use toyproof_verify::compare::{Legend, TOLERANCE, compare, compare_in_8_bits};

use super::inputs::{check_output, shell_word};
use super::{CliError, Exit, Terminal};

/// Compare two images: exit code 0 if they agree, 1 if they differ
///
/// Pixels differ if a component differs by more than 0.001, or, if an image is a PNG, by more than one of its
/// 256 levels: that is rounding.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Example:
  toyproof compare reference.png mine.png --diff difference.png")]
pub(super) struct Args {
    /// The expected image (.png, .exr)
    a: PathBuf,
    /// The actual image (.png, .exr)
    b: PathBuf,
    /// Write an image that shows where and by how much they differ
    #[arg(long, value_name = "IMAGE")]
    diff: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    if let Some(diff) = &args.diff {
        check_output(diff, &[&*args.a, &*args.b].into_iter().collect())?;
    }
    let shaders = [&args.a, &args.b].map(|path| files::is_shader(path) || files::is_project(path));
    if shaders.contains(&true) {
        let [a, b] = [&args.a, &args.b].map(|path| path_name(path));
        let shader = if shaders[0] { &a } else { &b };
        let help = match shaders {
            [true, true] => format!(
                "to compare a shader with another: toyproof check {} --reference {}",
                shell_word(&b),
                shell_word(&a)
            ),
            _ => format!(
                "to compare a shader with an image: toyproof check {} --reference {}",
                shell_word(shader),
                shell_word(if shaders[0] { &b } else { &a })
            ),
        };
        let error = CliError::new(format_args!("{shader} is a shader, but `compare` takes images"));
        return Err(error.with_help(help));
    }
    let (a, b) = match (image::read(&args.a), image::read(&args.b)) {
        (Ok(a), Ok(b)) => (a, b),
        (Err(a), Err(b)) => {
            terminal.error(a);
            return Err(b.into());
        }
        (Err(error), _) | (_, Err(error)) => return Err(error.into()),
    };
    if a.size() != b.size() {
        let [[aw, ah], [bw, bh]] = [a.size(), b.size()];
        return Err(CliError::new(format_args!(
            "{} has {aw}×{ah} pixels and {} has {bw}×{bh}; only images of equal size can be compared",
            path_name(&args.a),
            path_name(&args.b)
        )));
    }
    let has_8_bits = [&args.a, &args.b].iter().any(|path| {
        path.extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
    });
    let ((comparison, levels), tolerance) = if has_8_bits {
        (compare_in_8_bits(&a, &b), "one level of 255".to_owned())
    } else {
        (compare(&a, &b), TOLERANCE.to_string())
    };
    if let Some(path) = &args.diff {
        let difference_image = toyproof_verify::compare::difference(
            a.size(),
            &levels,
            Legend {
                tolerance: TOLERANCE as f32,
            },
        );
        terminal.write(path, &image::encode_shown(&difference_image, path)?)?;
    }
    let pixels = grouped(comparison.pixels);
    match comparison.differing {
        0 if comparison.max_abs == 0.0 => terminal.result(&format!("all {pixels} pixels are equal")),
        0 if has_8_bits => terminal.result(&format!("all {pixels} pixels agree to within {tolerance}")),
        0 => terminal.result(&format!(
            "all {pixels} pixels agree to within {}",
            magnitude(comparison.max_abs)
        )),
        differing => terminal.result(&format!(
            "{} of {pixels} pixels {} by more than {tolerance}; the largest difference is {:.4} ({} of 255)",
            grouped(differing),
            plural(differing, "differs", "differ"),
            comparison.max_abs,
            comparison.max_8bit
        )),
    }
    for (name, pixel) in [("first", comparison.first), ("worst", comparison.worst)] {
        if let Some(pixel) = pixel {
            terminal.result(&format!("{name} {}", toyproof_report::place(&pixel)));
        }
    }
    Ok(if comparison.differing == 0 {
        Exit::Success
    } else {
        Exit::ShaderFault
    })
}
