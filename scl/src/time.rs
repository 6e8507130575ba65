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

    /// Forgets the beats that were missed up to now; how many there were. The next [`tick`](Self::tick) waits for the next
    /// beat.
    pub fn skip_missed(&mut self) -> u64 {
        std::mem::take(&mut self.due) + self.timer.expired()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[tokio::test]
    async fn missed_beats_are_counted_and_can_be_forgotten() {
        const PERIOD: Duration = Duration::from_millis(2);
        let beats_since = |start: Instant| start.elapsed().as_nanos() / PERIOD.as_nanos();
        let before = Instant::now();
        let mut tick = interval(PERIOD).unwrap();
        let after = Instant::now();
        tick.tick().await;
        while beats_since(after) < 10 {}
        tick.tick().await;
        let at_least = beats_since(after);
        let beats = 2 + u128::from(tick.skip_missed());
        assert!((at_least..=beats_since(before)).contains(&beats), "{beats} beats, not {at_least} or a few more");
        tick.tick().await;
        assert!(beats_since(before) > beats, "a beat came before its time, or twice");
    }

    #[tokio::test]
    async fn a_period_of_zero_is_refused() {
        let error = interval(Duration::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "the period of an interval must not be zero");
    }
}
