//! `cargo xtask`: tables and measurements of the documents, expected texts of the tests, and releases.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command prints")]

mod corpus;
mod devices;
mod dist;
mod editor;
mod faults;
mod front_end;
mod page;
mod player;
mod projects;
mod references;
mod repairs;
mod sensitivity;
mod watch;

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

use clap::Parser;
use toyproof::gpu::{AdapterSelector, Worker};

#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
enum Task {
    /// Write the expected texts of the tests anew; read the difference before you commit it
    Bless,
    /// Write the pages of the guide that are generated from the texts beside the code
    Docs,
    /// Print the name of each planted fault, as in `tests/suite/fault_names.txt`
    FaultNames {
        /// Only exercises whose names contain this
        #[arg(default_value = "")]
        exercise: String,
    },
    /// Print the names of pairs of planted faults, and the time taken
    FaultPairs {
        /// Only exercises whose names contain this
        #[arg(default_value = "")]
        exercise: String,
    },
    /// Print the smallest errors of scenes that are found, the table of docs/evidence/accuracy.md
    Sensitivity,
    /// Compare the bits of the evaluator and of the strict GPU run, for the shaders of a folder that read no
    /// channel
    Corpus {
        /// The folder of shaders
        folder: PathBuf,
        /// The maximum number of shaders
        #[arg(long, default_value_t = usize::MAX)]
        limit: usize,
    },
    /// Compare the WGSL of another program, with our bindings, with its source shaders
    Conversions {
        /// The folder of shaders
        shaders: PathBuf,
        /// The folder of WGSL files, with the same names
        converted: PathBuf,
    },
    /// Measure what the Vulkan drivers of this machine compute, for docs/evidence/drivers.md
    Devices(devices::Arguments),
    /// Build the files of a release: archives, and packages for Debian and Python, with their checksums
    Dist(dist::Arguments),
    /// Measure how long the language server takes from a keystroke to the diagnostics
    Editor(editor::Arguments),
    /// Compare our GLSL front end for naga with naga's own, the tables of docs/evidence/front-end.md
    FrontEnd {
        /// A folder of shaders, or the git directory of a repository with ShaderToy's JSON files
        input: PathBuf,
        /// The maximum number of single-pass shaders of a repository, chosen at random
        #[arg(long, default_value_t = 300)]
        limit: usize,
        /// The seed of the choice
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Measure how long Chromium takes to open a report
    Page {
        /// The report.html
        file: PathBuf,
        /// Write screenshots into this folder
        #[arg(long)]
        screenshots: Option<PathBuf>,
    },
    /// Render projects in Chromium as ShaderToy's own page does; `tests/xtask/player.rs` documents the files
    Player(player::Arguments),
    /// Measure how many projects of a git repository are exported as they were imported, and how many compile
    Projects {
        /// The git directory of a repository with ShaderToy's JSON files
        repository: PathBuf,
        /// The maximum number of projects, chosen at random
        #[arg(long, default_value_t = usize::MAX)]
        limit: usize,
        /// The seed of the choice
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Compile all tabs of each project as well, and print the first error of those that do not compile
        #[arg(long)]
        check: bool,
    },
    /// Measure how many wrong shaders are repaired, and at which lines
    Repairs {
        /// A file with a line of JSON for each shader: `file`, `scene`, `group`, `lines`; the planted faults
        /// if none
        manifest: Option<PathBuf>,
        /// Only shaders whose names contain this, or of this group
        #[arg(long, default_value = "")]
        only: String,
        /// The work of a search
        #[arg(long, default_value_t = toyproof::explain::repair::DEFAULT_BUDGET)]
        search: f64,
        /// Search for known mistakes as well
        #[arg(long)]
        names: bool,
        /// A folder of correct shaders, whose expressions are tried where no edit is found
        #[arg(long, value_name = "DIR")]
        correct: Option<PathBuf>,
    },
    /// Print the verdicts that change where the exported shader of a scene is the reference instead of the
    /// scene
    References {
        /// Only exercises whose names contain this
        #[arg(default_value = "")]
        exercise: String,
        /// The tolerance, in 8-bit levels
        #[arg(long, default_value_t = 255.0 * toyproof::verify::DEFAULT_TOLERANCE)]
        tolerance: f64,
        /// Use other random numbers in stochastic shaders
        #[arg(long)]
        reseed: bool,
    },
    /// Measure the time from a save to the new image of `toyproof watch`, the table of docs/evidence/performance.md
    Watch(watch::Arguments),
    /// Run shaders: the process that other tasks start
    #[command(name = toyproof::cli::WORKER, hide = true)]
    Worker,
}

fn main() -> ExitCode {
    match Task::parse() {
        Task::Bless => return bless(),
        Task::Docs => {
            for (path, page) in toyproof_testkit::pages::generated() {
                std::fs::write(path, page).expect("the page can be written");
            }
        }
        Task::FaultNames { exercise } => faults::print_names(&exercise),
        Task::FaultPairs { exercise } => faults::print_pairs(&exercise),
        Task::Sensitivity => sensitivity::print_table(),
        Task::Corpus { folder, limit } => corpus::compare_folder(&folder, limit),
        Task::Conversions { shaders, converted } => corpus::compare_conversions(&shaders, &converted),
        Task::Devices(arguments) => return devices::print_table(&arguments),
        Task::Dist(arguments) => {
            if let Err(error) = dist::build(&arguments) {
                eprintln!("error: {error}");
                return ExitCode::FAILURE;
            }
        }
        Task::Editor(arguments) => editor::measure(&arguments),
        Task::FrontEnd { input, limit, seed } => front_end::compare(&input, limit, seed),
        Task::Page { file, screenshots } => page::measure(&file, screenshots.as_deref()),
        Task::Player(arguments) => player::play(&arguments),
        Task::Projects {
            repository,
            limit,
            seed,
            check,
        } => projects::measure(&repository, limit, seed, check),
        Task::Repairs {
            manifest,
            only,
            search,
            names,
            correct,
        } => repairs::measure(manifest.as_deref(), &only, search, names, correct.as_deref()),
        Task::References {
            exercise,
            tolerance,
            reseed,
        } => references::print_disagreements(&exercise, tolerance, reseed),
        Task::Watch(arguments) => watch::measure(&arguments),
        Task::Worker => {
            toyproof::gpu::serve(io::stdin(), io::stdout()).expect("the parent listens");
        }
    }
    ExitCode::SUCCESS
}

/// A worker process, which is this program.
fn worker(selector: AdapterSelector, timeout: Duration) -> Worker {
    let program = std::env::current_exe().expect("this program has a path");
    Worker::new(program, vec![toyproof::cli::WORKER.into()], selector, timeout)
}

/// Runs the tests with expected texts so that they write them.
fn bless() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let tests: [&[&str]; 2] = [
        &["--package", "toyproof-translate", "--lib", "wgsl"],
        &["--test", "suite", "--", "ui", "snapshots"],
    ];
    for arguments in tests {
        let mut test = Command::new(env!("CARGO"));
        test.arg("test").args(arguments).env("UPDATE_EXPECT", "1");
        let status = test.current_dir(&root).status().expect("cargo starts");
        if !status.success() {
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
