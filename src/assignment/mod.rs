//! Assignments: what the shaders of a class are checked against, described by one TOML file.
//!
//! ```
//! use std::path::Path;
//!
//! use toyproof::assignment::Assignment;
//! use toyproof::diagnostic::{File, Files};
//!
//! let mut files = Files::default();
//! let text = "scene = \"02-sphere.toml\"\n[[frame]]\nsize = [64, 36]\n[[frame]]\nsize = [36, 64]\n";
//! let file = files.add(File::new("assignment.toml", text));
//! // The paths in the file are relative to its folder.
//! let assignment = Assignment::parse(&files, file, Path::new("glsl")).unwrap();
//! assert_eq!(assignment.frames.len(), 2);
//! ```

mod file;

use std::path::PathBuf;

use toyproof_image::FrameInputs;

use crate::report::Rubric;

/// The name of an assignment's file, which is used for the shaders of its folder.
pub const FILE_NAME: &str = "assignment.toml";

/// The largest number of frames of an assignment.
pub const MAX_FRAMES: usize = 64;

/// An assignment.
#[derive(Debug, Clone)]
pub struct Assignment {
    /// What the shaders are compared with.
    pub reference: Reference,
    /// The frames in which a shader must be right, at least one.
    pub frames: Vec<FrameInputs>,
    /// The points, if the assignment gives any.
    pub rubric: Option<Rubric>,
}

/// What the shaders of an assignment are compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// The file of a scene.
    Scene(PathBuf),
    /// The file of a shader or of an image.
    Given {
        /// The file.
        path: PathBuf,
        /// The largest difference of a color, in 8-bit levels; none for the default.
        tolerance: Option<f64>,
    },
}
