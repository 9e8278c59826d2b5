//! The arguments of `toyproof check`.

use std::path::PathBuf;

use clap::ValueEnum;
use toyproof_explain::repair::DEFAULT_BUDGET;
use toyproof_report::Hints;
use toyproof_report::platform::{PLATFORMS, Platform};
use toyproof_verify::Difference;

use super::options::{BatchOptions, CheckFormat, CheckOptions, Options, PlanOptions, TaskInputs};
use super::shard::Shard;
use crate::cli::autograder::platform;
use crate::cli::inputs::{DriverArgs, FrameArgs, LanguageArgs, parse_number};
use crate::cli::reference::ReferenceArgs;

/// Check shaders against a reference, and give a verdict on each
///
/// The reference of a shader is the scene that --scene names, or the shader or image that --reference names,
/// else that of the assignment, else the .toml file beside the shader. A shader without one is `ok` if it
/// renders: nothing is compared.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof scenes --write course && toyproof check course --out report
  toyproof check homework --scene 02-sphere --out marks --rubric rubric.toml
  toyproof check homework --reference solution.glsl --out marks
  toyproof check homework --assignment shadows/assignment.toml --out marks
  toyproof check mine.glsl --scene scene.toml --format json
  toyproof check moodle.zip --class class.toml --out marks
  toyproof check homework --assignment shadows --out marks --feedback feedback.zip

Exit code: 0 if every shader is correct or ok, 1 if one is not, 2 for any other error.
With --shard: 0 if the shard is complete, else 2.")]
pub(in crate::cli) struct Args {
    /// Shaders: files, folders, or - for standard input; with --class, downloads
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The assignment (.toml): reference, frames and points [default: assignment.toml in the shaders' folder]
    ///
    /// A shader must be right in all frames. Flags of a frame (--size, --time, --mouse and so on) replace the
    /// frames of the assignment by that one, and --rubric replaces its points.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "reference"])]
    assignment: Option<PathBuf>,
    /// The class (.toml): the patterns, deadlines and rubrics of several assignments, which are all checked
    ///
    /// The shaders are downloads of Moodle or Canvas, which are collected into the folder `submissions` of
    /// --out, or what `toyproof collect --class` wrote. Every student has a row for each assignment, and
    /// class.csv has the points of all.
    #[arg(long, value_name = "FILE", requires = "out",
          conflicts_with_all = ["scene", "reference", "assignment", "rubric"])]
    class: Option<PathBuf>,
    /// Differences from the reference with which a shader is still correct, such as antialiasing,color-curve
    ///
    /// They are those of the section “Right, but not as asked” of the guide's page on mistakes, by their ids.
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    permit: Vec<Difference>,
    /// Write images and reports into this folder
    ///
    /// For each shader: the images NAME-actual.png, NAME-reference.png, NAME-difference.png,
    /// NAME-algorithm.png, NAME-precision.png and NAME-toolchain.png where a check finds differences,
    /// NAME-fixed.png where a fix was found, else NAME-value.png and NAME-reference-value.png of the values
    /// in which the shader departs from a reference shader. For all: report.html, report.csv, verdict.json,
    /// junit.xml and report.sarif; with --class, class.csv.
    #[arg(short, long, value_name = "DIR", help_heading = "Reports")]
    out: Option<PathBuf>,
    /// Write a page for each student into this folder or archive
    ///
    /// The page has the student's own shaders: verdict, points, images, functions and rules. It has the name
    /// that a collected download of Moodle or Canvas has, so that the archive can be uploaded there. It shows
    /// of a mistake what --hints permits, but no edits, whose expressions may be those of the reference or of
    /// other students. Several assignments have a folder or an archive each.
    #[arg(long, value_name = "DIR|FILE.zip", requires = "out", help_heading = "Reports")]
    feedback: Option<PathBuf>,
    /// Reuse results of an earlier run into the same folder
    ///
    /// A result is reused if shader, reference and flags are unchanged. The earlier run may have been
    /// interrupted.
    #[arg(long, requires = "out", help_heading = "Reports")]
    resume: bool,
    /// Check only part K of N of the shaders, in a folder of its own; `toyproof merge` writes the report of
    /// all
    ///
    /// Each shader is in one of the N parts, which depends on the contents of all shaders. The parts take
    /// about equally long. They may be checked at any time, in any order and on several machines; with
    /// --resume, a part that was interrupted continues.
    #[arg(long, value_name = "K/N", requires = "out", help_heading = "Reports")]
    pub(super) shard: Option<Shard>,
    /// Balance the parts by the times of an earlier report: a folder that --out wrote, or its verdict.json
    ///
    /// All parts need the same report. A shader that it does not have counts as the mean of the others.
    #[arg(long, value_name = "OLD", requires = "shard", help_heading = "Reports")]
    costs: Option<PathBuf>,
    /// List the verdicts that differ from an earlier report: a folder that --out wrote, or its verdict.json
    #[arg(long, value_name = "OLD", conflicts_with = "shard", help_heading = "Reports")]
    pub(super) compare: Option<PathBuf>,
    /// A rubric (.toml): points for compiling and for each check, for report.csv and results.json
    #[arg(long, value_name = "RUBRIC.toml", requires = "out", help_heading = "Reports")]
    rubric: Option<PathBuf>,
    /// What the teacher decides on single shaders (.toml) [default: decisions.toml beside the class or the
    /// assignment]
    ///
    /// Each table `[[decision]]` has a `shader` by its path in the report, or a `student` and in a class an
    /// `assignment`; a `verdict`, `points` or both; and a `reason`. All reports and the exit code follow the
    /// decisions; --resume and a later check never lose them.
    #[arg(long, value_name = "FILE", help_heading = "Reports")]
    decisions: Option<PathBuf>,
    /// The grading platform that reads results.json [default: gradescope]
    ///
    /// Platforms know when a submission is due: if one is named, the deadline of the assignment has no
    /// effect.
    #[arg(long, value_name = "PLATFORM", value_parser = platform(), requires = "out",
          help_heading = "Reports")]
    autograder: Option<&'static Platform>,
    /// What reports show of the mistake in a wrong shader [default: line for students' reports, else fix]
    ///
    /// Students' reports are junit.xml and results.json. If this option is given, it applies to
    /// all reports and to the terminal. results.jsonl, which --resume reads, always has everything.
    #[arg(long, value_enum, value_name = "HINTS", help_heading = "Reports")]
    hints: Option<HintLevel>,
    /// The format of standard output
    #[arg(long, value_enum, default_value_t = CheckFormat::Human, help_heading = "Output")]
    format: CheckFormat,
    /// The number of shaders to check in parallel [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    pub(super) jobs: Option<u16>,
    /// How long to search for a fix of a wrong shader; 0 turns the search off
    ///
    /// The search tries edits of the shader until its image is the expected one. Where several shaders are
    /// checked, a second search tries expressions of the correct ones. A unit is about a second of one core.
    /// Work is counted, not timed, so that the result is the same on every machine.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BUDGET, value_parser = parse_search, allow_negative_numbers = true)]
    search: f64,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

/// What reports show of the mistake in a wrong shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum HintLevel {
    /// Nothing
    None,
    /// The likely mistake, and the line of the fix or the suspect lines
    Line,
    /// Also the edit
    Fix,
}

impl From<HintLevel> for Hints {
    fn from(level: HintLevel) -> Self {
        match level {
            HintLevel::None => Self::None,
            HintLevel::Line => Self::Line,
            HintLevel::Fix => Self::Fix,
        }
    }
}

impl Args {
    /// The options that the arguments give.
    pub(super) fn options(&self) -> Options {
        let hints = |default| self.hints.map_or(default, Hints::from);
        Options {
            task: TaskInputs {
                name: None,
                shaders: self.shaders.clone(),
                assignment: self.assignment.clone(),
                rubric: self.rubric.clone(),
            },
            class: self.class.clone(),
            costs: self.costs.clone(),
            decisions: self.decisions.clone(),
            is_on_platform: self.autograder.is_some(),
            plan: PlanOptions {
                reference: self.reference.clone(),
                permitted: self.permit.clone(),
                frame: self.frame.inputs(),
                is_frame_given: self.frame.is_given(),
            },
            check: CheckOptions {
                language: self.language.clone(),
                driver: self.driver.clone(),
                search: self.search,
                is_moment_given: self.frame.is_moment_given(),
                out: self.out.clone(),
            },
            batch: BatchOptions {
                format: self.format,
                jobs: self.jobs.map(usize::from),
                out: self.out.clone(),
                feedback: self.feedback.clone(),
                resume: self.resume,
                shard: self.shard,
                // The expression that repairs a shader may be in another shard; `merge` searches.
                searches_again: self.search > 0.0 && self.shard.is_none(),
                teachers_hints: hints(Hints::Fix),
                students_hints: hints(Hints::Line),
                platform: self.autograder.unwrap_or(PLATFORMS[0]),
            },
        }
    }
}

/// The largest value of `--search`: an hour for each shader.
const MAX_SEARCH: f64 = 3600.0;

fn parse_search(text: &str) -> Result<f64, String> {
    let expected = format_args!("a number from 0 to {MAX_SEARCH}, in seconds of one core");
    parse_number(text, 0.0..=MAX_SEARCH, expected)
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    use super::*;

    fn args(flags: &[&str]) -> Result<Args, clap::Error> {
        let command = Args::augment_args(clap::Command::new("check"));
        let arguments = ["check", "a.glsl"].iter().chain(flags);
        command
            .try_get_matches_from(arguments)
            .and_then(|matches| Args::from_arg_matches(&matches))
    }

    #[test]
    fn students_see_lines_and_teachers_edits_unless_hints_are_given() {
        for (flags, expected) in [
            (&[][..], [Hints::Fix, Hints::Line]),
            (&["--hints", "none"], [Hints::None; 2]),
            (&["--hints", "line"], [Hints::Line; 2]),
            (&["--hints", "fix"], [Hints::Fix; 2]),
        ] {
            let batch = args(flags).unwrap().options().batch;
            assert_eq!(
                [batch.teachers_hints, batch.students_hints],
                expected,
                "{flags:?}"
            );
        }
    }

    #[test]
    fn the_search_has_a_limit() {
        assert!(args(&[]).unwrap().search > 0.0);
        for (text, expected) in [("0", 0.0), ("0.5", 0.5), ("3600", 3600.0)] {
            let search = args(&["--search", text]).unwrap().search;
            assert!((search - expected).abs() < f64::EPSILON, "{text}: {search}");
        }
        for text in ["-1", "NaN", "inf", "3601", "2s"] {
            let error = args(&["--search", text]).unwrap_err().to_string();
            assert!(
                error.contains("expected a number from 0 to 3600"),
                "{text}: {error}"
            );
        }
    }
}
