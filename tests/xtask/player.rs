//! Plays ShaderToy's projects in Chromium by the rules of the site's own page: the judge of `toyproof run`.
//!
//! A folder of results has `frame-0007-image.f32`, `frame-0007-buffer-a.f32` and so on: RGBA as 32-bit
//! floats, little endian, bottom row first; the six faces of `cube-a` are stacked. `sound.s16` has the samples
//! of the Sound tab in 16 bits, little endian, left before right. Its `player.json` has the size, the passes,
//! the frames, the tabs that do not compile with the messages of the compiler, and `failure`: why frames are
//! missing.
//!
//! A list has a line of JSON per project: `{"project": "a.json", "out": "a", "size": [64, 36], "frames": [0,
//! 7]}`. Only `project` is required. The default of `out` is the name of the file, below `--out`.

mod media;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use clap::Args;
use serde_json::{Value, json};
use toyproof::diagnostic::path_name;
use toyproof_testkit::devtools::Page;

use self::media::Media;

/// WebGL 2 on the bundled software driver. The time limit of a project is ours.
const SWITCHES: [&str; 4] = [
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-watchdog",
];

/// The frames in a second, as the page has them.
const FRAMES_PER_SECOND: f64 = 60.0;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A project: ShaderToy's JSON
    #[arg(required_unless_present = "list")]
    project: Option<PathBuf>,
    /// A file with a line of JSON for each project
    #[arg(long, conflicts_with = "project")]
    list: Option<PathBuf>,
    /// The size of the canvas
    #[arg(long, default_value = "64x36", value_parser = parse_size)]
    size: [u64; 2],
    /// The frames to write
    #[arg(long, default_value = "0", value_delimiter = ',')]
    frames: Vec<u64>,
    /// The passes to write; all by default
    #[arg(long, value_delimiter = ',')]
    passes: Vec<String>,
    /// The blocks of the Sound tab to write, of 512×512 samples
    #[arg(long, default_value_t = 0)]
    sound: u64,
    /// The folder of the results
    #[arg(long)]
    out: PathBuf,
    /// The time limit of a project, in seconds
    #[arg(long, default_value_t = 30.0)]
    timeout: f64,
}

fn parse_size(text: &str) -> Result<[u64; 2], String> {
    let numbers = text
        .split_once('x')
        .map(|(width, height)| [width, height].map(str::parse));
    match numbers {
        Some([Ok(width), Ok(height)]) => Ok([width, height]),
        _ => Err("write the size as 64x36".to_owned()),
    }
}

/// A project, and what to render of it.
#[derive(Debug)]
struct Job {
    project: PathBuf,
    out: PathBuf,
    size: [u64; 2],
    frames: Vec<u64>,
}

impl Job {
    /// Reads a line of a list.
    fn parse(line: &str, defaults: &Arguments) -> Self {
        let line: Value = serde_json::from_str(line).expect("a line is JSON");
        let project = PathBuf::from(line["project"].as_str().expect("a line has a project"));
        let out = match line["out"].as_str() {
            Some(out) => defaults.out.join(out),
            None => defaults.out.join(project.file_stem().expect("it is a file")),
        };
        let numbers = |key: &str| serde_json::from_value::<Vec<u64>>(line[key].clone()).ok();
        let size = numbers("size").map_or(defaults.size, |size| {
            size.try_into().expect("a size has two numbers")
        });
        let frames = numbers("frames").unwrap_or_else(|| defaults.frames.clone());
        Self {
            project,
            out,
            size,
            frames,
        }
    }
}

/// The player's page, in a browser that is started anew after each failure.
struct Player {
    chromium: PathBuf,
    file: PathBuf,
    page: Option<Page>,
}

impl Player {
    fn new() -> Self {
        Self {
            chromium: toyproof::gpu::browser::find().expect("Chromium is installed"),
            file: Path::new(env!("CARGO_MANIFEST_DIR")).join("player/player.html"),
            page: None,
        }
    }

    /// Renders a project into its folder, and returns the record of it.
    fn play(&mut self, job: &Job, arguments: &Arguments) -> Value {
        let mut record =
            json!({ "project": job.project, "size": job.size, "passes": [], "frames": [], "errors": [] });
        let mut project: Value = match read_json(&job.project) {
            Ok(project) => project,
            Err(failure) => {
                record["failure"] = failure.into();
                return record;
            }
        };
        // A new document has a new context: nothing is left of the project before.
        let mut page = self
            .page
            .take()
            .unwrap_or_else(|| Page::with(&self.chromium, &SWITCHES));
        page.open(&self.file);
        let media = Media::of(&mut project);
        match render(&mut page, job, arguments, (&project, &media), &mut record) {
            Ok(()) => self.page = Some(page),
            Err(failure) => record["failure"] = failure.into(),
        }
        record
    }
}

fn read_json(file: &Path) -> Result<Value, String> {
    let text = fs::read_to_string(file).map_err(|error| error.to_string())?;
    serde_json::from_str(&text).map_err(|error| error.to_string())
}

/// Renders a project, and adds what is done to its record.
fn render(
    page: &mut Page,
    job: &Job,
    arguments: &Arguments,
    (project, media): (&Value, &Media),
    record: &mut Value,
) -> Result<(), String> {
    let deadline = Instant::now() + Duration::from_secs_f64(arguments.timeout);
    let mut value = |script: &str| page.try_value(script, deadline.saturating_duration_since(Instant::now()));
    let size = json!(job.size);
    let loaded = value(&format!(
        "load({project}, {size}, {})",
        Value::from(media.stills.clone())
    ))?;
    record["passes"] = loaded["passes"].clone();
    record["errors"] = loaded["errors"].clone();
    if loaded["errors"] != json!([]) {
        return Ok(());
    }
    let names = loaded["passes"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str);
    let is_written =
        |name: &&str| arguments.passes.is_empty() || arguments.passes.iter().any(|pass| pass == name);
    let names: Vec<&str> = names.filter(is_written).collect();
    let frames: BTreeSet<u64> = job.frames.iter().copied().collect();
    let mut rendered = 0..;
    for &frame in &frames {
        let steps = rendered.by_ref().take_while(|&step| step < frame);
        for step in steps
            .chain([frame])
            .filter(|&step| step == frame || media.has_films())
        {
            let time = (step as f64 / FRAMES_PER_SECOND) as f32;
            value(&format!("render({step}, {})", media.films(time)))?;
        }
        for pass in &names {
            let file = job.out.join(format!("frame-{frame:04}-{pass}.f32"));
            write(&file, &value(&format!("pixels({pass:?})"))?);
        }
        let written = record["frames"].as_array_mut().expect("it is an array");
        written.push(json!(frame));
    }
    if arguments.sound > 0 {
        let samples = value(&format!("sound({})", arguments.sound))?;
        write(&job.out.join("sound.s16"), &samples);
    }
    Ok(())
}

/// Writes the bytes that the page returns.
fn write(file: &Path, base64: &Value) {
    let bytes = BASE64_STANDARD.decode(base64.as_str().expect("it is text"));
    fs::write(file, bytes.expect("it is base64")).expect("the folder is writable");
}

/// Renders one project or those of a list, and prints a line for each.
pub(super) fn play(arguments: &Arguments) {
    let jobs: Vec<Job> = match (&arguments.project, &arguments.list) {
        (Some(project), _) => vec![Job {
            project: project.clone(),
            out: arguments.out.clone(),
            size: arguments.size,
            frames: arguments.frames.clone(),
        }],
        (None, list) => {
            let list = list.as_ref().expect("clap requires it");
            let list = fs::read_to_string(list).expect("the list is readable");
            list.lines().map(|line| Job::parse(line, arguments)).collect()
        }
    };
    let mut player = Player::new();
    for job in &jobs {
        fs::create_dir_all(&job.out).expect("the folder is writable");
        let start = Instant::now();
        let record = player.play(job, arguments);
        fs::write(job.out.join("player.json"), format!("{record:#}\n")).expect("the folder is writable");
        println!(
            "{}: {}, {:.1} s",
            path_name(&job.project),
            summary(&record),
            start.elapsed().as_secs_f64()
        );
    }
}

/// A record in a line.
fn summary(record: &Value) -> String {
    let frames = record["frames"].as_array().map_or(0, Vec::len);
    match (record["failure"].as_str(), &record["errors"][0]) {
        (Some(failure), _) => format!("{frames} frames, then {failure}"),
        (None, Value::Null) => format!("{frames} frames"),
        (None, error) => {
            let log = error["log"].as_str().unwrap_or_default();
            let tab = error["pass"].as_str().unwrap_or("project");
            format!("refused: {tab}: {}", log.lines().next().unwrap_or_default())
        }
    }
}
