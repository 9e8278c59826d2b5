//! `toyproof check`

mod args;
mod batch;
mod checker;
mod decisions;
mod donors;
mod earlier;
mod features;
mod feedback;
mod images;
mod merge;
mod options;
mod outcome;
mod plan;
mod reference;
mod reference_cache;
mod reports;
mod results;
mod shader_check;
mod shard;
mod sharding;
mod submission;
mod submission_check;
mod work;

use toyproof_diagnostic::{grouped, plural};

pub(super) use self::args::{Args, HintLevel};
use self::earlier::earlier;
pub(super) use self::merge::{MergeArgs, merge};
pub(super) use self::plan::{PlannedFrame, assignment_beside, read_assignment};
pub(super) use self::reference::{Scenes, expected_in, expected_of_scene};
use self::results::{RESULTS_NAME, Results, read_lines};
pub(super) use self::shader_check::image;
use self::work::Work;
use super::{CliError, Exit, Terminal};

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    // A worker is created and dropped here, so that wrong arguments are reported before any work starts.
    let options = args.options();
    options.check.driver.worker()?;
    let earlier = earlier(args.compare.as_deref())?;
    let build = match (&options.batch.out, options.batch.shard) {
        (None, _) => None,
        (Some(_), None) => submission::build(),
        (Some(_), Some(_)) => Some(sharding::program()?),
    };
    let mut work = Work::new(&options, build.as_deref(), terminal)?;
    let mut results = None;
    if let Some(out) = &options.batch.out {
        if let (Some(shard), Some(program)) = (options.batch.shard, build) {
            work.select(&options.task.shaders, shard, program, out)?;
        }
        let cannot_write = |error| format!("cannot write {error}");
        let (lines, broken) = if options.batch.resume {
            read_lines(&out.join(RESULTS_NAME)).map_err(cannot_write)?
        } else {
            (Vec::new(), 0)
        };
        results = Some(Results::create(out, lines).map_err(cannot_write)?);
        if broken > 0 {
            terminal.warn(format_args!(
                "{} {} of results.jsonl cannot be read; {} checked again",
                grouped(broken),
                plural(broken, "line", "lines"),
                plural(broken, "its shader is", "their shaders are"),
            ));
        }
    }
    Ok(work.check(&options, results, earlier, terminal))
}
