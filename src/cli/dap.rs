//! `toyproof dap`

use std::env;
use std::ffi::OsString;
use std::io::{self, IsTerminal};

use clap::{ArgAction, Args as _, Command, FromArgMatches};
use serde_json::{Map, Value};
use toyproof_dap::{Launch, LaunchError, Launcher, serve};
use toyproof_diagnostic::{Diagnostic, Files, human, nearest};

use super::{CliError, Exit, Terminal, debug};

/// Serve an editor as a debug adapter: step through the execution of one pixel, forward and back
///
/// Speaks the Debug Adapter Protocol on standard input and output. An editor starts it; the arguments of its
/// launch configuration are the options of `debug`, such as `program`, `pixel` and `size`.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Example: the launch configuration of an editor that runs `toyproof dap`
  {\"type\": \"toyproof\", \"request\": \"launch\", \"program\": \"mine.glsl\", \"pixel\": [320, 180]}")]
pub(super) struct Args {}

pub(super) fn run(terminal: &Terminal) -> Result<Exit, CliError> {
    if io::stdin().is_terminal() {
        terminal
            .note("waiting for an editor that speaks the Debug Adapter Protocol; Ctrl-C ends the program");
    }
    match serve(io::stdin(), io::stdout(), &mut PixelLauncher { terminal }) {
        Ok(()) => Ok(Exit::Success),
        // The editor has ended.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(Exit::Success),
        Err(error) => Err(CliError::new(error)),
    }
}

/// Reads shaders with the options of `debug`.
struct PixelLauncher<'a> {
    terminal: &'a Terminal,
}

impl Launcher for PixelLauncher<'_> {
    fn launch(&mut self, arguments: &Map<String, Value>) -> Result<Launch, LaunchError> {
        let mut notes = Vec::new();
        let args = parse(arguments, &mut notes).map_err(|message| LaunchError {
            details: vec![message.clone()],
            message,
        })?;
        let (subject, warnings) = debug::subject(&args, self.terminal).map_err(|error| refusal(&error))?;
        notes.extend(texts(&warnings, &subject.files));
        Ok(Launch {
            subject,
            stops_on_entry: arguments
                .get(STOP_ON_ENTRY)
                .and_then(Value::as_bool)
                .unwrap_or(false),
            notes,
        })
    }
}

const STOP_ON_ENTRY: &str = "stopOnEntry";

/// The argument with the shader.
const PROGRAM: &str = "program";

/// The arguments that editors add, and those that are no options.
const OTHER_ARGUMENTS: [&str; 14] = [
    STOP_ON_ENTRY,
    PROGRAM,
    "channels",
    "console",
    "cwd",
    "debugServer",
    "internalConsoleOptions",
    "name",
    "noDebug",
    "postDebugTask",
    "preLaunchTask",
    "presentation",
    "request",
    "type",
];

/// The error of a command as that of a launch.
fn refusal(error: &CliError) -> LaunchError {
    let diagnostics = error.diagnostics.iter();
    let mut details: Vec<_> = diagnostics
        .flat_map(|(diagnostics, files)| texts(diagnostics, files))
        .collect();
    details.extend(error.message.iter().map(|message| format!("error: {message}")));
    details.extend(error.help.iter().map(|help| format!("help: {help}")));
    LaunchError {
        message: error.in_one_line(),
        details,
    }
}

fn texts(diagnostics: &[Diagnostic], files: &Files) -> Vec<String> {
    let texts = diagnostics.iter();
    texts
        .map(|diagnostic| human(diagnostic, files, None, false))
        .collect()
}

/// The options of `debug` that the arguments of a launch describe.
fn parse(arguments: &Map<String, Value>, notes: &mut Vec<String>) -> Result<debug::Args, String> {
    if let Some(folder) = arguments.get("cwd").and_then(Value::as_str) {
        env::set_current_dir(folder).map_err(|error| format!("`cwd`: {folder}: {error}"))?;
    }
    let command = debug::Args::augment_args(Command::new("launch")).disable_help_flag(true);
    let words = words(arguments, &command, notes)?;
    let parsed = command
        .try_get_matches_from(words)
        .and_then(|matches| debug::Args::from_arg_matches(&matches));
    parsed.map_err(|error| {
        let text = error.to_string();
        let text = text.strip_prefix("error: ").unwrap_or(&text);
        // The rest describes the command line.
        let text = text.split("\n\n").next().unwrap_or_default();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    })
}

/// The arguments of a launch as those of a command.
fn words(
    arguments: &Map<String, Value>,
    command: &Command,
    notes: &mut Vec<String>,
) -> Result<Vec<OsString>, String> {
    let options: Vec<_> = command
        .get_arguments()
        .filter(|option| option.get_id() != "format")
        .filter_map(|option| Some((option.get_long()?, option.get_action())))
        .collect();
    let names = options.iter().map(|(name, _)| *name);
    let mut words: Vec<OsString> = vec!["launch".into()];
    for (key, value) in arguments {
        let name = kebab_case(key);
        match options.iter().find(|(option, _)| *option == name) {
            Some((_, action)) => add(&mut words, &name, value, matches!(action, ArgAction::Append))?,
            None if OTHER_ARGUMENTS.contains(&&**key) || key.starts_with("__") => {}
            None => notes.push(match nearest(&name, names.clone()) {
                Some(near) => format!("the argument `{key}` is not known; did you mean `{near}`?"),
                None => format!("the argument `{key}` is not known"),
            }),
        }
    }
    for (number, channel) in arguments
        .get("channels")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .enumerate()
    {
        add(&mut words, &format!("channel{number}"), channel, false)?;
    }
    let program = arguments.get(PROGRAM).and_then(Value::as_str);
    let program = program.ok_or("the argument `program` must be the path of a shader or project")?;
    words.extend(["--".into(), program.into()]);
    Ok(words)
}

/// Adds an option; each element of a list is an option of its own if it may be repeated.
fn add(words: &mut Vec<OsString>, name: &str, value: &Value, is_repeated: bool) -> Result<(), String> {
    let text = match value {
        Value::Null | Value::Bool(false) => return Ok(()),
        Value::Bool(true) => {
            words.push(format!("--{name}").into());
            return Ok(());
        }
        Value::Array(values) if is_repeated => {
            return values.iter().try_for_each(|value| add(words, name, value, false));
        }
        Value::Object(values) if is_repeated => {
            for (key, value) in values {
                let text = option_text(name, value)?;
                words.push(format!("--{name}={key}={text}").into());
            }
            return Ok(());
        }
        value => option_text(name, value)?,
    };
    words.push(format!("--{name}={text}").into());
    Ok(())
}

/// A value as the text of an option: a list as numbers with commas between them, a size as `640x360`.
fn option_text(name: &str, value: &Value) -> Result<String, String> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Number(number) => Ok(number.to_string()),
        Value::Bool(value) => Ok(value.to_string()),
        Value::Array(values) => {
            let texts = values.iter().map(|value| option_text(name, value));
            let separator = if name == "size" { "x" } else { "," };
            Ok(texts.collect::<Result<Vec<_>, _>>()?.join(separator))
        }
        Value::Null | Value::Object(_) => Err(format!("the argument `{name}` has a value of the wrong type")),
    }
}

/// The name of an option: `include-dir` for `includeDir`.
fn kebab_case(key: &str) -> String {
    let mut name = String::new();
    for letter in key.chars() {
        if letter.is_ascii_uppercase() {
            name.push('-');
        }
        name.push(letter.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// The words of the command that a launch is read as.
    fn command_of(arguments: &Value) -> Result<String, String> {
        let mut notes = Vec::new();
        let command = debug::Args::augment_args(Command::new("launch"));
        let words = words(arguments.as_object().unwrap(), &command, &mut notes)?;
        let words = words[1..].iter().map(|word| word.to_str().unwrap());
        Ok(words
            .chain(notes.iter().map(String::as_str))
            .collect::<Vec<_>>()
            .join(" "))
    }

    #[test]
    fn arguments_of_a_launch_are_options_of_debug() {
        let launch = json!({
            "type": "toyproof", "request": "launch", "__sessionId": "1", "program": "a b.glsl", "pixel": [3, 4],
            "size": [64, 36], "time": 1.5, "lenient": true, "includeDir": ["x", "y"], "uniform": {"speed": 2},
            "channels": ["noise", null, "a.png"], "scene": null,
        });
        let expected = "--include-dir=x --include-dir=y --lenient --pixel=3,4 --size=64x36 --time=1.5 --uniform=speed=2 \
                        --channel0=noise --channel2=a.png -- a b.glsl";
        assert_eq!(command_of(&launch).unwrap(), expected);
        let unknown = json!({"program": "a", "pixle": 1});
        let expected = "-- a the argument `pixle` is not known; did you mean `pixel`?";
        assert_eq!(command_of(&unknown).unwrap(), expected);
        assert!(
            command_of(&json!({"pixel": [1, 2]}))
                .unwrap_err()
                .contains("`program`")
        );
        assert!(
            command_of(&json!({"program": "a", "pixel": {}}))
                .unwrap_err()
                .contains("`pixel`")
        );
    }

    #[test]
    fn invalid_arguments_of_a_launch_are_explained() {
        let error = |launch: Value| parse(launch.as_object().unwrap(), &mut Vec::new()).unwrap_err();
        let missing = error(json!({"program": "a"}));
        assert!(missing.contains("--pixel"), "{missing}");
        let wrong = error(json!({"program": "a", "pixel": [1]}));
        assert!(wrong.contains("expected two integers"), "{wrong}");
    }
}
