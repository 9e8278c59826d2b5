//! Measures how long the language server takes from a keystroke to the diagnostics of the text: the program
//! is run as an editor runs it.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::{Value, json};
use toyproof_testkit::lsp::Client;

use crate::front_end::of_folder;
use crate::projects;

/// The arguments of the task.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A folder of shaders, or the git directory of a repository with ShaderToy's JSON files
    input: PathBuf,
    /// The number of shaders, the longest ones
    #[arg(long, default_value_t = 50)]
    limit: usize,
    /// The number of keystrokes in each
    #[arg(long, default_value_t = 40)]
    keystrokes: usize,
    /// The program [default: the one beside this task]
    #[arg(long)]
    program: Option<PathBuf>,
}

/// Measures the times, and prints their median and the longest.
pub(super) fn measure(arguments: &Arguments) {
    let beside = || {
        let task = std::env::current_exe().expect("this program has a path");
        task.with_file_name("toyproof")
    };
    let program = arguments.program.clone().unwrap_or_else(beside);
    let shaders = longest(&arguments.input, arguments.limit);
    let mut server = Client::start(&program);
    server.initialize(None, &json!({}), &Value::Null);
    let mut all = Vec::new();
    println!("{:>8} {:>8} {:>8}  shader", "bytes", "median", "worst");
    for (index, (name, text)) in shaders.iter().enumerate() {
        let uri = format!("untitled:{index}.glsl");
        let mut times = keystrokes(&mut server, &uri, text, arguments.keystrokes);
        times.sort_by(f64::total_cmp);
        println!(
            "{:>8} {:>8.2} {:>8.2}  {name}",
            text.len(),
            times[times.len() / 2],
            times[times.len() - 1]
        );
        all.append(&mut times);
    }
    server.shut_down();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all[((all.len() - 1) as f64 * share) as usize];
    println!(
        "{} keystrokes: median {:.2} ms, 99 % {:.2} ms, worst {:.2} ms",
        all.len(),
        at(0.5),
        at(0.99),
        at(1.0)
    );
}

/// The longest shaders, with their names.
fn longest(input: &Path, limit: usize) -> Vec<(String, String)> {
    let mut shaders = if input.join("HEAD").is_file() {
        let tabs = projects::texts(input, 1).filter_map(|(name, json)| Some((name, image(&json)?)));
        tabs.collect::<Vec<_>>()
    } else {
        of_folder(input)
    };
    shaders.sort_by_key(|(name, text)| (usize::MAX - text.len(), name.clone()));
    shaders.truncate(limit);
    shaders
}

/// The text that is compiled for the Image tab of a project of the site.
fn image(json: &str) -> Option<String> {
    let root: Value = serde_json::from_str(json).ok()?;
    let root = root.get("Shader").or(root.get(0)).unwrap_or(&root);
    let passes = root.get("renderpass")?.as_array()?;
    let code = |kind: &str| {
        let pass = passes.iter().find(|pass| pass["type"] == kind)?;
        pass["code"].as_str()
    };
    let common = code("common").map(|common| format!("{common}\n"));
    Some(common.unwrap_or_default() + code("image")?)
}

/// The times from a keystroke to the diagnostics, in ms: characters are typed into names and deleted, at
/// places over the whole text.
fn keystrokes(server: &mut Client, uri: &str, text: &str, count: usize) -> Vec<f64> {
    server.open(uri, text);
    server.diagnostics(uri, 1);
    let lines: Vec<&str> = text.lines().collect();
    let mut times = Vec::with_capacity(count);
    for stroke in 0..count {
        // Every second keystroke deletes what the one before it typed.
        let line = (stroke / 2 * 2 + 1) * lines.len() / (count + 1);
        let column = lines[line].find(|c: char| c.is_ascii_alphabetic()).unwrap_or(0);
        let before = lines[line][..column].encode_utf16().count();
        let at = |character: usize| json!({"line": line, "character": character});
        let (end, typed) = if stroke % 2 == 0 {
            (before, "q")
        } else {
            (before + 1, "")
        };
        let change = json!({"range": {"start": at(before), "end": at(end)}, "text": typed});
        let version = stroke + 2;
        let document = json!({"uri": uri, "version": version});
        let start = Instant::now();
        server.notify(
            "textDocument/didChange",
            &json!({"textDocument": document, "contentChanges": [change]}),
        );
        server.diagnostics(uri, version as i64);
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    server.notify("textDocument/didClose", &json!({"textDocument": {"uri": uri}}));
    times
}
