//! Taps, where tools observe every message of a `pub`, `pull` or `rep` gate, with its number and time.

pub(crate) use crate::tap_meta::ObservedKind;

use crate::sync::{AbortOnDrop, lock};
use crate::tap_meta::{TapMeta, now_ns};
use crate::transport::Tap;
use bytes::Bytes;
use scl_fork::ProcessOwned;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::task::{Context, Waker};
use tokio::runtime::Handle;

/// The tap of one gate, shared by everything that the gate's messages pass through.
pub(crate) struct GateTap {
    shared: Option<ProcessOwned<Arc<Shared>>>,
    _task: Option<AbortOnDrop>,
}

struct Shared {
    end: Mutex<End>,
    /// Whether there is an observer. Without one, a message costs only this check and its number.
    observed: AtomicBool,
    /// Whether observers that join get the last message.
    latches: bool,
    sequence: AtomicU64,
    /// Copied from the end, which may be locked while a long message is encoded.
    dropped: AtomicU64,
}

struct End {
    tap: Box<dyn Tap>,
    task: Waker,
}

impl GateTap {
    /// Opens the tap; `tap` is `None` if the transport has no taps. `latches`: observers that join get the last
    /// message.
    pub(crate) fn new(tap: Option<Box<dyn Tap>>, latches: bool) -> Self {
        let Some(tap) = tap else { return Self { shared: None, _task: None } };
        let end = Mutex::new(End { tap, task: Waker::noop().clone() });
        let shared = Arc::new(Shared {
            end,
            observed: AtomicBool::new(false),
            latches,
            sequence: AtomicU64::new(0),
            dropped: AtomicU64::new(0),
        });
        let task = AbortOnDrop::drive(&Handle::current(), &shared, Shared::drive);
        Self { shared: Some(ProcessOwned::new(shared)), _task: Some(task) }
    }

    /// Shows a message to the observers, if there are any.
    pub(crate) fn observe(&self, kind: ObservedKind, call_id: u64, payload: &Bytes) {
        self.observe_with(kind, call_id, || payload.clone());
    }

    /// Like [`observe`](Self::observe), for a message that would have to be copied first: calls `payload` only if it is
    /// needed.
    pub(crate) fn observe_with(&self, kind: ObservedKind, call_id: u64, payload: impl FnOnce() -> Bytes) {
        if let Some(shared) = &self.shared {
            shared.observe(kind, call_id, payload);
        }
    }

    /// Returns the number of messages dropped because an observer reads slowly.
    pub(crate) fn dropped(&self) -> u64 {
        self.shared.as_ref().map_or(0, |shared| shared.dropped.load(Ordering::Relaxed))
    }

    /// Returns a function that returns the value of [`dropped`](Self::dropped), or 0 once the gate is gone.
    pub(crate) fn dropped_later(&self) -> impl Fn() -> u64 + Send + Sync + 'static {
        let shared = self.shared.as_deref().map(Arc::downgrade);
        move || shared.as_ref().and_then(Weak::upgrade).map_or(0, |shared| shared.dropped.load(Ordering::Relaxed))
    }
}

impl Shared {
    fn drive(&self, cx: &mut Context<'_>) {
        let mut end = lock(&self.end);
        end.task.clone_from(cx.waker());
        // Set this before a new observer is told that it is connected, so that a message sent right afterwards waits
        // for the lock and is observed.
        self.observed.store(true, Ordering::Release);
        let is_observed = end.tap.drive(cx);
        self.observed.store(is_observed, Ordering::Release);
    }

    fn observe(&self, kind: ObservedKind, call_id: u64, payload: impl FnOnce() -> Bytes) {
        // Count even without observers, so that an observer can tell a gap from its own absence.
        let sequence = self.sequence.fetch_add(1, Ordering::Relaxed);
        if !self.latches && !self.observed.load(Ordering::Acquire) {
            return;
        }
        let payload = payload();
        let meta = TapMeta { sequence, sent_ns: now_ns(), call_id, kind, latched: false };
        let mut end = lock(&self.end);
        let End { tap, task } = &mut *end;
        tap.observe(&mut Context::from_waker(task), &payload, &meta.encode());
        if self.latches {
            tap.latch(&payload, &TapMeta { latched: true, ..meta }.encode());
        }
        self.dropped.store(tap.dropped(), Ordering::Relaxed);
    }
}
