//! Budgets of work: instructions executed times chunks of pixels, and a price for compiling. Work is counted,
//! not timed, so that a result depends neither on the machine nor on its load.

use std::time::{Duration, Instant};

/// The work of a unit of a budget: about a second of one core.
const WORK_PER_UNIT: f64 = 3e8;

/// Work that may be done, and that has been done. The deadline is left against a hang.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    total: f64,
    spent: f64,
    deadline: Instant,
}

impl Budget {
    /// A budget of some units.
    pub(crate) fn of_units(units: f64, deadline: Instant) -> Self {
        let total = units * WORK_PER_UNIT;
        Self {
            total,
            spent: 0.0,
            deadline,
        }
    }

    /// A new budget of a share of this one's total.
    pub(crate) fn share(&self, share: f64) -> Self {
        Self {
            total: share * self.total,
            spent: 0.0,
            ..*self
        }
    }

    /// A new budget of one of several equal parts of the work that is left.
    pub(crate) fn part_of_rest(&self, parts: usize) -> Self {
        let total = (self.total - self.spent).max(0.0) / parts.max(1) as f64;
        Self {
            total,
            spent: 0.0,
            ..*self
        }
    }

    pub(crate) fn charge(&mut self, work: f64) {
        self.spent += work;
    }

    /// Whether a share of it is spent.
    pub(crate) fn is_spent(&self, share: f64) -> bool {
        self.spent > share * self.total
    }

    /// Whether the time is over, which only a hang exceeds.
    pub(crate) fn is_late(&self) -> bool {
        Instant::now() >= self.deadline
    }

    /// The time until a hang is assumed.
    pub(crate) fn time_left(&self) -> Duration {
        self.deadline.saturating_duration_since(Instant::now())
    }

    pub(crate) fn total(&self) -> f64 {
        self.total
    }

    pub(crate) fn spent(&self) -> f64 {
        self.spent
    }

    pub(crate) fn deadline(&self) -> Instant {
        self.deadline
    }
}
