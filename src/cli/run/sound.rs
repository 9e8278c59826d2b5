//! `toyproof run` of the sound of a project.

use std::path::Path;
use std::time::Instant;

use toyproof_diagnostic::magnitude;
use toyproof_eval::{self as eval, Number, SOUND_COLUMNS, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::Frame;
use toyproof_media::{SAMPLE_RATE, SOUND_SECONDS, sample_level, wav};
use toyproof_project::{CompiledProject, PassKind};

use super::project::{bound, report_missing};
use super::{ImageFailure, Precision, Runner, image_failure};
use crate::cli::CliError;
use crate::cli::shader::Shader;
use crate::cli::terminal::file_size;

/// The rows of samples that are computed at once: a block of the site.
const BLOCK_ROWS: u32 = 512;

/// The rows at the end of a sound in which its precision is measured: a tenth of a second.
const MEASURED_ROWS: u32 = 8;

/// An error of float32 of more than this part of full scale can be heard: −60 dB.
const AUDIBLE: f32 = 1e-3;

impl Runner<'_> {
    /// Computes the sound of a project, and writes it as a WAV file.
    pub(super) fn sound(
        &self,
        shader: &Shader,
        passes: &CompiledProject,
        seconds: Option<f64>,
        path: &Path,
    ) -> Result<(), CliError> {
        let Some(rendering) = passes.project.sound() else {
            let error = CliError::new(format_args!("{}: there is no {}", shader.name, PassKind::Sound));
            return Err(error.with_help("the tab `sound.glsl` defines `vec2 mainSound(int samp, float time)`"));
        };
        report_missing(&rendering, &[const { None }; 4], &shader.name, self.terminal);
        let frame = self.clock_of(&rendering, 0).frame(0);
        let frame = bound(&rendering, &frame).unwrap_or(frame);
        let checked = &passes.checked[rendering.passes[0]];
        let limit = self.args.driver.explicit_timeout();
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit));
        let failed = |failure: &eval::Failure| match image_failure(failure, shader) {
            ImageFailure::Failed(error) => error,
            ImageFailure::Interrupted => CliError::silent(),
        };
        let program = program.map_err(|refusal| failed(&refusal.into()))?;
        let seconds = seconds.unwrap_or(SOUND_SECONDS);
        let count = (seconds * f64::from(SAMPLE_RATE)).round().max(1.0) as usize;
        let start = Instant::now();
        let samples = match self.args.precision {
            Precision::F32 => self.samples::<f32>(&program, &frame, count),
            Precision::F64 => self.samples::<f64>(&program, &frame, count),
        };
        let samples = samples.map_err(|failure| failed(&failure))?;
        let levels: Vec<_> = samples.iter().map(|sample| sample.map(sample_level)).collect();
        let bytes = wav(&levels).map_err(CliError::new)?;
        self.terminal.write(path, &bytes)?;
        let facts = format!(
            "{:.1} s, {SAMPLE_RATE} Hz, stereo, {} on CPU, {}, {:.2} s",
            count as f64 / f64::from(SAMPLE_RATE),
            self.args.precision.name(),
            file_size(bytes.len()),
            start.elapsed().as_secs_f64()
        );
        self.terminal.confirm(path, &facts);
        if self.args.precision == Precision::F32 {
            let error = self.precision(&program, &frame, &samples).map_err(|failure| failed(&failure))?;
            self.report_precision(error, count, shader);
        }
        Ok(())
    }

    /// The samples, block by block.
    fn samples<N: Number>(
        &self,
        program: &Program,
        frame: &Frame,
        count: usize,
    ) -> Result<Vec<[f32; 2]>, eval::Failure> {
        let rows = count.div_ceil(SOUND_COLUMNS as usize) as u32;
        let bar = self.terminal.bar(u64::from(rows), "rows of samples");
        let mut samples = Vec::with_capacity(count);
        for first in (0..rows).step_by(BLOCK_ROWS as usize) {
            let block = first..(first + BLOCK_ROWS).min(rows);
            bar.inc(block.len() as u64);
            samples.extend(program.sound(frame, block, &self.sound_settings::<N>())?);
        }
        bar.finish_and_clear();
        samples.truncate(count);
        Ok(samples)
    }

    fn sound_settings<N: Number>(&self) -> Settings<'_, N> {
        Settings {
            deadline: Some(Instant::now() + self.args.driver.explicit_timeout()),
            interrupt: Some(self.terminal.interrupt_flag()),
            ..Settings::plain()
        }
    }

    /// The largest difference between float32 and double precision at the end of the sound.
    fn precision(
        &self,
        program: &Program,
        frame: &Frame,
        samples: &[[f32; 2]],
    ) -> Result<f32, eval::Failure> {
        let columns = SOUND_COLUMNS as usize;
        let last = samples.len().div_ceil(columns) as u32;
        let first = last.saturating_sub(MEASURED_ROWS);
        let double = program.sound(frame, first..last, &self.sound_settings::<f64>())?;
        let single = &samples[first as usize * columns..];
        let pairs = single.as_flattened().iter().zip(double.as_flattened());
        let differences = pairs.map(|(single, double)| (single - double).abs());
        Ok(differences.filter(|difference| difference.is_finite()).fold(0.0, f32::max))
    }

    fn report_precision(&self, error: f32, count: usize, shader: &Shader) {
        let end = count as f32 / SAMPLE_RATE as f32;
        let message = format!(
            "{}: at its end, the sound in float32 differs from double precision by up to {}",
            shader.name,
            magnitude(error.into())
        );
        if error <= AUDIBLE {
            self.terminal.detail(&message);
            return;
        }
        self.terminal.warn(&message);
        // Neighboring floats differ by this at the end.
        let step = f64::from(end.next_up() - end);
        self.terminal.help(&format!(
            "`time` has steps of {:.2} samples there: compute phases from `samp`, which is exact, or \
             reduce `time` by `fract` before it is multiplied",
            step * f64::from(SAMPLE_RATE)
        ));
    }
}
