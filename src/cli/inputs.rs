//! Arguments that several commands share: the frame, the driver, the deadline.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

use clap::ValueEnum;
use toyproof_diagnostic::{Code, Deadline, Files, Severity, human, one_of, path_name};
use toyproof_glsl::{self as glsl, Dialect, UniformValue};
use toyproof_gpu::{self as gpu, AdapterSelector, Worker};
use toyproof_image::output::Originals;
use toyproof_image::{Channel, FrameInputs, IDLE_MOUSE, Script, check_banded_size, check_size};
use toyproof_media::MediaFolder;
use toyproof_project as project;
use toyproof_project::files;
use toyproof_translate::FloatMode;

use super::{CliError, WORKER};

/// The time limit for one shader, unless the user gives another.
const DEFAULT_TIME_LIMIT: Duration = Duration::from_secs(10);

/// The longest time limit.
const MAX_TIME_LIMIT: Duration = Duration::from_secs(24 * 60 * 60);

/// Whether this program can load Vulkan drivers: a statically linked one has no dynamic linker.
pub(super) const LOADS_DRIVERS: bool = !cfg!(all(target_env = "musl", target_feature = "crt-static"));
/// The reason, and a way out.
pub(super) const STATIC_PROGRAM: &str = "this program is linked statically and cannot load Vulkan drivers; \
                                         the packages for glibc can: the .deb, the wheel, or *-linux-gnu.tar.gz";

/// Checks that a file can be written without overwriting one of the inputs.
pub(super) fn check_output(path: &Path, originals: &Originals) -> Result<(), CliError> {
    if originals.would_lose(path) {
        let error = format!("{} is an input and would be overwritten", path_name(path));
        return Err(CliError::new(error).with_help("give the output another name with -o"));
    }
    Ok(())
}

/// The values of ShaderToy's inputs.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Frame")]
pub(super) struct FrameArgs {
    /// Width and height in pixels [default: the scene's, else 640x360]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(super) size: Option<[u32; 2]>,
    /// iTime, in seconds [default: 0]
    #[arg(long, value_name = "S", value_parser = parse_seconds::<f32>, allow_negative_numbers = true)]
    time: Option<f32>,
    /// iFrame [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    frame: Option<i32>,
    /// iMouse, in pixels [default: 0,0,0,0]
    #[arg(long, value_name = "X,Y[,Z,W]", value_parser = parse_mouse, allow_hyphen_values = true, hide_short_help = true)]
    mouse: Option<[f32; 4]>,
    /// What the user does with the mouse and the keyboard over the frames: a TOML file with `[[mouse]]` and
    /// `[[key]]` events
    #[arg(long, visible_alias = "keys", value_name = "FILE", value_parser = parse_script, conflicts_with = "mouse", hide_short_help = true)]
    mouse_script: Vec<Arc<Script>>,
    /// iDate: year, month from 0 to 11, day, seconds since midnight
    #[arg(long, value_name = "Y,M,D,S", value_parser = parse_date, allow_hyphen_values = true, hide_short_help = true)]
    date: Option<[f32; 4]>,
    /// The texture of iChannel0: an image (.png, .jpg, .hdr, .exr, …) or `noise` [default: black]
    #[arg(long, value_name = "FILE|noise", hide_short_help = true)]
    channel0: Option<PathBuf>,
    /// The texture of iChannel1
    #[arg(long, value_name = "FILE|noise", hide_short_help = true)]
    channel1: Option<PathBuf>,
    /// The texture of iChannel2
    #[arg(long, value_name = "FILE|noise", hide_short_help = true)]
    channel2: Option<PathBuf>,
    /// The texture of iChannel3
    #[arg(long, value_name = "FILE|noise", hide_short_help = true)]
    channel3: Option<PathBuf>,
}

impl FrameArgs {
    /// Whether any flag of a frame besides its size is given.
    pub(super) fn is_given(&self) -> bool {
        let Self {
            time,
            frame,
            mouse,
            date,
            mouse_script,
            ..
        } = self;
        let is_given = [
            time.is_some(),
            frame.is_some(),
            mouse.is_some(),
            date.is_some(),
            !mouse_script.is_empty(),
        ];
        is_given.contains(&true) || self.channels().iter().any(|channel| channel.is_some())
    }

    /// Whether the number or the time of a frame is given.
    pub(super) fn is_moment_given(&self) -> bool {
        self.frame.is_some() || self.time.is_some()
    }

    fn channels(&self) -> [&Option<PathBuf>; 4] {
        [&self.channel0, &self.channel1, &self.channel2, &self.channel3]
    }

    /// The frame to show. One that depends on earlier ones follows from its time, if only that is given.
    pub(super) fn number(&self, has_history: bool, rate: f64) -> i32 {
        let of_time = self
            .time
            .filter(|_| has_history)
            .map(|time| (f64::from(time) * rate).round());
        let number = self.frame.or(of_time.map(|number| number.max(0.0) as i32));
        number.unwrap_or_default()
    }

    /// The time of frame 0, so that the frame to show has the given time; 0 by default.
    pub(super) fn start(&self, number: i32, rate: f64) -> f64 {
        self.time
            .map_or(0.0, |time| f64::from(time) - f64::from(number) / rate)
    }

    /// All events of the mouse and the keyboard.
    fn script(&self) -> Option<Arc<Script>> {
        let (first, others) = self.mouse_script.split_first()?;
        let all = others
            .iter()
            .fold(Arc::clone(first), |all, one| Arc::new(all.and(one)));
        Some(all)
    }

    /// The frame that the flags describe.
    pub(super) fn inputs(&self) -> FrameInputs {
        let script = self.script();
        let frame = self.frame.unwrap_or_default();
        let scripted = script.as_ref().and_then(|script| script.mouse(frame));
        FrameInputs {
            size: self.size,
            time: self.time.unwrap_or_default(),
            frame,
            mouse: scripted.or(self.mouse).unwrap_or(IDLE_MOUSE),
            date: self.date.unwrap_or_default(),
            script,
            channels: self
                .channels()
                .map(|channel| channel.as_deref().map(Channel::named)),
            uniforms: Vec::new(),
        }
    }
}

/// The frames of an assignment, each once, in the size that the user gives, if any.
pub(super) fn resized(frames: &[FrameInputs], size: Option<[u32; 2]>) -> Vec<FrameInputs> {
    let mut resized: Vec<FrameInputs> = Vec::new();
    for frame in frames {
        let frame = FrameInputs {
            size: size.or(frame.size),
            ..frame.clone()
        };
        if !resized.contains(&frame) {
            resized.push(frame);
        }
    }
    resized
}

/// Lists a folder of media.
fn parse_media(path: &str) -> Result<Arc<MediaFolder>, String> {
    let opened = MediaFolder::open(Path::new(path)).map(Arc::new);
    opened.map_err(|error| error.to_string())
}

/// Reads a script of the mouse and the keyboard.
fn parse_script(path: &str) -> Result<Arc<Script>, String> {
    let text = files::read_named(Path::new(path)).map_err(|error| error.to_string())?;
    let mut files = Files::default();
    let file = files.add(text);
    project::parse_script(&files, file)
        .map(Arc::new)
        .map_err(|errors| {
            let errors = errors.iter().map(|error| human(error, &files, None, false));
            format!("\n{}", errors.collect::<String>().trim_end())
        })
}

/// The flags that describe a frame, for a command that the user may run.
pub(super) fn frame_flags(inputs: &FrameInputs) -> Vec<String> {
    let list = |numbers: [f32; 4]| numbers.map(|number| number.to_string()).join(",");
    let mut flags = Vec::new();
    if let Some([width, height]) = inputs.size {
        flags.push(format!("--size {width}x{height}"));
    }
    if inputs.time != 0.0 {
        flags.push(format!("--time {}", inputs.time));
    }
    if inputs.frame != 0 {
        flags.push(format!("--frame {}", inputs.frame));
    }
    for (flag, numbers) in [("--mouse", inputs.mouse), ("--date", inputs.date)] {
        if numbers != [0.0; 4] {
            flags.push(format!("{flag} {}", list(numbers)));
        }
    }
    for (index, channel) in inputs.channels.iter().enumerate() {
        if let Some(channel) = channel {
            let name = channel
                .file()
                .map_or_else(|| Channel::NOISE.to_owned(), path_name);
            flags.push(format!("--channel{index} {}", shell_word(&name)));
        }
    }
    let uniforms = inputs.uniforms.iter().map(|value| format!("--uniform {value}"));
    flags.extend(uniforms);
    flags
}

/// The accepted language, and the treatment of warnings.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Shader")]
pub(super) struct LanguageArgs {
    /// Accept desktop-GLSL extensions that WebGL 2 rejects
    ///
    /// These are global variables initialized from uniforms, integers where floats are expected, and arrays
    /// of arrays.
    #[arg(long)]
    lenient: bool,
    /// The host of the shader, which sets its inputs [default: recognized by the text]
    ///
    /// shadertoy; ghostty; book-of-shaders (also glslViewer); glsl-sandbox; three (three.js, p5.js); webgl (any
    /// other page).
    #[arg(long, value_name = "auto|NAME", value_parser = parse_dialect, hide_short_help = true)]
    dialect: Option<DialectChoice>,
    /// The value of a uniform that the shader declares: `speed=2`, `color=1,0,0`
    #[arg(long, value_name = "NAME=X[,Y…]", value_parser = parse_uniform, allow_hyphen_values = true)]
    pub(super) uniform: Vec<UniformValue>,
    /// A folder in which `#include "file"` is searched, after that of the shader
    #[arg(long, value_name = "DIR", hide_short_help = true)]
    include_dir: Vec<PathBuf>,
    /// A folder of copies of ShaderToy's media, which projects then read instead of computed ones
    ///
    /// A file has the name of a medium (`rock-tiles.jpg`), or the name that it has on the site.
    #[arg(long, value_name = "DIR", value_parser = parse_media, hide_short_help = true)]
    media: Option<Arc<MediaFolder>>,
    /// Treat warnings as errors: `warnings` for all, or a code such as W0005
    ///
    /// A comment `// toyproof: allow(W0005)` in the shader takes precedence.
    #[arg(long, value_name = "warnings|CODE", value_parser = parse_deny, hide_short_help = true)]
    deny: Vec<Deny>,
}

/// Where and how the shader runs.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Device")]
pub(super) struct DriverArgs {
    /// The device that runs shaders: `auto`, `lavapipe`, `cpu`, or a substring of an adapter's name
    ///
    /// `auto` selects lavapipe if it is installed, else the first Vulkan driver, else the CPU. `cpu` is
    /// toyproof's own evaluator: it needs no driver. There is no toolchain check, since that compares a GPU
    /// with the CPU.
    #[arg(long, value_name = "DEVICE", default_value = "auto", value_parser = parse_device)]
    device: DeviceSelector,
    /// The float arithmetic: `strict` or `fast` [default: strict; for `convert`: fast]
    ///
    /// strict: no reassociation or contraction; sin, pow and the like are expanded to operations with the
    /// same bits on every device. fast: native functions, and the driver may rearrange arithmetic.
    #[arg(long, value_enum, value_name = "MODE", hide_possible_values = true)]
    float: Option<Float>,
    /// The time limit for one shader: seconds, or a number with a unit (500ms, 2m) [default: 10s; for `run`:
    /// none]
    #[arg(long, value_name = "TIME", value_parser = parse_time_limit)]
    timeout: Option<Duration>,
}

/// The device that runs a shader.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum DeviceSelector {
    /// The evaluator, in this process.
    Cpu,
    /// A Vulkan driver, in a worker.
    Gpu(AdapterSelector),
}

/// Which warnings count as errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deny {
    /// All.
    Warnings,
    /// Warnings with this code.
    Code(Code),
}

impl Deny {
    pub(super) fn includes(self, code: Code) -> bool {
        match self {
            Self::Warnings => true,
            Self::Code(denied) => denied == code,
        }
    }
}

/// The format of standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Human,
    Json,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Float {
    Strict,
    Fast,
}

impl From<Float> for FloatMode {
    fn from(float: Float) -> Self {
        match float {
            Float::Strict => Self::Strict,
            Float::Fast => Self::Fast,
        }
    }
}

/// The value of `--dialect`.
#[derive(Debug, Clone, Copy)]
enum DialectChoice {
    Recognized,
    Given(Dialect),
}

/// Parses the name of a dialect.
fn parse_dialect(text: &str) -> Result<DialectChoice, String> {
    if text == "auto" {
        return Ok(DialectChoice::Recognized);
    }
    let dialect = Dialect::named(text).map(DialectChoice::Given);
    dialect.ok_or_else(|| {
        let names: Vec<_> = Dialect::all().map(Dialect::name).collect();
        format!("expected auto, {}", one_of(&names))
    })
}

/// Parses the value of a uniform.
fn parse_uniform(text: &str) -> Result<UniformValue, String> {
    let expected = "expected a name, `=` and numbers with commas between them, such as color=1,0,0.5";
    let (name, numbers) = text.split_once('=').ok_or(expected)?;
    let component = |text: &str| match text.trim() {
        "true" => Ok(1.0),
        "false" => Ok(0.0),
        number => number
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite())
            .ok_or(expected),
    };
    let components = numbers.split(',').map(component).collect::<Result<_, _>>()?;
    let name = name.trim().to_owned();
    if name.is_empty() {
        return Err(expected.to_owned());
    }
    Ok(UniformValue { name, components })
}

impl LanguageArgs {
    pub(super) fn options(&self, deadline: Deadline) -> glsl::Options {
        let dialect = match self.dialect {
            Some(DialectChoice::Given(dialect)) => Some(dialect),
            Some(DialectChoice::Recognized) | None => None,
        };
        glsl::Options {
            lenient: self.lenient,
            dialect,
            uniforms: self.uniform.clone(),
            deadline,
            ..glsl::Options::default()
        }
    }

    /// These options with values of uniforms that the user does not give.
    pub(super) fn with_uniforms(&self, values: &[UniformValue]) -> Self {
        let mut all = self.clone();
        UniformValue::add_missing(&mut all.uniform, values);
        all
    }

    /// The flags that set these options, for a command that the user may run.
    pub(super) fn flags(&self) -> Vec<String> {
        let lenient = self.lenient.then(|| "--lenient".to_owned());
        let dialect = match self.dialect {
            Some(DialectChoice::Given(dialect)) => Some(format!("--dialect {}", dialect.name())),
            Some(DialectChoice::Recognized) | None => None,
        };
        let uniforms = self.uniform.iter().map(|value| format!("--uniform {value}"));
        let folders = self.include_dir.iter();
        let folders = folders.map(|folder| format!("--include-dir {}", shell_word(&path_name(folder))));
        let flags = lenient.into_iter().chain(dialect).chain(uniforms);
        flags.chain(folders).collect()
    }

    /// The user's copies of the site's media.
    pub(super) fn media(&self) -> Option<&MediaFolder> {
        self.media.as_deref()
    }

    /// The folders in which included files are searched.
    pub(super) fn include_folders(&self) -> &[PathBuf] {
        &self.include_dir
    }

    pub(super) fn denied(&self) -> &[Deny] {
        &self.deny
    }
}

impl DriverArgs {
    pub(super) fn float(&self) -> FloatMode {
        self.float.unwrap_or(Float::Strict).into()
    }

    /// The mode that `--float` gives; `None` without the flag.
    pub(super) fn explicit_float(&self) -> Option<FloatMode> {
        self.float.map(FloatMode::from)
    }

    /// The time limit for one shader.
    pub(super) fn timeout(&self) -> Duration {
        self.timeout.unwrap_or(DEFAULT_TIME_LIMIT)
    }

    /// The time limit of a command that has none by default.
    pub(super) fn explicit_timeout(&self) -> Duration {
        self.timeout.unwrap_or(MAX_TIME_LIMIT)
    }

    /// Creates the worker that runs shaders on a GPU; `None` for `--device cpu`.
    pub(super) fn worker(&self) -> Result<Option<Worker>, String> {
        self.worker_for(1)
    }

    /// Like [`Self::worker`], with a time limit for several images.
    pub(super) fn worker_for(&self, images: u32) -> Result<Option<Worker>, String> {
        match &self.device {
            DeviceSelector::Cpu => Ok(None),
            DeviceSelector::Gpu(on) => worker(on.clone(), self.timeout() * images).map(Some),
        }
    }

    /// Like [`Self::worker`], for a command that has no time limit by default.
    pub(super) fn patient_worker(&self) -> Result<Option<Worker>, String> {
        match &self.device {
            DeviceSelector::Cpu => Ok(None),
            DeviceSelector::Gpu(on) => worker(on.clone(), self.explicit_timeout()).map(Some),
        }
    }

    /// Creates a worker that only translates shaders, without a driver.
    pub(super) fn translator(&self) -> Result<Worker, String> {
        worker(AdapterSelector::Auto, self.timeout()).map(Worker::without_driver)
    }

    /// Returns whether the evaluator may replace a missing driver.
    pub(super) fn may_fall_back(&self) -> bool {
        self.device == DeviceSelector::Gpu(AdapterSelector::Auto)
    }

    /// Returns whether the evaluator may render, although there is a driver.
    pub(super) fn may_be_evaluated(&self) -> bool {
        self.device == DeviceSelector::Cpu || self.may_fall_back()
    }

    /// Returns whether the evaluator renders the same bits as the driver that would be selected, on the same
    /// processor.
    pub(super) fn is_evaluator_equal(&self) -> bool {
        self.may_fall_back() && self.float() == FloatMode::Strict && gpu::is_automatic_driver_software()
    }
}

/// Creates a worker that runs this program with the argument [`WORKER`].
pub(super) fn worker(on: AdapterSelector, timeout: Duration) -> Result<Worker, String> {
    let program = std::env::current_exe()
        .map_err(|error| format!("cannot find the program itself to run it as a worker: {error}"))?;
    Ok(Worker::new(program, vec![WORKER.to_owned()], on, timeout))
}

/// Parses a time limit: seconds, or numbers with units.
pub(super) fn parse_time_limit(text: &str) -> Result<Duration, String> {
    let seconds = text
        .parse()
        .ok()
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    let Ok(time) = seconds.map_or_else(|| humantime::parse_duration(text), Ok) else {
        return Err("expected seconds or a number with a unit: 10, 500ms, 2m".to_owned());
    };
    if time > MAX_TIME_LIMIT {
        return Err("the longest time limit is 24 hours".to_owned());
    }
    if time.is_zero() {
        return Err("the time limit must be above 0".to_owned());
    }
    Ok(time)
}

/// Shortens the name of an adapter and its driver: without what is in parentheses, and without the adapter if
/// the driver's name begins with it.
pub(super) fn short_device(device: &str) -> String {
    let mut depth = 0_usize;
    let mut short = String::new();
    for character in device.chars() {
        match character {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            character if depth == 0 => short.push(character),
            _ => {}
        }
    }
    let parts: Vec<_> = short.split(',').map(str::trim).collect();
    match parts[..] {
        [adapter, driver] if driver.starts_with(adapter) => driver.to_owned(),
        _ => parts.join(", "),
    }
}

/// Quotes an argument for a shell, if needed.
pub(super) fn shell_word(text: &str) -> String {
    let is_plain = |character: char| character.is_alphanumeric() || "-_./:,+@%=".contains(character);
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else if cfg!(windows) {
        format!("\"{text}\"")
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

/// Parses a number in a range; `expected` is the message on any other text.
pub(super) fn parse_number(
    text: &str,
    range: RangeInclusive<f64>,
    expected: impl Display,
) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("expected {expected}"))
}

/// Parses the time of a frame, in seconds.
pub(super) fn parse_seconds<T: FromStr + Into<f64> + Copy>(text: &str) -> Result<T, String> {
    match text.parse::<T>() {
        Ok(time) if time.into().is_finite() => Ok(time),
        _ => Err("expected a finite number of seconds".to_owned()),
    }
}

pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let [width, height] = parse_sides(text)?;
    check_size(width, height).map_err(|error| error.to_string())
}

/// Parses the size of an image that may be rendered in bands.
pub(super) fn parse_banded_size(text: &str) -> Result<[u32; 2], String> {
    let [width, height] = parse_sides(text)?;
    check_banded_size(width, height).map_err(|error| error.to_string())
}

fn parse_sides(text: &str) -> Result<[u64; 2], String> {
    let (width, height) = text
        .split_once(['x', 'X', '×'])
        .ok_or("expected WIDTHxHEIGHT, such as 640x360")?;
    let side = |side: &str| {
        side.parse::<u64>()
            .map_err(|_| format!("`{side}` is not a number of pixels"))
    };
    Ok([side(width)?, side(height)?])
}

pub(super) fn parse_device(text: &str) -> Result<DeviceSelector, String> {
    match text {
        "cpu" => Ok(DeviceSelector::Cpu),
        "auto" if !LOADS_DRIVERS => Ok(DeviceSelector::Cpu),
        _ if !LOADS_DRIVERS => Err(STATIC_PROGRAM.to_owned()),
        text => parse_adapter(text).map(DeviceSelector::Gpu),
    }
}

pub(super) fn parse_adapter(text: &str) -> Result<AdapterSelector, String> {
    Ok(match text {
        "" => return Err("expected auto, lavapipe, cpu, or a substring of an adapter's name".to_owned()),
        "auto" => AdapterSelector::Auto,
        "lavapipe" => AdapterSelector::Lavapipe,
        name => AdapterSelector::Named(name.to_owned()),
    })
}

fn parse_deny(text: &str) -> Result<Deny, String> {
    if text == "warnings" {
        return Ok(Deny::Warnings);
    }
    let code = Code::parse(text).filter(|code| code.severity() != Severity::Error);
    code.map(Deny::Code)
        .ok_or_else(|| "expected `warnings` or the code of a warning, such as W0005".to_owned())
}

fn parse_numbers(text: &str) -> Result<Vec<f32>, String> {
    text.split(',')
        .map(|part| match f32::from_str(part.trim()) {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(format!("`{}` is not a number", part.trim())),
        })
        .collect()
}

fn parse_mouse(text: &str) -> Result<[f32; 4], String> {
    match parse_numbers(text)?[..] {
        [x, y] => Ok([x, y, 0.0, 0.0]),
        [x, y, z, w] => Ok([x, y, z, w]),
        _ => Err("expected two or four numbers: X,Y or X,Y,Z,W".to_owned()),
    }
}

fn parse_date(text: &str) -> Result<[f32; 4], String> {
    let expected = "expected four numbers: year, month from 0 (January) to 11, day, seconds";
    match parse_numbers(text)?[..] {
        [year, month, day, seconds] if (0.0..=11.0).contains(&month) => Ok([year, month, day, seconds]),
        [_, month, ..] if !(0.0..=11.0).contains(&month) => {
            Err(format!("the month {month} is out of range; {expected}"))
        }
        _ => Err(expected.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_parsed() {
        assert_eq!(parse_size("640x360"), Ok([640, 360]));
        assert_eq!(parse_mouse("1,-2.5"), Ok([1.0, -2.5, 0.0, 0.0]));
        assert_eq!(
            parse_adapter("llvm"),
            Ok(AdapterSelector::Named("llvm".to_owned()))
        );
        assert_eq!(parse_device("cpu"), Ok(DeviceSelector::Cpu));
        assert_eq!(
            parse_device("auto"),
            Ok(DeviceSelector::Gpu(AdapterSelector::Auto))
        );
        assert_eq!(parse_deny("warnings"), Ok(Deny::Warnings));
        assert_eq!(parse_deny("w0005"), Ok(Deny::Code(Code::SineHash)));
        assert!(parse_deny("E0001").is_err() && parse_deny("errors").is_err());
        for bad in ["640", "0x0", "ax3", "100000x100000", "1x-1"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_date("2020,11,1,0"), Ok([2020.0, 11.0, 1.0, 0.0]));
        for bad in ["2020,12,1,0", "2020,-1,1,0", "nan,0,1,0", "2020,nan,1,0"] {
            assert!(parse_date(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_seconds("-1.5"), Ok(-1.5_f32));
        assert!(
            ["nan", "inf", "-inf", "1e60"]
                .iter()
                .all(|bad| parse_seconds::<f32>(bad).is_err())
        );
        assert_eq!(parse_time_limit("2.5"), Ok(Duration::from_millis(2500)));
        assert_eq!(parse_time_limit("500ms"), Ok(Duration::from_millis(500)));
        for bad in ["0s", "0", "-1", "nan", "inf", "25h", "soon", ""] {
            assert!(parse_time_limit(bad).is_err(), "{bad}");
        }
        let lavapipe = "llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 22.3.6 (LLVM 15.0.6)";
        assert_eq!(short_device(lavapipe), "llvmpipe Mesa 22.3.6");
        assert_eq!(
            short_device("NVIDIA H200, NVIDIA 570.1"),
            "NVIDIA H200, NVIDIA 570.1"
        );
        assert_eq!(shell_word("a/b-1.glsl"), "a/b-1.glsl");
        assert_eq!(shell_word("Grüße.glsl"), "Grüße.glsl");
        assert!(
            parse_mouse("1,2,3").is_err() && parse_date("2026,1").is_err() && parse_numbers("1,b").is_err()
        );
    }
}
