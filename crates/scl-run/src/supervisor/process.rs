//! The process of a program, and the reports about it that are still to be shown.

use super::super::children::Running;
use std::time::{Duration, Instant};

/// How long to wait for output after a program has ended: processes it started may still write.
const LATE_OUTPUT: Duration = Duration::from_millis(500);

/// The current or last process of a program.
#[derive(Debug)]
pub(super) struct Process {
    pub(super) number: usize,
    pub(super) running: Running,
    pub(super) open_streams: u8,
    pub(super) ended: Option<Instant>,
    /// Written after its last output.
    pub(super) reports: Vec<String>,
}

impl Process {
    pub(super) fn new(number: usize, running: Running) -> Self {
        Self { number, running, open_streams: 2, ended: None, reports: Vec::new() }
    }

    /// When it counts as drained at the latest, if it has ended.
    pub(super) fn drained_at(&self) -> Option<Instant> {
        self.ended.map(|at| at + LATE_OUTPUT)
    }

    /// Whether it has ended, and no more output of it is waited for.
    pub(super) fn is_drained(&self) -> bool {
        self.ended.is_some_and(|at| self.open_streams == 0 || at.elapsed() >= LATE_OUTPUT)
    }

    /// Whether it is drained, and all reports about it have been written.
    pub(super) fn is_silent(&self) -> bool {
        self.is_drained() && self.reports.is_empty()
    }
}
