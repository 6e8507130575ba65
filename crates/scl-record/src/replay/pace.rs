//! When each message is due.

use super::Rate;
use super::alarm::Alarm;
use super::lateness::Lateness;
use super::report::Late;
use scl_terminal::Problem;
use std::time::Duration;

/// Turns times of the recording into times of the replay.
pub(super) struct Pace {
    rate: Rate,
    alarm: Alarm,
    /// A time of the recording, and the time of the replay that belongs to it.
    base: Option<(u64, Duration)>,
    /// The longest time of the recording between two messages that wait; of longer ones, the rest is skipped.
    max_gap: Option<u64>,
    latest: Option<u64>,
    skipped: u64,
    lateness: Lateness,
}

impl Pace {
    /// Needs a tokio runtime.
    ///
    /// # Errors
    /// The process has no file descriptor left.
    pub(super) fn new(rate: Rate, max_gap: Option<Duration>) -> Result<Self, Problem> {
        let alarm = Alarm::new().map_err(|error| Problem::new(format!("cannot create a timer: {error}")))?;
        let max_gap = max_gap.map(|gap| u64::try_from(gap.as_nanos()).unwrap_or(u64::MAX));
        Ok(Self { rate, alarm, base: None, max_gap, latest: None, skipped: 0, lateness: Lateness::default() })
    }

    /// Begins now, with this time of the recording, or with the first message.
    pub(super) fn begin(&mut self, origin: Option<u64>) {
        self.base = origin.map(|origin| (origin, Alarm::now()));
        (self.latest, self.skipped) = (origin, 0);
    }

    /// Waits until a message is due.
    ///
    /// # Errors
    /// The timer has failed.
    pub(super) async fn wait_for(&mut self, time: u64) -> Result<(), Problem> {
        let Rate::Times(rate) = self.rate else { return Ok(()) };
        let time = self.without_gaps(time);
        let (origin, started) = *self.base.get_or_insert_with(|| (time, Alarm::now()));
        let since_origin = Duration::from_nanos(time.saturating_sub(origin));
        let due = started.saturating_add(scaled(since_origin, rate));
        let waited = self.alarm.wait_until(due).await;
        waited.map_err(|error| Problem::new(format!("the timer failed: {error}")))?;
        self.lateness.add(Alarm::now().saturating_sub(due));
        Ok(())
    }

    fn without_gaps(&mut self, time: u64) -> u64 {
        let gap = time.saturating_sub(self.latest.unwrap_or(time));
        self.skipped += self.max_gap.map_or(0, |most| gap.saturating_sub(most));
        self.latest = Some(self.latest.map_or(time, |latest| latest.max(time)));
        time.saturating_sub(self.skipped)
    }

    /// How exact it was; `None` if messages had no time.
    pub(super) fn late(&self) -> Option<Late> {
        (!self.rate.is_max()).then(|| self.lateness.summary())
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
