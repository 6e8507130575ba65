//! The states of a component.

use super::super::restarts::Time;
use rustix::process::Signal;

/// What is happening to a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    /// To be started at this time.
    Waiting { until: Time },
    /// Its process is being started.
    Starting,
    /// Its process runs.
    Running,
    /// Its process has said that it is ready.
    Ready,
    /// Its process was asked to end, or reported that it is stopping. It is killed at this time; `None` if it has been
    /// killed already.
    Stopping { reason: StopReason, kill_at: Option<Time> },
    /// It has no process, and gets one only on request.
    Ended(Verdict),
}

/// Why a process is ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StopReason {
    /// All components are stopped, by this signal.
    Everything(Signal),
    /// A stop or restart of this component alone was requested.
    Request { start_again: bool },
    /// It has failed already: it was not ready or not alive in time.
    Failed,
    /// It is the wrong program, so another start would not help. SCL in the program has refused to run, and it ends by
    /// itself.
    Refused,
    /// The process itself reported that it is stopping.
    Own,
    /// Its first process ended by itself, and the others were asked to end.
    LeaderEnded,
}

/// How a component ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Successfully, also when all components were stopped.
    InOrder,
    /// On request.
    Stopped,
    /// It has failed, and is not started again.
    Failed,
}

impl StopReason {
    /// The signal that asked all components to stop, if that is the reason.
    pub(super) fn asked_by(self) -> Option<Signal> {
        match self {
            StopReason::Everything(signal) => Some(signal),
            _ => None,
        }
    }

    pub(super) fn signal(self) -> Signal {
        self.asked_by().unwrap_or(Signal::TERM)
    }

    /// Whether the processes were asked to end, so that a second signal would end an SCL program at once.
    pub(super) fn is_asked(self) -> bool {
        matches!(self, StopReason::Everything(_) | StopReason::Request { .. } | StopReason::LeaderEnded)
    }
}
