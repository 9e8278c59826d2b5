//! The language server: diagnostics, completion, navigation, rename and checks for editors that speak the
//! Language Server Protocol. The engine, which answers questions about open texts, does not know the
//! transport; [`serve`] connects both.
//!
//! ```no_run
//! use toyproof_lsp::{Host, serve};
//!
//! let executable = std::env::current_exe().expect("a program");
//! serve(Host { executable, cache: None }).expect("a client on standard input");
//! ```
//!
//! # Parts
//!
//! - `workspace`: the open documents and folders; `unit`: what is analyzed together; `snapshot`: a document
//!   as it is now, which each feature reads.
//! - `encoding`, `location`: positions and URIs of the protocol; `settings`: those of the editor.
//! - `diagnostics`, `explain`: messages, and the explanations of their codes.
//! - `tokens`: the text as it is written; `scope`: what is visible; `describe`, `doc_comment`: what names
//!   mean.
//! - `symbol`: entities that are the same in all texts; `edits`: edits of files.
//! - `hover`, `completion`, `navigation`, `rename`, `code_actions` and the other features: a file and a
//!   function for each.
//! - `background`: the verdict after a save and the values of a pixel, which the program finds itself.
//! - `server`: the loop over messages.

mod background;
mod code_actions;
mod color;
mod completion;
mod describe;
mod diagnostics;
mod doc_comment;
mod edits;
mod encoding;
#[cfg(test)]
mod every_feature;
mod explain;
mod folding;
mod formatting;
mod hover;
mod inlay_hint;
mod location;
mod navigation;
mod outline;
mod rename;
mod scope;
mod selection;
mod semantic;
mod server;
mod settings;
mod signature;
mod snapshot;
mod symbol;
mod tokens;
mod unit;
mod workspace;

use std::path::PathBuf;

pub use self::server::{ServeError, serve};

/// What the server needs from the program that it is a part of.
#[derive(Debug, Clone)]
pub struct Host {
    /// The program, which runs checks.
    pub executable: PathBuf,
    /// The folder for explanations of codes, which editors open; `None` for none.
    pub cache: Option<PathBuf>,
}

#[cfg(test)]
mod tests;
