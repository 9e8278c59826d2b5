//! A command that tests a shader, as those of creduce and cvise do.

use std::fmt;
use std::fs;
use std::io::{self, Read as _, Seek as _};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use thiserror::Error;

/// The longest output of a command in a report, in lines and bytes.
const MAX_OUTPUT_LINES: usize = 40;
const MAX_OUTPUT_BYTES: u64 = 1 << 16;

/// What stands for the file in a command.
const FILE: &str = "{}";

/// The time between two checks whether a command has ended.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// A command of the shell in which `{}` stands for the file of a shader, or the folder of a project.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    text: String,
    file_name: String,
}

/// What a command gets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CommandInput {
    /// A file with this text.
    File(String),
    /// A folder with these files, by their names.
    Folder(Vec<(String, String)>),
}

impl CommandInput {
    /// Writes the file or the folder, in place of what a path names.
    fn write(&self, path: &Path) -> io::Result<()> {
        match self {
            Self::File(text) => fs::write(path, text),
            Self::Folder(files) => {
                if path.exists() {
                    fs::remove_dir_all(path)?;
                }
                fs::create_dir(path)?;
                files
                    .iter()
                    .try_for_each(|(name, text)| fs::write(path.join(name), text))
            }
        }
    }
}

/// How a command ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// With an exit status.
    Exit(i32),
    /// By a signal.
    Signal(i32),
    /// It exceeds the time limit, and is ended.
    Timeout,
}

/// Why a command cannot be used.
#[derive(Debug, Error)]
pub enum CommandError {
    /// It names no file.
    #[error("the command has no `{{}}`, in place of which it gets the name of a file")]
    NoFile,
    /// The name is passed as one argument whatever it contains, and quotes would make it another.
    #[error("`{{}}` in the command needs no quotes")]
    Quoted,
    /// It does not start, or its file cannot be written.
    #[error("cannot run the command: {0}")]
    NotRun(#[from] io::Error),
}

impl CommandLine {
    /// A command that gets a file of a name, whose extension may matter to the command.
    ///
    /// # Errors
    /// If the command has no `{}`, or has it in quotes.
    pub fn new(text: &str, file_name: &str) -> Result<Self, CommandError> {
        if !text.contains(FILE) {
            return Err(CommandError::NoFile);
        }
        if text.contains("'{}'") || text.contains("\"{}\"") {
            return Err(CommandError::Quoted);
        }
        Ok(Self {
            text: text.to_owned(),
            file_name: file_name.to_owned(),
        })
    }

    /// The name of the file.
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// The command as a person types it, with the name of the file.
    pub fn shown(&self) -> String {
        self.text.replace(FILE, &self.file_name)
    }

    /// Runs the command on an input, in a folder of its own for temporary files.
    ///
    /// # Errors
    /// If it does not start.
    pub fn run(
        &self,
        folder: &TempDir,
        input: &CommandInput,
        limit: Duration,
    ) -> Result<Ending, CommandError> {
        self.run_into(folder, input, limit, [Stdio::null(), Stdio::null()])
    }

    /// Runs the command like [`run`](Self::run), and returns the first lines that it prints, without colors.
    ///
    /// # Errors
    /// If it does not start.
    pub fn output(
        &self,
        folder: &TempDir,
        input: &CommandInput,
        limit: Duration,
    ) -> Result<String, CommandError> {
        let mut printed = tempfile::tempfile()?;
        // Both write at the end of one file, in their order.
        let streams = [printed.try_clone()?.into(), printed.try_clone()?.into()];
        self.run_into(folder, input, limit, streams)?;
        printed.rewind()?;
        let mut bytes = Vec::new();
        printed.take(MAX_OUTPUT_BYTES).read_to_end(&mut bytes)?;
        let file = folder.path().join(&self.file_name);
        let text = without_colors(&String::from_utf8_lossy(&bytes))
            .replace(&*file.to_string_lossy(), &self.file_name);
        let lines: Vec<&str> = text.lines().take(MAX_OUTPUT_LINES).collect();
        Ok(lines.join("\n"))
    }

    fn run_into(
        &self,
        folder: &TempDir,
        input: &CommandInput,
        limit: Duration,
        [stdout, stderr]: [Stdio; 2],
    ) -> Result<Ending, CommandError> {
        let file = folder.path().join(&self.file_name);
        input.write(&file)?;
        let mut command = shell(&self.text, &file);
        command.stdin(Stdio::null()).stdout(stdout).stderr(stderr);
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let deadline = Instant::now() + limit;
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(ending(status));
            }
            if Instant::now() > deadline {
                #[cfg(unix)]
                if let Some(group) = rustix::process::Pid::from_raw(child.id() as i32) {
                    // Its children hold the driver or the file.
                    let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
                }
                let _ = child.kill();
                child.wait()?;
                return Ok(Ending::Timeout);
            }
            thread::sleep(POLL_INTERVAL);
        }
    }
}

impl fmt::Display for CommandLine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Exit(code) => write!(f, "ends with exit status {code}"),
            Self::Signal(signal) => write!(f, "is ended by signal {signal}"),
            Self::Timeout => f.write_str("exceeds the time limit"),
        }
    }
}

/// The command in the shell, whose first argument is the file: so its name needs no quotes.
#[cfg(unix)]
fn shell(text: &str, file: &Path) -> Command {
    let mut command = Command::new("/bin/sh");
    command
        .args(["-c", &text.replace(FILE, "\"$1\""), "sh"])
        .arg(file);
    command
}

#[cfg(not(unix))]
fn shell(text: &str, file: &Path) -> Command {
    let mut command = Command::new("cmd");
    command.args(["/C", &text.replace(FILE, &file.to_string_lossy())]);
    command
}

/// A text without the escape sequences that color it: `ESC [`, numbers, and a letter.
fn without_colors(text: &str) -> String {
    let mut parts = text.split("\x1b[");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push_str(
            part.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';')
                .get(1..)
                .unwrap_or_default(),
        );
    }
    out
}

fn ending(status: ExitStatus) -> Ending {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return Ending::Signal(signal);
    }
    Ending::Exit(status.code().unwrap_or_default())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn input() -> CommandInput {
        CommandInput::File("void f();".to_owned())
    }

    fn run(text: &str, limit: Duration) -> Ending {
        let folder = tempfile::tempdir().unwrap();
        let command = CommandLine::new(text, "it's a.glsl").unwrap();
        command.run(&folder, &input(), limit).unwrap()
    }

    #[test]
    fn commands_end_in_several_ways() {
        let limit = Duration::from_secs(10);
        assert_eq!(run("grep -q void {}", limit), Ending::Exit(0));
        assert_eq!(run("grep -q float {}", limit), Ending::Exit(1));
        assert_eq!(run("kill -SEGV $$ # {}", limit), Ending::Signal(11));
    }

    #[test]
    fn the_output_has_the_name_of_the_file_and_no_colors() {
        let folder = tempfile::tempdir().unwrap();
        let text = "echo {}; printf '\\033[1;31merror\\033[0m\\n' >&2; seq 100; exit 3";
        let command = CommandLine::new(text, "a.frag").unwrap();
        let output = command
            .output(&folder, &input(), Duration::from_secs(10))
            .unwrap();
        assert!(output.starts_with("a.frag\nerror\n1\n2\n"), "{output}");
        assert_eq!(output.lines().count(), MAX_OUTPUT_LINES);
        assert!(command.shown().starts_with("echo a.frag; "));
    }

    #[test]
    fn a_command_gets_the_files_of_a_project() {
        let folder = tempfile::tempdir().unwrap();
        let command = CommandLine::new("ls {}", "waves").unwrap();
        for names in [&["image.glsl", "buffer-a.glsl"][..], &["image.glsl"]] {
            let files = names.iter().map(|&name| (name.to_owned(), String::new()));
            let input = CommandInput::Folder(files.collect());
            let output = command.output(&folder, &input, Duration::from_secs(10)).unwrap();
            assert_eq!(output.lines().count(), names.len(), "{output}");
        }
    }

    #[test]
    fn a_hang_ends_with_all_processes() {
        let start = Instant::now();
        assert_eq!(
            run("sleep 60 & sleep 60; cat {}", Duration::from_millis(50)),
            Ending::Timeout
        );
        assert!(start.elapsed() < Duration::from_secs(30));
    }

    #[test]
    fn a_command_needs_a_file() {
        assert!(matches!(
            CommandLine::new("naga a.frag", "a.frag"),
            Err(CommandError::NoFile)
        ));
    }
}
