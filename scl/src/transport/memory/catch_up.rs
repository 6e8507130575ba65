//! Waiting, without a runtime, for what senders hold back.

use crate::sync::unparks_this_thread;
use crate::transport::Receiver;
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll};
use std::thread;
use std::time::{Duration, Instant};

/// Receives until `end` has caught up with its senders or the time is over, and returns the messages.
///
/// A sender on the same thread cannot answer during this call.
pub(super) fn catch_up(end: &mut dyn Receiver, within: Duration) -> VecDeque<Bytes> {
    let started = Instant::now();
    let waker = unparks_this_thread();
    let mut cx = Context::from_waker(&waker);
    let mut fetched = VecDeque::new();
    end.forget_answers();
    loop {
        fetch(end, &mut cx, &mut fetched);
        if end.poll_caught_up(&mut cx).is_ready() {
            fetch(end, &mut cx, &mut fetched);
            return fetched;
        }
        match within.checked_sub(started.elapsed()) {
            Some(left) if !left.is_zero() => thread::park_timeout(left),
            _ => return fetched,
        }
    }
}

/// Receives what has arrived, up to what a connection holds: a busy sender could otherwise keep this loop running
/// forever.
fn fetch(end: &mut dyn Receiver, cx: &mut Context<'_>, fetched: &mut VecDeque<Bytes>) {
    for _ in 0..=super::IN_FLIGHT {
        match end.poll_recv(cx) {
            Poll::Ready(message) => fetched.push_back(message),
            Poll::Pending => return,
        }
    }
}
