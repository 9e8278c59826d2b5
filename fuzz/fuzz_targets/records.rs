//! Any bytes as `results.jsonl` or `verdict.json`.

#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use toyproof_testkit::judge;

fuzz_target!(|bytes: &[u8]| {
    judge::records::judge(bytes, Duration::from_secs(2));
});
