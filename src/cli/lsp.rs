//! `toyproof lsp`

use std::env;
use std::path::PathBuf;

use toyproof_lsp::{Host, serve};

use super::{CliError, Exit};

/// Run the language server of editors, on standard input and output
///
/// Editors start it: it reports errors and warnings while one types, completes, renames and formats, and
/// checks a shader after each save. The guide's page on editors has the settings of each.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Example, for Neovim:
  vim.lsp.start({ name = \"toyproof\", cmd = { \"toyproof\", \"lsp\" } })

Exit code: 0 if the editor ends the session, 2 for any other error.")]
pub(super) struct Args {
    /// Accepted for editors that always give it: the server uses standard input and output
    #[arg(long, hide = true)]
    stdio: bool,
}

pub(super) fn run(_: &Args) -> Result<Exit, CliError> {
    let executable = env::current_exe().map_err(CliError::new)?;
    let host = Host {
        executable,
        cache: cache().map(|folder| folder.join("explanations")),
    };
    serve(host).map_err(CliError::new)?;
    Ok(Exit::Success)
}

/// The folder for files that can be made again: that of the system, for this version of the program.
fn cache() -> Option<PathBuf> {
    let folder = |variable: &str| {
        let folder = env::var_os(variable).map(PathBuf::from);
        folder.filter(|folder| folder.is_absolute())
    };
    let base = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")))
    };
    base.map(|base| base.join("toyproof").join(env!("CARGO_PKG_VERSION")))
}
