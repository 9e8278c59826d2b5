//! Measurements of other authors' projects, which are read from a git repository and never written to a file.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{ChildStdout, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use toyproof::diagnostic::{Deadline, File, Files, Severity, short};
use toyproof::glsl::Options;
use toyproof::project::{self, PROJECT_FILE, Project};

/// The time limit of a project.
const TIMEOUT: Duration = Duration::from_secs(10);

/// The JSON files of the newest commit, each with its object: a random choice.
fn files(repository: &Path, limit: usize, seed: u64) -> Vec<(String, String)> {
    let list = git(repository)
        .args(["ls-tree", "-r", "HEAD"])
        .output()
        .expect("git runs");
    let list = String::from_utf8(list.stdout).expect("names are UTF-8");
    let mut files: Vec<_> = list
        .lines()
        .filter_map(|line| {
            let (object, name) = line.split_once('\t')?;
            let is_json = Path::new(name)
                .extension()
                .is_some_and(|extension| extension == "json");
            let object = object.split(' ').nth(2)?;
            (is_json && name.contains('/')).then(|| (name.to_owned(), object.to_owned()))
        })
        .collect();
    // FNV-1a of the seed and the name, with a finalizer.
    files.sort_by_cached_key(|(name, _)| {
        let hash = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325 ^ seed, |hash: u64, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
        (hash ^ (hash >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    });
    files.truncate(limit);
    files
}

fn git(repository: &Path) -> Command {
    let mut git = Command::new("git");
    git.arg("--git-dir").arg(repository);
    git
}

/// Reads the next object that `git cat-file --batch` prints.
fn next_object(output: &mut BufReader<ChildStdout>) -> Vec<u8> {
    let mut header = String::new();
    output.read_line(&mut header).expect("git prints a header");
    let size = header
        .split_whitespace()
        .nth(2)
        .and_then(|size| size.parse::<usize>().ok());
    let mut bytes = vec![0; size.expect("the header has a size") + 1];
    output.read_exact(&mut bytes).expect("git prints the object");
    bytes.pop();
    bytes
}

/// The texts of the repository's JSON files with their names, in a random order, read one by one.
pub(super) fn texts(repository: &Path, seed: u64) -> impl Iterator<Item = (String, String)> {
    let chosen = files(repository, usize::MAX, seed).into_iter();
    chosen.filter_map(move |(name, object)| {
        let shown = git(repository).args(["cat-file", "blob", &object]).output();
        let text = String::from_utf8(shown.expect("git runs").stdout).ok()?;
        Some((name, text))
    })
}

/// The counts of projects.
#[derive(Default)]
struct Counts {
    all: usize,
    refused: usize,
    same: usize,
    compiled: usize,
    /// The projects that do not compile, by the code of the first error.
    errors: BTreeMap<String, usize>,
}

/// Exports what was imported, through a folder: returns whether the code is the same, byte for byte, and the JSON.
fn survives(project: &Project, files: &mut Files, text: &str) -> bool {
    let toml = files.add(File::new(PROJECT_FILE, project.to_toml()));
    let Ok(again) = Project::from_folder(files, Some(toml), project.tabs()) else {
        return false;
    };
    let [before, after] = [text, &again.to_json(files)].map(serde_json::from_str::<Value>);
    let (before, after) = (before.expect("it was parsed"), after.expect("it is JSON"));
    let codes = before["renderpass"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|pass| &pass["code"]);
    let tabs = again.tabs().iter().map(|(_, file)| files.get(*file).text());
    codes.map(|code| code.as_str().unwrap_or_default()).eq(tabs) && before == after
}

/// Measures the projects of a repository.
pub(super) fn measure(repository: &Path, limit: usize, seed: u64, checks: bool) {
    let chosen = files(repository, limit, seed);
    let mut reader = git(repository)
        .args(["cat-file", "--batch"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("git runs");
    let mut requests = reader.stdin.take().expect("it is piped");
    let mut output = BufReader::new(reader.stdout.take().expect("it is piped"));
    let objects: Vec<_> = chosen.iter().map(|(_, object)| object.clone()).collect();
    let writer = thread::spawn(move || {
        for object in objects {
            writeln!(requests, "{object}").expect("git reads");
        }
    });
    let start = Instant::now();
    let mut counts = Counts::default();
    for (name, _) in &chosen {
        let Ok(text) = String::from_utf8(next_object(&mut output)) else {
            println!("{name}: not UTF-8");
            continue;
        };
        if !Project::is_json(&text) {
            continue;
        }
        counts.add(name, &text, checks);
    }
    writer.join().expect("git read everything");
    reader.wait().expect("git ends");
    counts.print(checks);
    println!("{:.0} s", start.elapsed().as_secs_f64());
}

impl Counts {
    fn add(&mut self, name: &str, text: &str, checks: bool) {
        self.all += 1;
        let mut files = Files::default();
        let file = files.add(File::new(name, text));
        let project = match Project::from_json(&mut files, file) {
            Ok(project) => project,
            Err(errors) => {
                self.refused += 1;
                println!("{errors}");
                return;
            }
        };
        if survives(&project, &mut files, text) {
            self.same += 1;
        } else {
            println!("{name}: changed by export and import");
        }
        if !checks {
            return;
        }
        let options = Options {
            deadline: Deadline::after(TIMEOUT),
            ..Options::default()
        };
        match project::check(&project, &mut files, &options) {
            Ok(_) => self.compiled += 1,
            Err(errors) => {
                let mut errors = errors.into_iter();
                if let Some(first) = errors.find(|one| one.severity == Severity::Error) {
                    *self.errors.entry(first.code.to_string()).or_default() += 1;
                    println!("{}", short(&first, &files));
                }
            }
        }
    }

    fn print(&self, checks: bool) {
        let share = |count: usize| 100.0 * count as f64 / self.all.max(1) as f64;
        let Self {
            all,
            refused,
            same,
            compiled,
            errors,
        } = self;
        println!("{all} projects, {refused} refused ({:.3} %)", share(*refused));
        println!("{same} exported as they were imported ({:.3} %)", share(*same));
        if checks {
            println!("{compiled} compile in all tabs ({:.2} %)", share(*compiled));
            for (code, count) in errors {
                println!("  {code} {count}");
            }
        }
    }
}
