//! Programs that follow a rule are accepted, and render its result.

use toyproof::diagnostic::{Diagnostic, File, Files, short};
use toyproof::eval::{self, Settings};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::Worker;
use toyproof::image::Image;
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{FloatMode, Lowered, lower};

use super::{Expectation, Program, frame, programs};
use crate::requirements::require_worker;

fn checked(program: &Program, options: &Options) -> Result<(Checked, Files), String> {
    let mut files = Files::default();
    let file = files.add(File::new("s", program.text.as_str()));
    match check(&files, file, options) {
        Ok(checked) => Ok((checked, files)),
        Err(errors) => Err(told(&errors, &files)),
    }
}

fn lowered(program: &Program, options: &Options) -> Result<Lowered, String> {
    let (checked, files) = checked(program, options)?;
    let lowered = lower(&checked);
    ValidModule::parse(&lowered)
        .map_err(|errors| format!("naga: {}\n{}", told(&errors, &files), lowered.text()))
        .map(|_| lowered)
}

fn told(errors: &[Diagnostic], files: &Files) -> String {
    let lines: Vec<_> = errors.iter().map(|error| short(error, files)).collect();
    lines.join("\n    ")
}

fn render(worker: &mut Worker, program: &Program) -> Result<(), String> {
    let lowered = lowered(program, &Options::default())?;
    let text = lowered.text().to_owned();
    let drawn = worker
        .draw(lowered, frame(), FloatMode::Strict)
        .map_err(|failure| format!("{failure:?}\n{text}"))?;
    is_red(&drawn.image()).map_err(|why| format!("{why}\n{text}"))
}

fn evaluate(program: &Program) -> Result<(), String> {
    let (checked, _) = checked(program, &Options::default())?;
    let evaluator = eval::Program::new(&checked).map_err(|refusal| refusal.to_string())?;
    let rendered = evaluator
        .render::<f32>(&frame(), &Settings::default())
        .map_err(|failure| failure.to_string())?;
    is_red(&rendered.framebuffer.image())
}

fn is_red(image: &Image) -> Result<(), String> {
    match image.get(0, 0)[0] {
        1.0 => Ok(()),
        red => Err(format!("paints {red}")),
    }
}

/// The messages of all `holds` programs that fail the attempt.
fn failures(mut attempt: impl FnMut(&Program) -> Result<(), String>) -> String {
    let failures: Vec<_> = programs()
        .iter()
        .filter(|program| program.expectation == Expectation::Holds)
        .filter_map(|program| {
            let why = attempt(program).err()?;
            Some(format!("{}\n    {why}\n", program.name))
        })
        .collect();
    failures.concat()
}

#[test]
fn naga_accepts_each_program() {
    let failures = failures(|program| lowered(program, &Options::default()).map(drop));
    assert!(failures.is_empty(), "\n{failures}");
}

/// `--lenient` accepts everything that the default accepts.
#[test]
fn each_program_is_accepted_leniently() {
    let lenient = Options {
        lenient: true,
        ..Options::default()
    };
    let failures = failures(|program| lowered(program, &lenient).map(drop));
    assert!(failures.is_empty(), "\n{failures}");
}

#[test]
fn each_program_holds_in_the_evaluator() {
    let failures = failures(evaluate);
    assert!(failures.is_empty(), "\n{failures}");
}

#[test]
fn each_program_holds_on_the_gpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let failures = failures(|program| render(&mut worker, program));
    assert!(failures.is_empty(), "\n{failures}");
}
