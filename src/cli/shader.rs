//! What the commands that take shaders share: finding and reading them.

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Deadline, Diagnostic, Files, Severity, path_name};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{Failure, Phase};
use toyproof_lint::{Lints, lint};

use super::Terminal;
use super::inputs::{Deny, LanguageArgs};
use crate::cli::files;
use crate::cli::files::{Found, ReadError, of_content};

/// The lints have this part of the time limit of a shader.
const LINTS: u32 = 4;

/// A shader's text and its tree, or why there is none.
pub(super) struct Shader {
    pub(super) name: String,
    pub(super) files: Files,
    pub(super) checked: Result<Checked, Unusable>,
    pub(super) lints: Lints,
}

/// Why a shader cannot be used.
pub(super) enum Unusable {
    /// What it holds is at fault.
    Invalid(Vec<Diagnostic>),
    /// It cannot be had.
    Trouble(String),
}

impl Shader {
    pub(super) fn load(
        found: &Result<Found, ReadError>,
        language: &LanguageArgs,
        deadline: Deadline,
    ) -> Self {
        let mut files = Files::default();
        let mut lints = Lints::default();
        let (name, checked) = match found {
            Err(error) => (subject(error), Err(Unusable::Trouble(error.to_string()))),
            Ok(found) => {
                let share = deadline.share(LINTS);
                let checked = read(found, &mut files, &language.options(deadline));
                let checked = checked.and_then(|checked| {
                    lints = lint(&files, &checked, &share);
                    let denied = denied(&mut lints.warnings, language.denied());
                    if denied.is_empty() {
                        Ok(checked)
                    } else {
                        Err(Unusable::Invalid(denied))
                    }
                });
                (found.name(), checked)
            }
        };
        Self {
            name,
            files,
            checked,
            lints,
        }
    }

    /// The text that a shader was read from.
    pub(super) fn text(&self, checked: &Checked) -> &str {
        let at = checked.tree[checked.main_image].at;
        self.files.get(at.span.file).text()
    }
}

/// Takes out the warnings that count as errors.
pub(super) fn denied(warnings: &mut Vec<Diagnostic>, denied: &[Deny]) -> Vec<Diagnostic> {
    let (mut errors, rest): (Vec<_>, Vec<_>) = std::mem::take(warnings).into_iter().partition(|told| {
        let includes = |denied: &Deny| denied.includes(&told.code);
        told.severity == Severity::Warning && denied.iter().any(includes)
    });
    *warnings = rest;
    for error in &mut errors {
        error.severity = Severity::Error;
    }
    errors
}

fn read(found: &Found, files: &mut Files, options: &glsl::Options) -> Result<Checked, Unusable> {
    match files::read(found) {
        Ok(text) => {
            let file = files.add(text);
            glsl::check(files, file, options).map_err(Unusable::Invalid)
        }
        Err(error) => Err(match of_content(error, files) {
            Ok(diagnostic) => Unusable::Invalid(vec![diagnostic]),
            Err(error) => Unusable::Trouble(error.to_string()),
        }),
    }
}

fn subject(error: &ReadError) -> String {
    match error {
        ReadError::Missing(path) | ReadError::NoShader(path) | ReadError::Scene(path) => path_name(path),
        ReadError::Unreadable { name, .. } | ReadError::TooLarge { name } => name.clone(),
        ReadError::NotUtf8 { file, .. } => file.name().to_owned(),
    }
}

/// All shaders that the arguments name, in their order; standard input once. Warns of links that are not followed.
pub(super) fn find(arguments: &[PathBuf], terminal: &Terminal) -> Vec<Result<Found, ReadError>> {
    let first = arguments.iter().position(|argument| argument == Path::new("-"));
    arguments
        .iter()
        .enumerate()
        .filter(|&(at, argument)| argument != Path::new("-") || Some(at) == first)
        .flat_map(|(_, argument)| {
            let search = files::find(argument);
            for skipped in &search.skipped {
                terminal.warn(skipped);
            }
            search.inputs
        })
        .collect()
}

/// Whether it is the shader that does not compile, rather than the tools around it.
pub(super) fn is_invalid(failure: &Failure) -> bool {
    matches!(
        failure,
        Failure::Invalid(_)
            | Failure::StackOverflow {
                phase: Phase::Translating | Phase::Compiling
            }
    )
}
