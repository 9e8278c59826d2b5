//! The time from a save to the new image of `toyproof watch`, for the exercises of the course.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use toyproof_testkit::devtools::Page;
use toyproof_testkit::watching::Watch;

/// The pause before a save, in which the check of the last one is done for most shaders, as an author thinks
/// between two saves.
const PAUSE: Duration = Duration::from_secs(1);

/// The options of the measurement.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The number of saves of each shader
    #[arg(long, default_value_t = 9)]
    saves: usize,
    /// Only exercises whose names contain this
    #[arg(default_value = "")]
    exercise: String,
    /// The program
    #[arg(long, default_value = "target/release/toyproof")]
    program: PathBuf,
    /// Measure until Chromium's page has drawn the image, instead of until the server has sent it
    #[arg(long)]
    browser: bool,
}

fn milliseconds(time: Duration) -> f64 {
    1000.0 * time.as_secs_f64()
}

fn median(times: &mut [Duration]) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// Saves each exercise again and again, and prints a row for each, and the median of all saves.
pub(super) fn measure(arguments: &Arguments) {
    let program = fs::canonicalize(&arguments.program).expect("the program is built");
    let mut page = arguments.browser.then(|| {
        let chromium = toyproof::gpu::browser::find().expect("Chromium is installed");
        Page::new(&chromium)
    });
    let mut all = Vec::new();
    println!("| exercise | size | median | worst |\n|---|---|---|---|");
    let exercises = toyproof_testkit::EVERY_EXERCISE.iter();
    for exercise in exercises.filter(|exercise| exercise.name.contains(&arguments.exercise)) {
        let folder = std::env::temp_dir().join(format!("toyproof-watch-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("the folder can be created");
        let shader = folder.join("shader.glsl");
        fs::write(&shader, exercise.shader).expect("the shader can be written");
        fs::write(shader.with_extension("toml"), exercise.scene).expect("the scene can be written");
        let watch = Watch::start(&program, &folder, &["shader.glsl"]);
        let (mut times, size) = match &mut page {
            None => until_sent(&watch, &shader, exercise.shader, arguments.saves),
            Some(page) => until_drawn(&watch, page, &shader, exercise.shader, arguments.saves),
        };
        drop(watch);
        fs::remove_dir_all(&folder).expect("the folder can be removed");
        all.extend(&times);
        let worst = times.iter().max().copied().unwrap_or_default();
        println!(
            "| {} | {size} | {:.0} ms | {:.0} ms |",
            exercise.name,
            milliseconds(median(&mut times)),
            milliseconds(worst)
        );
    }
    println!(
        "median of {} saves: {:.0} ms",
        all.len(),
        milliseconds(median(&mut all))
    );
}

/// The text of a save with a number: all differ, and mean the same.
fn saved(text: &str, number: usize) -> String {
    format!("{text}// {number}\n")
}

fn until_sent(watch: &Watch, shader: &Path, text: &str, saves: usize) -> (Vec<Duration>, String) {
    let tab = watch.open_tab();
    let version = tab.next("version");
    let size: [u32; 2] = serde_json::from_value(version["frame"]["size"].clone()).expect("there is a size");
    let mut view = tab.view(size);
    for key in ["time", "frame", "mouse"] {
        view[key] = version["frame"][key].clone();
    }
    watch.image("frame", &view).expect("there is an image");
    let times = (0..saves).map(|number| {
        thread::sleep(PAUSE);
        let start = Instant::now();
        fs::write(shader, saved(text, number)).expect("the shader can be written");
        tab.next("version");
        watch.image("frame", &view).expect("there is an image");
        start.elapsed()
    });
    (times.collect(), format!("{}×{}", size[0], size[1]))
}

/// The times until the page of a browser has drawn each version.
fn until_drawn(
    watch: &Watch,
    page: &mut Page,
    shader: &Path,
    text: &str,
    saves: usize,
) -> (Vec<Duration>, String) {
    const SHOWN: &str = "document.querySelector('#images').dataset.version";
    page.open_url(&watch.url());
    page.until(&format!("{SHOWN} !== undefined"));
    let times = (0..saves).map(|number| {
        thread::sleep(PAUSE);
        let before = page.value(SHOWN);
        // The page answers once it has drawn the image.
        let drawn = format!(
            "new Promise(done => {{ const images = document.querySelector('#images'); \
             new MutationObserver((_, seen) => {{ if (images.dataset.version !== {before}) {{ seen.disconnect(); \
             requestAnimationFrame(() => done(true)) }} }}).observe(images, {{ attributes: true }}) }})"
        );
        let (path, text) = (shader.to_owned(), saved(text, number));
        let writer = thread::spawn(move || {
            // The page is waiting by then.
            thread::sleep(Duration::from_millis(200));
            let start = Instant::now();
            fs::write(path, text).expect("the shader can be written");
            start
        });
        assert_eq!(page.value(&drawn), true);
        let end = Instant::now();
        end - writer.join().expect("the shader is written")
    });
    let times = times.collect();
    let size = page.value(
        "(() => { const c = document.querySelector('#images canvas'); return [c.width, c.height] })()",
    );
    let number = |at: usize| size[at].as_u64().unwrap_or_default();
    let size = format!("{}×{}", number(0), number(1));
    (times, size)
}
