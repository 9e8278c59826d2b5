//! `toyproof run` of an image that is larger than memory, or than drivers render: its bands of rows are
//! written one after the other.

use std::fs::OpenOptions;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use toyproof_diagnostic::path_name;
use toyproof_eval::{self as eval, Number, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::output::{self, MakeError};
use toyproof_image::{self as image, Frame, Image};

use super::{ImageFailure, Precision, RenderedBy, Runner, check_evaluated, image_failure};
use crate::cli::CliError;
use crate::cli::sequence::StandardOutput;
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

    fn stream_bands<N: Number>(
        &mut self,
        shader: &Shader,
        frame: &Frame,
        path: &Path,
    ) -> Result<(), CliError> {
        let checked = shader.require_image()?;
        let start = Instant::now();
        let (args, terminal) = (self.args, self.terminal);
        let limit = args.driver.explicit_timeout();
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit));
        let program =
            program.map_err(|refusal| band_error(BandFailure::Evaluator(refusal.into()), shader, path))?;
        let settings = Settings::<N> {
            deadline: Some(start + limit),
            interrupt: Some(terminal.interrupt_flag()),
            ..Settings::plain()
        };
        let bar = terminal.bar(u64::from(frame.size[1]), "rows");
        let band = |rows: Range<u32>| -> Result<Image, BandFailure> {
            if terminal.is_closed() {
                return Err(io::Error::from(io::ErrorKind::BrokenPipe).into());
            }
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
        let alpha = args.transparent;
        let mut bytes = 0;
        let written = if path == Path::new("-") {
            let mut out = BufWriter::new(StandardOutput(terminal));
            let streamed = image::stream_png(frame.size, alpha, bands, &mut out);
            streamed
                .and_then(|()| Ok(out.flush()?))
                .map_err(MakeError::Content)
        } else {
            let folder = (path != self.output && path.starts_with(self.output)).then_some(self.output);
            output::make(folder, path, |file| {
                let mut out = BufWriter::new(OpenOptions::new().write(true).open(file)?);
                image::stream_png(frame.size, alpha, bands, &mut out)?;
                out.flush()?;
                bytes = file.metadata()?.len();
                Ok::<(), BandFailure>(())
            })
        };
        bar.finish_and_clear();
        // The reader of standard output has all it wants.
        if terminal.is_closed() {
            return Ok(());
        }
        written.map_err(|error| match error {
            MakeError::Output(error) => CliError::new(format_args!("cannot write {error}")),
            MakeError::Content(failure) => band_error(failure, shader, path),
        })?;
        let [width, height] = frame.size;
        let rendered = RenderedBy {
            device: "CPU",
            seconds: start.elapsed().as_secs_f64(),
        };
        let facts = format!(
            "{width}×{height}, {}{} on CPU, in bands, {}, {:.2} s",
            self.samples(),
            args.precision.name(),
            file_size(bytes as usize),
            rendered.seconds
        );
        terminal.confirm(path, &facts);
        self.record(&rendered, frame, &shader.name, path);
        Ok(())
    }
}

/// Why there is no image.
fn band_error(failure: BandFailure, shader: &Shader, path: &Path) -> CliError {
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
