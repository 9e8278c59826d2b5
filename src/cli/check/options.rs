//! The options of `check`, independent of its command line.

use std::path::PathBuf;

use clap::ValueEnum;
use toyproof_image::FrameInputs;
use toyproof_report::Hints;
use toyproof_report::platform::Platform;
use toyproof_verify::Difference;

use super::shard::Shard;
use crate::cli::inputs::{DriverArgs, LanguageArgs};
use crate::cli::reference::ReferenceArgs;

/// All options of one command.
pub(super) struct Options {
    /// All shaders, or the downloads of a class.
    pub(super) task: TaskInputs,
    pub(super) class: Option<PathBuf>,
    /// The earlier report whose times balance the shards.
    pub(super) costs: Option<PathBuf>,
    /// The file of the teacher's decisions, if it is not the one beside the class or the assignment.
    pub(super) decisions: Option<PathBuf>,
    /// Whether a grading platform checks the shaders, which knows when they are due.
    pub(super) is_on_platform: bool,
    pub(super) plan: PlanOptions,
    pub(super) check: CheckOptions,
    pub(super) batch: BatchOptions,
}

/// The shaders of one assignment, and the requirements on them; without a class, all shaders.
pub(super) struct TaskInputs {
    /// The name of the assignment in a class.
    pub(super) name: Option<String>,
    pub(super) shaders: Vec<PathBuf>,
    pub(super) assignment: Option<PathBuf>,
    pub(super) rubric: Option<PathBuf>,
}

/// The requirements on shaders that the user gives; an assignment has others.
pub(super) struct PlanOptions {
    pub(super) reference: ReferenceArgs,
    pub(super) permitted: Vec<Difference>,
    pub(super) frame: FrameInputs,
    /// Whether this frame replaces those of an assignment; otherwise only its size does, if it is given.
    pub(super) is_frame_given: bool,
}

/// How each shader is checked.
pub(super) struct CheckOptions {
    pub(super) language: LanguageArgs,
    pub(super) driver: DriverArgs,
    /// The budget of the search for a fix, in seconds of one core; 0 for none.
    pub(super) search: f64,
    /// Whether the user gives the number or the time of the frame.
    pub(super) is_moment_given: bool,
    /// The folder of the images, if they are written.
    pub(super) out: Option<PathBuf>,
}

/// How a batch runs, and what is reported of it.
pub(super) struct BatchOptions {
    pub(super) format: CheckFormat,
    /// The number of shaders to check in parallel; `None` for the number of cores.
    pub(super) jobs: Option<usize>,
    /// The folder of the reports, if they are written.
    pub(super) out: Option<PathBuf>,
    /// The folder or the archive of the pages for students, if they are written.
    pub(super) feedback: Option<PathBuf>,
    /// Whether results of an earlier run into this folder are reused.
    pub(super) resume: bool,
    pub(super) shard: Option<Shard>,
    /// Whether wrong shaders are searched again with expressions of correct ones.
    pub(super) searches_again: bool,
    /// The hints on the terminal and in reports for teachers.
    pub(super) teachers_hints: Hints,
    /// The hints in reports for students.
    pub(super) students_hints: Hints,
    /// The grading platform that reads the marks of a student.
    pub(super) platform: &'static Platform,
}

/// The format of standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CheckFormat {
    /// A verdict for each shader, with an explanation
    Human,
    /// A line `file:line:column: error[E0100]: message` for each diagnostic, for editors
    Short,
    /// verdict.json
    Json,
}
