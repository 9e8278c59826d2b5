//! `toyproof check`

mod args;
mod batch;
mod checker;
mod donors;
mod images;
mod merge;
mod outcome;
mod plan;
mod reference;
mod reports;
mod results;
mod shard;
mod submission;
mod work;

use std::path::Path;

use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_image::input;
use toyproof_project::files::NOT_UTF8;
use toyproof_report::Earlier;

pub(super) use self::args::Args;
pub(super) use self::merge::{MergeArgs, merge};
pub(super) use self::plan::read_assignment;
pub(super) use self::reference::Scenes;
use self::results::Results;
use self::work::Work;
use super::{Exit, Terminal};

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    // A worker is created and dropped here, so that wrong arguments are reported before any work starts.
    if let Err(error) = args.driver.worker() {
        terminal.error(error);
        return Exit::Error;
    }
    let Ok(earlier) = earlier(args.compare.as_deref(), terminal) else {
        return Exit::Error;
    };
    let build = match (&args.out, args.shard) {
        (None, _) => None,
        (Some(_), None) => submission::build(),
        (Some(_), Some(_)) => match shard::program() {
            Ok(program) => Some(program),
            Err(error) => {
                terminal.error(format_args!("the program's own file cannot be read: {error}"));
                return Exit::Error;
            }
        },
    };
    let Ok(mut work) = Work::new(args, build.as_deref(), terminal) else {
        return Exit::Error;
    };
    let mut results = None;
    if let Some(out) = &args.out {
        let opened = match (args.shard, build) {
            (Some(shard), Some(program)) => work.select(args, shard, program, out),
            _ => Ok(()),
        };
        match opened
            .and_then(|()| Results::open(out, args.resume).map_err(|error| format!("cannot write {error}")))
        {
            Ok(opened) => {
                if let broken @ 1.. = opened.broken as u64 {
                    terminal.warn(format_args!(
                        "{} {} of results.jsonl cannot be read; {} checked again",
                        grouped(broken),
                        plural(broken, "line", "lines"),
                        plural(broken, "its shader is", "their shaders are"),
                    ));
                }
                results = Some(opened);
            }
            Err(error) => {
                terminal.error(error);
                return Exit::Error;
            }
        }
    }
    work.check(args, results, earlier, terminal)
}

/// Reads an earlier report that `--compare` or `--costs` names, if any.
///
/// # Errors
/// It is unusable; the error has been printed.
fn earlier(path: Option<&Path>, terminal: &Terminal) -> Result<Option<Earlier>, ()> {
    let Some(path) = path else {
        return Ok(None);
    };
    let file = if path.is_dir() {
        path.join("verdict.json")
    } else {
        path.to_owned()
    };
    let name = path_name(&file);
    let bytes = input::read(&file).map_err(|error| error.to_string());
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).map_err(|_| NOT_UTF8.to_owned()));
    let earlier = text.and_then(|text| Earlier::parse(name.clone(), &text));
    earlier
        .map(Some)
        .map_err(|error| terminal.error(format_args!("{name} is not an earlier report: {error}")))
}
