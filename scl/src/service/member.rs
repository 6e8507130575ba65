//! One component of a process that a service manager watches: whether it is ready, and whether it is alive.

use super::Service;
use crate::sync::lock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What is known of one component.
///
/// A component proves that it is alive by calls to its gates ([`called`](Self::called)), and by a regular
/// [`tick`](Self::tick), which a task on the component's runtime makes. On the program's own current-thread runtime,
/// the tick alone is proof: a program that computes keeps the runtime from running its tasks. Elsewhere the runtime
/// goes on while the program hangs, so the tick `follows_calls`: it counts only if a call was made since the last
/// report or is waiting now, or if no call was ever made.
pub(crate) struct Member {
    service: Arc<Service>,
    follows_calls: bool,
    readiness: Mutex<Readiness>,
    /// Whether a gate was ever called.
    has_called: AtomicBool,
    /// Whether a gate was called, or a tick counted, since the last report. Both stay set if the manager wants no
    /// reports.
    called: AtomicBool,
    ticked: AtomicBool,
    /// Number of waiting calls that [`wait`](Self::wait) has counted.
    waiting: AtomicUsize,
}

#[derive(Default)]
struct Readiness {
    was_ready: bool,
    missing: Vec<String>,
}

/// A call that waits.
pub(crate) struct Waiting<'a>(&'a Member);

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.waiting.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Member {
    pub(super) fn new(service: Arc<Service>, follows_calls: bool) -> Self {
        let unwatched = service.watchdog.is_none();
        Self {
            service,
            follows_calls,
            readiness: Mutex::default(),
            has_called: AtomicBool::new(false),
            called: AtomicBool::new(unwatched),
            ticked: AtomicBool::new(unwatched),
            waiting: AtomicUsize::new(0),
        }
    }

    /// Returns how often to tick, if the manager wants to know that the process is alive: four times in its period, so
    /// that a call that has just begun to wait is reported within half of it.
    pub(crate) fn tick_period(&self) -> Option<Duration> {
        self.service.watchdog.map(|period| (period / 4).max(Duration::from_micros(100)))
    }

    /// Records that the program has called a gate. Costs two atomic reads, except for the first call after each report.
    pub(crate) fn called(&self) {
        if self.called.load(Ordering::Relaxed) {
            return;
        }
        self.has_called.store(true, Ordering::Relaxed);
        self.called.store(true, Ordering::Relaxed);
        if let Some(period) = self.service.watchdog {
            // Report rarely here: while a program calls often, the ticks report it.
            self.service.report_alive(period / 2);
        }
    }

    /// Counts a call that waits until the returned value is dropped.
    pub(crate) fn wait(&self) -> Waiting<'_> {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        Waiting(self)
    }

    /// Reports that the component is alive, if this tick proves it. Must be called regularly. `waits` returns true if
    /// any call waits that [`wait`](Self::wait) has not counted.
    pub(crate) fn tick(&self, waits: impl FnOnce() -> bool) {
        let is_alive = !self.follows_calls
            || !self.has_called.load(Ordering::Relaxed)
            || self.called.load(Ordering::Relaxed)
            || self.waiting.load(Ordering::Relaxed) > 0
            || waits();
        if is_alive && self.service.watchdog.is_some() {
            self.ticked.store(true, Ordering::Relaxed);
            self.service.report_alive(Duration::ZERO);
        }
    }

    /// Reports the names of the required peers that are not connected.
    pub(crate) fn report_missing(&self, missing: Vec<String>) {
        let changed = {
            let mut readiness = lock(&self.readiness);
            let first = !readiness.was_ready && missing.is_empty();
            readiness.was_ready |= first;
            let changed = first || readiness.missing != missing;
            readiness.missing = missing;
            changed
        };
        if changed || self.service.untold.load(Ordering::Relaxed) {
            self.service.report_changes();
        }
    }

    pub(crate) fn was_ready(&self) -> bool {
        lock(&self.readiness).was_ready
    }

    pub(super) fn missing(&self) -> Vec<String> {
        lock(&self.readiness).missing.clone()
    }

    pub(super) fn was_alive(&self) -> bool {
        self.called.load(Ordering::Relaxed) || self.ticked.load(Ordering::Relaxed)
    }

    pub(super) fn forget_life(&self) {
        self.called.store(false, Ordering::Relaxed);
        self.ticked.store(false, Ordering::Relaxed);
    }
}
