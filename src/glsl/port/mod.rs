//! The text of a shader for another host: its inputs become those of the other host, and its function `main`
//! becomes `mainImage`, or the reverse. Everything else is the author's text, with its comments.
//!
//! Names are replaced in the text, also in macros and in branches of `#if` that are not compiled. A name
//! that would get another meaning is replaced too: one that the other host declares, and one that is a word
//! of the other version of GLSL.

mod edit;
mod input;
mod names;

use thiserror::Error;
use toyproof_diagnostic::{Code, Deadline, Diagnostic, File, Files, Overdue, short};

use self::edit::Port;
use crate::dialect::{Dialect, Version};
use crate::source::Source;
use crate::{Checked, Options, UniformMode, check};

/// Why a shader cannot be written for a host.
#[derive(Debug, Error)]
pub enum PortError {
    /// It needs something that the host does not have.
    #[error("{}", .0.message)]
    Host(Box<Diagnostic>),
    /// The written text is invalid in every version that the host compiles.
    #[error("it is not compiled by {host}: {error}")]
    Invalid {
        /// The name of the host.
        host: &'static str,
        /// The first error, in the text for the newest version.
        error: String,
    },
    /// It takes too long.
    #[error(transparent)]
    Overdue(#[from] Overdue),
}

/// Why a host refuses a valid shader; `None` if it compiles it.
pub type Refusal<'r> = dyn Fn(&Files, &Checked) -> Option<Diagnostic> + 'r;

/// Writes a shader for another host, in the first version of GLSL that the host compiles and that has what
/// the shader uses. The result is a shader of the dialect `to`, without errors, for which `refusal` returns
/// none: why the host refuses a valid shader.
///
/// ```
/// use toyproof_diagnostic::{Deadline, File, Files};
/// use toyproof_glsl::{Dialect, Options, check, port};
///
/// let mut files = Files::default();
/// let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, sin(iTime), 1.0); }";
/// let file = files.add(File::new("waves.glsl", text));
/// let checked = check(&files, file, &Options::default()).unwrap();
/// let ported = port(&checked, &files, Dialect::BookOfShaders, &|_, _| None, &Deadline::default()).unwrap();
/// assert!(ported.contains("c = vec4(p / u_resolution, sin(u_time), 1.0);"), "{ported}");
/// ```
///
/// # Errors
/// The host does not set an input that the shader reads, or does not compile what the shader uses.
pub fn port(
    checked: &Checked,
    files: &Files,
    to: Dialect,
    refusal: &Refusal,
    deadline: &Deadline,
) -> Result<String, PortError> {
    port_in_versions(checked, files, (to, to.written_versions()), refusal, deadline)
}

/// Writes a shader for another host like [`port`], in the first of these versions that has what the shader
/// uses.
///
/// # Errors
/// Like [`port`].
pub fn port_in_versions(
    checked: &Checked,
    files: &Files,
    (to, versions): (Dialect, &[Version]),
    refusal: &Refusal,
    deadline: &Deadline,
) -> Result<String, PortError> {
    let file = checked.tree[checked.main_image].at.span.file;
    let source = Source::new(files, file);
    // A shader keeps its version if the host compiles it.
    let own = versions.iter().filter(|&&version| version == checked.version);
    let is_rewrapped = checked.dialect.calls_main_image() != to.calls_main_image();
    let own = own.filter(|_| !is_rewrapped);
    let mut error = PortError::Host(Box::new(Diagnostic::new(
        Code::UnsupportedByTarget,
        format!("shaders cannot be written for {}", to.title()),
    )));
    for &version in own.chain(versions) {
        deadline.check()?;
        let port = Port::new(checked, &source, to, version).map_err(PortError::Host)?;
        let text = port.text();
        // The header is not a part of the text: whoever writes it checks both.
        if to == Dialect::Isf {
            return Ok(text);
        }
        match check_written(text, checked, (to, version), refusal, deadline) {
            Ok(text) => return Ok(text),
            Err(problem) => error = problem,
        }
    }
    Err(error)
}

/// Returns a written text if the host compiles it.
fn check_written(
    text: String,
    original: &Checked,
    (to, version): (Dialect, Version),
    refusal: &Refusal,
    deadline: &Deadline,
) -> Result<String, PortError> {
    let mut files = Files::default();
    let file = files.add(File::new(version.name(), text));
    let options = Options {
        lenient: false,
        dialect: Some(to),
        uniform_mode: UniformMode::Replaced,
        deadline: deadline.clone(),
        ..original.options()
    };
    let error = match check(&files, file, &options) {
        Ok(written) => refusal(&files, &written),
        Err(errors) => {
            deadline.check()?;
            errors.first().cloned()
        }
    };
    match error {
        None => Ok(files.get(file).text().to_owned()),
        Some(error) => Err(PortError::Invalid {
            host: to.title(),
            error: short(&error, &files),
        }),
    }
}

#[cfg(test)]
mod tests;
