//! What a teacher needs beyond the check of one shader: assignments, tests of functions, submissions of a
//! class, autograders, and the similarity of shaders.
//!
//! # Parts
//!
//! - [`assignment`]: the requirements on the shaders of a class, in one TOML file
//! - [`function_test`]: tests of single functions, in assignments, files of their own and comments
//! - [`collect`]: the submissions of a class, from the downloads of a learning management system
//! - [`decisions`]: what a teacher decides on single shaders instead of the check
//! - [`autograder`]: autograders for grading platforms
//! - [`gradebook`]: marks in the tables of learning management systems
//! - [`pack`]: what students get of an assignment, without its solution
//! - [`similar`]: similarity of shaders by their trees
//! - [`shards`]: the parts of a large batch
//!
//! # Example
//!
//! ```
//! use std::path::Path;
//!
//! use toyproof_classroom::assignment::Assignment;
//! use toyproof_diagnostic::{File, Files};
//!
//! let mut files = Files::default();
//! let file = files.add(File::new("assignment.toml", "scene = \"02-sphere.toml\"\n"));
//! let assignment = Assignment::parse(&files, file, Path::new("../../glsl")).unwrap();
//! assert_eq!(assignment.frames.len(), 1);
//! ```

pub mod assignment;
pub mod autograder;
pub mod collect;
pub mod decisions;
pub mod function_test;
pub mod gradebook;
pub mod pack;
pub mod shards;
pub mod similar;
