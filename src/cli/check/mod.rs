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
use super::{CliError, Exit, Terminal};

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    // A worker is created and dropped here, so that wrong arguments are reported before any work starts.
    args.driver.worker()?;
    let earlier = earlier(args.compare.as_deref())?;
    let build = match (&args.out, args.shard) {
        (None, _) => None,
        (Some(_), None) => submission::build(),
        (Some(_), Some(_)) => Some(sharding::program()?),
    };
    let mut work = Work::new(args, build.as_deref(), terminal)?;
    let mut results = None;
    if let Some(out) = &args.out {
        if let (Some(shard), Some(program)) = (args.shard, build) {
            work.select(args, shard, program, out)?;
        }
        let opened = Results::open(out, args.resume).map_err(|error| format!("cannot write {error}"))?;
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
    Ok(work.check(args, results, earlier, terminal))
}
