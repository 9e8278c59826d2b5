//! `toyproof merge`: the report of all shards of a batch.

use std::collections::HashMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::{io, iter};

use clap::Parser;
use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_image::{input, output};

use super::args::Args;
use super::earlier::earlier;
use super::images::IMAGES;
use super::results::{Line, RESULTS_NAME, Results, read_lines};
use super::shard::Shard;
use super::sharding::{self, MANIFEST_NAME, Manifest};
use super::submission::Submission;
use super::work::Work;
use crate::cli::inputs::shell_word;
use crate::cli::names::with_suffix;
use crate::cli::{Cli, CliError, Command, Exit, Terminal};

/// Merge the shards of a batch into one report
///
/// The report is the one that a single `check` of all shaders writes. The shaders and the reference are read
/// again, so run it in the folder in which the shards were checked. Shards of other shaders, flags or
/// programs are rejected, and missing ones are listed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof check homework --scene 02-sphere --shard 1/2 --out shards/1
  toyproof check homework --scene 02-sphere --shard 2/2 --out shards/2
  toyproof merge shards/* --out marks

Exit code: 0 if every shader is correct or ok, 1 if one is not, 2 for any other error.")]
pub(in crate::cli) struct MergeArgs {
    /// The folders of the shards, in any order: what `check --shard K/N --out DIR` wrote
    #[arg(required = true, value_name = "DIR")]
    shards: Vec<PathBuf>,
    /// Write the images and reports into this folder
    #[arg(short, long, value_name = "DIR", help_heading = "Reports")]
    out: PathBuf,
    /// List the verdicts that differ from an earlier report: a folder that --out wrote, or its verdict.json
    #[arg(long, value_name = "OLD", help_heading = "Reports")]
    compare: Option<PathBuf>,
    /// The number of wrong shaders to search again in parallel [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    jobs: Option<u16>,
}

pub(in crate::cli) fn merge(args: &MergeArgs, terminal: &Terminal) -> Result<Exit, CliError> {
    let program = sharding::program()?;
    let folders = read_folders(args, &program)?;
    let (_, first) = &folders[0];
    let mut check = parse(&first.arguments, &args.out)?;
    check.shard = None;
    check.jobs = args.jobs;
    let options = check.options();
    let earlier = earlier(args.compare.as_deref())?;
    let work = Work::new(&options, Some(&program), terminal)?;
    if sharding::inputs(&work.submissions) != first.inputs {
        let error = CliError::new(
            "the shaders, their reference or a file that an option names changed after the shards were checked",
        );
        return Err(error
            .with_help("run `merge` in the folder in which the shards were checked, or check them again"));
    }
    let shards = first.shard.of;
    let numbers = sharding::assign(&work.submissions, shards);
    let mut results = find_results(&folders)?;
    let found: Vec<Option<Found>> = work
        .submissions
        .iter()
        .zip(&numbers)
        .map(|(submission, &number)| results.remove(&(number, submission.key.clone()?)))
        .collect();
    check_complete(&folders, &work.submissions, &numbers, &found)?;
    let cannot_write = |error| format!("cannot write {error}");
    let mut lines = Vec::new();
    for (submission, found) in work.submissions.iter().zip(found) {
        if let Some((folder, line)) = found {
            copy_images(submission, folder, &args.out).map_err(cannot_write)?;
            lines.push(line);
        }
    }
    let results = Results::create(&args.out, lines).map_err(cannot_write)?;
    terminal.note(&format!(
        "{} {} merged",
        grouped(shards.into()),
        plural(shards.into(), "shard is", "shards are")
    ));
    Ok(work.check(&options, Some(results), earlier, terminal))
}

/// Reads the manifests of the shards, which must belong to one batch and to this program.
fn read_folders(args: &MergeArgs, program: &str) -> Result<Vec<(PathBuf, Manifest)>, CliError> {
    let mut folders: Vec<(PathBuf, Manifest)> = Vec::new();
    for folder in &args.shards {
        let name = path_name(folder);
        let manifest = Manifest::read(folder)?
            .ok_or_else(|| format!("{name} is not the folder of a shard: it has no {MANIFEST_NAME}"))?;
        if is_same_folder(folder, &args.out) {
            let error = CliError::new(format_args!("{name} is a shard, and would be overwritten"));
            return Err(error.with_help("give the report another folder with --out"));
        }
        if manifest.program != program {
            let error = CliError::new(format_args!("{name} was written by another build of toyproof"));
            return Err(
                error.with_help("merge with the program that checked the shards, or check them again")
            );
        }
        if let Some((other, first)) = folders.first() {
            let other = path_name(other);
            let error = if manifest.shard.of != first.shard.of {
                format!(
                    "{name} is shard {}, and {other} is shard {}",
                    manifest.shard, first.shard
                )
            } else if manifest.arguments != first.arguments {
                format!("{name} was checked with other arguments than {other}")
            } else if manifest.inputs != first.inputs {
                format!("{name} was checked with other shaders, references or settings than {other}")
            } else {
                String::new()
            };
            if !error.is_empty() {
                return Err(CliError::new(error).with_help("merge the shards of one batch"));
            }
        }
        folders.push((folder.clone(), manifest));
    }
    Ok(folders)
}

fn is_same_folder(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Parses the arguments of the command that checked the shards as those of a check that writes into another
/// folder.
fn parse(arguments: &[String], out: &Path) -> Result<Args, CliError> {
    const NAME: &str = "check";
    let at = arguments.iter().position(|argument| argument == NAME);
    let (before, after) = arguments.split_at(at.map_or(0, |at| at + 1));
    let all = iter::once(OsString::from("toyproof"))
        .chain(before.iter().map(OsString::from))
        // Other options require these two.
        .chain(["--shard".into(), "1/1".into(), "--out".into(), out.into()])
        .chain(after.iter().map(OsString::from));
    match Cli::try_parse_from(all).map(|cli| cli.command) {
        Ok(Command::Check(check)) => Ok(*check),
        _ => Err(format!("the arguments in {MANIFEST_NAME} are not those of `toyproof {NAME}`").into()),
    }
}

/// The folder of a shard, and a result in it.
type Found<'a> = (&'a Path, Line);

/// Finds the results in all folders, by the numbers of their shards and their keys. Of several results of one
/// shader, which differ in their times, one is taken that does not depend on the order of the folders.
fn find_results(folders: &[(PathBuf, Manifest)]) -> io::Result<HashMap<(u32, String), Found<'_>>> {
    let mut folders: Vec<_> = folders.iter().collect();
    folders.sort_by(|(a, _), (b, _)| a.cmp(b));
    let mut results = HashMap::new();
    for (folder, manifest) in folders {
        let (lines, _) = read_lines(&folder.join(RESULTS_NAME))?;
        for line in lines {
            let key = (manifest.shard.number, line.key.clone());
            results.entry(key).or_insert((folder.as_path(), line));
        }
    }
    Ok(results)
}

/// Checks that there is a result of every shader that can be read; otherwise lists the shards that lack some.
fn check_complete(
    folders: &[(PathBuf, Manifest)],
    submissions: &[Submission],
    numbers: &[u32],
    found: &[Option<Found>],
) -> Result<(), CliError> {
    let (_, first) = &folders[0];
    let mut lacking = Vec::new();
    for number in 1..=first.shard.of {
        let of_shard =
            || (0..submissions.len()).filter(|&at| numbers[at] == number && submissions[at].key.is_some());
        let all = of_shard().count();
        let checked = of_shard().filter(|&at| found[at].is_some()).count();
        let shard = Shard {
            number,
            ..first.shard
        };
        if !folders.iter().any(|(_, manifest)| manifest.shard == shard) {
            lacking.push(format!("shard {shard}: missing"));
        } else if checked < all {
            lacking.push(format!(
                "shard {shard}: {} of {} {} checked",
                grouped(checked as u64),
                grouped(all as u64),
                plural(all as u64, "shader is", "shaders are")
            ));
        }
    }
    if lacking.is_empty() {
        return Ok(());
    }
    let arguments: Vec<_> = first
        .arguments
        .iter()
        .map(|argument| shell_word(argument))
        .collect();
    let error = CliError::new(format_args!(
        "{} of {} shards {} missing or incomplete\n{}",
        grouped(lacking.len() as u64),
        grouped(first.shard.of.into()),
        plural(lacking.len() as u64, "is", "are"),
        lacking.join("\n")
    ));
    Err(error.with_help(format_args!(
        "check them with `toyproof {} --shard K/{} --out DIR --resume`, and merge again",
        arguments.join(" "),
        first.shard.of
    )))
}

/// Copies the images of a shader, and removes those that it does not have.
fn copy_images(submission: &Submission, shard: &Path, out: &Path) -> io::Result<()> {
    let Some(stem) = &submission.output_stem else {
        return Ok(());
    };
    let relative = stem.strip_prefix(out).unwrap_or(stem);
    for kind in &IMAGES {
        let path = with_suffix(stem, kind.suffix);
        match input::read(&with_suffix(&shard.join(relative), kind.suffix)) {
            Ok(bytes) => output::write_inside(out, &path, &bytes)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => output::remove_inside(out, &path)?,
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
