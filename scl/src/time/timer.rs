//! The operating system's own timer (timerfd) inside the async runtime.

use rustix::time::{
    Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, timerfd_create, timerfd_settime,
};
use std::io;
use std::os::fd::OwnedFd;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::io::unix::AsyncFd;

/// A timer that keeps running while it is not polled, and costs the runtime nothing until it expires.
#[derive(Debug)]
pub struct Timer {
    descriptor: AsyncFd<OwnedFd>,
}

impl Timer {
    /// Creates a timer that is not set. Must be called inside a tokio runtime.
    pub fn new() -> io::Result<Self> {
        let timer = timerfd_create(TimerfdClockId::Monotonic, TimerfdFlags::NONBLOCK | TimerfdFlags::CLOEXEC)?;
        #[expect(deprecated, reason = "unsound only for types whose descriptor changes; that of an `OwnedFd` does not")]
        let descriptor = AsyncFd::new(timer)?;
        Ok(Self { descriptor })
    }

    /// Makes the timer expire after `first`, which must not be zero, and then every `period` unless that is zero.
    pub fn set(&self, first: Duration, period: Duration) -> io::Result<()> {
        let times = Itimerspec { it_value: timespec(first), it_interval: timespec(period) };
        timerfd_settime(self.descriptor.get_ref(), TimerfdTimerFlags::empty(), &times)?;
        Ok(())
    }

    /// Ready when the timer has expired; returns how often it did since the last read.
    pub fn poll_expired(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<u64>> {
        loop {
            let mut readable = ready!(self.descriptor.poll_read_ready(cx))?;
            let mut count = [0; 8];
            match readable.try_io(|timer| Ok(rustix::io::read(timer.get_ref(), &mut count)?)) {
                Ok(Ok(_)) => return Poll::Ready(Ok(u64::from_ne_bytes(count))),
                Ok(Err(error)) if error.kind() == io::ErrorKind::Interrupted => {}
                Ok(Err(error)) => return Poll::Ready(Err(error)),
                Err(_would_block) => {}
            }
        }
    }

    /// Returns how often the timer has expired since the last read, without waiting.
    pub(super) fn expired(&self) -> u64 {
        let mut count = [0; 8];
        // The read fails if the timer has not expired.
        rustix::io::read(self.descriptor.get_ref(), &mut count).map_or(0, |_| u64::from_ne_bytes(count))
    }
}

fn timespec(duration: Duration) -> Timespec {
    Timespec { tv_sec: duration.as_secs().try_into().unwrap_or(i64::MAX), tv_nsec: i64::from(duration.subsec_nanos()) }
}
