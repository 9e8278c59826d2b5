//! Assignments: the requirements on the shaders of a class, described by one TOML file.
//!
//! ```
//! use std::path::Path;
//!
//! use toyproof_classroom::assignment::Assignment;
//! use toyproof_diagnostic::{File, Files};
//!
//! let mut files = Files::default();
//! let text = "scene = \"02-sphere.toml\"\n[[frame]]\nsize = [64, 36]\n[[frame]]\nsize = [36, 64]\n";
//! let file = files.add(File::new("assignment.toml", text));
//! // The paths in the file are relative to its folder.
//! let assignment = Assignment::parse(&files, file, Path::new("../../glsl")).unwrap();
//! assert_eq!(assignment.frames.len(), 2);
//! ```
//!
//! # Parts
//!
//! - `file`: reads the TOML file of an assignment; `template` writes a new one.
//! - `rules`: checks the text; [`crate::function_test`] tests its functions.
//! - `sample`: a test of a function of a model solution, for a new assignment.

mod file;
mod rules;
mod sample;
mod template;

use std::path::{Path, PathBuf};

use toyproof_glsl::UniformValue;
use toyproof_image::FrameInputs;
use toyproof_report::{FunctionRecord, Rubric, RulesRecord};
use toyproof_toml::Moment;
use toyproof_verify::Difference;

pub use self::rules::Rules;
pub use self::template::Model;
use crate::function_test::{FunctionTest, Subject};

/// The name of an assignment's file, which is used for the shaders of its folder.
pub const FILE_NAME: &str = "assignment.toml";

/// The largest number of frames of an assignment.
pub const MAX_FRAMES: usize = 64;

/// An assignment.
#[derive(Debug, Clone)]
pub struct Assignment {
    /// The reference of the shaders.
    pub reference: Reference,
    /// The differences from the reference with which a shader is still correct.
    pub permitted: Vec<Difference>,
    /// When the submissions are due, unless a class has another deadline.
    pub deadline: Option<Moment>,
    /// The frames in which a shader must be right, at least one.
    pub frames: Vec<FrameInputs>,
    /// The values of uniforms that the shaders declare.
    pub uniforms: Vec<UniformValue>,
    /// The points of the checks, if the assignment gives any points.
    pub rubric: Option<Rubric>,
    /// The features of the image that earn points.
    pub features: Vec<Feature>,
    /// The rules for the shaders' text.
    pub rules: Option<Rules>,
    /// The functions that are tested.
    pub functions: Vec<FunctionTest>,
}

/// Whether a TOML file is an assignment and not a scene: it names its reference or its scene.
#[must_use]
pub fn is_assignment(text: &str) -> bool {
    let keys = text
        .lines()
        .map(str::trim_start)
        .take_while(|line| !line.starts_with('['));
    let mut names = keys.filter_map(|line| Some(line.split_once('=')?.0.trim_end()));
    names.any(|name| matches!(name, "reference" | "scene"))
}

impl Assignment {
    /// Checks the rules of a shader, if there are any, and tests its functions. `subject` is `None` if the
    /// shader does not compile.
    #[must_use]
    pub fn check_text(&self, subject: Option<&Subject>) -> (Option<RulesRecord>, Vec<FunctionRecord>) {
        let rules = self.rules.as_ref().map(|rules| match subject {
            Some(subject) => rules.check(subject.files, subject.checked, subject.text),
            None => rules.unchecked(),
        });
        let functions = self.functions.iter().map(|test| match subject {
            Some(subject) => test.run(subject),
            None => test.untested(),
        });
        (rules, functions.collect())
    }
}

/// A feature of the image, such as soft shadows.
#[derive(Debug, Clone)]
pub struct Feature {
    /// The name.
    pub name: String,
    /// The points for a shader that is right in all pixels that the feature changes.
    pub points: f64,
    /// The reference without the feature.
    pub without: Reference,
}

/// The reference of the shaders of an assignment.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference {
    /// The file of a scene.
    Scene(PathBuf),
    /// The file of a shader or of an image.
    Given {
        /// The file.
        path: PathBuf,
        /// The largest difference of a color, in 8-bit levels; `None` for the default.
        tolerance: Option<f64>,
    },
}

impl Reference {
    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        match self {
            Self::Scene(path) | Self::Given { path, .. } => path,
        }
    }
}
