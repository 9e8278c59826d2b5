//! Where the result is written, also during the reduction.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Files, path_name};
use toyproof_image::output::Originals;
use toyproof_project::Tab;
use toyproof_project::files::{self, Input, is_project};

use super::super::inputs::check_output;
use super::super::{CliError, Terminal};
use super::Args;
use super::original::Attempt;

/// The file of a shader or the folder of a project.
pub(super) struct Output(PathBuf);

impl Output {
    /// The output that the user names, or the default. Nothing but an earlier result may be overwritten.
    pub(super) fn new(args: &Args, input: &Input, attempt: &Attempt) -> Result<Self, CliError> {
        let path = args.output.clone().unwrap_or_else(|| beside(input, attempt));
        let originals: Originals = input.path().into_iter().collect();
        // A reduction is continued in place.
        let output = Some(&path).filter(|_| !is_reduced(input));
        for path in [output, args.report.as_ref()].into_iter().flatten() {
            check_output(path, &originals)?;
        }
        let refused = |error: String, help: &str| Err(CliError::new(error).with_help(help));
        let name = path_name(&path);
        match (&attempt.project, attempt.pass) {
            (Some(_), _) if path == Path::new("-") || path.is_file() => refused(
                format!("the result is a project, and {name} is not a folder"),
                "name a new folder with -o",
            ),
            (Some(_), _) if args.output.is_some() && is_project(&path) && input.path() != Some(&path) => {
                refused(
                    format!("{name} has a project already; nothing was written"),
                    "choose another folder with -o",
                )
            }
            (None, Some(pass)) if path.is_dir() => refused(
                format!("{pass} shows the fault alone, so the result is one shader, and {name} is a folder"),
                "name a file with -o",
            ),
            _ => Ok(Self(path)),
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    /// Whether the result goes to standard output, once it is final.
    pub(super) fn is_stream(&self) -> bool {
        self.0 == Path::new("-")
    }

    /// Writes texts that show the fault.
    pub(super) fn write(
        &self,
        attempt: &Attempt,
        texts: &[Option<String>],
        terminal: &Terminal,
    ) -> Result<(), CliError> {
        let Some(project) = &attempt.project else {
            let text = texts[0].as_deref().unwrap_or_default();
            return if self.is_stream() {
                Ok(())
            } else {
                terminal.write(&self.0, text.as_bytes())
            };
        };
        let files = project.folder(texts);
        for (name, text) in &files {
            terminal.write_output(&self.0, &self.0.join(name), text.as_bytes())?;
        }
        for name in Tab::ALL.map(Tab::file_name) {
            let path = self.0.join(&name);
            if files.iter().all(|(own, _)| *own != name) && path.is_file() {
                fs::remove_file(&path).map_err(|error| {
                    CliError::new(format_args!("cannot delete {}: {error}", path_name(&path)))
                })?;
            }
        }
        Ok(())
    }

    /// Writes the final texts, and the images that a project reads from its folder.
    pub(super) fn finish(
        &self,
        attempt: &Attempt,
        texts: &[Option<String>],
        input: &Input,
        terminal: &Terminal,
    ) -> Result<(), CliError> {
        if self.is_stream() {
            return terminal.bytes(texts[0].as_deref().unwrap_or_default().as_bytes());
        }
        let (Some(project), Some(folder)) = (&attempt.project, input.path().filter(|path| path.is_dir()))
        else {
            return Ok(());
        };
        for name in project.project(texts, &mut Files::default()).media_files() {
            let source = files::project_image(folder, name).map_err(CliError::new)?;
            let path = self.0.join(name);
            if source != path {
                terminal.write_output(&self.0, &path, &files::read_bytes(&source)?)?;
            }
        }
        Ok(())
    }
}

/// Whether a shader is the result of a reduction, by its name.
pub(super) fn is_reduced(input: &Input) -> bool {
    let Some(path) = input.path() else { return false };
    let is_reduced = |path: &Path| path.extension() == Some(OsStr::new("reduced"));
    is_reduced(path) || path.file_stem().is_some_and(|stem| is_reduced(Path::new(stem)))
}

/// The default output.
fn beside(input: &Input, attempt: &Attempt) -> PathBuf {
    let is_folder = attempt.project.is_some();
    match input.path() {
        Some(path) if is_reduced(input) && path.is_dir() == is_folder => path.to_owned(),
        Some(path) if is_folder => path.with_extension("reduced"),
        Some(path) => path.with_extension("reduced.glsl"),
        None => "-".into(),
    }
}
