//! `toyproof run` of an image that is larger than memory, or than drivers render: its bands of rows are
//! written one after the other.

use std::io;
use std::path::Path;
use std::time::Instant;

use toyproof_diagnostic::path_name;
use toyproof_eval::{self as eval, Number, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::output::{self, MakeError};
use toyproof_image::{self as image, Frame, Image};

use super::{ImageFailure, Precision, Runner, check_evaluated, image_failure};
use crate::cli::CliError;
use crate::cli::shader::Shader;
use crate::cli::terminal::file_size;

/// Why an image is not written completely.
enum BandFailure {
    Evaluator(eval::Failure),
    Output(io::Error),
}

impl From<io::Error> for BandFailure {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl Runner<'_> {
    /// Checks that an image can be rendered in bands, if it must be.
    pub(super) fn check_banded(
        &self,
        shader: &Shader,
        has_history: bool,
        path: &Path,
    ) -> Result<(), CliError> {
        let [width, height] = self.frame.size;
        let is_png = path == Path::new("-")
            || path
                .extension()
                .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        if has_history {
            let error = CliError::new(format_args!(
                "{}: buffers of {width}×{height} pixels are not rendered in bands",
                shader.name
            ));
            return Err(error.with_help("use a smaller --size, without --tile"));
        }
        if !is_png {
            let error = CliError::new(format_args!(
                "{}: an image of {width}×{height} pixels is rendered in bands, which only PNG takes",
                path_name(path)
            ));
            return Err(error.with_help("name a .png with -o, or use a smaller --size, without --tile"));
        }
        check_evaluated(self.args, "an image in bands")
    }

    /// Renders an image into its file, band by band.
    pub(super) fn banded_image(
        &mut self,
        shader: &Shader,
        frame: &Frame,
        path: &Path,
    ) -> Result<(), CliError> {
        self.check_banded(shader, false, path)?;
        match self.args.precision {
            Precision::F32 => self.stream_bands::<f32>(shader, frame, path),
            Precision::F64 => self.stream_bands::<f64>(shader, frame, path),
        }
    }

    fn stream_bands<N: Number>(&self, shader: &Shader, frame: &Frame, path: &Path) -> Result<(), CliError> {
        let checked = shader.require_image()?;
        let start = Instant::now();
        let limit = self.args.driver.explicit_timeout();
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit));
        let program = program
            .map_err(|refusal| self.band_error(BandFailure::Evaluator(refusal.into()), shader, path))?;
        let settings = Settings::<N> {
            deadline: Some(start + limit),
            interrupt: Some(self.terminal.interrupt_flag()),
            ..Settings::plain()
        };
        let bar = self.terminal.bar(u64::from(frame.size[1]), "rows");
        let band = |rows: std::ops::Range<u32>| -> Result<Image, BandFailure> {
            let count = rows.len() as u64;
            let rendered = match &self.supersampling {
                None => program
                    .render_rows(frame, rows, &settings)
                    .map(|rendered| rendered.image),
                Some(samples) => program.render_supersampled(frame, rows, samples, &settings),
            };
            bar.inc(count);
            rendered.map_err(BandFailure::Evaluator)
        };
        let bands: Vec<_> = frame.bands().collect();
        let bands = bands.into_iter().rev().map(band);
        let alpha = self.args.transparent;
        let mut bytes = 0;
        let written = if path == Path::new("-") {
            let mut failure = None;
            self.terminal
                .stream(|out| match image::stream_png(frame.size, alpha, bands, out) {
                    Ok(()) => Ok(()),
                    Err(BandFailure::Output(error)) => Err(error),
                    Err(evaluator) => {
                        failure = Some(evaluator);
                        Ok(())
                    }
                })?;
            failure.map_or(Ok(()), |failure| Err(MakeError::Content(failure)))
        } else {
            let folder = (path != self.output && path.starts_with(self.output)).then_some(self.output);
            output::make(folder, path, |file| {
                let mut out = io::BufWriter::new(std::fs::OpenOptions::new().write(true).open(file)?);
                image::stream_png(frame.size, alpha, bands, &mut out)?;
                io::Write::flush(&mut out)?;
                bytes = file.metadata()?.len();
                Ok::<(), BandFailure>(())
            })
        };
        bar.finish_and_clear();
        written.map_err(|error| match error {
            MakeError::Output(error) => CliError::new(format_args!("cannot write {error}")),
            MakeError::Content(failure) => self.band_error(failure, shader, path),
        })?;
        let [width, height] = frame.size;
        let facts = format!(
            "{width}×{height}, {} on CPU, in bands, {}, {:.2} s",
            self.args.precision.name(),
            file_size(bytes as usize),
            start.elapsed().as_secs_f64()
        );
        self.terminal.confirm(path, &facts);
        Ok(())
    }

    fn band_error(&self, failure: BandFailure, shader: &Shader, path: &Path) -> CliError {
        match failure {
            BandFailure::Output(error) => {
                CliError::new(format_args!("cannot write {}: {error}", path_name(path)))
            }
            BandFailure::Evaluator(failure) => match image_failure(&failure, shader) {
                ImageFailure::Failed(error) => error,
                ImageFailure::Interrupted => CliError::silent(),
            },
        }
    }
}
