//! `toyproof completions` and `toyproof man`: the command line for a shell and for `man`.

use std::fs;
use std::path::PathBuf;

use clap::CommandFactory;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap_complete::Shell;
use clap_mangen::Man;
use toyproof_diagnostic::path_name;
use toyproof_report as report;

use super::{Cli, CliError, Exit, Terminal};

/// Print a completion script for a shell
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof completions bash > ~/.local/share/bash-completion/completions/toyproof
  toyproof completions fish > ~/.config/fish/completions/toyproof.fish
  toyproof completions zsh > ~/.zfunc/_toyproof")]
pub(super) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn completions(args: &CompletionsArgs, terminal: &Terminal) -> Result<Exit, CliError> {
    let mut script = Vec::new();
    // The codes complete words; an unknown one is searched for, so it is not an error of the arguments.
    let codes = report::explanations().map(|explanation| PossibleValue::new(explanation.code));
    let codes = PossibleValuesParser::new(codes);
    let mut command = Cli::command().mut_subcommand("explain", |explain| {
        explain.mut_arg("codes", |argument| argument.value_parser(codes))
    });
    clap_complete::generate(args.shell, &mut command, "toyproof", &mut script);
    terminal.bytes(&script)?;
    Ok(Exit::Success)
}

/// Print the manual page, or write the pages of all commands to a folder
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof man | man -l -
  toyproof man -o /usr/local/share/man/man1")]
pub(super) struct ManArgs {
    /// Write one page for each command into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn man(args: &ManArgs, terminal: &Terminal) -> Result<Exit, CliError> {
    let Some(folder) = &args.output else {
        let mut page = Vec::new();
        // Writing to memory does not fail.
        let _ = Man::new(Cli::command()).render(&mut page);
        terminal.bytes(&page)?;
        return Ok(Exit::Success);
    };
    let written = fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written.map_err(|error| format!("cannot write to {}: {error}", path_name(folder)))?;
    terminal.confirm(folder, "one manual page for each command");
    Ok(Exit::Success)
}
