//! What a Vulkan driver computes: the toolchain check of the course and of random programs, the precision of
//! functions, what drivers are free to choose, and proofs of conversions. `cargo xtask devices` prints it as
//! a table.
//!
//! - `discovery`: the devices of this machine.
//! - `toolchain`, `conversions`: shaders of the course and random programs.
//! - `function`, `arguments`, `precision`, `errors`: the errors of functions, and what Vulkan permits.
//! - `behavior`, `derivatives`: results that drivers are free to choose.
//! - `probe`: expressions evaluated by a driver.
//! - `table`: all of it in Markdown.

pub mod arguments;
pub mod behavior;
pub mod conversions;
pub mod derivatives;
pub mod discovery;
pub mod errors;
pub mod function;
pub mod precision;
pub mod probe;
pub mod table;
pub mod toolchain;

use std::time::Duration;

use toyproof::diagnostic::grouped;
use toyproof::gpu::{LoopCap, Worker};
use toyproof::translate::FloatMode;

use self::arguments::arguments;
use self::behavior::{BEHAVIORS, Behavior, CONTRACTED, Contraction};
use self::conversions::{LANGUAGES, Language};
use self::discovery::Device;
use self::errors::Errors;
use self::function::{FUNCTIONS, Function};
use self::probe::Probe;
use self::table::{Column, Row};
use crate::{EVERY_EXERCISE, Exercise};

/// Returns why the measurements end, once they have to.
pub type Stop<'a> = &'a dyn Fn() -> Option<String>;

/// What is measured.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The exercises of the course.
    pub exercises: Vec<&'static Exercise>,
    /// The number of random programs.
    pub programs: u32,
    /// The functions whose errors are measured.
    pub functions: Vec<&'static Function>,
    /// The number of arguments of each function.
    pub arguments: usize,
    /// The rows of results that drivers choose.
    pub behaviors: Vec<&'static Behavior>,
    /// The languages of the conversions.
    pub languages: Vec<&'static Language>,
    /// The time limit of an image.
    pub timeout: Duration,
}

impl Plan {
    /// All measurements.
    pub fn complete(timeout: Duration) -> Self {
        Self {
            exercises: EVERY_EXERCISE.to_vec(),
            programs: 300,
            functions: FUNCTIONS.iter().collect(),
            arguments: 1 << 15,
            behaviors: BEHAVIORS.iter().collect(),
            languages: LANGUAGES.iter().collect(),
            timeout,
        }
    }

    fn measurements(&self) -> Vec<Measurement> {
        use Measurement as M;
        let device = DEVICE_ROWS.iter().map(M::Device);
        let functions = self.functions.iter().copied();
        let strict = functions.clone().filter(|function| function.is_strict());
        let strict = strict.map(|function| M::Function(function, FloatMode::Strict));
        let fast = functions.map(|function| M::Function(function, FloatMode::Fast));
        let behaviors = self.behaviors.iter().copied().map(M::Behavior);
        let languages = self.languages.iter().copied().map(M::Conversions);
        device
            .chain([M::Course, M::Programs])
            .chain([M::Contraction(FloatMode::Strict)])
            .chain(strict)
            .chain([M::Derivatives(FloatMode::Strict), M::Contraction(FloatMode::Fast)])
            .chain(fast)
            .chain(behaviors)
            .chain([M::Derivatives(FloatMode::Fast)])
            .chain(languages)
            .collect()
    }

    /// The rows of the table.
    pub fn rows(&self) -> Vec<Row> {
        self.measurements()
            .iter()
            .map(|measurement| measurement.row(self))
            .collect()
    }

    /// Measures a device, row by row. `translator` runs naga for conversions; `progress` is called before
    /// each section, and at the end with none. After `stop` has given a reason, nothing else is begun.
    pub fn measure(
        &self,
        device: &Device,
        translator: &mut Worker,
        stop: Stop,
        progress: &mut dyn FnMut(Option<&'static str>),
    ) -> Column {
        let mut workers = Workers {
            plain: device.worker().with_plain_code(),
            optimized: device.worker(),
            translator,
        };
        let mut section = "";
        let mut measure = |measurement: Measurement| {
            if let Some(why) = stop() {
                return Err(why);
            }
            let now = measurement.section();
            if now != section {
                section = now;
                progress(Some(section));
            }
            measurement.measure(self, device, &mut workers, stop)
        };
        let cells = self.measurements().into_iter().map(&mut measure).collect();
        progress(None);
        Column {
            title: device.title(),
            cells,
        }
    }
}

/// The processes of a measurement.
struct Workers<'a> {
    /// Compiles without LLVM's optimizations, which change no bit.
    plain: Worker,
    optimized: Worker,
    translator: &'a mut Worker,
}

/// A property of a device, and how it is printed.
type DeviceRow = (&'static str, fn(&Device) -> String);

const DEVICE_ROWS: [DeviceRow; 6] = [
    ("device", |device| device.driver.name.clone()),
    ("driver", |device| device.driver.version.clone()),
    ("runs on", |device| {
        let kind = if device.driver.software {
            "the CPU"
        } else {
            "a GPU"
        };
        kind.to_owned()
    }),
    ("Vulkan", |device| {
        device
            .driver
            .api_version
            .clone()
            .unwrap_or_else(|| "unknown".to_owned())
    }),
    (
        "float controls",
        |device| match &device.driver.float_controls[..] {
            [] => "none".to_owned(),
            controls => controls.join(", "),
        },
    ),
    ("loops", |device| match device.driver.loop_cap {
        Some(LoopCap::After(count)) => format!("**cut off after {} iterations**", grouped(count.into())),
        Some(LoopCap::NoneUpTo(count)) => format!("not cut off up to {} iterations", grouped(count.into())),
        None => "not measured: the device failed".to_owned(),
    }),
];

/// A row of the table.
#[derive(Debug, Clone, Copy)]
enum Measurement {
    Device(&'static DeviceRow),
    Course,
    Programs,
    Contraction(FloatMode),
    Function(&'static Function, FloatMode),
    Behavior(&'static Behavior),
    Derivatives(FloatMode),
    Conversions(&'static Language),
}

impl Measurement {
    fn section(self) -> &'static str {
        match self {
            Self::Device(_) => "Device",
            Self::Course
            | Self::Programs
            | Self::Contraction(FloatMode::Strict)
            | Self::Function(_, FloatMode::Strict)
            | Self::Derivatives(FloatMode::Strict) => "Strict runs",
            Self::Contraction(FloatMode::Fast) | Self::Function(_, FloatMode::Fast) => {
                "Precision of the driver's own functions, in fast runs"
            }
            Self::Behavior(_) | Self::Derivatives(FloatMode::Fast) => {
                "Results that drivers choose, in fast runs"
            }
            Self::Conversions(_) => "Conversions of the course, proved by running them",
        }
    }

    fn row(self, plan: &Plan) -> Row {
        let (label, requirement) = match self {
            Self::Device((label, _)) => ((*label).to_owned(), String::new()),
            Self::Course => ("the course".to_owned(), "all".to_owned()),
            Self::Programs => {
                let label = format!("{} random programs (seed {})", plan.programs, toolchain::SEED);
                (label, "all".to_owned())
            }
            Self::Contraction(FloatMode::Strict) => (
                format!("`{CONTRACTED}`, strict"),
                "not contracted (`NoContraction`)".to_owned(),
            ),
            Self::Contraction(FloatMode::Fast) => (format!("`{CONTRACTED}`"), "may be contracted".to_owned()),
            Self::Function(function, FloatMode::Strict) => (
                format!("`{}`, strict", function.expression),
                "rounded correctly".to_owned(),
            ),
            Self::Function(function, FloatMode::Fast) => {
                (format!("`{}`", function.expression), function.limit.to_owned())
            }
            Self::Behavior(behavior) => (behavior.label.to_owned(), behavior.requirement.to_owned()),
            Self::Derivatives(FloatMode::Strict) => {
                ("derivatives, strict".to_owned(), "fine, as requested".to_owned())
            }
            Self::Derivatives(FloatMode::Fast) => ("derivatives".to_owned(), "fine or coarse".to_owned()),
            Self::Conversions(language) => (language.name.to_owned(), "all".to_owned()),
        };
        Row {
            section: self.section(),
            label,
            requirement,
        }
    }

    /// Measures it. What the driver does not survive is an error, like what cannot be measured.
    fn measure(
        self,
        plan: &Plan,
        device: &Device,
        workers: &mut Workers,
        stop: Stop,
    ) -> Result<String, String> {
        let failed = |failure: toyproof::gpu::Failure| failure.to_string();
        match self {
            Self::Device((_, describe)) => Ok(describe(device)),
            Self::Course => {
                let course = toolchain::course(&mut workers.plain, &plan.exercises, plan.timeout, stop);
                Ok(course.to_string())
            }
            Self::Programs => {
                let programs = toolchain::programs(&mut workers.plain, plan.programs, plan.timeout, stop);
                Ok(programs.to_string())
            }
            Self::Contraction(float) => {
                let arguments = Contraction::arguments(plan.arguments);
                let probe = Probe::of_float(CONTRACTED, &arguments);
                let results = probe.run(&mut workers.optimized, float).map_err(failed)?;
                Ok(Contraction::new(&arguments, &results).describe())
            }
            Self::Function(function, float) => {
                let arguments = arguments(function.usual, plan.arguments);
                let probe = Probe::of_float(function.expression, &arguments);
                let results = probe.run(&mut workers.optimized, float).map_err(failed)?;
                let errors = Errors::new(function, &arguments, &results);
                Ok(match float {
                    FloatMode::Strict => errors.describe_rounding(),
                    FloatMode::Fast => errors.to_string(),
                })
            }
            Self::Behavior(behavior) => {
                let results = behavior.probe().run(&mut workers.optimized, FloatMode::Fast);
                Ok(behavior.describe(&results.map_err(failed)?))
            }
            Self::Derivatives(float) => {
                let image = derivatives::render(&mut workers.optimized, float).map_err(failed)?;
                Ok(derivatives::describe(&image))
            }
            Self::Conversions(language) => {
                let (worker, translator) = (&mut workers.plain, &mut *workers.translator);
                conversions::prove(language, worker, translator, &plan.exercises, plan.timeout, stop)
                    .map(|conversions| conversions.to_string())
            }
        }
    }
}
