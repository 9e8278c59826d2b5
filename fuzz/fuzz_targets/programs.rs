//! Any bytes as the decisions behind a valid program, which the evaluator and an interpreter run: a difference in one bit
//! of a pixel is a finding.

#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use toyproof_testkit::judge;

fuzz_target!(|bytes: &[u8]| {
    let _ = judge::programs::judge(bytes, Duration::from_secs(2));
});
