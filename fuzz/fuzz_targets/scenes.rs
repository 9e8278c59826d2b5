//! Any text as a scene file.

#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use toyproof_testkit::judge;

fuzz_target!(|text: &str| {
    // A scatter of 65,536 spheres is sorted twice for each of two frames.
    judge::scenes::judge(text, Duration::from_secs(10));
});
