//! `toyproof check`

mod args;
mod batch;
mod checker;
mod donors;
mod earlier;
mod images;
mod merge;
mod outcome;
mod plan;
mod reference;
mod reports;
mod results;
mod shard;
mod sharding;
mod submission;
mod work;

use toyproof_diagnostic::{grouped, plural};

pub(super) use self::args::Args;
use self::earlier::earlier;
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
        (Some(_), Some(_)) => match sharding::program() {
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
