//! A page on 127.0.0.1 that follows a shader while it is edited: its image beside the reference, its verdict,
//! its messages, and the values in a pixel. This crate has the server, the page and the following of files;
//! a [`Studio`], which the caller gives, reads, renders and checks the shader.
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::AtomicBool;
//!
//! use toyproof_watch::{Build, Server, Studio};
//!
//! struct Empty;
//!
//! impl Studio for Empty {
//!     fn build(&self) -> Build {
//!         Build { shader: None, status: serde_json::json!({"name": "none"}), files: Vec::new() }
//!     }
//!
//!     fn check(&self, _: &AtomicBool) -> Option<serde_json::Value> {
//!         None
//!     }
//! }
//!
//! let server = Server::open(0)?;
//! assert!(server.url().starts_with("http://127.0.0.1:"));
//! // The page is served until the flag is set.
//! server.run(Arc::new(Empty), &AtomicBool::new(true));
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! # Parts
//!
//! - `http`: requests and responses, with limits; hosts and origins are checked.
//! - `server`: the port, the token, the paths, and a thread for each connection.
//! - `session`: the versions of the shader, the images of the tabs, and the events for them.
//! - `follow`: files that are followed, and the changes that are one save.
//! - `view`: what a tab shows.
//! - `page`: the page, which uses the parts of the report's page and the player of `toyproof_gpu::browser`.

mod follow;
mod http;
mod server;
mod session;
mod view;

pub use server::Server;
pub use session::{Build, Failure, Rendered, Studio, WatchedShader};
pub use view::{KeyCodes, View};
