//! When work on a shader must be over.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::{Duration, Instant};

use thiserror::Error;

/// How often loops may ask before the clock is read again.
const POLLS: u32 = 256;

/// A time that work must not pass. Loops over a shader ask [`Self::is_over`] once for each item; the clock is read once in
/// 256 times.
#[derive(Debug, Default)]
pub struct Deadline {
    /// None: never.
    end: Option<Instant>,
    limit: Duration,
    polls: AtomicU32,
    is_over: AtomicBool,
}

/// The time is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("this shader takes longer than {} s to compile", limit.as_secs_f64())]
pub struct Overdue {
    /// How much time there was.
    pub limit: Duration,
}

impl Deadline {
    /// That long from now.
    #[must_use]
    pub fn after(limit: Duration) -> Self {
        Self {
            end: Instant::now().checked_add(limit),
            limit,
            ..Self::default()
        }
    }

    /// For a part of the work that others do not depend on: the first of that share of the whole time from now, and the end of it.
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

    /// Whether the time is over.
    pub fn is_over(&self) -> bool {
        let Some(end) = self.end else {
            return false;
        };
        // Threads that ask at once may lose a count, which does no harm.
        let polls = self.polls.load(Ordering::Relaxed);
        self.polls.store(polls.wrapping_add(1), Ordering::Relaxed);
        if polls.is_multiple_of(POLLS) && Instant::now() >= end {
            self.is_over.store(true, Ordering::Relaxed);
        }
        self.is_over.load(Ordering::Relaxed)
    }

    /// Fails if the time is over; reads the clock.
    ///
    /// # Errors
    /// If it is.
    pub fn check(&self) -> Result<(), Overdue> {
        match self.end {
            Some(end) if Instant::now() >= end => Err(Overdue { limit: self.limit }),
            _ => Ok(()),
        }
    }

    /// How much time is left; none if it never ends.
    #[must_use]
    pub fn left(&self) -> Option<Duration> {
        self.end.map(|end| end.saturating_duration_since(Instant::now()))
    }

    /// How much time there was, all in all.
    #[must_use]
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
    fn none_is_never_over_and_none_at_all_is_over_at_once() {
        let never = Deadline::default();
        assert!(!never.is_over() && never.check().is_ok() && never.share(4).check().is_ok());
        assert_eq!(never.left(), None);
        let over = Deadline::after(Duration::ZERO);
        assert!(over.is_over() && over.is_over() && over.share(4).is_over());
        assert_eq!(over.left(), Some(Duration::ZERO));
        let text = over.check().unwrap_err().to_string();
        assert_eq!(text, "this shader takes longer than 0 s to compile");
    }

    #[test]
    fn a_share_ends_no_later_than_the_whole() {
        let whole = Deadline::after(Duration::from_secs(8));
        let part = whole.share(4);
        assert_eq!(part.limit(), Duration::from_secs(2));
        assert!(part.end < whole.end);
    }
}
