//! Counts what became of the messages of a route at this host.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts of one route since the gateway started.
#[derive(Debug, Default)]
pub struct Counts {
    /// Messages taken by the far component if they leave this host, or by the component here if they arrive; for
    /// requests, the replies.
    carried: AtomicU64,
    /// Messages from a component here that the far component may or may not have taken; for requests, those without a
    /// reply.
    given_up: AtomicU64,
    /// Messages in this gateway: taken from one side, not acknowledged by the other.
    held: AtomicU64,
}

impl Counts {
    pub(crate) fn add_carried(&self, count: u64) {
        self.carried.fetch_add(count, Ordering::Relaxed);
    }

    pub(crate) fn add_given_up(&self, count: u64) {
        self.given_up.fetch_add(count, Ordering::Relaxed);
    }

    pub(crate) fn set_held(&self, count: u64) {
        self.held.store(count, Ordering::Relaxed);
    }

    /// Number of messages carried so far.
    pub fn carried(&self) -> u64 {
        self.carried.load(Ordering::Relaxed)
    }

    /// Number of messages whose fate is unknown.
    pub fn given_up(&self) -> u64 {
        self.given_up.load(Ordering::Relaxed)
    }

    /// Number of messages in this gateway now.
    pub fn held(&self) -> u64 {
        self.held.load(Ordering::Relaxed)
    }
}

/// `carried 12, given up 0, held 3`.
impl fmt::Display for Counts {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "carried {}, given up {}, held {}", self.carried(), self.given_up(), self.held())
    }
}
