//! `ShaderToy` projects: their tabs, the order of their passes, and the inputs of these, read from a folder
//! or from the site's JSON, and written as either.
//!
//! A project is the Image tab and up to seven others: Common, whose text precedes every other tab, Buffers A
//! to D, Cube A and Sound. Importing and exporting are inverse: the code stays as it is, byte for byte, and
//! whatever else the JSON holds is kept.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_project::{PassKind, Project};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let json = r#"{"ver": "0.1", "info": {"name": "Blue"}, "renderpass": [{"inputs": [], "outputs": [], "type": "image",
//!         "code": "void mainImage(out vec4 c, in vec2 p) { c = vec4(0, 0, 1, 1); }", "name": "Image", "description": ""}]}"#;
//!     let file = files.add(File::new("blue.json", json));
//!     let project = Project::from_json(&mut files, file)?;
//!     assert_eq!(project.name(), Some("Blue"));
//!     assert_eq!(project.passes[0].kind, PassKind::Image);
//!     assert!(project.to_toml().contains("name = \"Blue\""));
//!     Ok(())
//! }
//! ```
//!
//! # Parts
//!
//! - `node`: trees of values with their places.
//! - `json`, `folder`: the two forms of a project, which are inverse.
//! - `read`: a tree of values as a project.
//! - `media`: the ids of the site's built-in media.
//! - `declared`: what hosts declare outside of the language: headers of ISF, `#iUniform`.
//! - `check`: compiles every tab with Common in front, and Common alone.
//! - `analyze`: the same for an editor, which also needs the trees of tabs with errors.
//! - `lint`: warnings about inputs.
//! - `graph`: what renders the image; `textures`: what inputs read, from files or computed.
//! - `subset`: a project with some of its passes and inputs.
//! - `script`: files that describe the mouse and the keyboard over the frames of a run.

mod analyze;
pub mod archive;
mod check;
mod compiled;
mod declared;
pub mod files;
mod folder;
mod format;
mod graph;
mod json;
mod lint;
mod media;
mod node;
mod pass;
mod project;
mod read;
mod script;
mod subset;
mod textures;

pub use toyproof_glsl::{Filter, Wrap};

pub use self::analyze::{AnalyzedProject, AnalyzedTab, analyze};
pub use self::check::{CheckedPass, CheckedProject, check};
pub use self::compiled::CompiledProject;
pub use self::declared::{Declared, with_declarations};
pub use self::folder::PROJECT_FILE;
pub use self::graph::{Rendering, UnsupportedPass};
pub use self::media::Medium;
pub use self::pass::{Buffer, Input, MAX_TAB_BYTES, Pass, PassKind, Sampler, Source, SourceType, Tab};
pub use self::project::Project;
pub use self::script::parse_script;
pub use self::textures::MissingMedium;

#[cfg(test)]
mod tests;
