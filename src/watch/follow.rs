//! Follows files by examining them again and again: few files, on any file system, also network drives, whose
//! changes no system reports.

use std::fs::Metadata;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// What changes when a file is written or replaced. The files of a folder have their names only: an editor's
/// temporary files come and go, and the times of others are followed where they are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Signature {
    modified: Option<SystemTime>,
    length: u64,
    /// Differs if another file has the same name now, as after a save by renaming.
    file: u64,
}

impl Signature {
    /// `None` if there is no file.
    fn of(path: &Path) -> Option<Self> {
        let metadata = path.metadata().ok()?;
        if metadata.is_dir() {
            return Some(Self {
                modified: None,
                length: 0,
                file: names(path),
            });
        }
        Some(Self {
            modified: metadata.modified().ok(),
            length: metadata.len(),
            file: identity(&metadata),
        })
    }
}

#[cfg(unix)]
fn identity(metadata: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> u64 {
    0
}

/// The extensions of the files of a folder that can belong to a project.
const FOLLOWED_EXTENSIONS: [&str; 3] = ["glsl", "json", "toml"];

/// A digest of the names of the files in a folder that can belong to a project.
fn names(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| PathBuf::from(entry.file_name()));
    let mut names: Vec<_> = names
        .filter(|name| {
            let extension = name.extension().and_then(|extension| extension.to_str());
            extension.is_some_and(|extension| FOLLOWED_EXTENSIONS.contains(&extension))
        })
        .collect();
    names.sort_unstable();
    let mut hasher = DefaultHasher::new();
    names.hash(&mut hasher);
    hasher.finish()
}

/// The followed files, each as it was last seen.
#[derive(Debug, Default)]
pub(crate) struct Follower {
    files: Vec<(PathBuf, Option<Signature>)>,
}

impl Follower {
    /// Follows these files, which were read after a time. One that was not followed and has changed since
    /// then counts as changed.
    pub(crate) fn follow(&mut self, paths: Vec<PathBuf>, read_after: SystemTime) {
        let known = std::mem::take(&mut self.files);
        self.files = paths
            .into_iter()
            .map(|path| {
                let known = known.iter().find(|(known, _)| *known == path);
                let signature = match known {
                    Some((_, signature)) => *signature,
                    None => Signature::of(&path).filter(|new| new.modified.is_none_or(|at| at < read_after)),
                };
                (path, signature)
            })
            .collect();
    }

    /// Whether a file has changed since the last call.
    pub(crate) fn poll(&mut self) -> bool {
        let mut has_changed = false;
        for (path, last) in &mut self.files {
            let now = Signature::of(path);
            has_changed |= now != *last;
            *last = now;
        }
        has_changed
    }
}

/// The time after a change in which further changes belong to the same save, in which an editor writes
/// several files, or the same one twice.
pub(crate) const SETTLE_TIME: Duration = Duration::from_millis(100);
/// The time after which changes are shown although there are always more.
const MAX_BURST_TIME: Duration = Duration::from_secs(1);

/// Changes that are shown as one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Burst {
    first: Instant,
    last: Instant,
}

impl Burst {
    /// A burst with one change.
    pub(crate) fn new(now: Instant) -> Self {
        Self {
            first: now,
            last: now,
        }
    }

    /// Adds a change.
    #[must_use]
    pub(crate) fn with(self, now: Instant) -> Self {
        Self { last: now, ..self }
    }

    /// Whether the changes are to be shown.
    pub(crate) fn is_over(&self, now: Instant) -> bool {
        now.duration_since(self.last) >= SETTLE_TIME || now.duration_since(self.first) >= MAX_BURST_TIME
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn following(paths: &[&Path]) -> Follower {
        let mut follower = Follower::default();
        let later = SystemTime::now() + Duration::from_secs(3600);
        follower.follow(paths.iter().map(|path| path.to_path_buf()).collect(), later);
        assert!(!follower.poll());
        follower
    }

    #[test]
    fn writing_renaming_removing_and_creating_are_changes() {
        let folder = tempfile::tempdir().unwrap();
        let [path, other, missing] = ["a.glsl", "b", "c"].map(|name| folder.path().join(name));
        fs::write(&path, "one").unwrap();
        let mut follower = following(&[&path, &missing]);
        fs::write(&path, "longer").unwrap();
        assert!(follower.poll() && !follower.poll());
        // The length and the time are those of the old file.
        let time = path.metadata().unwrap().modified().unwrap();
        fs::write(&other, "LONGER").unwrap();
        fs::File::options()
            .write(true)
            .open(&other)
            .unwrap()
            .set_modified(time)
            .unwrap();
        fs::rename(&other, &path).unwrap();
        assert_eq!(follower.poll(), cfg!(unix));
        fs::remove_file(&path).unwrap();
        assert!(follower.poll() && !follower.poll());
        fs::write(&missing, "").unwrap();
        assert!(follower.poll() && !follower.poll());
    }

    #[test]
    fn a_file_that_changed_while_it_was_read_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let before = SystemTime::now() - Duration::from_secs(1);
        fs::write(&path, "").unwrap();
        let mut follower = Follower::default();
        follower.follow(vec![path.clone()], before);
        assert!(follower.poll() && !follower.poll());
        follower.follow(vec![path], before);
        assert!(!follower.poll(), "it is known");
    }

    #[test]
    fn a_folder_changes_with_the_names_of_its_shaders() {
        let folder = tempfile::tempdir().unwrap();
        let mut follower = following(&[folder.path()]);
        fs::write(folder.path().join(".image.glsl.swp"), "").unwrap();
        assert!(!follower.poll());
        fs::write(folder.path().join("buffer-a.glsl"), "").unwrap();
        assert!(follower.poll() && !follower.poll());
        fs::write(folder.path().join("buffer-a.glsl"), "text").unwrap();
        assert!(!follower.poll(), "its contents are followed where it is read");
    }

    #[test]
    fn changes_within_the_settle_time_are_one() {
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        let burst = Burst::new(start);
        assert!(!burst.is_over(at(99)) && burst.is_over(at(100)));
        let burst = burst.with(at(90));
        assert!(!burst.is_over(at(189)) && burst.is_over(at(190)));
        let endless = (1..20).fold(burst, |burst, step| burst.with(at(60 * step)));
        assert!(endless.is_over(at(1000)), "changes that never end are shown");
    }
}
