//! `toyproof fmt`

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{File, grouped, plural};
use toyproof_format::{Error as FormatError, format};
use toyproof_project::Tab;
use toyproof_project::files::{self, Input, ProjectTexts, ReadError, Texts};

use super::shader::find;
use super::{CliError, Exit, Terminal};

/// Format shaders
///
/// Each statement gets a line of its own, blocks are indented by 4 columns, and lines of code are broken at
/// 100 columns. Comments, directives, blank lines and the author's line breaks inside of statements are kept,
/// and so is the meaning: only blanks between tokens change. Shaders with errors are formatted, too.
///
/// A comment `// toyproof: no-format` keeps the statement or declaration after it as it is, and the whole file
/// if it is at its top.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof fmt mine.glsl
  toyproof fmt course --check
  toyproof fmt - < mine.glsl > formatted.glsl

Exit code: 0 if all files are formatted, 1 if --check finds one that is not, 2 for any error.")]
pub(super) struct Args {
    /// Shaders: files, folders, projects, or - for standard input, which is written to standard output
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// Write nothing, and list the files that are not formatted
    #[arg(long)]
    check: bool,
}

/// How many files have which state.
#[derive(Debug, Default)]
struct Counts {
    formatted: u64,
    unchanged: u64,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let mut exit = Exit::Success;
    let mut counts = Counts::default();
    for input in find(&args.shaders, terminal) {
        for formatted in
            texts(input).map(|text| text.and_then(|text| args.format(&text, &mut counts, terminal)))
        {
            if let Err(error) = formatted {
                exit = exit.max(terminal.fail(&error));
            }
        }
    }
    let Counts { formatted, unchanged } = counts;
    let verb = if args.check { "not formatted" } else { "formatted" };
    terminal.note(&format!(
        "{} {} {verb}, {} unchanged",
        grouped(formatted),
        plural(formatted, "file", "files"),
        grouped(unchanged)
    ));
    if args.check && formatted > 0 {
        exit = exit.max(Exit::ShaderFault);
    }
    exit
}

/// A text, and the file that it is in unless it is a stream.
struct Text {
    file: File,
    path: Option<PathBuf>,
}

/// The texts of an input: of a project, those of its tabs.
fn texts(input: Result<Input, ReadError>) -> impl Iterator<Item = Result<Text, CliError>> {
    let read = input.and_then(|input| Ok((files::read(&input)?, input)));
    let texts = match read {
        Err(error) => vec![Err(error.into())],
        Ok((Texts::Shader(file), input)) => {
            let path = input.path().map(Path::to_owned);
            vec![Ok(Text { file, path })]
        }
        Ok((Texts::Project(ProjectTexts::Json(file)), _)) => {
            let error = CliError::new(format_args!("{}: JSON is not formatted", file.name()));
            vec![Err(error.with_help("write it as files with `toyproof import`"))]
        }
        Ok((Texts::Project(ProjectTexts::Folder { tabs, folder, .. }), _)) => {
            let text = |(tab, file): (Tab, File)| {
                let path = folder.as_ref().map(|folder| folder.join(tab.file_name()));
                Ok(Text { file, path })
            };
            tabs.into_iter().map(text).collect()
        }
    };
    texts.into_iter()
}

impl Args {
    fn format(&self, text: &Text, counts: &mut Counts, terminal: &Terminal) -> Result<(), CliError> {
        let Text { file, path } = text;
        let formatted = format(file.text()).map_err(|error| match error {
            FormatError::TooDeep(_) => format!("{}:{error}", file.name()),
            FormatError::Changed(_) => format!("{}: {error}", file.name()),
        })?;
        let is_formatted = formatted == file.text();
        if is_formatted {
            counts.unchanged += 1;
        } else {
            counts.formatted += 1;
        }
        match path {
            _ if self.check => {
                if !is_formatted {
                    terminal.result(file.name());
                }
                Ok(())
            }
            None => terminal.bytes(formatted.as_bytes()),
            Some(path) if !is_formatted => {
                terminal.write(path, formatted.as_bytes())?;
                terminal.result(&format!("formatted {}", file.name()));
                Ok(())
            }
            Some(_) => Ok(()),
        }
    }
}
