//! `toyproof compare`: two images, two folders of images, or two shaders.

mod folders;
mod images;
mod shaders;

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use toyproof_diagnostic::path_name;
use toyproof_metrics::Metric;
use toyproof_project::files;
use toyproof_report::ComparisonReport;
use toyproof_verify::compare::{Criteria, MaxDiffering, Rectangle};

use super::inputs::{
    Format, FrameArgs, LanguageArgs, check_output, parse_number, parse_time_limit, shell_word,
};
use super::reference::parse_tolerance;
use super::sequence::{self, Frames, parse_rate};
use super::{CliError, Exit, Terminal};

/// Compare two images, folders of images, or shaders: exit code 0 if they agree, 1 if they differ
///
/// Pixels of images differ if a component differs by more than 0.001, or, if an image is a PNG, by more than
/// one of its 256 levels: that is rounding. Images of two folders are compared by their names.
///
/// Two shaders or projects are evaluated in strict float32 on the CPU, and compared to the bit: is a minified
/// or optimized shader the same? With --tolerance, --max-differing or --metric, their images are compared
/// instead.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof compare reference.png mine.png --diff difference.png
  toyproof compare expected actual --metric flip --limit 0.05 --diff differences
  toyproof compare mine.glsl minified.glsl --frames 0..59")]
pub(super) struct Args {
    /// The expected image (.png, .exr), a folder of images, or a shader or project
    a: PathBuf,
    /// The actual image, folder, shader or project
    b: PathBuf,
    /// The largest difference of a color component of pixels that agree, in 8-bit levels [default: 1 for PNG,
    /// else 0.255]
    #[arg(long, value_name = "LEVELS", value_parser = parse_tolerance, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// The largest number of pixels that differ, or their share: 20, 0.1% [default: 0, or any with --limit]
    #[arg(long, value_name = "N|P%", value_parser = parse_most)]
    max_differing: Option<MaxDiffering>,
    /// A measure of the whole image: rmse, psnr (decibels), ssim, flip or hdr-flip
    #[arg(long, value_enum, value_name = "NAME", hide_possible_values = true)]
    metric: Option<MetricName>,
    /// The limit of the metric: rmse, flip and hdr-flip may not be larger, psnr and ssim not smaller
    ///
    /// It decides instead of the number of differing pixels, unless --max-differing is given, too.
    #[arg(long, value_name = "X", requires = "metric", allow_negative_numbers = true)]
    limit: Option<f64>,
    /// Compare a part of the images only: its left column and bottom row, from 0, its width and its height
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_region)]
    region: Option<Rectangle>,
    /// Write an image that shows where and by how much they differ; of folders, a folder of such images
    ///
    /// Each decade of the difference has a color. The errors of ssim, flip and hdr-flip are shown in the
    /// colors of magma, from black (0) to light yellow (1).
    #[arg(long, value_name = "IMAGE|DIR")]
    diff: Option<PathBuf>,
    /// The format of standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
    /// Compare shaders in frames A to B [default: the frame of --frame; of projects, 0..7]
    #[arg(long, value_name = "A..B", value_parser = sequence::parse_frames, conflicts_with = "frame", help_heading = "Frame")]
    frames: Option<Frames>,
    /// The frames of shaders in a second
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = parse_rate, hide_short_help = true, help_heading = "Frame")]
    fps: f64,
    /// The time limit for compiling a pass and for each frame: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = parse_time_limit, hide_short_help = true)]
    timeout: Duration,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
}

/// The values of `--metric`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum MetricName {
    Rmse,
    Psnr,
    Ssim,
    Flip,
    HdrFlip,
}

impl From<MetricName> for Metric {
    fn from(name: MetricName) -> Self {
        match name {
            MetricName::Rmse => Self::Rmse,
            MetricName::Psnr => Self::Psnr,
            MetricName::Ssim => Self::Ssim,
            MetricName::Flip => Self::Flip,
            MetricName::HdrFlip => Self::HdrFlip,
        }
    }
}

impl Args {
    /// By what images are compared.
    fn criteria(&self) -> Result<Criteria, CliError> {
        let metric = self.metric.map(Metric::from);
        if let Some((metric, limit)) = metric.zip(self.limit)
            && let range = metric.limits()
            && !range.contains(&limit)
        {
            let (name, low, high) = (metric.name(), range.start(), range.end());
            let error = format!(
                "the limit {limit} of {name} is out of range; expected a number from {low} to {high}"
            );
            return Err(CliError::new(error));
        }
        Ok(Criteria {
            tolerance: self.tolerance.map(|levels| levels / 255.0),
            max_differing: self.max_differing,
            metric,
            limit: self.limit,
            region: self.region,
        })
    }

    /// The inputs as the user named them.
    fn names(&self) -> [String; 2] {
        [&self.a, &self.b].map(|path| path_name(path))
    }

    /// Whether a flag is given that concerns shaders alone.
    fn has_frame_flags(&self) -> bool {
        self.frames.is_some() || self.frame.size.is_some() || self.frame.is_given()
    }
}

/// What an input is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Shader,
    Folder,
    Image,
}

impl Kind {
    fn of(path: &Path) -> Self {
        if path == Path::new("-") || files::is_shader(path) || files::is_project(path) || files::is_json(path)
        {
            Self::Shader
        } else if path.is_dir() {
            Self::Folder
        } else {
            Self::Image
        }
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    if let Some(diff) = &args.diff {
        check_output(diff, &[&*args.a, &*args.b].into_iter().collect())?;
    }
    let criteria = args.criteria()?;
    let kinds = [&args.a, &args.b].map(|path| Kind::of(path));
    if !kinds.contains(&Kind::Shader) && args.has_frame_flags() {
        let error = CliError::new("images have no frames: --frames, --size and the like apply to shaders");
        return Err(error.with_help("leave these flags out; --region compares a part of the images"));
    }
    let report = match kinds {
        [Kind::Shader, Kind::Shader] => shaders::compare(args, &criteria, terminal)?,
        [Kind::Folder, Kind::Folder] => folders::compare(args, &criteria, terminal)?,
        [Kind::Image, Kind::Image] => images::compare(args, &criteria, terminal)?,
        [Kind::Shader, other] => return Err(mixed(&args.a, &args.b, other)),
        [other, Kind::Shader] => return Err(mixed(&args.b, &args.a, other)),
        [Kind::Folder, Kind::Image] | [Kind::Image, Kind::Folder] => {
            let [a, b] = args.names();
            let folder = if kinds[0] == Kind::Folder { &a } else { &b };
            return Err(CliError::new(format_args!(
                "{folder} is a folder, and can only be compared with another folder of images"
            )));
        }
    };
    match args.format {
        Format::Json => terminal.stream(|out| report.json(out))?,
        Format::Human => {
            for line in report.lines(terminal.is_verbose()) {
                terminal.result(&line);
            }
        }
    }
    Ok(exit(&report))
}

fn exit(report: &ComparisonReport) -> Exit {
    match (report.has_errors(), report.agrees()) {
        (true, _) => Exit::Error,
        (false, true) => Exit::Success,
        (false, false) => Exit::ShaderFault,
    }
}

/// The error on a shader and something else.
fn mixed(shader: &Path, other: &Path, kind: Kind) -> CliError {
    let [name, other] = [shader, other].map(path_name);
    if kind == Kind::Folder {
        return CliError::new(format_args!(
            "{name} is a shader, and {other} is a folder without a project; only a shader or a project can be compared \
             with it"
        ));
    }
    let error = CliError::new(format_args!(
        "{name} is a shader; `compare` takes two images, or two shaders"
    ));
    error.with_help(format_args!(
        "to compare a shader with an image: toyproof check {} --reference {}",
        shell_word(&name),
        shell_word(&other)
    ))
}

/// Parses the largest number of differing pixels, or their share.
fn parse_most(text: &str) -> Result<MaxDiffering, String> {
    const EXPECTED: &str = "a number of pixels, or a share from 0% to 100%";
    match text.strip_suffix('%') {
        Some(share) => parse_number(share.trim_end(), 0.0..=100.0, EXPECTED).map(MaxDiffering::Percent),
        None => text
            .parse()
            .map(MaxDiffering::Pixels)
            .map_err(|_| format!("expected {EXPECTED}")),
    }
}

/// Parses a part of an image.
fn parse_region(text: &str) -> Result<Rectangle, String> {
    let expected =
        "expected four integers X,Y,W,H: the left column, the bottom row, the width and the height";
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Rectangle { x, y, width, height }),
        _ => Err(expected.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_parsed() {
        assert_eq!(parse_most("12"), Ok(MaxDiffering::Pixels(12)));
        assert_eq!(parse_most("0.5 %"), Ok(MaxDiffering::Percent(0.5)));
        for wrong in ["", "-1", "1.5", "101%", "x%", "nan%"] {
            assert!(parse_most(wrong).is_err(), "{wrong}");
        }
        let region = Rectangle {
            x: 1,
            y: 2,
            width: 3,
            height: 4,
        };
        assert_eq!(parse_region("1, 2,3,4"), Ok(region));
        for wrong in ["1,2,3", "1,2,0,4", "1,2,3,-4", "1,2,3,4,5", ""] {
            assert!(parse_region(wrong).is_err(), "{wrong}");
        }
    }
}
