//! The time that Chromium takes to open a report.

use std::fs;
use std::path::Path;

use serde_json::json;
use toyproof_testkit::devtools::Page;

/// Reads the browser's own clock.
const CLOCK: &str = "(async () => { \
    const first = () => performance.getEntriesByName('first-contentful-paint')[0]; \
    while (!first()) await new Promise(done => setTimeout(done, 10)); \
    return [first().startTime, performance.getEntriesByType('navigation')[0].loadEventEnd] })()";

/// The processor time of the page's thread, in seconds.
fn thread_seconds(page: &mut Page) -> f64 {
    let reported = page.call("Performance.getMetrics", &json!({}));
    let metrics = reported["metrics"].as_array().expect("there are metrics");
    let task = metrics.iter().find(|metric| metric["name"] == "TaskDuration");
    task.and_then(|task| task["value"].as_f64())
        .expect("it is a number")
}

/// Opens a report five times and prints the times; then writes screenshots of it.
pub(super) fn measure(file: &Path, screenshots: Option<&Path>) {
    let chromium = toyproof::gpu::browser::find().expect("Chromium is installed");
    let mut page = Page::new(&chromium);
    let file = fs::canonicalize(file).expect("the report exists");
    for _ in 0..5 {
        page.window([1400, 900], false);
        page.call("Performance.enable", &json!({ "timeDomain": "threadTicks" }));
        page.open(&file);
        let opened = thread_seconds(&mut page);
        let [shown_at, loaded]: [f64; 2] = serde_json::from_value(page.value(CLOCK)).expect("two numbers");
        let before = thread_seconds(&mut page);
        page.value("document.querySelector('#shaders tr[data-verdict=ok] a').click()");
        page.until("document.querySelector('article.open dl dd') !== null");
        let shown = thread_seconds(&mut page) - before;
        println!(
            "{shown_at:.0} ms until the first content, {loaded:.0} ms until all is loaded; {opened:.2} s of the thread to \
             open, {shown:.2} s to show an image"
        );
    }
    let Some(folder) = screenshots else {
        return;
    };
    let mut shot = |name: &str, size, dark| {
        page.window(size, dark);
        fs::write(folder.join(name), page.screenshot()).expect("the folder is writable");
    };
    shot("light.png", [1400, 900], false);
    shot("dark.png", [1400, 900], true);
    shot("narrow.png", [390, 844], false);
}
