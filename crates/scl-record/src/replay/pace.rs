//! When each message is due.

use super::Rate;
use super::report::Late;
use scl::time::Timer;
use scl_observe::Distribution;
use scl_terminal::Problem;
use std::future::poll_fn;
use std::io;
use std::time::{Duration, Instant};

/// Turns times of the recording into times of the replay.
pub(super) struct Pace {
    rate: Rate,
    timer: Timer,
    /// The time from which the times of the replay count.
    epoch: Instant,
    /// A time of the recording, and the corresponding time of the replay.
    base: Option<(u64, Duration)>,
    /// Maximum time between two messages, in nanoseconds of the recording; the rest of a longer gap is skipped.
    max_gap: Option<u64>,
    latest: Option<u64>,
    skipped: u64,
    /// By how many nanoseconds messages were sent too late.
    lateness: Distribution,
}

impl Pace {
    /// Must be called inside a tokio runtime.
    ///
    /// # Errors
    /// The process has no file descriptor left.
    pub(super) fn new(rate: Rate, max_gap: Option<Duration>) -> Result<Self, Problem> {
        let timer = Timer::new().map_err(|error| Problem::new(format!("cannot create a timer: {error}")))?;
        let max_gap = max_gap.map(scl_text::duration::nanoseconds);
        let (epoch, lateness) = (Instant::now(), Distribution::default());
        Ok(Self { rate, timer, epoch, base: None, max_gap, latest: None, skipped: 0, lateness })
    }

    /// Begins now, at the time `origin` of the recording; if that is `None`, begins with the first message.
    pub(super) fn begin(&mut self, origin: Option<u64>) {
        self.base = origin.map(|origin| (origin, self.epoch.elapsed()));
        (self.latest, self.skipped) = (origin, 0);
    }

    /// Waits until a message is due.
    ///
    /// # Errors
    /// The timer has failed.
    pub(super) async fn wait_for(&mut self, time: u64) -> Result<(), Problem> {
        let Rate::Times(rate) = self.rate else { return Ok(()) };
        let time = self.without_gaps(time);
        let (origin, started) = *self.base.get_or_insert_with(|| (time, self.epoch.elapsed()));
        let since_origin = Duration::from_nanos(time.saturating_sub(origin));
        let due = started.saturating_add(scaled(since_origin, rate));
        let waited = self.wait_until(due).await;
        waited.map_err(|error| Problem::new(format!("the timer failed: {error}")))?;
        let late = self.epoch.elapsed().saturating_sub(due);
        self.lateness.add(i64::try_from(late.as_nanos()).unwrap_or(i64::MAX));
        Ok(())
    }

    /// Waits until a time of the replay, with the precision of the operating system's timer.
    async fn wait_until(&mut self, time: Duration) -> io::Result<()> {
        loop {
            let left = time.saturating_sub(self.epoch.elapsed());
            if left.is_zero() {
                return Ok(());
            }
            self.timer.set(left, Duration::ZERO)?;
            poll_fn(|cx| self.timer.poll_expired(cx)).await?;
        }
    }

    fn without_gaps(&mut self, time: u64) -> u64 {
        let gap = time.saturating_sub(self.latest.unwrap_or(time));
        self.skipped += self.max_gap.map_or(0, |most| gap.saturating_sub(most));
        self.latest = Some(self.latest.map_or(time, |latest| latest.max(time)));
        time.saturating_sub(self.skipped)
    }

    /// How late messages were sent; `None` for [`Rate::Max`], at which messages have no due time.
    pub(super) fn late(&self) -> Option<Late> {
        let time = |nanoseconds: i64| Duration::from_nanos(nanoseconds.unsigned_abs());
        let late = self.lateness.spread().map(|it| Late { p50: time(it.p50), p99: time(it.p99), max: time(it.max) });
        (!self.rate.is_max()).then(|| late.unwrap_or_default())
    }
}

fn scaled(time: Duration, rate: f64) -> Duration {
    if rate == 1.0 {
        return time;
    }
    Duration::try_from_secs_f64(time.as_secs_f64() / rate).unwrap_or(Duration::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn it_waits_until_the_time_and_not_at_all_for_past_ones() {
        let mut pace = Pace::new(Rate::Times(1.0), None).unwrap();
        let start = pace.epoch.elapsed();
        for step in 1..=50 {
            let time = start + Duration::from_micros(300) * step;
            pace.wait_until(time).await.unwrap();
            assert!(pace.epoch.elapsed() >= time);
        }
        pace.wait_until(start).await.unwrap();
    }

    #[tokio::test]
    async fn lateness_is_told_unless_there_is_no_time() {
        let mut pace = Pace::new(Rate::Times(1.0), None).unwrap();
        (1..=100).for_each(|micros| pace.lateness.add(micros * 1000));
        let Late { p50, p99, max } = pace.late().unwrap();
        assert_eq!(max, Duration::from_micros(100));
        let near = |found: Duration, micros: u64| (found.as_secs_f64() * 1e6 / micros as f64 - 1.0).abs() < 0.002;
        assert!(near(p50, 50) && near(p99, 99), "{p50:?} {p99:?}");
        assert!(Pace::new(Rate::Max, None).unwrap().late().is_none());
    }

    #[tokio::test]
    async fn long_gaps_are_shortened_and_short_ones_kept() {
        let second = 1_000_000_000;
        let times = [10, 11, 15, 14, 3615, 3616];
        for (max_gap, expected) in
            [(None, times), (Some(2), [10, 11, 13, 12, 15, 16]), (Some(0), [10, 10, 10, 9, 10, 10])]
        {
            let mut pace = Pace::new(Rate::Times(1.0), max_gap.map(Duration::from_secs)).unwrap();
            let shortened = times.map(|time| pace.without_gaps(time * second) / second);
            assert_eq!(shortened, expected, "{max_gap:?}");
        }
        // From a position in the recording on, the pause before the first message is one, too.
        let mut pace = Pace::new(Rate::Times(1.0), Some(Duration::from_secs(2))).unwrap();
        pace.begin(Some(10 * second));
        assert_eq!([3610, 3611].map(|time| pace.without_gaps(time * second) / second), [12, 13]);
    }
}
