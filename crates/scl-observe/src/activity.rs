//! What a component does, in a word.

use std::time::Duration;

/// What a component does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Activity {
    /// It runs. Whether all required peers are connected is unknown, because it writes no figures.
    Running,
    /// It runs, and all required peers are connected.
    Ready,
    /// It runs, and waits for peers.
    Waiting,
    /// It runs, and has not written its figures for this long.
    Hangs(Duration),
    /// It was killed or has crashed.
    Dead,
    /// It does not run.
    Stopped,
}

impl Activity {
    /// One word: `waiting`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Ready => "ready",
            Self::Waiting => "waiting",
            Self::Hangs(_) => "hangs",
            Self::Dead => "dead",
            Self::Stopped => "stopped",
        }
    }
}
