//! The conversions of the course, proved on a driver.

use std::collections::BTreeSet;
use std::fmt;
use std::process::{Command, Stdio};
use std::time::Duration;

use toyproof::convert::{Converter, Prover, Runner, ShaderProof, Source};
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{self, Options};
use toyproof::gpu::Worker;
use toyproof::translate::FloatMode;
use toyproof::translate::backend::Target;
use toyproof::translate::c_family::{CHost, Title};
use toyproof::translate::wgsl::Style;

use super::Stop;
use crate::Exercise;

/// The compiler that reads HLSL for the proof.
const GLSLANG: &str = "glslangValidator";

/// A language of conversions.
#[derive(Debug, Clone, Copy)]
pub struct Language {
    /// Its name.
    pub name: &'static str,
    target: Target,
    host: Option<CHost>,
}

/// The languages of conversions.
pub static LANGUAGES: [Language; 4] = [
    Language {
        name: "WGSL",
        target: Target::Wgsl,
        host: None,
    },
    Language {
        name: "SPIR-V",
        target: Target::Spirv,
        host: None,
    },
    Language {
        name: "GLSL ES",
        target: Target::Glsl,
        host: Some(CHost::Glsl),
    },
    Language {
        name: "HLSL",
        target: Target::Hlsl,
        host: Some(CHost::Hlsl),
    },
];

/// The conversions that were proved.
#[derive(Debug, Clone, Default)]
pub struct Conversions {
    /// The number of shaders that were converted.
    pub shaders: usize,
    /// The number of those whose written file was read again and proved.
    pub proved: usize,
    /// What read the files.
    pub readers: BTreeSet<String>,
    /// The first shader that was not proved, and the reason.
    pub failure: Option<(String, String)>,
    /// Why not all were converted.
    pub stopped: Option<String>,
}

impl fmt::Display for Conversions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "proved {} of {}", self.proved, self.shaders)?;
        if !self.readers.is_empty() {
            let readers: Vec<_> = self.readers.iter().map(String::as_str).collect();
            write!(f, "; read by {}", readers.join(" and "))?;
        }
        if let Some((name, why)) = &self.failure {
            write!(f, "; **not proved**, first {name}: {why}")?;
        }
        match &self.stopped {
            Some(why) => write!(f, "; the others were not measured: {why}"),
            None => Ok(()),
        }
    }
}

/// Converts exercises to a language, and proves the conversions on a driver; `translator` runs naga.
///
/// # Errors
/// If a program that the proof requires is missing.
///
/// # Panics
/// If an exercise is invalid.
pub fn prove(
    language: &Language,
    worker: &mut Worker,
    translator: &mut Worker,
    exercises: &[&Exercise],
    timeout: Duration,
    stop: Stop,
) -> Result<Conversions, String> {
    if language.target == Target::Hlsl && !is_installed(GLSLANG) {
        return Err(format!("{GLSLANG}, which reads HLSL, is not installed"));
    }
    let converter = Converter {
        target: Some(language.target),
        style: Style::Plain,
        c_host: language.host,
        dialect: None,
        float: FloatMode::Fast,
        timeout,
    };
    let mut sum = Conversions::default();
    for exercise in exercises {
        sum.stopped = stop();
        if sum.stopped.is_some() {
            break;
        }
        let result = prove_one(&converter, worker, translator, exercise);
        // An interrupt from the terminal also ends glslang.
        sum.stopped = result.as_ref().err().and_then(|_| stop());
        if sum.stopped.is_some() {
            break;
        }
        sum.shaders += 1;
        match result {
            Ok(readers) => {
                sum.proved += 1;
                sum.readers.extend(readers);
            }
            Err(why) => {
                sum.failure.get_or_insert_with(|| (exercise.name.to_owned(), why));
            }
        }
    }
    Ok(sum)
}

/// Converts an exercise; returns the readers of the proved file.
fn prove_one(
    converter: &Converter,
    worker: &mut Worker,
    translator: &mut Worker,
    exercise: &Exercise,
) -> Result<Vec<String>, String> {
    let mut files = Files::default();
    let file = files.add(File::new(exercise.name, exercise.shader));
    let checked = glsl::check(&files, file, &Options::default()).expect("the course is valid");
    let mut prover = Prover {
        runner: Runner::Driver(worker),
        browser: None,
        timeout: converter.timeout,
        pool: None,
    };
    let source = Source {
        checked: &checked,
        files: &files,
    };
    let conversion = converter
        .convert(
            source,
            Title::of_shader(exercise.name),
            translator,
            Some(&mut prover),
        )
        .map_err(|error| error.to_string())?;
    match conversion.proof {
        Some(Ok(ShaderProof::File(_, readers))) => Ok(readers.run.iter().map(ToString::to_string).collect()),
        Some(Err(unproved)) => Err(unproved.to_string()),
        Some(Ok(ShaderProof::Source(_))) | None => Err("no reader reads the written file".to_owned()),
    }
}

fn is_installed(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version");
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok()
}
