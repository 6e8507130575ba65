//! Waiting for messages that do not come within the `deadline` of a gate.

use super::inbox::{Inbox, Untold};
use crate::error::{BlockingError, GateName, RecvError};
use crate::state::ComponentState;
use crate::sync::lock;
use crate::time::Watchdog;
use std::future::{pending, poll_fn};
use std::io;
use std::pin::pin;
use std::sync::{Arc, Mutex, Weak};
use std::task::Poll;
use std::time::Instant;

/// Waits until messages are missing of which the program was not told, and returns how many.
///
/// It holds the gate and its component weakly, so that it can be kept while they are used, and fails when they are
/// closed.
pub(super) fn wait(
    gate: GateName,
    state: &Arc<ComponentState>,
    inbox: Weak<Mutex<Inbox>>,
) -> impl Future<Output = Result<u64, RecvError>> + Send + use<> {
    let (changes, state) = (state.changes(), Arc::downgrade(state));
    async move {
        let blocking = |source| RecvError::Blocking { gate, source };
        let refused = |source| RecvError::Timer { gate, source };
        let (mut watchdog, mut failed) = (None, None);
        loop {
            let mut changed = pin!(changes.next());
            // Registered before the look, so that no change is overlooked.
            changed.as_mut().enable();
            let Some(untold) = look(&state, &inbox).map_err(blocking)? else { return pending().await };
            let next = match untold {
                Untold::Missed(untold) => return Ok(untold.get()),
                Untold::NoneBefore(next) => next,
            };
            if let Some(source) = failed.take() {
                return Err(refused(source));
            }
            let Some(next) = next else {
                changed.await;
                continue;
            };
            let timer = match &mut watchdog {
                Some(timer) => timer,
                none => none.insert(start_timer(&state).map_err(refused)?),
            };
            let deadline = tokio::time::Instant::now() + next.saturating_duration_since(Instant::now());
            let waited = poll_fn(|cx| match timer.poll_past(cx, deadline) {
                Poll::Pending => changed.as_mut().poll(cx).map(Ok),
                expired => expired,
            });
            // A timer also fails when its runtime has ended, which the next look finds.
            failed = waited.await.err();
        }
    }
}

/// Looks for missed messages. Returns `None` after a stop request, when calls stay pending.
fn look(state: &Weak<ComponentState>, inbox: &Weak<Mutex<Inbox>>) -> Result<Option<Untold>, BlockingError> {
    let state = state.upgrade().ok_or(BlockingError::Closed)?;
    state.check()?;
    if state.is_stopped() {
        return Ok(None);
    }
    let inbox = inbox.upgrade().ok_or(BlockingError::Closed)?;
    let untold = lock(&inbox).tell_missed();
    Ok(Some(untold))
}

/// Starts a timer on the component's runtime: the future may be polled outside of one.
fn start_timer(state: &Weak<ComponentState>) -> io::Result<Watchdog> {
    let state = state.upgrade().ok_or_else(|| io::Error::other(BlockingError::Closed))?;
    let _runtime = state.enter();
    Watchdog::new()
}
