//! `toyproof trade --rewrite` and `--mediump`: changes of a shader for its numbers.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, all_of, grouped, plural};
use toyproof_glsl::Checked;
use toyproof_gpu::Worker;
use toyproof_image::Frame;
use toyproof_lab::trade::{Evaluated, HalfRun, half_run};
use toyproof_numerics::mixed::{MixedPrecision, mixed_precision};
use toyproof_numerics::rewrite::{self, rewrite};

use super::{Args, names_shader, workers};
use crate::cli::shader::{Shader, find_one};
use crate::cli::{CliError, Exit, Terminal};

/// The number of other forms of expressions that are tried in each round.
const MAX_REWRITES: usize = 400;

/// The share of the time budget for finding variables, if devices are measured in the rest.
const SEARCH_SHARE: f64 = 0.7;

pub(super) fn run(args: &Args, interrupted: &AtomicBool, terminal: &Terminal) -> Result<Exit, CliError> {
    let start = Instant::now();
    if !names_shader(&args.subject) {
        return Err(CliError::new("--rewrite and --mediump take a shader").with_help("name a file (.glsl)"));
    }
    let input = find_one(&args.subject, "trade", terminal)?;
    let shader = Shader::load(&input, &args.language, Deadline::after(args.budget));
    let checked = shader.require_single_pass()?;
    let frame = args.frame.inputs().load()?;
    let task = Task {
        shader: &shader,
        checked,
        frame: &frame,
        start,
        budget: args.budget,
        interrupted,
        terminal,
    };
    let changed = if args.rewrite {
        task.rewritten()
    } else {
        task.mediump(&args.device)
    };
    if interrupted.load(Ordering::Relaxed) {
        return Err(CliError::new("interrupted"));
    }
    let changed = changed?;
    for line in &changed.lines {
        terminal.result(line);
    }
    if let (Some(folder), Some(text)) = (&args.output, &changed.text) {
        let path = folder.join(if args.rewrite {
            "rewritten.glsl"
        } else {
            "mediump.glsl"
        });
        terminal.write(&path, text.as_bytes())?;
        terminal.confirm(&path, "the shader with these changes");
    }
    Ok(Exit::Success)
}

/// A shader to change, and how long that may take.
struct Task<'a> {
    shader: &'a Shader,
    checked: &'a Checked,
    frame: &'a Frame,
    start: Instant,
    budget: Duration,
    interrupted: &'a AtomicBool,
    terminal: &'a Terminal,
}

/// What was found.
struct Changed {
    lines: Vec<String>,
    /// The shader with the changes, if there are any.
    text: Option<String>,
}

impl Task<'_> {
    fn too_slow(&self) -> CliError {
        CliError::new(format_args!(
            "{}: a frame takes longer than the time budget",
            self.shader.name
        ))
        .with_help("use a longer --budget or a smaller --size")
    }

    fn rewritten(&self) -> Result<Changed, CliError> {
        let Self { shader, frame, .. } = *self;
        let subject = rewrite::Subject {
            checked: self.checked,
            text: shader.text(self.checked),
            frame,
            near: None,
            max_candidates: MAX_REWRITES,
        };
        let spinner = self.terminal.spinner(&shader.name);
        let rewrites = rewrite(subject, self.start + self.budget, self.interrupted);
        spinner.finish_and_clear();
        let rewrites = rewrites.ok_or_else(|| self.too_slow())?;
        let pixels = u64::from(frame.size[0]) * u64::from(frame.size[1]);
        let before = rewrites.before;
        let imprecise = format!(
            "float32 is visibly imprecise in {} of {} {}, by at most {:.1e}",
            grouped(before.imprecise),
            grouped(pixels),
            plural(pixels, "pixel", "pixels"),
            before.largest
        );
        let Some(fix) = &rewrites.fix else {
            let lines = if before.imprecise == 0 {
                vec!["float32 is precise enough in all pixels".to_owned()]
            } else {
                vec![
                    imprecise,
                    "No identity of the catalogue loses fewer digits.".to_owned(),
                ]
            };
            return Ok(Changed { lines, text: None });
        };
        let mut lines = vec![imprecise, fix.message.clone()];
        for edit in &fix.edits {
            let position = shader.files.position(edit.span);
            lines.push(format!(
                "  line {}: {}  →  {}",
                position.line,
                shader.files.text(edit.span),
                edit.replacement
            ));
        }
        Ok(Changed {
            lines,
            text: Some(rewrites.text),
        })
    }

    /// Finds what may be `mediump`, and measures it on the devices that `--device` names.
    fn mediump(&self, devices: &str) -> Result<Changed, CliError> {
        let search = if devices == "cpu" { 1.0 } else { SEARCH_SHARE };
        let until = self.start + self.budget.mul_f64(search);
        let spinner = self.terminal.spinner(&self.shader.name);
        let text = self.shader.text(self.checked);
        let mixed = mixed_precision(self.checked, text, self.frame, until, self.interrupted);
        spinner.finish_and_clear();
        let mixed = mixed.ok_or_else(|| self.too_slow())?;
        let share = mixed.operations.map_or_else(String::new, |share| {
            format!(
                "{:.0} % of the executed operations have 16 bits then; ",
                100.0 * share
            )
        });
        let mut lines = vec![format!(
            "{} of {} variables and results may be mediump: {share}{}",
            mixed.found,
            mixed.tried,
            visible(mixed.changed_pixels)
        )];
        if !mixed.is_complete {
            lines.push(
                "The time budget ended before all were tried; use a longer --budget or a smaller --size."
                    .to_owned(),
            );
        }
        if mixed.found > 0 {
            lines.push(format!("  {}", all_of(&mixed.names)));
            lines.extend(self.on_devices(devices, &mixed)?);
        }
        Ok(Changed {
            lines,
            text: (mixed.found > 0).then_some(mixed.text),
        })
    }

    /// What 16 bits change on each device, in the rest of the time.
    fn on_devices(&self, devices: &str, mixed: &MixedPrecision) -> Result<Vec<String>, CliError> {
        let left = || (self.start + self.budget).saturating_duration_since(Instant::now());
        let workers = workers(devices, left(), self.terminal)?;
        let count = workers.len() as u32;
        let line = |(at, (name, mut worker)): (u32, (String, Worker))| {
            let until = Instant::now() + left() / (count - at);
            let spinner = self.terminal.spinner(&name);
            let shaders = [(self.checked, &mixed.own), (&mixed.emulated, &mixed.image)]
                .map(|(shader, image)| Evaluated { shader, image });
            let run = half_run(&mut worker, shaders, self.frame, until, self.interrupted);
            spinner.finish_and_clear();
            match run {
                Ok(Some(run)) => on_device(&name, &run),
                Ok(None) => format!("{name} in 16 bits: not measured within the time budget"),
                Err(failure) => format!("{name} in 16 bits: {failure}"),
            }
        };
        Ok((0..).zip(workers).map(line).collect())
    }
}

/// What 16 bits change on a device.
fn on_device(name: &str, run: &HalfRun) -> String {
    let [slow, fast] = run.seconds_per_frame.map(|seconds| seconds.median);
    format!(
        "{name} in 16 bits: {}, {} unlike the emulation; {:.3} ms instead of {:.3} ms, {:.2} times as fast",
        visible(run.changed_pixels),
        grouped(run.unlike_emulation),
        1e3 * fast,
        1e3 * slow,
        slow / fast,
    )
}

fn visible(pixels: u64) -> String {
    format!(
        "{} visible {}",
        grouped(pixels),
        plural(pixels, "pixel", "pixels")
    )
}
