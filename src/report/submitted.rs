//! Whose submission a shader is, and how late it is.

use std::fmt;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{grouped, plural};

use super::Record;

/// A shader as a submission of a class.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudentSubmission {
    /// The name of the assignment; null if the class has only one.
    pub assignment: Option<String>,
    /// The student's name.
    pub student: String,
    /// The number that the learning management system gives to the student, if any.
    pub id: Option<String>,
    /// How late the submission is; null if it is in time.
    pub late: Option<Late>,
}

/// How late a submission is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Late {
    /// The seconds after the deadline; null if the download does not state them.
    pub seconds: Option<u64>,
}

impl Late {
    /// The number of days, including the day that has begun; 1 if the download does not state it.
    #[must_use]
    pub fn days(self) -> u64 {
        self.seconds.map_or(1, |seconds| seconds.div_ceil(86_400).max(1))
    }
}

impl fmt::Display for Late {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(seconds) = self.seconds else {
            return f.write_str("late");
        };
        let (days, hours, minutes) = (seconds / 86_400, seconds / 3600 % 24, seconds.div_ceil(60) % 60);
        let days_and = format!("{} {}", grouped(days), plural(days, "day", "days"));
        match seconds {
            // From 59 min 1 s on, the minutes are rounded up to an hour.
            0..3_541 => write!(f, "late by {minutes} min"),
            3_541..86_400 => write!(f, "late by {} h {minutes} min", seconds.div_ceil(60) / 60),
            _ if hours == 0 => write!(f, "late by {days_and}"),
            _ => write!(f, "late by {days_and} {hours} h"),
        }
    }
}

impl Record {
    /// How late the submission is; `None` if it is in time, or no class is checked.
    #[must_use]
    pub fn late(&self) -> Option<Late> {
        self.submitted.as_ref()?.late
    }

    /// The reason of the verdict, and how late the submission is.
    pub(super) fn reason_and_lateness(&self) -> String {
        match self.late() {
            None => self.reason.clone(),
            Some(late) => format!("{}; {late}", self.reason),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lateness_is_stated_in_whole_minutes_or_hours() {
        for (seconds, expected, days) in [
            (1, "late by 1 min", 1),
            (60, "late by 1 min", 1),
            (3_540, "late by 59 min", 1),
            (3_541, "late by 1 h 0 min", 1),
            (7_500, "late by 2 h 5 min", 1),
            (86_400, "late by 1 day", 1),
            (86_401, "late by 1 day", 2),
            (266_400, "late by 3 days 2 h", 4),
        ] {
            let late = Late {
                seconds: Some(seconds),
            };
            assert_eq!(
                (late.to_string().as_str(), late.days()),
                (expected, days),
                "{seconds}"
            );
        }
        let unknown = Late { seconds: None };
        assert_eq!((unknown.to_string().as_str(), unknown.days()), ("late", 1));
    }
}
