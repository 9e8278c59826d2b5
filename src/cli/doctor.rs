//! `toyproof doctor`

use std::time::Duration;

use super::inputs::{self, Place};
use super::{Exit, Terminal};
use crate::compare::grouped;
use crate::gpu::{Driver, INSTALL_HINT, LoopCap, On, is_pinned_by_user, lavapipe_manifest, manifests};
use crate::source::path_name;

/// Say which Vulkan drivers are installed, which is chosen and why, what is missing and how to get it
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  toyproof doctor")]
pub(super) struct Args {
    /// The adapter that a command would be given; `cpu` for toyproof's own evaluator, which needs none
    #[arg(long, value_name = "ADAPTER", default_value = "auto", value_parser = inputs::place)]
    on: Place,
}

/// Loading every driver of a machine takes longer than one shader.
const PATIENCE: Duration = Duration::from_secs(60);

/// What there is without a driver.
const WITHOUT: &str = "\nChosen: none. `check`, `run` and `explain` work all the same, on the CPU. `check` then tells whether a shader's \
                       mathematics is the scene's and whether float32 is enough for it; the toolchain question, whether a GPU paints what \
                       the shader says, is not asked.";

/// What `--on cpu` chooses.
const EVALUATOR: &str = "\nChosen, because --on cpu asks for it: toyproof's own evaluator, which needs no driver. `check` does not ask the \
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
        Place::Gpu(on) => on,
        Place::Cpu => {
            terminal.result(EVALUATOR);
            return Exit::Good;
        }
    };
    let drivers = inputs::worker(on.clone(), PATIENCE).and_then(|worker| {
        worker
            .with_all_drivers()
            .probe()
            .map_err(|failure| failure.to_string())
    });
    match drivers {
        Ok(drivers) => {
            if let Some(chosen) = drivers.first() {
                terminal.result(&format!("\nChosen, {}:", reason(on, chosen)));
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
            Exit::Good
        }
        Err(error) => {
            if *on == On::Auto {
                terminal.result(WITHOUT);
            }
            terminal.error(error);
            Exit::Trouble
        }
    }
}

fn reason(on: &On, chosen: &Driver) -> String {
    match on {
        On::Auto if chosen.is_lavapipe() => {
            "because lavapipe gives the same bits on every machine".to_owned()
        }
        On::Auto if is_pinned_by_user() => "because the environment names it".to_owned(),
        On::Auto => "because it comes first".to_owned(),
        On::Lavapipe => "because --on lavapipe asks for it".to_owned(),
        On::Named(words) => format!("because --on “{words}” asks for it"),
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
