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
    lateness: Lateness,
}

impl Pace {
    /// Needs a tokio runtime.
    ///
    /// # Errors
    /// The process has no file descriptor left.
    pub(super) fn new(rate: Rate) -> Result<Self, Problem> {
        let alarm = Alarm::new().map_err(|error| Problem::new(format!("cannot create a timer: {error}")))?;
        Ok(Self { rate, alarm, base: None, lateness: Lateness::default() })
    }

    /// Begins now, with this time of the recording, or with the first message.
    pub(super) fn begin(&mut self, origin: Option<u64>) {
        self.base = origin.map(|origin| (origin, Alarm::now()));
    }

    /// Waits until a message is due.
    ///
    /// # Errors
    /// The timer has failed.
    pub(super) async fn wait_for(&mut self, time: u64) -> Result<(), Problem> {
        let Rate::Times(rate) = self.rate else { return Ok(()) };
        let (origin, started) = *self.base.get_or_insert_with(|| (time, Alarm::now()));
        let since_origin = Duration::from_nanos(time.saturating_sub(origin));
        let due = started.saturating_add(scaled(since_origin, rate));
        let waited = self.alarm.wait_until(due).await;
        waited.map_err(|error| Problem::new(format!("the timer failed: {error}")))?;
        self.lateness.add(Alarm::now().saturating_sub(due));
        Ok(())
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
