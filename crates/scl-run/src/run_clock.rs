//! The time of a run, which stands still while `scl run` itself does not run.
//!
//! A frozen container, a paused virtual machine and SIGSTOP to a whole system also stop the components. If time limits
//! kept running, they would end healthy components.

use super::restarts::Time;
use std::time::{Duration, Instant};

/// Maximum wait between two looks at the clock while something is due. If the process is paused during a wait, the rest
/// of that wait still counts.
pub(crate) const LONGEST_WAIT: Duration = Duration::from_millis(50);
/// A delay beyond this means that the process did not run.
const LATE: Duration = Duration::from_millis(10);

/// The time since the start of a run.
#[derive(Debug, Clone)]
pub(crate) struct RunClock {
    began: Instant,
    last_look: Instant,
    /// Time in which this process did not run.
    lost: Duration,
}

impl RunClock {
    pub(crate) fn start(now: Instant) -> Self {
        Self { began: now, last_look: now, lost: Duration::ZERO }
    }

    /// The time of the run at an instant.
    pub(crate) fn at(&self, instant: Instant) -> Time {
        instant.saturating_duration_since(self.began).saturating_sub(self.lost)
    }

    /// Notes that this process is running. `waited` is how long it meant to wait since the last look; any time beyond
    /// that is lost. Returns the lost time.
    pub(crate) fn look(&mut self, now: Instant, waited: Duration) -> Duration {
        let late = now.saturating_duration_since(self.last_look).saturating_sub(waited);
        let lost = if late > LATE { late } else { Duration::ZERO };
        self.lost += lost;
        self.last_look = now;
        lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// Looks at these times, each with the wait that was planned before it. Returns the time of the run after the last.
    fn time_after(looks: &[(u32, u32)]) -> Duration {
        let began = Instant::now();
        let mut clock = RunClock::start(began);
        for (at, waited) in looks {
            clock.look(began + *at * MS, *waited * MS);
        }
        clock.at(clock.last_look)
    }

    #[test]
    fn time_passes_while_the_process_waits_and_works() {
        assert_eq!(time_after(&[(50, 50), (51, 0), (101, 50), (103, 50), (108, 0)]), 108 * MS);
        // Woken by an event, or without a limit.
        assert_eq!(time_after(&[(3, 50), (4, 0), (90_000, u32::MAX)]), 90_000 * MS);
    }

    #[test]
    fn time_in_which_the_process_did_not_run_does_not_count() {
        // While it waits, at the end of a wait, while it works, and twice.
        assert_eq!(time_after(&[(4020, 50)]), 50 * MS);
        assert_eq!(time_after(&[(50, 50), (51, 0), (4101, 50)]), 101 * MS);
        assert_eq!(time_after(&[(50, 50), (4050, 0), (4060, 50)]), 60 * MS);
        assert_eq!(time_after(&[(1050, 50), (2050, 0), (2052, 2)]), 52 * MS);
    }
}
