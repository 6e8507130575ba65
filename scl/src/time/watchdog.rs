//! Deadlines that are nearly always met.
//!
//! A timeout of the async runtime would be set and cancelled in each call, and while one is set, each wait of the
//! runtime sets and cancels a timer of the operating system. Measured, that adds up to a third to a round trip. This
//! timer is left running instead: it expires now and then, usually long after the call it was set for has returned, and
//! is set again.

use super::clock;
use super::timer::Timer;
use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::time::{Instant, Sleep, sleep_until};

/// Watches one deadline at a time.
#[derive(Debug)]
pub(crate) struct Watchdog {
    timer: Timer,
    /// Used instead of `timer` while tokio's clock is paused in a test.
    paused: Option<Pin<Box<Sleep>>>,
    /// When the running timer expires; this may be before the deadline.
    expires: Option<Instant>,
}

impl Watchdog {
    /// Creates a watchdog. Must be called inside a tokio runtime.
    pub(crate) fn new() -> io::Result<Self> {
        Ok(Self { timer: Timer::new()?, paused: None, expires: None })
    }

    /// Ready when the deadline has passed on tokio's clock, which tests can pause.
    ///
    /// # Errors
    /// The timer has failed. The caller must give up as if the deadline had passed: it would not be woken again.
    pub(crate) fn poll_past(&mut self, cx: &mut Context<'_>, deadline: Instant) -> Poll<io::Result<()>> {
        loop {
            if self.expires.is_none_or(|expires| expires > deadline) {
                let left = deadline.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    return Poll::Ready(Ok(()));
                }
                self.set(deadline, left)?;
            }
            match &mut self.paused {
                Some(sleep) => ready!(sleep.as_mut().poll(cx)),
                None => {
                    ready!(self.timer.poll_expired(cx))?;
                }
            }
            self.expires = None;
        }
    }

    fn set(&mut self, deadline: Instant, left: Duration) -> io::Result<()> {
        // Checked only here, because the check costs more than a poll.
        if clock::is_paused() {
            self.paused = Some(Box::pin(sleep_until(deadline)));
        } else {
            self.paused = None;
            self.timer.set(left, Duration::ZERO)?;
        }
        self.expires = Some(deadline);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::future::poll_fn;
    use std::task::Waker;

    async fn keep_deadlines(millis: &[u64]) {
        let mut watchdog = Watchdog::new().unwrap();
        for millis in millis {
            let start = Instant::now();
            let far = start + Duration::from_secs(3600);
            assert!(watchdog.poll_past(&mut Context::from_waker(Waker::noop()), far).is_pending());
            let deadline = start + Duration::from_millis(*millis);
            poll_fn(|cx| watchdog.poll_past(cx, deadline)).await.unwrap();
            assert!(Instant::now() >= deadline);
        }
    }

    #[tokio::test]
    async fn each_deadline_is_kept_whatever_the_timer_was_set_for_before() {
        keep_deadlines(&[30, 10, 20, 0]).await;
    }

    #[tokio::test(start_paused = true)]
    async fn a_paused_clock_is_followed() {
        keep_deadlines(&[3_000_000, 1_000_000, 2_000_000, 0]).await;
    }

    #[tokio::test]
    async fn the_clock_may_be_paused_and_resumed_between_deadlines() {
        let mut watchdog = Watchdog::new().unwrap();
        for (millis, pause) in [(10, true), (10_000_000, false), (10, true), (10_000_000, false)] {
            let deadline = Instant::now() + Duration::from_millis(millis);
            poll_fn(|cx| watchdog.poll_past(cx, deadline)).await.unwrap();
            assert!(Instant::now() >= deadline);
            if pause { tokio::time::pause() } else { tokio::time::resume() }
        }
    }

    #[test]
    fn a_timer_whose_runtime_has_ended_is_an_error() {
        let mut watchdog = super::super::tests::in_a_runtime_that_ends(|| Watchdog::new().unwrap());
        let polled =
            watchdog.poll_past(&mut Context::from_waker(Waker::noop()), Instant::now() + Duration::from_secs(1));
        assert!(matches!(polled, Poll::Ready(Err(_))), "{polled:?}");
    }
}
