//! `toyproof trade --rewrite` and `--mediump`: changes of a shader for its numbers.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use toyproof_diagnostic::{Deadline, all_of, grouped, plural};
use toyproof_glsl::Checked;
use toyproof_image::Frame;
use toyproof_numerics::mixed::{MixedPrecision, mixed_precision};
use toyproof_numerics::rewrite::{self, rewrite};

use super::{Args, names_shader};
use crate::cli::shader::{Shader, find_one};
use crate::cli::{CliError, Exit, Terminal};

/// The number of other forms of expressions that are tried in each round.
const MAX_REWRITES: usize = 400;

pub(super) fn run(args: &Args, interrupted: &AtomicBool, terminal: &Terminal) -> Result<Exit, CliError> {
    let start = Instant::now();
    if !names_shader(&args.subject) {
        return Err(CliError::new("--rewrite and --mediump take a shader").with_help("name a file (.glsl)"));
    }
    let input = find_one(&args.subject, "trade", terminal)?;
    let shader = Shader::load(&input, &args.language, Deadline::after(args.budget));
    let checked = shader.require_single_pass()?;
    let frame = args.frame.inputs().load()?;
    let until = start + args.budget;
    let spinner = terminal.spinner(&shader.name);
    let changed = if args.rewrite {
        rewritten(&shader, checked, &frame, until, interrupted)
    } else {
        mediump(&shader, checked, &frame, until, interrupted)
    };
    spinner.finish_and_clear();
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

/// What was found.
struct Changed {
    lines: Vec<String>,
    /// The shader with the changes, if there are any.
    text: Option<String>,
}

fn too_slow(shader: &Shader) -> CliError {
    CliError::new(format_args!(
        "{}: a frame takes longer than the time budget",
        shader.name
    ))
    .with_help("use a longer --budget or a smaller --size")
}

fn rewritten(
    shader: &Shader,
    checked: &Checked,
    frame: &Frame,
    until: Instant,
    interrupted: &AtomicBool,
) -> Result<Changed, CliError> {
    let subject = rewrite::Subject {
        checked,
        text: shader.text(checked),
        frame,
        near: None,
        max_candidates: MAX_REWRITES,
    };
    let rewrites = rewrite(subject, until, interrupted).ok_or_else(|| too_slow(shader))?;
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

fn mediump(
    shader: &Shader,
    checked: &Checked,
    frame: &Frame,
    until: Instant,
    interrupted: &AtomicBool,
) -> Result<Changed, CliError> {
    let mixed = mixed_precision(checked, shader.text(checked), frame, until, interrupted);
    let MixedPrecision {
        names,
        tried,
        operations,
        changed_pixels,
        is_complete,
        text,
        ..
    } = mixed.ok_or_else(|| too_slow(shader))?;
    let count = names.len();
    let share = operations.map_or_else(String::new, |share| {
        format!(
            "{:.0} % of the executed operations have 16 bits then; ",
            100.0 * share
        )
    });
    let mut lines = vec![format!(
        "{count} of {tried} variables and results may be mediump: {share}{} visible {}",
        grouped(changed_pixels),
        plural(changed_pixels, "pixel", "pixels")
    )];
    if count > 0 {
        lines.push(format!("  {}", all_of(&names)));
    }
    if !is_complete {
        lines.push(
            "The time budget ended before all were tried; use a longer --budget or a smaller --size."
                .to_owned(),
        );
    }
    Ok(Changed {
        lines,
        text: (count > 0).then_some(text),
    })
}
