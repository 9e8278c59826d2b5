//! `toyproof doctor`

use std::path::PathBuf;
use std::time::Duration;

use serde::Serialize;
use toyproof_diagnostic::{grouped, path_name};
use toyproof_gpu::{
    AdapterSelector, Driver, Failure, INSTALL_HINT, LoopCap, SANDBOX_VARIABLE, is_pinned_by_user,
    lavapipe_manifest, manifests, pinned,
};

use super::inputs::{self, DeviceSelector, Format};
use super::{CliError, Exit, Terminal};

/// List the Vulkan drivers, the one that is used, and what is missing
#[derive(Debug, clap::Args)]
#[command(after_long_help = "Example:\n  toyproof doctor --device lavapipe")]
pub(super) struct Args {
    /// The device to test: `auto`, `lavapipe`, `cpu`, or a substring of an adapter's name
    #[arg(long, value_name = "DEVICE", default_value = "auto", value_parser = inputs::parse_device)]
    device: DeviceSelector,
    /// The format of standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
}

/// The time limit for loading all drivers together, and then for each alone.
const TIME_LIMIT: Duration = Duration::from_secs(20);

/// The drivers of this machine.
#[derive(Debug, Serialize)]
struct Report {
    tool: String,
    /// The manifests of the installed drivers.
    manifests: Vec<String>,
    /// Whether the environment selects the drivers that are loaded.
    is_pinned: bool,
    /// The selected device: a driver's name, or `cpu`; null if there is none.
    selected: Option<String>,
    /// Why it is selected.
    reason: Option<&'static str>,
    /// How a worker process, which loads the drivers, is restricted; null if no driver is used.
    sandbox: Option<String>,
    /// The drivers that start, the selected one first.
    drivers: Vec<DriverReport>,
    /// Why no driver can be used.
    error: Option<String>,
    /// For each manifest, whether its driver starts alone; empty if all start together.
    tests: Vec<DriverTest>,
    /// The version of ffmpeg, which writes MP4 and `WebM`; null if it is not installed.
    ffmpeg: Option<String>,
}

/// A driver that starts.
#[derive(Debug, Serialize)]
struct DriverReport {
    name: String,
    version: String,
    is_software: bool,
    filters_float32: bool,
    /// The Vulkan names of its float controls for 32 bits.
    float_controls: Vec<String>,
    /// The number of iterations after which it cuts off loops; null if it did not in the test, or the test
    /// failed.
    loop_limit: Option<u32>,
}

/// The test of one driver.
#[derive(Debug, Serialize)]
struct DriverTest {
    manifest: String,
    /// Why it does not start; null if it does.
    error: Option<String>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let report = examine(&args.device)?;
    match args.format {
        Format::Human => report.print(terminal),
        Format::Json => {
            // Strings, lists and options always serialize.
            let json = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
            terminal.bytes(json.as_bytes())?;
        }
    }
    Ok(if report.error.is_some() {
        Exit::Error
    } else {
        Exit::Success
    })
}

/// Starts all drivers together, and each alone if that fails.
fn examine(device: &DeviceSelector) -> Result<Report, String> {
    let manifests = manifests();
    let mut report = Report {
        tool: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
        manifests: manifests.iter().map(|path| path_name(path)).collect(),
        is_pinned: is_pinned_by_user(),
        selected: None,
        reason: None,
        sandbox: None,
        drivers: Vec::new(),
        error: None,
        tests: Vec::new(),
        ffmpeg: toyproof_film::ffmpeg_version(),
    };
    let adapter = match device {
        DeviceSelector::Gpu(adapter) => adapter,
        DeviceSelector::Cpu => {
            report.selected = Some("cpu".to_owned());
            report.reason = Some(if inputs::LOADS_DRIVERS {
                "named by --device"
            } else {
                inputs::STATIC_PROGRAM
            });
            return Ok(report);
        }
    };
    let mut worker = inputs::worker(adapter.clone(), TIME_LIMIT)?.with_all_drivers();
    report.sandbox = worker.sandbox().ok().map(|sandbox| sandbox.to_string());
    match worker.probe() {
        Ok(drivers) => {
            if let Some(selected) = drivers.first() {
                report.selected = Some(selected.name.clone());
                report.reason = Some(selection_reason(adapter, selected));
            }
            report.drivers = drivers.into_iter().map(DriverReport::new).collect();
        }
        Err(failure) => {
            if let Failure::NotStarted(_) = failure {
                // Those that the Vulkan loader would load.
                let loaded = pinned().unwrap_or(manifests);
                report.tests = loaded.into_iter().map(test_alone).collect();
            }
            report.error = Some(failure.to_string());
        }
    }
    Ok(report)
}

/// Starts one driver alone.
fn test_alone(manifest: PathBuf) -> DriverTest {
    let name = path_name(&manifest);
    let worker = inputs::worker(AdapterSelector::Auto, TIME_LIMIT);
    let probed = worker.and_then(|worker| {
        let mut worker = worker.with_manifest(manifest);
        worker.probe().map_err(|failure| failure.to_string())
    });
    DriverTest {
        manifest: name,
        error: probed.err(),
    }
}

fn selection_reason(adapter: &AdapterSelector, selected: &Driver) -> &'static str {
    match adapter {
        AdapterSelector::Auto if selected.is_lavapipe() => {
            "the default: lavapipe renders the same bits on every machine"
        }
        AdapterSelector::Auto if is_pinned_by_user() => "named by the environment",
        AdapterSelector::Auto => "the first driver; lavapipe is not installed",
        AdapterSelector::Lavapipe | AdapterSelector::Named(_) => "named by --device",
    }
}

impl DriverReport {
    fn new(driver: Driver) -> Self {
        Self {
            loop_limit: match driver.loop_cap {
                Some(LoopCap::After(count)) => Some(count),
                Some(LoopCap::NoneUpTo(_)) | None => None,
            },
            name: driver.name,
            version: driver.version,
            is_software: driver.software,
            filters_float32: driver.float32_filterable,
            float_controls: driver.float_controls,
        }
    }

    fn print(&self, terminal: &Terminal) {
        let kind = if self.is_software {
            "runs on the CPU"
        } else {
            "runs on a GPU"
        };
        terminal.result(&format!("  {}", self.name));
        terminal.result(&format!("    driver          {} ({kind})", self.version));
        if let Some(limit) = self.loop_limit {
            terminal.result(&format!(
                "    loops           stopped after {} iterations (Mesa before 23); `check` reports where",
                grouped(u64::from(limit))
            ));
        }
        if !self.filters_float32 {
            terminal.result("    textures        float32 textures are not filtered");
        }
        if terminal.is_verbose() {
            let controls = match &self.float_controls[..] {
                [] => "none".to_owned(),
                names => names.join(", "),
            };
            terminal.result(&format!("    float controls  {controls}"));
        }
    }
}

impl Report {
    fn print(&self, terminal: &Terminal) {
        let selected = self.selected.as_deref().unwrap_or("none");
        let reason = self
            .reason
            .map(|reason| format!(" ({reason})"))
            .unwrap_or_default();
        terminal.result(&format!("Selected device: {selected}{reason}"));
        if selected == "cpu" {
            terminal
                .paragraph("toyproof's own evaluator needs no driver; `check` skips the toolchain check.");
        }
        if let Some(sandbox) = &self.sandbox {
            terminal.result(&format!("Sandbox of drivers: {sandbox}"));
        }
        if !self.drivers.is_empty() {
            terminal.result("\nVulkan devices:");
            for driver in &self.drivers {
                driver.print(terminal);
            }
        }
        terminal.result("\nInstalled Vulkan drivers:");
        for manifest in &self.manifests {
            terminal.result(&format!("  {manifest}"));
        }
        if self.manifests.is_empty() {
            terminal.result("  none");
        }
        if self.is_pinned {
            terminal.result(
                "  VK_DRIVER_FILES or VK_ICD_FILENAMES is set: only the drivers named there are loaded",
            );
        }
        match &self.ffmpeg {
            Some(version) => terminal.result(&format!("\nffmpeg, which writes MP4 and WebM: {version}")),
            None => terminal.result("\nffmpeg, which writes MP4 and WebM: not installed"),
        }
        if !self.tests.is_empty() {
            terminal.result("\nEach driver alone:");
            for DriverTest { manifest, error } in &self.tests {
                terminal.result(&format!("  {manifest}: {}", error.as_deref().unwrap_or("starts")));
            }
        }
        if let Some(error) = &self.error {
            terminal.result("");
            terminal.error(error);
            if lavapipe_manifest().is_none() || self.is_pinned {
                terminal.help(INSTALL_HINT);
            }
            if !self.tests.is_empty() {
                terminal.help(
                    "remove or update the driver that does not start, or name another: \
                     VK_DRIVER_FILES=MANIFEST.json toyproof …",
                );
                terminal.help(format_args!(
                    "a driver that starts with {SANDBOX_VARIABLE}=off needs files outside of the system's folders"
                ));
            }
            terminal.note(
                "`check`, `run` and `debug` work without a driver, on the CPU; the toolchain check is skipped.",
            );
        } else if selected != "cpu" && lavapipe_manifest().is_none() {
            terminal.result("");
            terminal.paragraph(&format!(
                "lavapipe, which renders the same bits on every machine, is not installed; {INSTALL_HINT}"
            ));
        }
    }
}
