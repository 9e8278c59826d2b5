//! When a submission was made, as far as a download states it, and how late that is.

use serde::{Deserialize, Serialize};
use toyproof_project::archive::FileTime;
use toyproof_report::Late;
use toyproof_toml::Moment;

use super::collection::SubmittedFile;

/// When the shaders of a submission were submitted, in seconds since 1970-01-01 00:00.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SubmissionTime {
    /// The time of the last file, in UTC; null if no file has such a time.
    pub utc: Option<i64>,
    /// The time of the last file whose time zone is not stated; null if there is no such file.
    pub local: Option<i64>,
    /// Whether the system marks the submission as late.
    pub is_marked_late: bool,
    /// Whether there is a file that has no time, and that the system would not mark.
    pub is_unknown: bool,
}

/// How late something was submitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lateness {
    /// Submitted on time.
    OnTime,
    /// Submitted late.
    Late(Late),
    /// The download does not state the time.
    Unknown,
}

impl SubmissionTime {
    /// The time of these files. Canvas marks late files, and gives all files the time of the download.
    pub(super) fn of<'a>(files: impl IntoIterator<Item = &'a SubmittedFile>) -> Self {
        let mut all = Self::default();
        for file in files {
            match (file.is_late, file.time) {
                (Some(is_late), _) => all.is_marked_late |= is_late,
                (None, None) => all.is_unknown = true,
                (None, Some(FileTime::Utc(seconds))) => all.utc = all.utc.max(Some(seconds)),
                (None, Some(FileTime::Local(seconds))) => all.local = all.local.max(Some(seconds)),
            }
        }
        all
    }

    /// How late that is. A time without a time zone is that of a clock at the place of the deadline.
    #[must_use]
    pub fn lateness(self, deadline: Option<Moment>) -> Lateness {
        if self.is_marked_late {
            return Lateness::Late(Late { seconds: None });
        }
        let Some(deadline) = deadline else {
            return Lateness::OnTime;
        };
        let last = self.utc.max(self.local.map(|seconds| seconds - deadline.offset));
        match last.map(|last| last - deadline.seconds) {
            Some(delay @ 1..) => Lateness::Late(Late {
                seconds: Some(delay.unsigned_abs()),
            }),
            _ if self.is_unknown => Lateness::Unknown,
            _ => Lateness::OnTime,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOON: Moment = Moment {
        seconds: 43_200,
        offset: 3600,
    };

    #[test]
    fn the_last_file_counts_in_the_time_of_the_deadline() {
        let time = |utc, local| SubmissionTime {
            utc,
            local,
            ..SubmissionTime::default()
        };
        let late = |seconds| Lateness::Late(Late { seconds });
        for (time, expected) in [
            (time(Some(43_200), None), Lateness::OnTime),
            (time(Some(43_201), None), late(Some(1))),
            (time(None, Some(46_800)), Lateness::OnTime),
            (time(Some(0), Some(46_860)), late(Some(60))),
            (time(None, None), Lateness::OnTime),
        ] {
            assert_eq!(time.lateness(Some(NOON)), expected, "{time:?}");
            assert_eq!(time.lateness(None), Lateness::OnTime);
            let unknown = SubmissionTime {
                is_unknown: true,
                ..time
            };
            let expected = match expected {
                Lateness::OnTime => Lateness::Unknown,
                known => known,
            };
            assert_eq!(unknown.lateness(Some(NOON)), expected, "{unknown:?}");
            let marked = SubmissionTime {
                is_marked_late: true,
                ..time
            };
            assert_eq!(marked.lateness(None), late(None));
        }
    }
}
