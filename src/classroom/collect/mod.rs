//! The submissions of a class: downloads of a learning management system, sorted by students.
//!
//! - `class`, `students`: `class.toml`, and the list of students
//! - `download`, `text`, `naming`: what is in a download, which texts are shaders, and whose they are
//! - `collection`: the submissions of all students
//! - `lateness`: when a submission was made, and how late that is
//! - `roster`: the list of the students in a folder of submissions
//! - `storage`: writes the shaders of each student

pub mod class;
pub mod collection;
mod download;
pub mod lateness;
pub mod naming;
pub mod roster;
pub mod storage;
pub(crate) mod students;
pub mod text;
