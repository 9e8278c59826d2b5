//! All work of one command: the submissions, and their requirements.

use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};

use toyproof_classroom::collect::roster::Owners;
use toyproof_classroom::decisions::Decisions;
use toyproof_project::files::{Input, ReadError};
use toyproof_report::{Earlier, Rubrics};

use super::batch::Batch;
use super::checker::Checker;
use super::decisions::DecisionFiles;
use super::earlier::earlier;
use super::features::Features;
use super::images::IMAGES;
use super::options::{Options, TaskInputs};
use super::plan::{Plan, assignment_beside};
use super::reference::References;
use super::reports::REPORT_NAMES;
use super::results::{RESULTS_NAME, Results};
use super::shard::Shard;
use super::sharding::{self, Manifest};
use super::submission::Submission;
use crate::cli::collect::{ClassPart, class_parts};
use crate::cli::names::Names;
use crate::cli::shader::find_submissions;
use crate::cli::{CliError, Exit, Terminal};

/// All that one command checks.
pub(super) struct Work {
    /// At least one; one for each assignment of a class.
    tasks: Vec<Task>,
    rubrics: Rubrics,
    pub(super) submissions: Vec<Submission>,
    decisions: Decisions,
}

impl From<ClassPart> for TaskInputs {
    fn from(part: ClassPart) -> Self {
        Self {
            name: Some(part.name),
            shaders: vec![part.folder],
            assignment: Some(part.assignment),
            rubric: part.rubric,
        }
    }
}

/// The plan of some of the shaders, and their references.
struct Task {
    plan: Plan,
    references: References,
    features: Features,
}

/// Whether an input is a reference that a search of a folder has found beside the shaders.
fn is_found_reference(input: &Result<Input, ReadError>, references: &HashSet<PathBuf>) -> bool {
    let found = input.as_ref().ok().filter(|input| input.folder.is_some());
    let path = found.and_then(|found| found.path()?.canonicalize().ok());
    path.is_some_and(|path| references.contains(&path))
}

impl Task {
    /// The canonical paths of the reference shaders.
    fn reference_files(&self) -> Vec<PathBuf> {
        let assignment = self.plan.assignment.iter().map(|(assignment, _)| assignment);
        let references = assignment.flat_map(|assignment| {
            let features = assignment.features.iter().map(|feature| &feature.without);
            std::iter::once(&assignment.reference).chain(features)
        });
        references
            .filter_map(|reference| reference.path().canonicalize().ok())
            .collect()
    }

    /// Reads the plan of a task, and renders its references.
    fn new(options: &Options, inputs: &TaskInputs, terminal: &Terminal) -> Result<Self, CliError> {
        let mut plan = Plan::new(&options.plan, inputs, terminal)?;
        let references = References::new(&options.check, &mut plan, terminal)?;
        let features = Features::new(&plan, &references, &options.check, terminal)?;
        Ok(Self {
            plan,
            references,
            features,
        })
    }

    /// The task of a shader with an assignment next to it. An error is that of this shader alone.
    fn beside(options: &Options, found: &Input, terminal: &Terminal) -> Option<Result<Self, ReadError>> {
        let assignment = assignment_beside(found)?;
        let name = found.name();
        let inputs = TaskInputs {
            name: None,
            shaders: found.path().map(Path::to_owned).into_iter().collect(),
            assignment: Some(assignment),
            rubric: None,
        };
        let task = Self::new(options, &inputs, terminal);
        Some(task.map_err(|error| {
            let error = io::Error::other(error.in_one_line());
            ReadError::Unreadable { name, error }
        }))
    }
}

/// The folder of `--out` with the submissions of a class that were collected from downloads.
const SUBMISSIONS: &str = "submissions";

impl Work {
    /// Reads the tasks that the options name. With the `build` that checks them, submissions have keys.
    pub(super) fn new(options: &Options, build: Option<&str>, terminal: &Terminal) -> Result<Self, CliError> {
        let costs = earlier(options.costs.as_deref())?;
        let mut decisions = DecisionFiles::new(options.decisions.as_deref(), options.class.as_deref())?;
        let collected = options.batch.out.as_ref().map(|out| out.join(SUBMISSIONS));
        let parts;
        let parts = match &options.class {
            Some(class) => {
                let to = collected.as_deref().filter(|_| options.batch.shard.is_none());
                let of_class = class_parts(&options.task.shaders, class, to, terminal)?;
                parts = of_class.into_iter().map(TaskInputs::from).collect::<Vec<_>>();
                &parts[..]
            }
            None => std::slice::from_ref(&options.task),
        };
        let reserved: Vec<&str> = REPORT_NAMES
            .into_iter()
            .chain([RESULTS_NAME, sharding::MANIFEST_NAME, SUBMISSIONS])
            .collect();
        let mut names = Names::new(&IMAGES.map(|kind| kind.suffix), &reserved);
        let mut work = Self {
            tasks: Vec::new(),
            rubrics: Rubrics::default(),
            submissions: Vec::new(),
            decisions: Decisions::default(),
        };
        for part in parts {
            let mut common = Task::new(options, part, terminal)?;
            if let Some(file) = &common.plan.assignment_file {
                decisions.add_beside(file, part.name.as_deref())?;
            }
            let mut inputs = find_submissions(&part.shaders, terminal);
            let deadline = common.plan.assignment.as_ref().and_then(|(one, _)| one.deadline);
            let deadline = deadline.filter(|_| !options.is_on_platform);
            let owners = Owners::read(&part.shaders, &mut inputs, deadline, |error| terminal.warn(error));
            match (&part.name, common.plan.rubric.take()) {
                (None, rubric) => work.rubrics = rubric.into(),
                (Some(name), Some(rubric)) => work.rubrics.add(name.clone(), rubric),
                (Some(_), None) => {}
            }
            let index_of_common = work.tasks.len();
            let beside = inputs.iter().map(|input| match input {
                Ok(found) if !common.plan.reference.is_given() => Task::beside(options, found, terminal),
                _ => None,
            });
            let beside: Vec<Option<Result<Task, ReadError>>> = beside.collect();
            let references: HashSet<PathBuf> = beside
                .iter()
                .flatten()
                .flatten()
                .flat_map(Task::reference_files)
                .collect();
            let mut own_tasks = Vec::new();
            for (mut input, own) in inputs.into_iter().zip(beside) {
                if is_found_reference(&input, &references) {
                    continue;
                }
                if let (Ok(input), Some(name)) = (&mut input, &part.name) {
                    input.relative = Path::new(name).join(&input.relative);
                }
                let owner = owners.find(&input).cloned();
                let (submitted, page) = owner.map(|owner| (owner.submitted, owner.page)).unzip();
                let own = match own.transpose() {
                    Ok(own) => own,
                    Err(error) => {
                        input = Err(error);
                        None
                    }
                };
                let task = match own {
                    Some(_) => index_of_common + 1 + own_tasks.len(),
                    None => index_of_common,
                };
                let Task { plan, references, .. } = own.as_ref().unwrap_or(&common);
                let submission = Submission::new(input, &options.check, plan, references, &mut names, build);
                let seconds = costs.as_ref().and_then(|costs| costs.seconds(&submission.name));
                own_tasks.extend(own);
                work.submissions.push(Submission {
                    seconds,
                    task,
                    submitted,
                    page,
                    ..submission
                });
            }
            work.tasks.push(common);
            work.tasks.extend(own_tasks);
        }
        work.decisions = decisions.finish(&work.submissions, terminal);
        Ok(work)
    }

    /// Keeps the submissions of a shard, and describes it in its folder.
    pub(super) fn select(
        &mut self,
        shaders: &[PathBuf],
        shard: Shard,
        program: String,
        out: &Path,
    ) -> Result<(), CliError> {
        if shaders.iter().any(|shader| shader == Path::new("-")) {
            return Err("--shard cannot be used with standard input, which only one shard could read".into());
        }
        let manifest = Manifest {
            program,
            inputs: sharding::inputs(&self.submissions),
            shard,
            arguments: sharding::arguments()?,
        };
        let mut numbers = sharding::assign(&self.submissions, shard.of).into_iter();
        self.submissions.retain(|_| numbers.next() == Some(shard.number));
        Ok(manifest.write(out)?)
    }

    /// Checks all submissions, and writes the reports.
    pub(super) fn check(
        mut self,
        options: &Options,
        results: Option<Results>,
        earlier: Option<Earlier>,
        terminal: &Terminal,
    ) -> Exit {
        let submissions = &self.submissions;
        let rubrics = std::mem::take(&mut self.rubrics);
        let decisions = &self.decisions;
        let mut batch = Batch::new(
            &options.batch,
            rubrics,
            decisions,
            results,
            earlier,
            submissions,
            terminal,
        );
        let tasks = self.tasks.iter();
        let checkers =
            tasks.map(|task| Checker::new(&options.check, &task.plan, &task.references, &task.features));
        batch.check(submissions, &checkers.collect::<Vec<_>>(), &options.check.driver);
        batch.finish(submissions)
    }
}
