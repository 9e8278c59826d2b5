//! The help of the program, which lists the commands in groups, and the advice on unknown commands.

use std::fmt::Write;

use clap::Command;
use clap::error::{ContextKind, ContextValue, Error};
use toyproof_diagnostic::nearest;

/// The commands, each in one group.
const GROUPS: [(&str, &[&str]); 7] = [
    (
        "Shaders",
        &["check", "test", "run", "debug", "convert", "compare", "reduce"],
    ),
    ("Scenes", &["scenes", "render"]),
    (
        "Classes",
        &["new", "collect", "similar", "merge", "gradebook", "autograder"],
    ),
    ("Projects", &["import", "export"]),
    ("Measurements", &["trade", "stress"]),
    ("Editing", &["watch", "fmt", "lsp", "dap"]),
    ("Help", &["explain", "doctor", "completions", "man"]),
];

/// Lists the commands in groups in the help.
pub(super) fn with_groups(command: Command) -> Command {
    let header = *command.get_styles().get_header();
    let literal = *command.get_styles().get_literal();
    let width = GROUPS.iter().flat_map(|(_, names)| *names).map(|name| name.len());
    let width = width.max().unwrap_or(0);
    let mut groups = String::new();
    for (title, names) in GROUPS {
        let _ = writeln!(groups, "{header}{title}:{header:#}");
        for name in names {
            let about = command.find_subcommand(name).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let space = width - name.len();
            let _ = writeln!(groups, "  {literal}{name}{literal:#}{:space$}  {about}", "");
        }
        groups.push('\n');
    }
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{groups}{header}Options:{header:#}\n\
         {{options}}{{after-help}}"
    ))
}

/// Suggests only the command that is nearest to an unknown one.
pub(super) fn with_nearest(mut error: Error, command: &Command) -> Error {
    if let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidSubcommand) {
        let names: Vec<_> = command.get_subcommands().map(Command::get_name).collect();
        if let Some(near) = nearest(unknown, names.iter().copied()) {
            let near = ContextValue::Strings(vec![near.to_owned()]);
            error.insert(ContextKind::SuggestedSubcommand, near);
        }
    }
    error
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::cli::Cli;

    #[test]
    fn every_command_is_in_one_group() {
        let mut grouped: Vec<_> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        grouped.sort_unstable();
        let command = Cli::command();
        let mut names: Vec<_> = command.get_subcommands().map(Command::get_name).collect();
        names.sort_unstable();
        assert_eq!(grouped, names);
    }

    #[test]
    fn an_unknown_command_has_one_suggestion() {
        for (unknown, suggested) in [("rnder", "render"), ("convrt", "convert"), ("chek", "check")] {
            let command = Cli::command();
            let error = command
                .clone()
                .try_get_matches_from(["toyproof", unknown])
                .unwrap_err();
            let error = with_nearest(error, &command).to_string();
            let tip = format!("a similar subcommand exists: '{suggested}'\n");
            assert!(error.contains(&tip), "{error}");
        }
    }
}
