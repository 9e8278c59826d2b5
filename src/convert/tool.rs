//! External tools that validate or compile the conversion, where they are installed: tint, spirv-val,
//! glslang.

use std::fs::File;
use std::io::{self, Read, Seek, Write};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::{NamedTempFile, tempfile};
use thiserror::Error;
use toyproof_translate::backend::{Target, roundtrip, spirv};

/// Why a tool did not accept a file.
#[derive(Debug, Error)]
pub enum ToolError {
    /// The tool rejects the file with this message.
    #[error("{tool} rejects the output: {message}")]
    Refused {
        /// The tool.
        tool: &'static str,
        /// The first error message.
        message: String,
    },
    /// The file could not be written for the tool.
    #[error("cannot write a temporary file for {tool}: {error}")]
    Unwritable {
        /// The tool.
        tool: &'static str,
        /// The system's error.
        error: io::Error,
    },
    /// The tool could not be run, or its output could not be read.
    #[error("cannot run {tool}: {error}")]
    NotRun {
        /// The tool.
        tool: &'static str,
        /// The system's error.
        error: io::Error,
    },
    /// The length of the tool's output is not a multiple of four bytes.
    #[error("the length of the output of {0} is not a multiple of four bytes")]
    PartialWord(&'static str),
}

/// A tool that reads a language: its program and arguments; the file's name is appended.
struct Tool {
    name: &'static str,
    arguments: &'static [&'static str],
    /// The flag that prints its version; the first line of the output is reported.
    version: Option<&'static str>,
}

/// The validator of a language.
fn validator(target: Target) -> Option<Tool> {
    let (name, arguments, version): (_, &[&str], _) = match target {
        Target::Wgsl => ("tint", &["--format", "wgsl"], None),
        Target::Spirv => ("spirv-val", &["--target-env", "vulkan1.0"], Some("--version")),
        Target::Glsl => (GLSLANG, &["-S", "frag"], Some("--version")),
        // glslang validates HLSL when it compiles it, and only Apple's compiler reads Metal.
        Target::Hlsl | Target::Msl => return None,
    };
    Some(Tool {
        name,
        arguments,
        version,
    })
}

const GLSLANG: &str = "glslangValidator";

/// glslang as a compiler of a language for Vulkan.
fn compiler(target: Target) -> Option<Tool> {
    let arguments: &[&str] = match target {
        Target::Glsl => &["-V", "-S", "frag"],
        // Without `-Od`, its optimizer does algebra: it turns `2.0 * x / 240.0` into one product, and
        // products with sums into `fma`.
        Target::Hlsl => &["-D", "-V", "-Od", "--hlsl-offsets", "-S", "frag", "-e", "main"],
        Target::Wgsl | Target::Spirv | Target::Msl => return None,
    };
    Some(Tool {
        name: GLSLANG,
        arguments,
        version: Some("--version"),
    })
}

/// Validates a file; returns the name and version of the tool that accepts it, or `None` if no tool is
/// installed.
///
/// # Errors
/// The tool's first error message.
pub(super) fn validate(target: Target, bytes: &[u8]) -> Result<Option<String>, ToolError> {
    let Some(tool) = validator(target) else {
        return Ok(None);
    };
    let file = tool.file(target, bytes)?;
    let read = tool.read(&file, &[])?;
    Ok(read.map(|()| tool.name_and_version()))
}

/// Compiles a file with glslang for Vulkan; returns the SPIR-V and the tool's name and version, or `None` if
/// glslang is not installed or does not read the language.
///
/// # Errors
/// The tool's first error message.
pub(super) fn compile(target: Target, bytes: &[u8]) -> Result<Option<(Vec<u32>, String)>, ToolError> {
    let text = String::from_utf8_lossy(bytes);
    match roundtrip::for_glslang(target, &text) {
        Some(text) => compile_hosted(target, &text),
        None => Ok(None),
    }
}

/// Compiles a text like [`compile`] that is written for Vulkan, or for a substitute of its host.
///
/// # Errors
/// The tool's first error message.
pub(super) fn compile_hosted(target: Target, text: &str) -> Result<Option<(Vec<u32>, String)>, ToolError> {
    let Some(tool) = compiler(target) else {
        return Ok(None);
    };
    let file = tool.file(target, text.as_bytes())?;
    let converted = tool.file(Target::Spirv, &[])?;
    let to = converted.path().to_string_lossy().into_owned();
    if tool.read(&file, &["-o", &to])?.is_none() {
        return Ok(None);
    }
    let bytes = std::fs::read(converted.path()).map_err(|error| tool.not_run(error))?;
    let words = spirv::of_bytes(&bytes).ok_or(ToolError::PartialWord(tool.name))?;
    Ok(Some((words, tool.name_and_version())))
}

impl Tool {
    fn not_run(&self, error: io::Error) -> ToolError {
        let tool = self.name;
        ToolError::NotRun { tool, error }
    }

    fn file(&self, target: Target, bytes: &[u8]) -> Result<NamedTempFile, ToolError> {
        let suffix = format!(".{}", target.extension());
        let written = tempfile::Builder::new()
            .suffix(&suffix)
            .tempfile()
            .and_then(|mut file| {
                file.write_all(bytes)?;
                file.flush()?;
                Ok(file)
            });
        let tool = self.name;
        written.map_err(|error| ToolError::Unwritable { tool, error })
    }

    /// Runs the tool on a file; `None` if it is not installed.
    fn read(&self, file: &NamedTempFile, more: &[&str]) -> Result<Option<()>, ToolError> {
        let output = run(Command::new(self.name)
            .args(self.arguments)
            .args(more)
            .arg(file.path()));
        let output = match output {
            Ok(output) => output,
            // It is not installed.
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(self.not_run(error)),
        };
        if output.status.success() {
            return Ok(Some(()));
        }
        let messages = [output.stderr, output.stdout].concat();
        let messages = String::from_utf8_lossy(&messages).replace(&*file.path().to_string_lossy(), "");
        let first = messages
            .lines()
            .find(|line| line.contains("error") || line.contains("ERROR"));
        let first = first.or_else(|| messages.lines().next()).unwrap_or("no message");
        Err(ToolError::Refused {
            tool: self.name,
            message: first.trim().to_owned(),
        })
    }

    /// The name, with its version if it reports one.
    fn name_and_version(&self) -> String {
        let version = self
            .version
            .and_then(|flag| run(Command::new(self.name).arg(flag)).ok());
        let version = version.and_then(|output| {
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let first = text.lines().find(|line| !line.trim().is_empty())?;
            Some(format!(" ({})", first.trim()))
        });
        format!("{}{}", self.name, version.unwrap_or_default())
    }
}

/// The time limit of a tool.
const TIME_LIMIT: Duration = Duration::from_secs(60);

/// The time between two checks whether a tool has ended.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// Runs a tool until it ends or exceeds `TIME_LIMIT`.
fn run(command: &mut Command) -> io::Result<Output> {
    let (mut stdout, mut stderr) = (tempfile()?, tempfile()?);
    let mut child = command
        .stdin(Stdio::null())
        .stdout(stdout.try_clone()?)
        .stderr(stderr.try_clone()?)
        .spawn()?;
    let deadline = Instant::now() + TIME_LIMIT;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if Instant::now() > deadline {
            child.kill()?;
            child.wait()?;
            return Err(io::Error::new(
                io::ErrorKind::TimedOut,
                "it did not finish within 60 s",
            ));
        }
        thread::sleep(POLL_INTERVAL);
    };
    let read_all = |file: &mut File| {
        let mut bytes = Vec::new();
        file.rewind()?;
        file.read_to_end(&mut bytes)?;
        Ok::<_, io::Error>(bytes)
    };
    Ok(Output {
        status,
        stdout: read_all(&mut stdout)?,
        stderr: read_all(&mut stderr)?,
    })
}
