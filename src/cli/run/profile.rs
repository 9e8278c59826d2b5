//! `toyproof run --profile`: the operations of a shader by function and line, and what is never executed.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use serde::Serialize;
use toyproof_diagnostic::{FileId, Files, columns, grouped, path_name, plural, printable};
use toyproof_eval::Settings;
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::Frame;
use toyproof_player::{Source, Target};
use toyproof_project::PassKind;
use toyproof_report::{ProfiledPass, profile_csv, profile_html};
use toyproof_verify::profile::{LineProfile, ShaderProfile};

use super::{Args, Runner, check_evaluated, evaluation_error};
use crate::cli::CliError;
use crate::cli::inputs::Format;
use crate::cli::shader::Shader;

#[derive(Debug, clap::Args)]
pub(super) struct ProfileArgs {
    /// Count the operations of each function and line, and list what is never executed; also to FILE (.html or
    /// .csv)
    ///
    /// The operations of the image in float32 are counted on the CPU, before any optimization: one for each
    /// component, and for functions such as sin those that compute them in strict images. The page has the source
    /// with the operations of each line. Very slow images are sampled in a grid of tiles.
    #[arg(
        long,
        value_name = "FILE",
        num_args = 0..=1,
        require_equals = true,
        conflicts_with_all = ["frames", "duration", "samples", "tile", "precision"],
        help_heading = "Performance"
    )]
    #[expect(
        clippy::option_option,
        reason = "clap's type of a flag whose value may be left out"
    )]
    pub(super) profile: Option<Option<PathBuf>>,
}

impl ProfileArgs {
    /// The file of the profile, if it is written.
    fn file(&self) -> Option<&Path> {
        self.profile.as_ref()?.as_deref()
    }
}

/// Checks that there is one image whose operations can be counted, and that the file can have them.
pub(super) fn check(args: &Args, is_one: bool, output: &Path) -> Result<(), CliError> {
    check_evaluated(args, "--profile")?;
    if !is_one {
        return Err(CliError::new("--profile takes one shader").with_help("name its image with -o"));
    }
    if output == Path::new("-") {
        let error = CliError::new("standard output takes an image, not a profile beside it");
        return Err(error.with_help("name a file with -o"));
    }
    match args.profile.file() {
        Some(file) if FileFormat::new(file).is_none() => {
            let error = CliError::new(format_args!("a profile cannot be written as {}", path_name(file)));
            Err(error.with_help("name a file that ends in .html or .csv"))
        }
        _ => Ok(()),
    }
}

/// The format of a profile's file.
enum FileFormat {
    Html,
    Csv,
}

impl FileFormat {
    fn new(file: &Path) -> Option<Self> {
        let extension = file.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "html" | "htm" => Some(Self::Html),
            "csv" => Some(Self::Csv),
            _ => None,
        }
    }
}

/// A pass that is profiled.
pub(super) struct Pass<'a> {
    pub(super) target: Target,
    pub(super) checked: &'a Checked,
    /// The frame with what its channels read.
    pub(super) frame: Frame,
    pub(super) inputs: [Option<Source>; 4],
}

/// A profile, as JSON has it.
#[derive(Debug, Serialize)]
pub(super) struct WrittenProfile {
    passes: Vec<WrittenPass>,
    /// The passes that no other pass reads in this frame.
    never_read: Vec<String>,
}

#[derive(Debug, Serialize)]
struct WrittenPass {
    /// The name; `None` for the only pass.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    pixels: u64,
    /// Of the rows and columns of tiles, every which one was run.
    step: u32,
    operations: u64,
    /// The largest number of operations of a pixel.
    largest: u64,
    /// The first such pixel: x from the left, y from the bottom.
    at: [u32; 2],
    functions: Vec<WrittenFunction>,
    lines: Vec<WrittenLine>,
    never_executed: Vec<WrittenPart>,
    never_called: Vec<String>,
    never_read: Vec<String>,
}

#[derive(Debug, Serialize)]
struct WrittenFunction {
    name: String,
    calls: u64,
    own: u64,
    total: u64,
}

#[derive(Debug, Serialize)]
struct WrittenLine {
    file: String,
    line: usize,
    operations: u64,
    executions: Option<u64>,
}

#[derive(Debug, Serialize)]
struct WrittenPart {
    file: String,
    line: usize,
    what: &'static str,
}

impl WrittenPass {
    fn new(pass: &ProfiledPass<'_>, files: &Files) -> Self {
        let profile = pass.profile;
        let functions = profile.functions.iter().map(|function| WrittenFunction {
            name: function.name.clone(),
            calls: function.calls,
            own: function.own,
            total: function.total,
        });
        let lines = profile.lines.iter().map(|line| WrittenLine {
            file: files.get(line.file).name().to_owned(),
            line: line.line,
            operations: line.operations,
            executions: line.executions,
        });
        let parts = profile.unexecuted.iter().map(|part| WrittenPart {
            file: files.name(part.at).to_owned(),
            line: files.position(part.at).line,
            what: part.description(),
        });
        Self {
            name: pass.name.map(str::to_owned),
            pixels: profile.pixels,
            step: profile.step,
            operations: profile.operations,
            largest: profile.largest.0,
            at: profile.largest.1,
            functions: functions.collect(),
            lines: lines.collect(),
            never_executed: parts.collect(),
            never_called: profile.uncalled.clone(),
            never_read: profile.unread.clone(),
        }
    }
}

/// The number of lines that are printed without --verbose.
const MAX_LINES: usize = 10;

impl Runner<'_> {
    /// Counts the operations of passes, prints them and writes them to the file.
    pub(super) fn write_profile(&mut self, shader: &Shader, passes: &[Pass<'_>]) -> Result<(), CliError> {
        if self.args.profile.profile.is_none() {
            return Ok(());
        }
        let bar = self.terminal.bar(passes.len() as u64, "passes");
        let profiles = passes.iter().map(|pass| {
            let profile = self.profile(shader, pass);
            bar.inc(1);
            profile
        });
        let profiles: Result<Vec<_>, _> = profiles.collect();
        bar.finish_and_clear();
        let profiles = profiles?;
        let names: Vec<_> = passes.iter().map(|pass| pass.target.to_string()).collect();
        let name = |at: usize| (names.len() > 1).then(|| names[at].as_str());
        let profiled = passes
            .iter()
            .zip(&profiles)
            .enumerate()
            .map(|(at, (pass, profile))| ProfiledPass {
                name: name(at),
                profile,
                sources: sources(pass.checked, &shader.files),
            });
        let profiled: Vec<_> = profiled.collect();
        let unread = unread_passes(shader, passes, &profiles);
        if let Some(path) = self.args.profile.file() {
            let text = match FileFormat::new(path) {
                Some(FileFormat::Html) => profile_html(&shader.name, &profiled, &shader.files),
                _ => profile_csv(&profiled, &shader.files),
            };
            self.terminal.write(path, text.as_bytes())?;
            self.terminal.confirm(path, "operations of each line");
        }
        if self.args.format == Format::Json {
            let written = profiled.iter().map(|pass| WrittenPass::new(pass, &shader.files));
            let profile = WrittenProfile {
                passes: written.collect(),
                never_read: unread,
            };
            if let Some(image) = self.images.last_mut() {
                image.profile = Some(profile);
            }
            return Ok(());
        }
        for pass in &profiled {
            self.print_profile(pass, &shader.files);
        }
        if !unread.is_empty() {
            self.terminal.result(&format!(
                "never read by another pass in this frame: {}",
                unread.join(", ")
            ));
        }
        Ok(())
    }

    fn profile(&self, shader: &Shader, pass: &Pass<'_>) -> Result<ShaderProfile, CliError> {
        let failed = |failure| evaluation_error(&failure, shader);
        let limit = self.args.driver.explicit_timeout();
        let program = Program::within(pass.checked, limit).map_err(|refusal| failed(refusal.into()))?;
        let settings = Settings {
            deadline: Some(Instant::now() + limit),
            interrupt: Some(self.terminal.interrupt_flag()),
            ..Settings::plain()
        };
        let profile = program.profile(&pass.frame, &settings);
        if self.terminal.interrupt_flag().load(Ordering::Relaxed) {
            return Err(CliError::silent());
        }
        let profile = profile.map_err(failed)?;
        Ok(ShaderProfile::new(
            &profile,
            pass.checked,
            &shader.files,
            &pass.frame,
        ))
    }

    /// Prints the tables of a pass.
    fn print_profile(&self, pass: &ProfiledPass<'_>, files: &Files) {
        let profile = pass.profile;
        let print = |line: &str| self.terminal.result(line);
        let (most, [x, y]) = profile.largest;
        let name = pass.name.map_or_else(String::new, |name| format!("{name}: "));
        print(&format!(
            "{name}{} operations per pixel, at most {} at ({x}, {y}){}",
            mean(profile.per_pixel(profile.operations)),
            grouped(most),
            sampled(profile)
        ));
        for line in function_table(profile) {
            print(&line);
        }
        let is_several = profile
            .lines
            .iter()
            .any(|line| line.file != profile.lines[0].file);
        let count = if self.terminal.is_verbose() {
            usize::MAX
        } else {
            MAX_LINES
        };
        for line in line_table(profile, files, count, is_several) {
            print(&line);
        }
        if let more @ 1.. = profile.lines.len().saturating_sub(count) as u64 {
            print(&format!(
                "  and {} more {}, which --verbose shows",
                grouped(more),
                plural(more, "line", "lines")
            ));
        }
        for line in unused(profile, files, is_several) {
            print(&line);
        }
    }
}

/// A mean of counts: whole if it is large.
fn mean(value: f64) -> String {
    if value >= 100.0 {
        grouped(value.round() as u64)
    } else {
        format!("{value:.1}")
    }
}

fn sampled(profile: &ShaderProfile) -> String {
    match profile.step {
        1 => String::new(),
        step => format!(
            " (in {} pixels, a grid of every {}th tile in each direction)",
            grouped(profile.pixels),
            step
        ),
    }
}

fn share(profile: &ShaderProfile, operations: u64) -> String {
    format!("{:.1} %", profile.share(operations))
}

fn function_table(profile: &ShaderProfile) -> Vec<String> {
    let header = ["function", "total", "own", "calls per pixel"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    rows.extend(profile.functions.iter().map(|function| {
        vec![
            function.name.clone(),
            share(profile, function.total),
            share(profile, function.own),
            mean(profile.per_pixel(function.calls)),
        ]
    }));
    columns("  ", &rows, &[1, 2, 3])
}

fn line_table(profile: &ShaderProfile, files: &Files, count: usize, is_several: bool) -> Vec<String> {
    let header = ["line", "share", "per pixel", "executed", ""];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    rows.extend(profile.lines.iter().take(count).map(|line| {
        vec![
            line_name(line, files, is_several),
            share(profile, line.operations),
            mean(profile.per_pixel(line.operations)),
            line.executions.map_or_else(String::new, |count| {
                format!("{}×", mean(profile.per_pixel(count)))
            }),
            source_text(line, files),
        ]
    }));
    columns("  ", &rows, &[0, 1, 2, 3])
}

fn line_name(line: &LineProfile, files: &Files, is_several: bool) -> String {
    if is_several {
        format!("{}:{}", file_name(files.get(line.file).name()), line.line)
    } else {
        line.line.to_string()
    }
}

/// The last part of a path.
fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// The largest number of characters of a line that are printed.
const MAX_TEXT: usize = 60;

fn source_text(line: &LineProfile, files: &Files) -> String {
    let file = files.get(line.file);
    let range = file.line_range(line.line - 1).unwrap_or_default();
    let text = file.text()[range].trim();
    let shown: String = text.chars().take(MAX_TEXT).collect();
    let rest = if shown.len() < text.len() { " …" } else { "" };
    format!("{}{rest}", printable(&shown))
}

/// What no pixel executed, called or read.
fn unused(profile: &ShaderProfile, files: &Files, is_several: bool) -> Vec<String> {
    let mut lines = Vec::new();
    for part in &profile.unexecuted {
        let file = if is_several {
            format!("{}, ", file_name(files.name(part.at)))
        } else {
            String::new()
        };
        let line = files.position(part.at).line;
        lines.push(format!("  {file}line {line}: {}", part.description()));
    }
    if !lines.is_empty() {
        lines.insert(0, "never in this frame:".to_owned());
    }
    for (what, names) in [("called", &profile.uncalled), ("read", &profile.unread)] {
        if !names.is_empty() {
            lines.push(format!("never {what} in this frame: {}", names.join(", ")));
        }
    }
    lines
}

/// The files that the source of a shader consists of.
fn sources(checked: &Checked, files: &Files) -> Vec<FileId> {
    files.parts(checked.tree[checked.main_image].at.span.file)
}

/// The buffers and the cube map of a project of which no other pass reads a texel in this frame.
fn unread_passes(shader: &Shader, rendered: &[Pass<'_>], profiles: &[ShaderProfile]) -> Vec<String> {
    let is_read = |target: Target| {
        let mut others = rendered
            .iter()
            .zip(profiles)
            .filter(|(pass, _)| pass.target != target);
        others.any(|(pass, profile)| {
            let mut channels = pass.inputs.iter().zip(profile.samples_channel);
            channels.any(|(input, is_sampled)| match input {
                Some(Source::Buffer(number)) => is_sampled && target == Target::Buffer(*number),
                _ => false,
            })
        })
    };
    let passes = shader
        .project()
        .into_iter()
        .flat_map(|compiled| &compiled.project.passes);
    let unread = passes.filter(|pass| {
        let is_buffer = !matches!(pass.kind, PassKind::Image | PassKind::Sound);
        is_buffer && !is_read(pass.kind.target())
    });
    unread.map(|pass| pass.kind.to_string()).collect()
}
