//! Deadlines for work on a shader.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::{Duration, Instant};

use thiserror::Error;

/// The number of calls of `is_over` between reads of the clock.
const POLLS_PER_CLOCK_READ: u32 = 256;

/// A time by which work must end. Loops over a shader call [`Self::is_over`] once for each item; the clock is
/// read once in 256 calls.
#[derive(Debug, Default)]
pub struct Deadline {
    /// `None` for no deadline.
    end: Option<Instant>,
    limit: Duration,
    polls: AtomicU32,
    is_over: AtomicBool,
}

/// The deadline has passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("compilation exceeded the time limit of {} s", limit.as_secs_f64())]
pub struct Overdue {
    /// The time limit.
    pub limit: Duration,
}

impl Deadline {
    /// The deadline that is `limit` from now.
    pub fn after(limit: Duration) -> Self {
        Self {
            end: Instant::now().checked_add(limit),
            limit,
            ..Self::default()
        }
    }

    /// A deadline for an independent part of the work: `1 / parts` of the time limit from now, but no later
    /// than this deadline.
    #[must_use]
    pub fn share(&self, parts: u32) -> Self {
        let limit = self.limit / parts;
        let end = self.end.map(|end| end.min(Instant::now() + limit));
        Self {
            end,
            limit,
            ..Self::default()
        }
    }

    /// Whether the deadline has passed.
    pub fn is_over(&self) -> bool {
        let Some(end) = self.end else {
            return false;
        };
        // Concurrent calls may lose a count, which is harmless.
        let polls = self.polls.load(Ordering::Relaxed);
        self.polls.store(polls.wrapping_add(1), Ordering::Relaxed);
        if polls.is_multiple_of(POLLS_PER_CLOCK_READ) && Instant::now() >= end {
            self.is_over.store(true, Ordering::Relaxed);
        }
        self.is_over.load(Ordering::Relaxed)
    }

    /// Reads the clock and fails if the deadline has passed.
    ///
    /// # Errors
    /// [`Overdue`] if the deadline has passed.
    pub fn check(&self) -> Result<(), Overdue> {
        match self.end {
            Some(end) if Instant::now() >= end => Err(Overdue { limit: self.limit }),
            _ => Ok(()),
        }
    }

    /// The remaining time; `None` without a deadline.
    pub fn left(&self) -> Option<Duration> {
        self.end.map(|end| end.saturating_duration_since(Instant::now()))
    }

    /// The total time limit.
    pub fn limit(&self) -> Duration {
        self.limit
    }
}

impl Clone for Deadline {
    fn clone(&self) -> Self {
        Self {
            end: self.end,
            limit: self.limit,
            ..Self::default()
        }
    }
}

impl PartialEq for Deadline {
    fn eq(&self, other: &Self) -> bool {
        (self.end, self.limit) == (other.end, other.limit)
    }
}

impl Eq for Deadline {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_deadline_never_ends_and_zero_time_ends_at_once() {
        let never = Deadline::default();
        assert!(!never.is_over() && never.check().is_ok() && never.share(4).check().is_ok());
        assert_eq!(never.left(), None);
        let over = Deadline::after(Duration::ZERO);
        assert!(over.is_over() && over.is_over() && over.share(4).is_over());
        assert_eq!(over.left(), Some(Duration::ZERO));
        let text = over.check().unwrap_err().to_string();
        assert_eq!(text, "compilation exceeded the time limit of 0 s");
    }

    #[test]
    fn a_share_ends_no_later_than_the_whole() {
        let whole = Deadline::after(Duration::from_secs(8));
        let part = whole.share(4);
        assert_eq!(part.limit(), Duration::from_secs(2));
        assert!(part.end < whole.end);
    }
}
