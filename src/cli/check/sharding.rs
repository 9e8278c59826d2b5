//! A part of a batch, `--shard K/N`: which shaders are checked, and the file from which `merge` recognizes
//! the parts of one batch.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use toyproof_classroom::shards::{Item, distribute};
use toyproof_diagnostic::path_name;
use toyproof_image::{input, output};

use super::shard::Shard;
use super::submission::Submission;

/// The name of the file in a shard's folder that describes the shard.
pub(super) const MANIFEST_NAME: &str = "shard.json";

/// Fixed cost of a shader, for rendering and comparing it, in equivalent bytes of source.
const BASE_COST: u64 = 4096;

/// Fixed cost of a shader in addition to its measured time, for reading and reporting it, in microseconds.
const BASE_MICROSECONDS: u64 = 1000;

// Which shaders a shard has.

/// Assigns each submission to one of `shards` shards; returns the number of each shard, from 1.
pub(super) fn assign(submissions: &[Submission], shards: u32) -> Vec<u32> {
    let known: Vec<f64> = submissions
        .iter()
        .filter_map(|submission| submission.seconds)
        .collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let items = submissions.iter().map(|submission| Item {
        hash: hash(submission.key.as_deref().unwrap_or(&submission.name)),
        cost: if known.is_empty() {
            BASE_COST + submission.bytes
        } else {
            BASE_MICROSECONDS + (1e6 * submission.seconds.unwrap_or(mean)) as u64
        },
    });
    distribute(&items.collect::<Vec<_>>(), shards)
}

/// The first bytes of the SHA-256 of a text.
fn hash(text: &str) -> u64 {
    let hash: [u8; 32] = Sha256::digest(text).into();
    hash.first_chunk().copied().map_or(0, u64::from_be_bytes)
}

// The description of the batch in a shard's folder.

/// Identifies the program by its content, on any machine: the SHA-256 of its file.
///
/// # Errors
/// The file cannot be read.
pub(super) fn program() -> Result<String, String> {
    let mut hash = Sha256::new();
    let mut copy = || io::copy(&mut File::open(std::env::current_exe()?)?, &mut hash);
    copy().map_err(|error| format!("the program's own file cannot be read: {error}"))?;
    Ok(format!("{:x}", hash.finalize()))
}

/// Identifies the shaders of a batch, their references and the flags, by their keys, and the times that
/// balance the shards.
pub(super) fn inputs(submissions: &[Submission]) -> String {
    let mut hash = Sha256::new();
    for submission in submissions {
        hash.update(submission.key.as_deref().unwrap_or_default());
        hash.update(&submission.name);
        if let Some(seconds) = submission.seconds {
            hash.update(seconds.to_le_bytes());
        }
        hash.update(b"\n");
    }
    format!("{:x}", hash.finalize())
}

/// The file that describes a shard.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Manifest {
    /// [`program`].
    pub(super) program: String,
    /// [`inputs`], of all shards.
    pub(super) inputs: String,
    pub(super) shard: Shard,
    /// The arguments of the command, without those that may differ from shard to shard.
    pub(super) arguments: Vec<String>,
}

impl Manifest {
    /// Reads the description of the shard in a folder; `None` if the folder has none.
    ///
    /// # Errors
    /// The file cannot be read or has another format.
    pub(super) fn read(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(MANIFEST_NAME);
        let with_path = |error: String| io::Error::other(format!("{}: {error}", path_name(&path)));
        match input::read(&path) {
            Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| with_path(error.to_string())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(with_path(error.to_string())),
        }
    }

    /// Writes the description into the folder of the shard, unless that is another shard's.
    ///
    /// # Errors
    /// The file cannot be written, or the folder has another shard.
    pub(super) fn write(&self, folder: &Path) -> io::Result<()> {
        if let Some(other) = Self::read(folder)?
            && other.shard != self.shard
        {
            return Err(io::Error::other(format!(
                "{}: it has the results of shard {}; shard {} needs a folder of its own",
                path_name(folder),
                other.shard,
                self.shard
            )));
        }
        let text = serde_json::to_string_pretty(self).map_err(io::Error::other)? + "\n";
        output::write_inside(folder, &folder.join(MANIFEST_NAME), text.as_bytes())
    }
}

/// The options with a value that may differ from shard to shard.
const OPTIONS: [&str; 4] = ["--shard", "--out", "--jobs", "--color"];
/// The flags that may differ from shard to shard.
const FLAGS: [&str; 5] = ["--resume", "--verbose", "--quiet", "-v", "-q"];

/// The arguments of this process, without those that may differ from shard to shard.
///
/// # Errors
/// An argument that is not Unicode text.
pub(super) fn arguments() -> Result<Vec<String>, String> {
    let arguments = std::env::args_os().skip(1).map(OsString::into_string);
    let arguments: Result<Vec<String>, OsString> = arguments.collect();
    let arguments = arguments.map_err(|argument| {
        let name = path_name(Path::new(&argument));
        format!("--shard takes only arguments that are UTF-8 text, and `{name}` is not")
    })?;
    Ok(common(arguments))
}

fn common(arguments: Vec<String>) -> Vec<String> {
    let mut rest = arguments.into_iter();
    let mut common = Vec::new();
    while let Some(argument) = rest.next() {
        if argument == "--" {
            common.push(argument);
            common.extend(rest);
            break;
        }
        let option = OPTIONS.iter().find_map(|option| argument.strip_prefix(option));
        match option {
            Some("") => drop(rest.next()),
            Some(value) if value.starts_with('=') => {}
            _ if FLAGS.contains(&argument.as_str()) => {}
            _ => common.push(argument),
        }
    }
    common
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_from_shard_to_shard_is_not_recorded() {
        let recorded = |text: &str| common(text.split(' ').map(str::to_owned).collect()).join(" ");
        let same = "check hw --scene a.toml --search 0";
        assert_eq!(
            recorded("-q check hw --scene a.toml --shard 1/2 --out=x --resume --search 0 --jobs 3"),
            same
        );
        assert_eq!(recorded("check --out a -- --out b"), "check -- --out b");
        assert_eq!(recorded("check --outer"), "check --outer");
    }
}
