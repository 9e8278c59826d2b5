//! `toyproof watch`

mod browser;
mod reference;
mod studio;
mod verdict;
mod watched;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Duration;

use toyproof_watch::Server;

use self::studio::ShaderStudio;
use super::check::HintLevel;
use super::inputs::{FrameArgs, LanguageArgs, parse_time_limit};
use super::reference::ReferenceArgs;
use super::{CliError, Exit, Terminal};

/// Show a shader on a page that follows it while it is edited
///
/// The page is served on 127.0.0.1 only, at the address that is printed. After each save it shows the image
/// of the evaluator beside the reference, the messages, then the verdict with the likely mistake. An image
/// stays while the shader does not compile. The address contains a token: who knows it can see the shader.
#[derive(Debug, Clone, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof watch mine.glsl --open
  toyproof watch mine.glsl --scene 03-shading
  toyproof watch mine.glsl --reference solution.glsl --port 8000
  toyproof watch project --assignment waves")]
pub(super) struct Args {
    /// The shader or the project: a file, or a folder
    input: PathBuf,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The assignment (.toml), or its folder: its reference, and its first frame unless flags name another
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "reference"])]
    assignment: Option<PathBuf>,
    /// What the page shows of the mistake in a wrong shader [default: line with an assignment, else fix]
    #[arg(long, value_enum, value_name = "HINTS")]
    hints: Option<HintLevel>,
    /// The port [default: any free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open the page in the system's browser
    #[arg(long)]
    open: bool,
    /// The time limit for an image and for the check: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = parse_time_limit)]
    timeout: Duration,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    frame: FrameArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    if args.input == Path::new("-") {
        let error = CliError::new("standard input cannot be followed");
        return Err(error.with_help("name a file or a folder"));
    }
    let studio = ShaderStudio::new(args.clone())?;
    let server = Server::open(args.port)
        .map_err(|error| CliError::new(format_args!("cannot listen on port {}: {error}", args.port)))?;
    let url = server.url();
    terminal.result(&url);
    if args.open {
        open(&url, terminal);
    }
    terminal.watch_interrupts("the page is not served any more");
    server.run(Arc::new(studio), terminal.interrupt_flag());
    Ok(Exit::Success)
}

/// Opens the page in the system's browser.
fn open(url: &str, terminal: &Terminal) {
    let mut command = if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else {
        Command::new(if cfg!(target_os = "macos") {
            "open"
        } else {
            "xdg-open"
        })
    };
    let quiet = command
        .arg(url)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if let Err(error) = quiet.spawn() {
        terminal.warn(format_args!(
            "cannot open a browser: {error}\nhelp: open the address in one"
        ));
    }
}
