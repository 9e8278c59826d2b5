//! `toyproof run` of the sound of a project.

use std::io::Write as _;
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

/// A compiled sound, with what it reads.
struct Sound {
    program: Program,
    frame: Frame,
}

/// The WAV file of samples.
fn file(samples: &[[f32; 2]]) -> Result<Vec<u8>, CliError> {
    let levels: Vec<_> = samples.iter().map(|sample| sample.map(sample_level)).collect();
    wav(&levels).map_err(CliError::new)
}

fn failed(failure: &eval::Failure, shader: &Shader) -> CliError {
    match image_failure(failure, shader) {
        ImageFailure::Failed(error) => error,
        ImageFailure::Interrupted => CliError::silent(),
    }
}

impl Runner<'_> {
    /// Computes the sound of a project, and writes it as a WAV file.
    pub(super) fn sound(
        &self,
        shader: &Shader,
        passes: &CompiledProject,
        seconds: Option<f64>,
        path: &Path,
    ) -> Result<(), CliError> {
        let Some(sound) = self.prepared_sound(shader, passes)? else {
            let error = CliError::new(format_args!("{}: there is no {}", shader.name, PassKind::Sound));
            return Err(
                error.with_help("the tab `sound.glsl` defines `vec2 mainSound(int samp, float time)`")
            );
        };
        let start = Instant::now();
        let samples = self.all_samples(&sound, seconds.unwrap_or(SOUND_SECONDS), shader)?;
        let count = samples.len();
        let bytes = file(&samples)?;
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
            let error = self
                .precision(&sound, &samples)
                .map_err(|failure| failed(&failure, shader))?;
            self.report_precision(error, count, shader);
        }
        Ok(())
    }

    /// Writes the sound of a film of a project from a time on, in seconds, to a temporary file; `None` if the
    /// project has no sound.
    pub(super) fn sound_of_film(
        &self,
        shader: &Shader,
        passes: &CompiledProject,
        (from, seconds): (f64, f64),
    ) -> Result<Option<tempfile::NamedTempFile>, CliError> {
        let Some(sound) = self.prepared_sound(shader, passes)? else {
            return Ok(None);
        };
        let from = from.max(0.0);
        let samples = self.all_samples(&sound, from + seconds, shader)?;
        let first = (from * f64::from(SAMPLE_RATE)) as usize;
        let bytes = file(&samples[first.min(samples.len() - 1)..])?;
        let temporary = tempfile::Builder::new()
            .prefix("toyproof-")
            .suffix(".wav")
            .tempfile();
        let temporary = temporary.and_then(|mut temporary| {
            temporary.write_all(&bytes)?;
            Ok(temporary)
        });
        temporary
            .map(Some)
            .map_err(|error| CliError::new(format_args!("a temporary file: {error}")))
    }

    /// Compiles the sound of a project, if it has one.
    fn prepared_sound(&self, shader: &Shader, passes: &CompiledProject) -> Result<Option<Sound>, CliError> {
        let Some(rendering) = passes.project.sound() else {
            return Ok(None);
        };
        report_missing(&rendering, &[const { None }; 4], &shader.name, self.terminal);
        let frame = self.clock_of(&rendering, 0).frame(0);
        let checked = &passes.checked[rendering.passes[0]];
        let limit = self.args.driver.explicit_timeout();
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit));
        Ok(Some(Sound {
            program: program.map_err(|refusal| failed(&refusal.into(), shader))?,
            frame: bound(&rendering, &frame).unwrap_or(frame),
        }))
    }

    /// The samples of the first seconds of a sound.
    fn all_samples(&self, sound: &Sound, seconds: f64, shader: &Shader) -> Result<Vec<[f32; 2]>, CliError> {
        let count = (seconds * f64::from(SAMPLE_RATE)).round().max(1.0) as usize;
        let samples = match self.args.precision {
            Precision::F32 => self.sound_samples::<f32>(sound, count),
            Precision::F64 => self.sound_samples::<f64>(sound, count),
        };
        samples.map_err(|failure| failed(&failure, shader))
    }

    /// The samples, block by block.
    fn sound_samples<N: Number>(&self, sound: &Sound, count: usize) -> Result<Vec<[f32; 2]>, eval::Failure> {
        let rows = count.div_ceil(SOUND_COLUMNS as usize) as u32;
        let bar = self.terminal.bar(u64::from(rows), "rows of samples");
        let mut samples = Vec::with_capacity(count);
        for first in (0..rows).step_by(BLOCK_ROWS as usize) {
            let block = first..(first + BLOCK_ROWS).min(rows);
            bar.inc(block.len() as u64);
            samples.extend(
                sound
                    .program
                    .sound(&sound.frame, block, &self.sound_settings::<N>())?,
            );
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
    fn precision(&self, sound: &Sound, samples: &[[f32; 2]]) -> Result<f32, eval::Failure> {
        let columns = SOUND_COLUMNS as usize;
        let last = samples.len().div_ceil(columns) as u32;
        let first = last.saturating_sub(MEASURED_ROWS);
        let settings = self.sound_settings::<f64>();
        let double = sound.program.sound(&sound.frame, first..last, &settings)?;
        let single = &samples[first as usize * columns..];
        let pairs = single.as_flattened().iter().zip(double.as_flattened());
        let differences = pairs.map(|(single, double)| (single - double).abs());
        Ok(differences
            .filter(|difference| difference.is_finite())
            .fold(0.0, f32::max))
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
        self.terminal.help(format_args!(
            "`time` has steps of {:.2} samples there: compute phases from `samp`, which is exact, or \
             reduce `time` by `fract` before it is multiplied",
            step * f64::from(SAMPLE_RATE)
        ));
    }
}
