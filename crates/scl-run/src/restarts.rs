//! Counts the restarts of a component: how long to wait before the next one, and when it has had too many.

use super::policy::{RestartDelay, RestartLimit};
use std::collections::VecDeque;
use std::time::Duration;

/// Time since the start of the run.
pub(crate) type Time = Duration;

/// After this long without a restart, the delay starts again with the first.
const RESET_AFTER: Duration = Duration::from_secs(60);

/// The restarts of one component.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Restarts {
    /// Number of restarts so far.
    pub(crate) total: usize,
    in_a_row: u32,
    /// The times of the last restarts, at most as many as the limit allows.
    recent: VecDeque<Time>,
}

impl Restarts {
    /// Counts a restart and returns the delay before it; `None` if the limit is reached.
    pub(crate) fn next(&mut self, now: Time, delay: RestartDelay, limit: RestartLimit) -> Option<Duration> {
        let last = self.recent.back().copied();
        self.recent.retain(|at| now.saturating_sub(*at) < limit.within);
        if self.recent.len() >= limit.count {
            return None;
        }
        if last.is_some_and(|last| now.saturating_sub(last) >= RESET_AFTER) {
            self.in_a_row = 0;
        }
        let factor = 2_u32.saturating_pow(self.in_a_row);
        self.recent.push_back(now);
        self.in_a_row += 1;
        self.total += 1;
        debug_assert!(self.recent.len() <= limit.count.min(self.total), "each restart is counted once");
        debug_assert!(self.in_a_row as usize <= self.total, "each restart is counted once");
        Some(delay.first.saturating_mul(factor).min(delay.longest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::policy::Policy;

    fn delays(times: &[u64], limit: RestartLimit) -> Vec<Option<u128>> {
        let mut restarts = Restarts::default();
        let next = |at: &u64| restarts.next(Duration::from_secs(*at), Policy::default().delay, limit);
        times.iter().map(next).map(|delay| delay.map(|delay| delay.as_millis())).collect()
    }

    const UNLIMITED: RestartLimit = RestartLimit { count: usize::MAX, within: Duration::from_secs(60) };

    #[test]
    fn delays_double_up_to_the_longest() {
        let expected = [100, 200, 400, 800, 1600, 3200, 5000, 5000].map(Some);
        assert_eq!(delays(&[1; 8], UNLIMITED), expected);
        assert_eq!(delays(&[1; 200], UNLIMITED)[199], Some(5000));
    }

    #[test]
    fn a_minute_without_a_restart_resets_the_delay() {
        assert_eq!(delays(&[1, 2, 61, 121, 122], UNLIMITED), [100, 200, 400, 100, 200].map(Some));
    }

    #[test]
    fn the_limit_counts_within_its_period() {
        let limit = RestartLimit { count: 2, within: Duration::from_secs(10) };
        let refused = |times: &[u64]| delays(times, limit).iter().map(Option::is_none).collect::<Vec<_>>();
        assert_eq!(refused(&[1, 2, 3]), [false, false, true]);
        assert_eq!(refused(&[1, 2, 11, 12, 13]), [false, false, false, false, true]);
        let none = RestartLimit { count: 0, within: Duration::from_secs(10) };
        assert_eq!(delays(&[1], none), [None]);
    }
}
