//! Any text as the JSON of a project, or as its `project.toml`.

#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use toyproof_testkit::judge;

fuzz_target!(|text: &str| {
    judge::projects::judge(text, Duration::from_secs(2));
});
