//! Periodic timers that are exact to the operating system's clock.

mod clock;
mod rounded;
#[cfg(feature = "zeromq")]
mod stamp;
mod timer;
mod watchdog;

pub(crate) use rounded::Rounded;
#[cfg(feature = "zeromq")]
pub(crate) use stamp::{stamp_of, time_of};
#[doc(hidden)]
pub use timer::Timer;
pub(crate) use watchdog::Watchdog;

use std::future::poll_fn;
use std::io;
use std::time::Duration;
use tokio::time::Instant;

/// A periodic timer. The runtime's own timers round to milliseconds; this one uses the operating system's (timerfd).
///
/// Made by [`interval`].
#[derive(Debug)]
pub struct Interval {
    period: Duration,
    schedule: Schedule,
}

/// Which clock counts the ticks.
#[derive(Debug)]
enum Schedule {
    /// The operating system's, with the ticks that have expired but were not returned yet.
    System { timer: Timer, due: u64 },
    /// Tokio's paused clock in a test, with the time of the next tick.
    Paused { next: Instant },
}

/// Makes a timer that ticks every `period`, for the first time after one period.
///
/// ```
/// # #[tokio::main(flavor = "current_thread")]
/// # async fn main() -> std::io::Result<()> {
/// use std::time::Duration;
///
/// let mut tick = scl::time::interval(Duration::from_micros(500))?;
/// tick.tick().await?;
/// # Ok(())
/// # }
/// ```
///
/// # Tests
///
/// While tokio's clock is paused, as in `#[tokio::test(start_paused = true)]`, the timer follows that clock: a thousand
/// ticks take no time. Tokio rounds up to milliseconds there, so the ticks of a shorter period come several at a time.
/// Each call checks which clock is in use; when it was paused or resumed in between, the timer starts again.
///
/// # Errors
/// The period is zero, there is no tokio runtime, or the process has no file descriptor left.
pub fn interval(period: Duration) -> io::Result<Interval> {
    if period.is_zero() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the period of an interval must not be zero"));
    }
    if tokio::runtime::Handle::try_current().is_err() {
        return Err(io::Error::other("an interval needs a tokio runtime: write `#[scl::main]` on `async fn main`"));
    }
    Ok(Interval { period, schedule: Schedule::start(period, clock::is_paused())? })
}

impl Interval {
    /// Waits for the next tick. Missed ticks are returned at once, one by one, so that their number stays correct.
    ///
    /// # Errors
    /// The timer has failed, for example because its runtime has ended. There will be no more ticks.
    ///
    /// # Cancel safety
    /// Cancel safe: each tick is returned once.
    pub async fn tick(&mut self) -> io::Result<()> {
        self.follow_clock()?;
        match &mut self.schedule {
            Schedule::System { timer, due } => {
                while *due == 0 {
                    *due = poll_fn(|cx| timer.poll_expired(cx)).await?;
                }
                *due -= 1;
            }
            Schedule::Paused { next } => {
                tokio::time::sleep_until(*next).await;
                *next += self.period;
            }
        }
        Ok(())
    }

    /// Skips the ticks missed so far and returns their number. The next [`tick`](Self::tick) then waits for a new one.
    pub fn skip_missed(&mut self) -> u64 {
        match &mut self.schedule {
            Schedule::System { timer, due } => std::mem::take(due) + timer.expired(),
            Schedule::Paused { next } => {
                let now = Instant::now();
                let Some(late) = now.checked_duration_since(*next) else { return 0 };
                let (late, period) = (late.as_nanos(), self.period.as_nanos());
                let since_last = u64::try_from(late % period).unwrap_or(u64::MAX);
                *next = now + self.period.saturating_sub(Duration::from_nanos(since_last));
                u64::try_from(late / period).map_or(u64::MAX, |missed| missed.saturating_add(1))
            }
        }
    }

    fn follow_clock(&mut self) -> io::Result<()> {
        let paused = clock::is_paused();
        if paused != matches!(self.schedule, Schedule::Paused { .. }) {
            self.schedule = Schedule::start(self.period, paused)?;
        }
        Ok(())
    }
}

impl Schedule {
    fn start(period: Duration, paused: bool) -> io::Result<Self> {
        if paused {
            return Ok(Self::Paused { next: Instant::now() + period });
        }
        let timer = Timer::new()?;
        timer.set(period, period)?;
        Ok(Self::System { timer, due: 0 })
    }
}

#[cfg(test)]
mod tests;
