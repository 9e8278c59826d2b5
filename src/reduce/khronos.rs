//! Khronos' reference programs, if they are installed: their verdicts are evidence that maintainers accept.

use std::fmt;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};

use tempfile::NamedTempFile;

/// What a reference program says about a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Opinion {
    /// The command without the file.
    command: String,
    /// The first line of the program's `--version`.
    version: String,
    /// The first error, if the program rejects the file.
    error: Option<String>,
}

impl fmt::Display for Opinion {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            command,
            version,
            error,
        } = self;
        match error {
            None => write!(f, "`{command}` ({version}) accepts it."),
            Some(error) => write!(
                f,
                "`{command}` ({version}) rejects it, so it may be at fault itself: `{error}`"
            ),
        }
    }
}

/// What glslang says about a fragment shader for Vulkan; `None` if it is not installed.
pub(crate) fn glslang(text: &str) -> Option<Opinion> {
    let file = file(".frag", text.as_bytes())?;
    opinion("glslangValidator", &["-V", "-o", null_device()], "-V", &file)
}

/// What spirv-val says about a module for Vulkan; `None` if it is not installed.
pub(crate) fn spirv_val(module: &[u8]) -> Option<Opinion> {
    let environment = "--target-env vulkan1.3";
    let arguments: Vec<&str> = environment.split(' ').collect();
    opinion("spirv-val", &arguments, environment, &file(".spv", module)?)
}

/// A module as assembly; `None` if spirv-dis is not installed.
pub(crate) fn spirv_dis(module: &[u8]) -> Option<String> {
    let output = output("spirv-dis", &["--no-color"], Some(&file(".spv", module)?))?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then_some(text)
}

/// The opinion of a program, whose command is shown with the arguments `shown`.
fn opinion(program: &str, arguments: &[&str], shown: &str, file: &NamedTempFile) -> Option<Opinion> {
    let read = output(program, arguments, Some(file))?;
    let version = output(program, &["--version"], None)?;
    let text = [read.stdout, read.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    // glslang prints the name of the file first.
    let name = file.path().to_string_lossy();
    let error = text.lines().find(|line| !line.is_empty() && *line != name);
    let error = error.unwrap_or("it names no reason").replace(&*name, "shader");
    let error = error.trim().to_owned();
    let version = String::from_utf8_lossy(&version.stdout);
    Some(Opinion {
        command: format!("{program} {shown}"),
        version: version.lines().next().unwrap_or_default().to_owned(),
        error: (!read.status.success()).then_some(error),
    })
}

fn output(program: &str, arguments: &[&str], file: Option<&NamedTempFile>) -> Option<Output> {
    Command::new(program)
        .args(arguments)
        .args(file.map(NamedTempFile::path))
        .stdin(Stdio::null())
        .output()
        .ok()
}

fn file(suffix: &str, bytes: &[u8]) -> Option<NamedTempFile> {
    let mut file = tempfile::Builder::new().suffix(suffix).tempfile().ok()?;
    file.write_all(bytes).ok()?;
    Some(file)
}

fn null_device() -> &'static str {
    if cfg!(windows) { "NUL" } else { "/dev/null" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opinions_name_the_command_and_the_first_error() {
        let opinion = |error: Option<&str>| {
            let [command, version] = ["spirv-val", "SPIRV-Tools v2023.1"].map(str::to_owned);
            let error = error.map(str::to_owned);
            Opinion {
                command,
                version,
                error,
            }
            .to_string()
        };
        assert_eq!(opinion(None), "`spirv-val` (SPIRV-Tools v2023.1) accepts it.");
        assert_eq!(
            opinion(Some("error: line 3")),
            "`spirv-val` (SPIRV-Tools v2023.1) rejects it, so it may be at fault itself: `error: line 3`"
        );
    }
}
