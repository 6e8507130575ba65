//! Periods exact to the operating system's clock.

use rustix::time::{
    Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, timerfd_create, timerfd_settime,
};
use std::io;
use std::os::fd::OwnedFd;
use std::time::Duration;
use tokio::io::unix::AsyncFd;

/// A steady beat. The runtime's own timer rounds to milliseconds; this one is the operating system's (timerfd).
#[derive(Debug)]
pub struct Interval {
    timer: AsyncFd<OwnedFd>,
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
    let timer = timerfd_create(TimerfdClockId::Monotonic, TimerfdFlags::NONBLOCK | TimerfdFlags::CLOEXEC)?;
    let period =
        Timespec { tv_sec: period.as_secs().try_into().unwrap_or(i64::MAX), tv_nsec: i64::from(period.subsec_nanos()) };
    timerfd_settime(&timer, TimerfdTimerFlags::empty(), &Itimerspec { it_interval: period, it_value: period })?;
    #[expect(deprecated, reason = "unsound only for types that change their descriptor; an `OwnedFd` keeps it")]
    let timer = AsyncFd::new(timer)?;
    Ok(Interval { timer, due: 0 })
}

impl Interval {
    /// Waits for the next beat. Beats that were missed come at once, one by one, so that their number stays right.
    ///
    /// # Cancel safety
    /// Cancel safe: a beat is reported once.
    pub async fn tick(&mut self) {
        while self.due == 0 {
            // Both fail only if the timer's descriptor is closed by somebody else; then there are no more beats.
            let Ok(mut ready) = self.timer.readable().await else { return std::future::pending().await };
            let mut expirations = [0; 8];
            let read = ready.try_io(|timer| Ok(rustix::io::read(timer.get_ref(), &mut expirations)?));
            match read {
                Ok(Ok(8)) => self.due = u64::from_ne_bytes(expirations),
                Ok(Err(error)) if error.kind() != io::ErrorKind::Interrupted => return std::future::pending().await,
                _ => {}
            }
        }
        self.due -= 1;
    }

    /// Forgets the beats that were missed; how many there were.
    pub fn skip_missed(&mut self) -> u64 {
        std::mem::take(&mut self.due)
    }
}
