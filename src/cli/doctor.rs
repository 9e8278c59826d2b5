//! `toyproof doctor`

use std::path::PathBuf;
use std::time::Duration;

use toyproof_diagnostic::{grouped, path_name};
use toyproof_gpu::{
    AdapterSelector, Driver, Failure, INSTALL_HINT, LoopCap, is_pinned_by_user, lavapipe_manifest, manifests,
    pinned,
};

use super::inputs::{self, DeviceSelector};
use super::{Exit, Terminal};

/// Say which Vulkan drivers are installed, which is chosen and why, what is missing and how to get it
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  toyproof doctor")]
pub(super) struct Args {
    /// The adapter that a command would be given; `cpu` for toyproof's own evaluator, which needs none
    #[arg(long, value_name = "ADAPTER", default_value = "auto", value_parser = inputs::parse_device)]
    on: DeviceSelector,
}

/// The time limit for loading all drivers together, and then for each alone.
const TIME_LIMIT: Duration = Duration::from_secs(20);

/// The message on a machine without drivers.
const NO_DRIVER_MESSAGE: &str = "\nChosen: none. `check`, `run` and `explain` work all the same, on the CPU. `check` then tells whether a shader's \
                       mathematics is the scene's and whether float32 is enough for it; the toolchain question, whether a GPU paints what \
                       the shader says, is not asked.";

/// The message for `--on cpu`.
const EVALUATOR_MESSAGE: &str = "\nChosen, because --on cpu asks for it: toyproof's own evaluator, which needs no driver. `check` does not ask the \
                         toolchain question with it.";

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let manifests = manifests();
    terminal.result("Vulkan drivers installed:");
    for path in &manifests {
        terminal.result(&format!("  {}", path_name(path)));
    }
    if manifests.is_empty() {
        terminal.result("  none");
    }
    if is_pinned_by_user() {
        terminal.result(
            "  VK_DRIVER_FILES or VK_ICD_FILENAMES is set: only the drivers that it names are loaded",
        );
    }
    let on = match &args.on {
        DeviceSelector::Gpu(on) => on,
        DeviceSelector::Cpu => {
            terminal.result(EVALUATOR_MESSAGE);
            return Exit::Success;
        }
    };
    let worker = match inputs::worker(on.clone(), TIME_LIMIT) {
        Ok(worker) => worker,
        Err(error) => {
            terminal.error(error);
            return Exit::Error;
        }
    };
    match worker.with_all_drivers().probe() {
        Ok(drivers) => {
            if let Some(chosen) = drivers.first() {
                terminal.result(&format!("\nChosen, {}:", selection_reason(on, chosen)));
            }
            for (index, driver) in drivers.iter().enumerate() {
                if index == 1 {
                    terminal.result("\nOthers (--on takes words of a name):");
                }
                terminal.result(&describe(driver));
            }
            if lavapipe_manifest().is_none() {
                terminal.result(&format!(
                    "\nlavapipe, on which every figure of this tool was measured, is missing; {INSTALL_HINT}"
                ));
            }
            Exit::Success
        }
        Err(failure) => {
            if let Failure::NotStarted(_) = failure {
                report_broken(&candidates(manifests), terminal);
            }
            if *on == AdapterSelector::Auto {
                terminal.result(NO_DRIVER_MESSAGE);
            }
            terminal.error(failure);
            Exit::Error
        }
    }
}

/// The manifests of the drivers that the Vulkan loader would load.
fn candidates(installed: Vec<PathBuf>) -> Vec<PathBuf> {
    match pinned() {
        None => installed,
        Some(pinned) => pinned,
    }
}

/// Starts each driver alone, to find those that do not start.
fn report_broken(manifests: &[PathBuf], terminal: &Terminal) {
    terminal.result("\nEach driver alone:");
    for manifest in manifests {
        let path = path_name(manifest);
        let alone = inputs::worker(AdapterSelector::Auto, TIME_LIMIT)
            .map(|worker| worker.with_manifest(manifest.clone()).probe());
        match alone {
            Ok(Ok(_)) => terminal.result(&format!("  {path}: starts")),
            Ok(Err(failure)) => terminal.result(&format!("  {path}: {failure}")),
            Err(error) => terminal.result(&format!("  {path}: {error}")),
        }
    }
    terminal.result(
        "  Remove or update a driver that does not start, or name another: VK_DRIVER_FILES=MANIFEST.json toyproof …",
    );
}

fn selection_reason(on: &AdapterSelector, chosen: &Driver) -> String {
    match on {
        AdapterSelector::Auto if chosen.is_lavapipe() => {
            "because lavapipe gives the same bits on every machine".to_owned()
        }
        AdapterSelector::Auto if is_pinned_by_user() => "because the environment names it".to_owned(),
        AdapterSelector::Auto => "because it comes first".to_owned(),
        AdapterSelector::Lavapipe => "because --on lavapipe asks for it".to_owned(),
        AdapterSelector::Named(name) => format!("because --on “{name}” asks for it"),
    }
}

fn describe(driver: &Driver) -> String {
    let yes = |is: bool| if is { "yes" } else { "no" };
    let controls = match &driver.float_controls[..] {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    let loops = match driver.loop_cap {
        None => "could not be measured".to_owned(),
        Some(LoopCap::NoneUpTo(tried)) => format!(
            "run to their end (tried {} iterations)",
            grouped(u64::from(tried))
        ),
        Some(LoopCap::After(count)) => {
            format!(
                "are ended by force after {} iterations of a pixel (Mesa before 23); `check` tells which",
                grouped(u64::from(count))
            )
        }
    };
    format!(
        "  {}\n    driver: {}\n    runs on the CPU: {}\n    float32 textures filtered: {}\n    \
         float controls, 32 bits: {controls}\n    loops: {loops}",
        driver.name,
        driver.version,
        yes(driver.software),
        yes(driver.float32_filterable),
    )
}
