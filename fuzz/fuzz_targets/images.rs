//! Any bytes as an image file.

#![no_main]

use std::sync::LazyLock;
use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use toyproof_testkit::judge;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| TempDir::new().expect("a folder can be made"));

fuzz_target!(|bytes: &[u8]| {
    // A few bytes may compress an image of a gigabyte, which is the most that is decoded.
    judge::images::judge(bytes, FOLDER.path(), Duration::from_secs(20));
});
