//! Logging refused connections, however many there are.

use std::io;
use std::time::{Duration, Instant};

/// Minimum interval between two log lines; each gives the number of refusals since the one before.
const PERIOD: Duration = Duration::from_secs(60);

#[derive(Default)]
pub(super) struct Refusals {
    logged: Option<Instant>,
    /// Number of refusals since the last log line.
    count: u64,
}

impl Refusals {
    pub(super) fn log(&mut self, endpoint: &str, error: &io::Error) {
        self.count += 1;
        if self.logged.is_some_and(|logged| logged.elapsed() < PERIOD) {
            return;
        }
        tracing::warn!(endpoint, %error, connections = self.count, "refusing connections");
        *self = Self { logged: Some(Instant::now()), count: 0 };
    }
}
