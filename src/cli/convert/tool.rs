//! Other people's judges of what was written, where they are installed: tint, spirv-val, glslang.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::emit::Target;

/// A judge of a language: its program and arguments; the file's name follows.
struct Tool {
    name: &'static str,
    arguments: &'static [&'static str],
    /// What asks it for its version; the first line is told.
    version: Option<&'static str>,
}

fn tool(target: Target) -> Option<Tool> {
    let (name, arguments, version): (_, &[&str], _) = match target {
        Target::Wgsl => ("tint", &["--format", "wgsl"], None),
        Target::Spirv => ("spirv-val", &["--target-env", "vulkan1.0"], Some("--version")),
        Target::Glsl => ("glslangValidator", &["-S", "frag"], Some("--version")),
        Target::Hlsl => (
            "glslangValidator",
            &["-D", "-V", "-S", "frag", "-e", "main", "-o", "-"],
            Some("--version"),
        ),
        // Only Apple's compiler reads Metal.
        Target::Msl => return None,
    };
    Some(Tool {
        name,
        arguments,
        version,
    })
}

/// Which tool accepts the file, in words; nothing if there is none.
///
/// # Errors
/// What the tool says against it.
pub(super) fn judge(target: Target, bytes: &[u8]) -> Result<Option<String>, String> {
    let Some(tool) = tool(target) else { return Ok(None) };
    let suffix = format!(".{}", target.extension());
    let written = tempfile::Builder::new()
        .suffix(&suffix)
        .tempfile()
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.flush()?;
            Ok(file)
        });
    let file = written.map_err(|error| format!("{} has no file to read: {error}", tool.name))?;
    let output = Command::new(tool.name)
        .args(tool.arguments)
        .arg(file.path())
        .stdin(Stdio::null())
        .output();
    // It is not installed.
    let Ok(output) = output else { return Ok(None) };
    if !output.status.success() {
        let said = [output.stderr, output.stdout].concat();
        let said = String::from_utf8_lossy(&said).replace(&*file.path().to_string_lossy(), "");
        let first = said
            .lines()
            .find(|line| line.contains("error") || line.contains("ERROR"));
        let first = first.or_else(|| said.lines().next()).unwrap_or("it says nothing");
        return Err(format!("{} refuses it: {}", tool.name, first.trim()));
    }
    let version = tool
        .version
        .and_then(|flag| Command::new(tool.name).arg(flag).output().ok());
    let version = version.and_then(|output| {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.lines().next().map(|line| format!(" ({})", line.trim()))
    });
    Ok(Some(format!(
        "{}{} accepts it",
        tool.name,
        version.unwrap_or_default()
    )))
}
