//! Periods exact to the operating system's clock.

mod timer;
mod watchdog;

pub(crate) use watchdog::Watchdog;

use std::future::poll_fn;
use std::io;
use std::time::Duration;
use timer::Timer;

/// A steady beat. The runtime's own timer rounds to milliseconds; this one is the operating system's (timerfd).
#[derive(Debug)]
pub struct Interval {
    timer: Timer,
    /// Beats that are due but not yet reported.
    due: u64,
}

/// A beat every `period`, the first after one period.
///
/// ```
/// # #[tokio::main(flavor = "current_thread")]
/// # async fn main() -> std::io::Result<()> {
/// use std::time::Duration;
///
/// let mut tick = scl::time::interval(Duration::from_micros(500))?;
/// tick.tick().await;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// A period of zero, no descriptor left, or no tokio runtime.
pub fn interval(period: Duration) -> io::Result<Interval> {
    if period.is_zero() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the period of an interval must not be zero"));
    }
    if tokio::runtime::Handle::try_current().is_err() {
        return Err(io::Error::other("an interval needs a tokio runtime: write `#[scl::main]` on `async fn main`"));
    }
    let timer = Timer::new()?;
    timer.set(period, period)?;
    Ok(Interval { timer, due: 0 })
}

impl Interval {
    /// Waits for the next beat. Beats that were missed come at once, one by one, so that their number stays right.
    ///
    /// # Cancel safety
    /// Cancel safe: a beat is reported once.
    pub async fn tick(&mut self) {
        while self.due == 0 {
            match poll_fn(|cx| self.timer.poll_expired(cx)).await {
                Ok(beats) => self.due = beats,
                // Only if the descriptor was closed by somebody else: then there are no more beats.
                Err(_) => std::future::pending().await,
            }
        }
        self.due -= 1;
    }

    /// Forgets the beats that were missed; how many there were.
    pub fn skip_missed(&mut self) -> u64 {
        std::mem::take(&mut self.due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[tokio::test]
    async fn missed_beats_are_counted_and_can_be_forgotten() {
        let started = Instant::now();
        let mut tick = interval(Duration::from_millis(2)).unwrap();
        tick.tick().await;
        while started.elapsed() < Duration::from_millis(20) {}
        tick.tick().await;
        assert!(tick.skip_missed() >= 4);
        assert_eq!(tick.skip_missed(), 0);
    }

    #[tokio::test]
    async fn a_period_of_zero_is_refused() {
        let error = interval(Duration::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "the period of an interval must not be zero");
    }
}
