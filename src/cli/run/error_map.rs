//! `toyproof run --error-map`: how far float32 is from double precision in each pixel.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::ValueEnum;
use serde::Serialize;
use toyproof_diagnostic::{columns, grouped, path_name};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{self as image, Frame};
use toyproof_project::{PassKind, Tab};
use toyproof_verify::compare::{ErrorUnit, PrecisionMap};
use toyproof_verify::evaluator::Evaluator;

use super::{Args, Runner, check_evaluated, evaluation_error};
use crate::cli::CliError;
use crate::cli::inputs::{Format, shell_word};
use crate::cli::shader::Shader;

#[derive(Debug, clap::Args)]
pub(super) struct ErrorMapArgs {
    /// Write a map of the error of float32 in each pixel (.png), and print a histogram
    ///
    /// The shader is evaluated in float32 and in double precision, on the CPU. Of a pass of a project, both read
    /// the buffers that float32 rendered.
    #[arg(
        long,
        value_name = "IMAGE",
        conflicts_with_all = ["frames", "duration", "samples", "tile", "precision"],
        help_heading = "Precision"
    )]
    pub(super) error_map: Option<PathBuf>,
    /// The unit of errors: `levels` of 8 bits of the displayed colors, or `ulps`, units in the last place
    #[arg(
        long,
        value_enum,
        value_name = "UNIT",
        default_value = "levels",
        requires = "error_map",
        hide_possible_values = true,
        help_heading = "Precision"
    )]
    error_unit: UnitArg,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum UnitArg {
    Levels,
    Ulps,
}

impl UnitArg {
    fn unit(self) -> ErrorUnit {
        match self {
            Self::Levels => ErrorUnit::Levels,
            Self::Ulps => ErrorUnit::Ulps,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Levels => "levels",
            Self::Ulps => "ulps",
        }
    }
}

/// Checks that there is one image whose errors can be shown.
pub(super) fn check(args: &Args, is_one: bool) -> Result<(), CliError> {
    check_evaluated(args, "--error-map")?;
    if !is_one {
        return Err(CliError::new("--error-map takes one shader").with_help("name its image with -o"));
    }
    if args.pass == Some(PassKind::CubeA) {
        return Err(CliError::new("--error-map shows the image or a buffer").with_help("change --pass"));
    }
    Ok(())
}

/// The errors of an image, as JSON has them.
#[derive(Debug, Serialize)]
pub(super) struct WrittenErrors {
    output: String,
    /// `levels` or `ulps`.
    unit: &'static str,
    /// The largest error.
    largest: Option<f64>,
    /// The first pixel with the largest error: x from the left, y from the bottom.
    at: Option<[u32; 2]>,
    /// The numbers of pixels with errors up to each limit, in ascending order.
    histogram: Vec<(&'static str, u64)>,
}

impl Runner<'_> {
    /// Writes the map of a shader in a frame, with what its channels read.
    pub(super) fn write_error_map(
        &mut self,
        shader: &Shader,
        checked: &Checked,
        frame: &Frame,
    ) -> Result<(), CliError> {
        let args = &self.args.error_map;
        let Some(path) = &args.error_map else {
            return Ok(());
        };
        let failed = |failure| evaluation_error(&failure, shader);
        let limit = self.args.driver.explicit_timeout();
        let program = Program::within(checked, limit).map_err(|refusal| failed(refusal.into()))?;
        let evaluator = Evaluator::new(&program, frame, limit, self.terminal.interrupt_flag());
        let spinner = self.terminal.spinner(&shader.name);
        let rendered = evaluator.render(&frame.rows(), |_| ());
        spinner.finish_and_clear();
        if self.terminal.interrupt_flag().load(Ordering::Relaxed) {
            return Err(CliError::silent());
        }
        let rendered = rendered.map_err(failed)?;
        let double = rendered.double.map_err(failed)?;
        let unit = args.error_unit;
        let map = PrecisionMap::new(&rendered.single, &double.image, &rendered.undefined, unit.unit());
        let map_image = image::encode_shown(&map.image(), path)?;
        self.terminal.write(path, &map_image)?;
        let [width, height] = frame.size;
        self.terminal.confirm(
            path,
            &format!("errors of float32 in {}, {width}×{height}", unit.name()),
        );
        let errors = WrittenErrors {
            output: path_name(path),
            unit: unit.name(),
            largest: map.worst().map(|(error, _)| error),
            at: map.worst().map(|(_, at)| at),
            histogram: map.histogram(),
        };
        self.print_errors(&errors, shader);
        if let Some(written) = self.images.last_mut() {
            written.errors = Some(errors);
        }
        Ok(())
    }

    /// Prints the histogram, and how to debug the worst pixel.
    fn print_errors(&self, errors: &WrittenErrors, shader: &Shader) {
        if self.args.format == Format::Json {
            return;
        }
        let all: u64 = errors.histogram.iter().map(|(_, count)| count).sum();
        let mut rows = vec![vec![errors.unit.to_owned(), "pixels".to_owned(), String::new()]];
        for &(name, count) in errors.histogram.iter().filter(|(_, count)| *count > 0) {
            let share = 100.0 * count as f64 / all as f64;
            rows.push(vec![name.to_owned(), grouped(count), format!("{share:.1} %")]);
        }
        for line in columns("  ", &rows, &[1, 2]) {
            self.terminal.result(&line);
        }
        if let (Some(largest), Some([x, y])) = (errors.largest.filter(|&error| error > 0.0), errors.at) {
            let pass = match self.args.pass {
                Some(pass) if pass != PassKind::Image => format!(" --pass {}", Tab::Pass(pass).name()),
                _ => String::new(),
            };
            let unit = if errors.unit == "ulps" { "ULPs" } else { "levels" };
            self.terminal.result(&format!(
                "largest: {largest:.3} {unit} at ({x}, {y}); toyproof debug {}{pass} --pixel {x},{y}",
                shell_word(&shader.name)
            ));
        }
    }
}
