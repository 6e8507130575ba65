//! Times that another process of this machine understands.

use rustix::time::{ClockId, clock_gettime};
use scl_text::duration::nanoseconds;
use std::time::{Duration, Instant};

/// Returns the time in nanoseconds of `CLOCK_MONOTONIC`, which all processes of a machine share.
pub(crate) fn stamp_of(time: Instant) -> u64 {
    now().saturating_sub(nanoseconds(time.elapsed()))
}

/// Returns the time of a stamp; now if it has not come yet, as in a container with a clock of its own.
pub(crate) fn time_of(stamp: u64) -> Instant {
    let (now, stamped) = (Instant::now(), Duration::from_nanos(now().saturating_sub(stamp)));
    now.checked_sub(stamped).unwrap_or(now)
}

fn now() -> u64 {
    let now = clock_gettime(ClockId::Monotonic);
    let now = Duration::new(now.tv_sec.try_into().unwrap_or(0), now.tv_nsec.try_into().unwrap_or(0));
    nanoseconds(now)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_comes_back() {
        let started = Instant::now();
        let time = started - Duration::from_secs(3);
        let back = time_of(stamp_of(time));
        // The time between two readings of the clock makes it earlier.
        assert!(back <= time && time - back <= started.elapsed(), "{:?}", time.duration_since(back));
        let early = Instant::now();
        let to_come = time_of(u64::MAX);
        assert!((early..=Instant::now()).contains(&to_come), "a time that has not come is now");
    }
}
