//! Deadlines that are nearly always met.
//!
//! A timeout of the async runtime is set and taken back for each call, and with one set, each wait of the runtime sets
//! and takes back a timer of the operating system: measured, that adds up to a third to a round trip. This timer is left
//! running instead: it expires now and then, finds that the call it was set for is long over, and is set anew.

use super::timer::Timer;
use std::io;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

/// Watches one deadline at a time.
#[derive(Debug)]
pub(crate) struct Watchdog {
    timer: Timer,
    /// When the timer expires; earlier than it has to is good enough.
    expires: Option<Instant>,
}

impl Watchdog {
    /// Needs a tokio runtime.
    pub(crate) fn new() -> io::Result<Self> {
        Ok(Self { timer: Timer::new()?, expires: None })
    }

    /// Ready when the deadline is past.
    pub(crate) fn poll_past(&mut self, cx: &mut Context<'_>, deadline: Instant) -> Poll<io::Result<()>> {
        loop {
            if self.expires.is_none_or(|expires| expires > deadline) {
                let left = deadline.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    return Poll::Ready(Ok(()));
                }
                self.timer.set(left, Duration::ZERO)?;
                self.expires = Some(deadline);
            }
            ready!(self.timer.poll_expired(cx))?;
            self.expires = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::future::poll_fn;

    #[tokio::test]
    async fn each_deadline_is_kept_whatever_the_timer_was_set_for_before() {
        let mut watchdog = Watchdog::new().unwrap();
        for millis in [30, 10, 20, 0] {
            let started = Instant::now();
            let far = started + Duration::from_secs(3600);
            let waker = std::task::Waker::noop();
            assert!(watchdog.poll_past(&mut Context::from_waker(waker), far).is_pending());
            let deadline = started + Duration::from_millis(millis);
            poll_fn(|cx| watchdog.poll_past(cx, deadline)).await.unwrap();
            assert!(Instant::now() >= deadline);
        }
    }
}
