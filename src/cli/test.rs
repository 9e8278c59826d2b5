//! `toyproof test`: tests of single functions.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use toyproof_classroom::function_test::{
    FunctionTest, Precision, SUFFIX, ShaderTests, Subject, TestError, TestFile, TestRecord, TestReport,
    comment_tests, is_test_file,
};
use toyproof_diagnostic::{Deadline, File, Files, grouped, path_name, plural};
use toyproof_image::output;
use toyproof_project::files::{self, Input, ReadError};

use super::inputs::{Format, LanguageArgs, parse_time_limit};
use super::shader::{Shader, Unusable, find, parse_named};
use super::{CliError, Exit, Terminal};

/// Test single functions of shaders
///
/// A test calls a function and compares its result, or checks a property for sampled arguments. It is written
/// in a comment of the shader (`// @test f(1.0) == 2.0`), in a file beside it (NAME.test.toml), or in a file
/// that names its shader. Each test is evaluated on the CPU, in float32 and in double precision.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Tests in comments:
  // @test disk(vec2(3.0, 0.0), 1.0) == 2.0
  // @test disk(p, 1.0) == disk(-p, 1.0) +- 1e-6 for p in [-2, 2]
  // @test |normalAt(p)| == 1 for p in [-2, 2] after makeScene()
  // @test fresnel(x) in [0, 1] for x in [0, 1]
  // @test fresnel(x) is decreasing for x in [0, 1]

Examples:
  toyproof test mine.glsl
  toyproof test disk.test.toml
  toyproof test disk.test.toml homework/*.glsl --out results

Exit code: 0 if all tests pass, 1 if one fails, 2 if there are none or one is invalid.")]
pub(super) struct Args {
    /// Shaders with tests (files, folders, or - for standard input), or files of tests (.toml)
    ///
    /// With a file of tests and shaders, each shader is tested with the file. Otherwise a shader's own tests
    /// are those in its comments and in NAME.test.toml beside it.
    #[arg(required = true, value_name = "SHADER|FILE.test.toml")]
    inputs: Vec<PathBuf>,
    /// The number types in which functions are evaluated, if a test does not choose
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = PrecisionArg::Both)]
    precision: PrecisionArg,
    /// Write tests.json and junit.xml into this folder
    #[arg(short, long, value_name = "DIR", help_heading = "Reports")]
    out: Option<PathBuf>,
    /// The format of standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output")]
    format: Format,
    /// The time limit of a test: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", value_parser = parse_time_limit, default_value = "10s")]
    timeout: Duration,
    #[command(flatten)]
    language: LanguageArgs,
}

/// The number types of an evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PrecisionArg {
    F32,
    F64,
    Both,
}

impl From<PrecisionArg> for Precision {
    fn from(precision: PrecisionArg) -> Self {
        match precision {
            PrecisionArg::F32 => Self::Single,
            PrecisionArg::F64 => Self::Double,
            PrecisionArg::Both => Self::Both,
        }
    }
}

/// The name of the report for programs in the folder of `--out`.
const TESTS: &str = "tests.json";
/// The name of the report for continuous integration in the folder of `--out`.
const JUNIT: &str = "junit.xml";

/// A shader, and where its tests are.
struct Task {
    shader: Result<Input, ReadError>,
    tests: Source,
}

/// Where the tests of a shader are.
enum Source {
    /// In its comments, and in the file beside it if that exists.
    Own,
    /// In these files.
    Files(Vec<PathBuf>),
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let tasks = tasks(args, terminal)?;
    let mut all = Vec::new();
    let mut exit = Exit::Success;
    let mut untested = Vec::new();
    for task in &tasks {
        match args.test(task, terminal) {
            Ok(tested) if tested.tests.is_empty() => untested.push(tested.shader),
            Ok(tested) => {
                if args.format == Format::Human {
                    print(&tested, terminal);
                }
                all.push(tested);
            }
            Err(error) => exit = exit.max(terminal.fail(&error)),
        }
    }
    let report = TestReport::new(all);
    if report.tests().next().is_none() && exit == Exit::Success {
        return Err(without_tests(&untested));
    }
    if args.format == Format::Json {
        terminal.stream(|out| report.json(out))?;
    } else if report.tests().next().is_some() {
        summarize(&report, &untested, terminal);
    }
    if let Some(folder) = &args.out {
        write(&report, folder)?;
        terminal.note(&format!("results: {}", path_name(&folder.join(JUNIT))));
    }
    for test in report.tests().filter(|test| !test.is_passed()) {
        exit = exit.max(if test.is_error() {
            Exit::Error
        } else {
            Exit::ShaderFault
        });
    }
    Ok(exit)
}

/// The shaders that the arguments name, with their tests.
fn tasks(args: &Args, terminal: &Terminal) -> Result<Vec<Task>, CliError> {
    let is_toml = |path: &&PathBuf| {
        let extension = path.extension().map(OsStr::to_ascii_lowercase);
        extension.is_some_and(|extension| extension == "toml") && !path.is_dir()
    };
    let (test_files, shaders): (Vec<_>, Vec<_>) = args.inputs.iter().partition(is_toml);
    let shaders: Vec<PathBuf> = shaders.into_iter().cloned().collect();
    if test_files.is_empty() {
        let found = find(&shaders, terminal).into_iter();
        return Ok(found
            .map(|shader| Task {
                shader,
                tests: Source::Own,
            })
            .collect());
    }
    if shaders.is_empty() {
        let mut tasks = Vec::new();
        for file in test_files {
            let shader = shader_of(file)?;
            tasks.extend(find(&[shader], terminal).into_iter().map(|shader| Task {
                shader,
                tests: Source::Files(vec![file.clone()]),
            }));
        }
        return Ok(tasks);
    }
    // Errors in the files are reported once, before the first shader.
    for file in &test_files {
        parse_named(file, |files, id| TestFile::parse(files, id, folder(file)))?;
    }
    let files: Vec<_> = test_files.into_iter().cloned().collect();
    let found = find(&shaders, terminal).into_iter();
    Ok(found
        .map(|shader| Task {
            shader,
            tests: Source::Files(files.clone()),
        })
        .collect())
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The shader that a test file names, or that lies beside it.
fn shader_of(path: &Path) -> Result<PathBuf, CliError> {
    let tests = parse_named(path, |files, id| TestFile::parse(files, id, folder(path)))?;
    if let Some(shader) = tests.shader {
        return Ok(shader);
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    let stem = name
        .as_deref()
        .and_then(|name| name.get(..name.len().checked_sub(SUFFIX.len())?));
    let stem = stem.filter(|_| is_test_file(path));
    let beside = stem.and_then(|stem| {
        let project = folder(path).join(stem);
        let extensions = files::EXTENSIONS.into_iter().chain(["json"]);
        let mut shaders = extensions.map(|extension| folder(path).join(format!("{stem}.{extension}")));
        shaders
            .find(|path| path.is_file())
            .or_else(|| files::is_project(&project).then_some(project))
    });
    beside.ok_or_else(|| {
        CliError::new(format_args!(
            "{} names no shader, and no shader is beside it",
            path_name(path)
        ))
        .with_help(
            "add `shader = \"mine.glsl\"` at the top of the file, or name the shader on the command line",
        )
    })
}

/// The test file that lies beside a shader or a project.
fn beside(shader: &Input) -> Option<PathBuf> {
    let path = shader.path()?;
    let mut name = path.file_stem()?.to_owned();
    name.push(SUFFIX);
    let path = path.with_file_name(name);
    path.is_file().then_some(path)
}

impl Args {
    /// Tests a shader.
    fn test(&self, task: &Task, terminal: &Terminal) -> Result<ShaderTests, CliError> {
        let mut shader = Shader::load(&task.shader, &self.language, Deadline::after(self.timeout));
        let mut tests = Vec::new();
        let test_files = match (&task.tests, &task.shader) {
            (Source::Files(files), _) => files.clone(),
            (Source::Own, Ok(input)) => beside(input).into_iter().collect(),
            (Source::Own, Err(_)) => Vec::new(),
        };
        let name = shader.name.clone();
        let of = |tests| ShaderTests { shader: name, tests };
        for path in &test_files {
            let text = files::read_named(path)?;
            tests.extend(parse(text, path, &mut shader.files)?);
        }
        let checked = match shader.image() {
            Ok(checked) => checked,
            Err(Unusable::Unreadable(error)) => return Err(CliError::new(error)),
            Err(Unusable::Invalid(errors)) => {
                terminal.diagnostics(errors, &shader.files);
                return Ok(of(vec![TestRecord::invalid(errors, &shader.files)]));
            }
        };
        let subject = Subject {
            checked,
            files: &shader.files,
            text: shader.text(checked),
            timeout: self.timeout,
        };
        if matches!(task.tests, Source::Own) {
            match comment_tests(&subject) {
                Ok(commented) => tests.extend(commented),
                Err(errors) => {
                    terminal.diagnostics(&errors, &shader.files);
                    return Ok(of(vec![TestRecord::unreadable(&errors, &shader.files)]));
                }
            }
        }
        let mut records = Vec::new();
        for test in &tests {
            for result in test.results(&subject, self.precision.into()) {
                records.push(TestRecord::new(&test.name, &result, &shader.files));
                if let Err(TestError::Test(errors)) = &result.runs {
                    terminal.diagnostics(errors, &shader.files);
                }
            }
        }
        Ok(of(records))
    }
}

/// Parses a test file beside the files of the shader, so that diagnostics on either are shown.
fn parse(text: File, path: &Path, files: &mut Files) -> Result<Vec<FunctionTest>, CliError> {
    let file = files.add(text);
    let tests = TestFile::parse(files, file, folder(path));
    let tests = tests.map_err(|errors| CliError::diagnostics(errors, files))?;
    Ok(tests.functions)
}

/// The error of a command without tests.
fn without_tests(shaders: &[String]) -> CliError {
    let error = match shaders {
        [shader] => format!("{shader} has no tests"),
        _ => "none of the shaders has tests".to_owned(),
    };
    CliError::new(error).with_help(
        "write a comment such as `// @test f(1.0) == 2.0` beside a function, or a file NAME.test.toml beside the \
         shader; `toyproof test --help` shows more",
    )
}

fn print(tested: &ShaderTests, terminal: &Terminal) {
    for test in &tested.tests {
        if test.is_passed() && terminal.is_quiet() {
            continue;
        }
        let place = match test.place() {
            place if place.is_empty() => tested.shader.clone(),
            place => place,
        };
        terminal.result(&format!("{:<7} {place}  {}", test.status, test.test));
        // The diagnostics of an invalid test have been printed.
        if !test.message.is_empty() && test.diagnostics.is_empty() {
            terminal.result(&format!("        {}", test.message));
        }
    }
}

/// Prints the counts.
fn summarize(report: &TestReport, untested: &[String], terminal: &Terminal) {
    let all = report.tests().count() as u64;
    let passed = report.tests().filter(|test| test.is_passed()).count() as u64;
    let errors = report.tests().filter(|test| test.is_error()).count() as u64;
    let mut counts = Vec::new();
    for (count, word) in [
        (passed, "passed"),
        (all - passed - errors, "failed"),
        (errors, "invalid"),
    ] {
        if count > 0 {
            counts.push(format!("{} {word}", grouped(count)));
        }
    }
    terminal.note(&format!(
        "\n{} {}: {}",
        grouped(all),
        plural(all, "test", "tests"),
        counts.join(", ")
    ));
    if !untested.is_empty() {
        let count = untested.len() as u64;
        terminal.note(&format!(
            "{} {} no tests",
            grouped(count),
            plural(count, "shader has", "shaders have")
        ));
    }
}

fn write(report: &TestReport, folder: &Path) -> Result<(), CliError> {
    let path = folder.join(JUNIT);
    let written = output::stream_inside(folder, &path, |out| report.junit(out));
    written.map_err(|error| format!("cannot write {error}"))?;
    let path = folder.join(TESTS);
    let written = output::stream_inside(folder, &path, |out| report.json(out));
    Ok(written.map_err(|error| format!("cannot write {error}"))?)
}
