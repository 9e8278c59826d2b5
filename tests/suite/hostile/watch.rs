//! Watches a program's use of the machine: the memory of it and its child processes, the files that they
//! write, and whether they all end.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::{Duration, Instant};
use std::{fs, thread};

use crate::support::wait::HANG_GUARD;

/// The observations until it ended.
#[derive(Debug)]
pub(super) struct Seen {
    /// None if it had to be killed.
    pub(super) code: Option<i32>,
    pub(super) seconds: f64,
    /// The peak memory in bytes.
    pub(super) bytes: u64,
}

/// Watches a program until it ends, or kills it if it hangs.
pub(super) fn watch(mut child: Child) -> Seen {
    let start = Instant::now();
    let mut bytes = 0;
    let status = loop {
        bytes = bytes.max(resident(child.id()));
        match child.try_wait().unwrap() {
            Some(status) => break Some(status),
            None if start.elapsed() > HANG_GUARD => break None,
            None => thread::sleep(Duration::from_millis(5)),
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    if status.is_none() {
        child.kill().unwrap();
        child.wait().unwrap();
    }
    Seen {
        code: status.and_then(|status| status.code()),
        seconds,
        bytes,
    }
}

/// The resident memory of a process and its descendants, in bytes.
fn resident(pid: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let held = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let held = held.and_then(|held| held.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    let threads = fs::read_dir(format!("/proc/{pid}/task")).into_iter().flatten();
    let children = threads.flatten().flat_map(|thread| {
        let children = fs::read_to_string(thread.path().join("children")).unwrap_or_default();
        let pids: Vec<u32> = children
            .split_whitespace()
            .filter_map(|pid| pid.parse().ok())
            .collect();
        pids
    });
    held.map_or(0, |held| held << 10) + children.map(resident).sum::<u64>()
}

/// The processes whose environment contains `word`, after giving them time to end.
pub(super) fn left(word: &OsStr) -> Vec<String> {
    let start = Instant::now();
    loop {
        let processes = fs::read_dir("/proc").unwrap().flatten();
        let left: Vec<_> = processes
            .filter(|process| {
                let environment = fs::read(process.path().join("environ")).unwrap_or_default();
                let mut words = environment.windows(word.len());
                words.any(|window| window == word.as_bytes())
            })
            .map(|process| fs::read_to_string(process.path().join("cmdline")).unwrap_or_default())
            .collect();
        if left.is_empty() || start.elapsed() > HANG_GUARD {
            return left;
        }
        thread::sleep(Duration::from_millis(20));
    }
}

/// All files below a folder, with their contents.
pub(super) fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if entry.file_type().unwrap().is_dir() {
            files.extend(self::files(&path));
        } else {
            files.insert(path.clone(), fs::read(&path).unwrap_or_default());
        }
    }
    files
}
