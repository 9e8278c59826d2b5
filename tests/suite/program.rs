//! Runs the program as a user does.

use std::path::Path;
use std::process::{Command, Output};

/// The result of a run.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs `toyproof` with these arguments in a folder.
pub(crate) fn toyproof(folder: &Path, arguments: &[&str]) -> Run {
    run(command(folder).args(arguments))
}

/// The program in a folder, without environment variables that would change its output.
pub(crate) fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toyproof"));
    command
        .current_dir(folder)
        .env_remove("NO_COLOR")
        .env_remove("CLICOLOR_FORCE")
        .env_remove("RUST_BACKTRACE");
    command
}

/// Checks the folder `hw` against `scene.toml`, in a small size and without a GPU.
pub(crate) fn check_homework(folder: &Path) -> Command {
    let mut check = command(folder);
    check.args([
        "check",
        "hw",
        "--scene",
        "scene.toml",
        "--device",
        "cpu",
        "--size",
        "64x36",
    ]);
    check
}

/// Runs a command and asserts that no internal error occurs.
pub(crate) fn run(command: &mut Command) -> Run {
    let run = output(command);
    let all = [&run.stdout, &run.stderr];
    assert!(
        all.iter()
            .all(|text| !text.contains("internal error") && !text.contains("panic at")),
        "{run:?}"
    );
    run
}

/// Runs a command.
pub(crate) fn output(command: &mut Command) -> Run {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().unwrap();
    Run {
        code: status
            .code()
            .unwrap_or_else(|| panic!("ended by a signal: {status}")),
        stdout: String::from_utf8(stdout).unwrap(),
        stderr: String::from_utf8(stderr).unwrap(),
    }
}
