//! Helpers of all pumps: windows, timers, the names of ends, and opening ends with retries and logged failures.

use crate::route::Route;
use scl::bridge::MirrorError;
use scl::host::text_with_causes;
use scl::transport::{TransportError, Window};
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::time::{Sleep, sleep};

/// Delay before a local end that could not be opened is tried again.
const RETRY: Duration = Duration::from_secs(1);

/// Maximum number of messages that a component here may have in flight into the gateway: with what the far component's
/// queue holds, no more than one window is lost when the gateway is killed.
const MESSAGES: u64 = crate::wire::WINDOW_MESSAGES as u64;

/// How many messages a pump carries before other tasks get their turn.
pub(super) const BATCH: usize = 64;

/// Maximum number of unanswered requests of a route. Beyond that, the oldest are given up: their requesters have long
/// since stopped waiting.
pub(super) const MOST_OPEN: usize = 4096;

/// How much a sending component may have unacknowledged on this route.
pub(super) fn window(route: &Route) -> Window {
    Window { messages: u64::from(route.queue).clamp(1, MESSAGES), bytes: crate::wire::WINDOW_BYTES }
}

/// A timer that may be off.
#[derive(Debug, Default)]
pub(super) struct Timer(Option<Pin<Box<Sleep>>>);

impl Timer {
    pub(super) fn start(&mut self, after: Duration) {
        self.0.get_or_insert_with(|| Box::pin(sleep(after)));
    }

    pub(super) fn stop(&mut self) {
        self.0 = None;
    }

    /// Returns true if the timer was started and has expired. Wakes the task when a running timer expires.
    pub(super) fn is_over(&mut self, cx: &mut Context<'_>) -> bool {
        self.0.as_mut().is_some_and(|sleep| sleep.as_mut().poll(cx).is_ready())
    }

    fn is_running(&mut self, cx: &mut Context<'_>) -> bool {
        self.0.as_mut().is_some_and(|sleep| sleep.as_mut().poll(cx) == Poll::Pending)
    }
}

/// Why a local end could not be opened.
#[derive(Debug, thiserror::Error)]
pub(super) enum LocalError {
    #[error(transparent)]
    Mirror(#[from] MirrorError),
    #[error(transparent)]
    Transport(#[from] TransportError),
}

/// Limits how often an end that could not be opened is tried again.
#[derive(Debug, Default)]
pub(super) struct Attempts {
    pause: Timer,
    logged: Option<String>,
}

impl Attempts {
    /// Opens an end, unless the last attempt has just failed. A failure is logged if it differs from the last one.
    pub(super) fn open<E>(
        &mut self,
        cx: &mut Context<'_>,
        route: &Route,
        open: impl FnOnce() -> Result<E, LocalError>,
    ) -> Option<E> {
        if self.pause.is_running(cx) {
            return None;
        }
        self.pause.stop();
        match open() {
            Ok(end) => {
                self.logged = None;
                Some(end)
            }
            Err(error) => {
                let text = text_with_causes(&error);
                if self.logged.as_ref() != Some(&text) {
                    tracing::error!(route = %route.key, "cannot open `{}` here: {text}", route.endpoint);
                    self.logged = Some(text);
                }
                self.pause.start(RETRY);
                // Registers the task's waker.
                let _not_yet = self.pause.is_running(cx);
                None
            }
        }
    }
}

/// `component.gate` of an end of a route, or its host.
pub(super) fn end_name(end: &crate::route::RouteEnd) -> String {
    match (&end.component, &end.gate) {
        (Some(component), Some(gate)) => format!("{component}.{gate}"),
        _ => format!("host {}", end.host),
    }
}

/// Returns the names of the component and gate at an end; empty if any component may connect there.
pub(super) fn names(end: &crate::route::RouteEnd) -> (&str, &str) {
    (end.component.as_deref().unwrap_or_default(), end.gate.as_deref().unwrap_or_default())
}
