//! The check of the shader, by this program itself: another process, which ends at once when the shader is
//! saved again, whatever it is doing.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use toyproof_image::input;
use toyproof_report::Record;

use super::Args;
use super::studio::{article, source};
use crate::cli::Terminal;
use crate::cli::shader::find_one;

/// The time between two looks at the process.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// The name of the file of its messages.
const MESSAGES: &str = "messages.txt";

/// The images of the viewer, by the ends of the names of their files.
const IMAGES: [(&str, &str); 6] = [
    ("fixed", "-fixed.png"),
    ("algorithm", "-algorithm.png"),
    ("precision", "-precision.png"),
    ("toolchain", "-toolchain.png"),
    ("value", "-value.png"),
    ("referenceValue", "-reference-value.png"),
];

/// Checks the shader with the arguments of this process; `None` if it is stopped.
pub(super) fn check(args: &Args, has_assignment: bool, stop: &AtomicBool) -> Option<Value> {
    match checked(args, has_assignment, stop) {
        Ok(result) => result,
        Err(error) => Some(json!({"failure": format!("the check failed: {error}")})),
    }
}

/// The report, of which the records are needed.
#[derive(Deserialize)]
struct Verdicts {
    shaders: Vec<Record>,
}

fn checked(args: &Args, has_assignment: bool, stop: &AtomicBool) -> io::Result<Option<Value>> {
    // The reports, and the messages if there are none.
    let folder = tempfile::Builder::new().prefix("toyproof-watch-").tempdir()?;
    let mut command = Command::new(std::env::current_exe()?);
    command
        .args(check_arguments(std::env::args_os().skip(1)))
        .arg("--out")
        .arg(folder.path())
        .args(["--device", "cpu", "--format", "json", "--quiet"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(folder.path().join(MESSAGES))?);
    if args.hints.is_none() && has_assignment {
        command.args(["--hints", "line"]);
    }
    let mut child = command.spawn()?;
    let status = loop {
        if stop.load(Ordering::Relaxed) {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        match child.try_wait()? {
            Some(status) => break status,
            None => thread::sleep(POLL_INTERVAL),
        }
    };
    let read = input::read(&folder.path().join("verdict.json"));
    let verdicts: Option<Verdicts> = read.ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let Some(record) = verdicts.and_then(|mut verdicts| verdicts.shaders.pop()) else {
        let messages = input::read(&folder.path().join(MESSAGES)).unwrap_or_default();
        let messages = String::from_utf8_lossy(&messages);
        let message = messages.lines().next().unwrap_or_default();
        return Err(io::Error::other(format!("{message} ({status})")));
    };
    let found = find_one(&args.input, "watch", &Terminal::new(true, false)).ok();
    let source = found.and_then(|input| source(&input));
    Ok(Some(json!({
        "article": article(&record, source.as_deref()),
        "ran": {
            "algorithm": record.algorithm.is_some(), "precision": record.precision.is_some(),
            "toolchain": record.toolchain.is_some(),
        },
        "images": images(folder.path())?,
    })))
}

/// The images that the check wrote, as URLs.
fn images(folder: &Path) -> io::Result<Map<String, Value>> {
    let mut found = Map::new();
    for path in image_files(folder)? {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        // `-reference-value.png` also ends with `-value.png`, and is the longer one.
        let kinds = IMAGES.iter().filter(|(_, suffix)| name.ends_with(suffix));
        if let Some((kind, _)) = kinds.max_by_key(|(_, suffix)| suffix.len()) {
            let url = format!(
                "data:image/png;base64,{}",
                BASE64_STANDARD.encode(input::read(&path)?)
            );
            found.insert((*kind).to_owned(), url.into());
        }
    }
    Ok(found)
}

/// The files of a folder and of those in it: the images of a project are in a folder of its name.
fn image_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(image_files(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

/// The options of `watch` with a value that `check` does not have.
const OPTIONS: [&str; 1] = ["--port"];
/// The flags that `check` does not have, or that are given anyway.
const FLAGS: [&str; 5] = ["--open", "--quiet", "--verbose", "-q", "-v"];

/// The arguments of `check` for those of `watch`.
fn check_arguments(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut rest = arguments.peekable();
    let mut checked = Vec::new();
    let mut is_named = false;
    while let Some(argument) = rest.next() {
        let text = argument.to_str().unwrap_or_default();
        if text == "--" {
            checked.push(argument);
            checked.extend(rest);
            break;
        }
        let option = OPTIONS.iter().find_map(|option| text.strip_prefix(option));
        match option {
            Some("") => drop(rest.next()),
            Some(value) if value.starts_with('=') => {}
            _ if FLAGS.contains(&text) => {}
            _ if text == "watch" && !is_named => {
                is_named = true;
                checked.push("check".into());
            }
            _ => checked.push(argument),
        }
    }
    // Options follow, which are none after `--`.
    if let Some(end) = checked.iter().position(|argument| argument == "--") {
        let inputs = checked.split_off(end);
        let inputs = inputs
            .into_iter()
            .skip(1)
            .map(|input| Path::new(".").join(input).into_os_string());
        checked.extend(inputs);
    }
    checked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_has_the_arguments_of_the_page() {
        for (watch, check) in [
            (
                "watch a.glsl --port 80 --scene b.toml",
                "check a.glsl --scene b.toml",
            ),
            ("-v watch watch --port=80 --open --time 2", "check watch --time 2"),
            ("watch --ports", "check --ports"),
            ("watch --time 1 -- -a.glsl", "check --time 1 ./-a.glsl"),
        ] {
            let arguments = check_arguments(watch.split(' ').map(OsString::from));
            assert_eq!(arguments.join(" ".as_ref()), *check, "{watch}");
        }
    }
}
