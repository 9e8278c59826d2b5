//! The table of Vulkan drivers.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::builder::RangedU64ValueParser;
use clap::value_parser;
use toyproof::diagnostic::grouped;
use toyproof::gpu::{AdapterSelector, INSTALL_HINT};
use toyproof_testkit::devices::behavior::GUARDED;
use toyproof_testkit::devices::discovery::{Device, discover};
use toyproof_testkit::devices::table::markdown;
use toyproof_testkit::devices::{Plan, arguments};

/// The exit code where nothing can be measured.
const NO_DEVICE: u8 = 2;

/// The time limit of an image, in seconds.
const IMAGE_SECONDS: u64 = 20;

/// The time for what has begun before a device's time limit ends: an image of the driver, and one of the
/// evaluator.
const RESERVED_SECONDS: u64 = 2 * IMAGE_SECONDS;

/// Set by an interrupt.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Only this device: `auto`, `lavapipe`, or a substring of the name of an adapter or its driver [default: all]
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// The time limit of each device, in seconds; what does not fit is not measured
    #[arg(long, value_name = "SECONDS", default_value_t = 240, value_parser = time_limits())]
    time_limit: u64,
}

/// The accepted time limits.
fn time_limits() -> RangedU64ValueParser {
    value_parser!(u64).range(RESERVED_SECONDS + 1..)
}

/// Measures the devices, and prints the table, also where it is interrupted.
#[expect(clippy::exit, reason = "a second interrupt ends the program at once")]
pub(super) fn print_table(options: &Arguments) -> ExitCode {
    // If no handler can be installed, an interrupt ends the program.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!("interrupted: the table follows after the current shader; interrupt again to stop at once");
    });
    let timeout = Duration::from_secs(IMAGE_SECONDS);
    let new_worker = move |selector: AdapterSelector| super::worker(selector, timeout);
    let mut discovery = discover(&new_worker);
    for note in &discovery.notes {
        eprintln!("{note}");
    }
    let names: Vec<_> = discovery.devices.iter().map(Device::title).collect();
    if let Some(device) = &options.device {
        discovery.select(device);
    }
    if discovery.devices.is_empty() {
        if !names.is_empty() {
            let names = names.join("; ");
            eprintln!("error: no device matches `--device`; available: {names}");
        } else if discovery.notes.is_empty() {
            eprintln!("error: no Vulkan driver found; {INSTALL_HINT}");
        } else {
            eprintln!("error: no Vulkan driver starts");
        }
        return ExitCode::from(NO_DEVICE);
    }
    let plan = Plan::complete(timeout);
    let mut translator = new_worker(AdapterSelector::Auto).without_driver();
    let mut columns = Vec::new();
    for device in &discovery.devices {
        let title = device.title();
        let start = Instant::now();
        let limit = Duration::from_secs(options.time_limit.saturating_sub(RESERVED_SECONDS));
        let stop = || {
            if INTERRUPTED.load(Ordering::Relaxed) {
                Some("interrupted".to_owned())
            } else if start.elapsed() >= limit {
                Some(format!("the time limit of {} s", options.time_limit))
            } else {
                None
            }
        };
        let mut section: Option<(&str, Instant)> = None;
        let mut progress = |next: Option<&'static str>| {
            if let Some((name, begun)) = section {
                eprintln!("{title}: {name}: {:.1} s", begun.elapsed().as_secs_f64());
            }
            section = next.map(|name| (name, Instant::now()));
        };
        columns.push(plan.measure(device, &mut translator, &stop, &mut progress));
        eprintln!("{title}: {:.1} s in total", start.elapsed().as_secs_f64());
    }
    print!("{}", markdown(&plan.rows(), &columns));
    println!(
        "\n{GUARDED}\n\nArguments: {} for each function, random ones with seed {}.",
        grouped(plan.arguments as u64),
        arguments::SEED
    );
    for note in &discovery.notes {
        println!("\n{note}");
    }
    ExitCode::SUCCESS
}
