//! How well a loop keeps its period.

use std::fmt;
use std::time::{Duration, Instant};

/// A loop that starts each round at its time, and what came of that.
pub(crate) struct Pace {
    period: Duration,
    next: Instant,
    /// By how much each round was late, in microseconds.
    late: Vec<u64>,
    /// Rounds that started after the next one should have.
    missed: u64,
}

impl Pace {
    pub(crate) fn new(period: Duration) -> Self {
        Self { period, next: Instant::now() + period, late: Vec::new(), missed: 0 }
    }

    /// Sleeps until the next round.
    pub(crate) fn wait(&mut self) {
        let now = Instant::now();
        std::thread::sleep(self.next.saturating_duration_since(now));
        let late = self.next.elapsed();
        self.late.push(late.as_micros() as u64);
        self.next += self.period;
        if late > self.period {
            self.missed += 1;
            // A late round is no reason to hurry through those that follow.
            self.next = Instant::now() + self.period;
        }
    }

    /// The record since the last time it was taken.
    pub(crate) fn take(&mut self) -> Record {
        let mut late = std::mem::take(&mut self.late);
        late.sort_unstable();
        let at = |share: usize| late.get((late.len() * share / 100).min(late.len().saturating_sub(1))).copied();
        let (p99, max) = (at(99).unwrap_or(0), late.last().copied().unwrap_or(0));
        Record { rounds: late.len(), p99, max, missed: std::mem::take(&mut self.missed) }
    }
}

pub(crate) struct Record {
    pub(crate) rounds: usize,
    p99: u64,
    max: u64,
    missed: u64,
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rounds, p99, max, missed } = self;
        write!(f, "rounds={rounds} late_p99_us={p99} late_max_us={max} missed={missed}")
    }
}
