//! How many wrong shaders are repaired, and at which lines.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;
use toyproof::diagnostic::{File, Files};
use toyproof::explain::known::Hypotheses;
use toyproof::explain::repair::{Donors, Repair, SearchOptions, SearchResult};
use toyproof::explain::{self, Options};
use toyproof::glsl::Checked;
use toyproof::image::Frame;
use toyproof::lint::Lints;
use toyproof::scene;
use toyproof::verify::{Case, Expected, Verdict};
use toyproof_testkit::faults::faults;
use toyproof_testkit::{checked, edited};

/// The size of the images.
const SIZE: [u32; 2] = [160, 90];

/// A wrong shader, and where its mistakes are.
struct Sample {
    name: String,
    group: String,
    shader: String,
    scene: PathBuf,
    /// Any of these lines counts as the mistake's.
    lines: Vec<usize>,
}

impl Sample {
    /// The number of the scene.
    fn number(&self) -> &str {
        let name = self.scene.file_stem().and_then(OsStr::to_str).unwrap_or_default();
        name.split('-').next().unwrap_or_default()
    }
}

/// Collects the expressions of the shaders of a folder whose names begin with a number.
fn read_donors(folder: &Path, number: &str) -> Donors {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the folder can be read")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| {
            path.file_name()
                .and_then(OsStr::to_str)
                .is_some_and(|name| name.starts_with(number))
        })
        .collect();
    files.sort();
    let texts = files
        .iter()
        .map(|file| fs::read_to_string(file).expect("the shader can be read"));
    let shaders: Vec<Checked> = texts.map(|text| checked(&text)).collect();
    Donors::new(&shaders)
}

/// Prints each sample's repairs, and the rates of each group. Without a manifest the samples are the planted
/// faults of the exercises; its lines are JSON objects with `file`, `scene`, `group` and `lines`. What is not
/// repaired is searched again with the expressions of correct shaders: those in the folder `correct` whose names
/// begin with the number of the scene.
pub(super) fn measure(manifest: Option<&Path>, only: &str, budget: f64, names: bool, correct: Option<&Path>) {
    let samples = match manifest {
        Some(manifest) => read(manifest),
        None => planted(),
    };
    let mut donors: BTreeMap<&str, Donors> = BTreeMap::new();
    let mut rates: BTreeMap<&str, Rates> = BTreeMap::new();
    for sample in samples
        .iter()
        .filter(|sample| sample.name.contains(only) || sample.group == only)
    {
        let of_group = rates.entry(sample.group.as_str()).or_default();
        let number = sample.number();
        let donors = correct.map(|folder| {
            donors
                .entry(number)
                .or_insert_with(|| read_donors(folder, number))
        });
        try_sample(sample, budget, names, donors.as_deref(), of_group);
    }
    for (group, rates) in &mut rates {
        rates.print(group);
    }
}

fn planted() -> Vec<Sample> {
    let samples = faults().map(|(title, exercise, edits)| {
        let shader = edited(exercise, edits);
        let before: Vec<&str> = exercise.shader.lines().collect();
        let after: Vec<&str> = shader.lines().collect();
        let same = before.iter().zip(&after).take_while(|(a, b)| a == b).count();
        Sample {
            name: format!("{}: {title}", exercise.name),
            group: "planted".to_owned(),
            scene: PathBuf::from(format!("glsl/{}.toml", exercise.name)),
            lines: (same..=same + 1).collect(),
            shader,
        }
    });
    samples.collect()
}

fn read(manifest: &Path) -> Vec<Sample> {
    let folder = manifest.parent().unwrap_or(Path::new("."));
    let text = fs::read_to_string(manifest).expect("the manifest can be read");
    let samples = text.lines().filter(|line| !line.trim().is_empty()).map(|line| {
        let case: Value = serde_json::from_str(line).expect("a JSON object for each line");
        let text = |key: &str| case[key].as_str().unwrap_or_default().to_owned();
        let lines = case["lines"].as_array().map_or(&[][..], Vec::as_slice);
        Sample {
            name: text("file"),
            group: text("group"),
            shader: fs::read_to_string(folder.join(text("file"))).expect("the shader can be read"),
            scene: PathBuf::from(format!("glsl/{}.toml", text("scene"))),
            lines: lines
                .iter()
                .filter_map(Value::as_u64)
                .map(|line| line as usize)
                .collect(),
        }
    });
    samples.collect()
}

/// The results of a group.
#[derive(Default)]
struct Rates {
    wrong: usize,
    others: usize,
    repaired: usize,
    named: usize,
    named_or_repaired: usize,
    /// Repairs whose first line, or any of whose lines, is the mistake's.
    first_line: usize,
    any_line: usize,
    /// Unrepaired shaders whose suspects include the mistake's line.
    suspects: usize,
    suspect_in_three: usize,
    times: Vec<Duration>,
}

fn try_sample(sample: &Sample, budget: f64, names: bool, donors: Option<&Donors>, rates: &mut Rates) {
    let mut files = Files::default();
    let scene_text = fs::read_to_string(&sample.scene).expect("the scene can be read");
    let scene_file = files.add(File::new("scene", scene_text));
    let scene = scene::parse(&files, scene_file).expect("the scene is valid");
    let frame = Frame {
        size: SIZE,
        ..Frame::default()
    };
    let checked = checked(&sample.shader);
    let expected = Expected::from_scene(scene.clone(), &frame);
    let hypotheses = names.then(|| Hypotheses::new(&scene, &frame)).flatten();
    let search = SearchOptions {
        source: &sample.shader,
        budget,
        donors: None,
        pass: None,
    };
    let options = Options {
        hypotheses: hypotheses.as_ref(),
        search: Some(search),
        ..Options::default()
    };
    let lints = Lints::default();
    let case = Case::new(&checked, &lints, &frame)
        .with_expected(&expected)
        .with_timeout(Duration::from_secs(20));
    let start = Instant::now();
    let findings = match explain::check(None, &case, &options) {
        Ok(findings) => findings,
        Err(failure) => {
            println!("{}: {failure}", sample.name);
            rates.others += 1;
            return;
        }
    };
    let mut found = findings.search.unwrap_or_default();
    if found.repairs.is_empty() && findings.verdict == Verdict::Wrong && donors.is_some() {
        let options = Options {
            search: Some(SearchOptions { donors, ..search }),
            ..Options::default()
        };
        let again = explain::check(None, &case, &options);
        let again = again.ok().and_then(|findings| findings.search);
        found.repairs = again.unwrap_or_default().repairs;
    }
    let time = start.elapsed();
    for panic in &findings.panics {
        println!("PANIC {}: {panic}", sample.name);
    }
    if findings.verdict != Verdict::Wrong {
        println!("{:?} {}", findings.verdict, sample.name);
        rates.others += 1;
        return;
    }
    rates.add(sample, &found, findings.mistake.is_some(), time);
}

impl Rates {
    /// Adds a wrong shader, and prints what was found.
    fn add(&mut self, sample: &Sample, search: &SearchResult, is_named: bool, time: Duration) {
        let line = |start: u32| sample.shader[..start as usize].matches('\n').count() + 1;
        let is_mistake = |start: u32| sample.lines.contains(&line(start));
        let of_repair = |repair: &Repair| repair.fix.edits.iter().any(|edit| is_mistake(edit.span.start));
        self.wrong += 1;
        self.times.push(time);
        self.repaired += usize::from(!search.repairs.is_empty());
        self.named += usize::from(is_named);
        self.named_or_repaired += usize::from(is_named || !search.repairs.is_empty());
        let first = search.repairs.first().is_some_and(of_repair);
        let any = search.repairs.iter().any(of_repair);
        self.first_line += usize::from(first);
        self.any_line += usize::from(any);
        let suspects = search
            .suspects
            .iter()
            .any(|suspect| is_mistake(suspect.span.start));
        self.suspects += usize::from(search.repairs.is_empty());
        self.suspect_in_three += usize::from(search.repairs.is_empty() && suspects);
        let mark = match (search.repairs.is_empty(), first, any) {
            (true, ..) => "NONE ",
            (_, true, _) => "first",
            (_, _, true) => "any  ",
            _ => "other",
        };
        println!(
            "{mark} {:5.2} s {} lines {:?}{}",
            time.as_secs_f64(),
            sample.name,
            sample.lines,
            if search.is_cut { " (cut)" } else { "" }
        );
        for repair in &search.repairs {
            let at = repair.fix.edits.first().map_or(0, |edit| line(edit.span.start));
            println!(
                "        {at}: {} [{}] {} of {}",
                repair.fix.message, repair.mistake.id, repair.agreeing, repair.pixels
            );
        }
        if search.repairs.is_empty() {
            let suspects: Vec<String> = search
                .suspects
                .iter()
                .map(|suspect| format!("{} ({:.2})", line(suspect.span.start), suspect.score))
                .collect();
            println!("        suspects {}", suspects.join(", "));
        }
    }

    fn print(&mut self, group: &str) {
        self.times.sort_unstable();
        let percent = |count: usize, of: usize| 100.0 * count as f64 / of.max(1) as f64;
        let time = |share: f64| {
            let at = (self.times.len() as f64 * share) as usize;
            self.times
                .get(at.min(self.times.len().saturating_sub(1)))
                .map_or(0.0, Duration::as_secs_f64)
        };
        println!(
            "{group}: {} wrong ({} others); repaired {:.1} %; at the line: first {:.1} %, any {:.1} %; \
             named {:.1} %, named or repaired {:.1} %; suspect in three {} of {}; median {:.2} s, 95 % {:.2} s, most {:.2} s",
            self.wrong,
            self.others,
            percent(self.repaired, self.wrong),
            percent(self.first_line, self.wrong),
            percent(self.any_line, self.wrong),
            percent(self.named, self.wrong),
            percent(self.named_or_repaired, self.wrong),
            self.suspect_in_three,
            self.suspects,
            time(0.5),
            time(0.95),
            time(1.0),
        );
    }
}
