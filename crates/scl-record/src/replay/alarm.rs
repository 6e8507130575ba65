//! Waiting for points in time, exact to the operating system's timer.

use rustix::time::{
    ClockId, Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, clock_gettime, timerfd_create,
    timerfd_settime,
};
use std::io;
use std::os::fd::OwnedFd;
use std::time::Duration;
use tokio::io::Interest;
use tokio::io::unix::AsyncFd;

/// An alarm clock.
#[derive(Debug)]
pub(super) struct Alarm {
    timer: AsyncFd<OwnedFd>,
}

impl Alarm {
    /// Needs a tokio runtime.
    pub(super) fn new() -> io::Result<Self> {
        let timer = timerfd_create(TimerfdClockId::Monotonic, TimerfdFlags::NONBLOCK | TimerfdFlags::CLOEXEC)?;
        #[expect(deprecated, reason = "unsound only for types whose descriptor changes; that of an `OwnedFd` does not")]
        let timer = AsyncFd::with_interest(timer, Interest::READABLE)?;
        Ok(Self { timer })
    }

    /// Time since an arbitrary beginning.
    pub(super) fn now() -> Duration {
        let now = clock_gettime(ClockId::Monotonic);
        Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32)
    }

    /// Waits until [`now`](Self::now) is at least `time`. An absolute time, so that delays do not add up.
    pub(super) async fn wait_until(&mut self, time: Duration) -> io::Result<()> {
        if Self::now() >= time {
            return Ok(());
        }
        let at =
            Timespec { tv_sec: i64::try_from(time.as_secs()).unwrap_or(i64::MAX), tv_nsec: time.subsec_nanos().into() };
        let never_again = Timespec { tv_sec: 0, tv_nsec: 0 };
        let times = Itimerspec { it_value: at, it_interval: never_again };
        timerfd_settime(self.timer.get_ref(), TimerfdTimerFlags::ABSTIME, &times)?;
        while Self::now() < time {
            let mut ready = self.timer.readable().await?;
            let mut count = [0; 8];
            // The read tells the runtime that the timer is to be waited for again.
            let _expired = ready.try_io(|timer| Ok(rustix::io::read(timer.get_ref(), &mut count)?));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn it_waits_until_the_time_and_not_at_all_for_past_ones() {
        let mut alarm = Alarm::new().unwrap();
        let start = Alarm::now();
        for step in 1..=50 {
            let time = start + Duration::from_micros(300) * step;
            alarm.wait_until(time).await.unwrap();
            assert!(Alarm::now() >= time);
        }
        alarm.wait_until(start).await.unwrap();
    }
}
