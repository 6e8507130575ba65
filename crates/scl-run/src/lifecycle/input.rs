//! What happens to a component, and what is to be done for it.

use super::super::ending::Ending;
use rustix::process::Signal;
use std::time::Duration;

/// What happens to a component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Input {
    /// Its process was started.
    Started,
    /// It could not be started, because of this.
    CannotStart(String),
    /// The first of its processes ended. Others are still running, which are to end with it.
    LeaderEnded,
    /// Its process and all processes that it has started ended.
    Exited(Ending),
    /// Its process sent a notice.
    Notified(Notice),
    /// Its process is the wrong program, as this report says.
    Refused(String),
    /// All components are to stop.
    StopAll(Signal),
    /// The process must end now.
    Kill,
    /// A stop of this component is requested.
    Stop,
    /// A restart of this component is requested.
    Restart,
    /// Time has passed.
    Time,
}

/// What a process says about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Notice {
    /// `READY=1`
    Ready,
    /// `STOPPING=1`
    Stopping,
    /// `WATCHDOG=1`
    Alive,
    /// `STATUS=...`
    Status(String),
    /// `X_SCL_OPENS=...`: it has tried to open this component, which it was not started as.
    Opens(String),
}

/// What is to be done for a component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Action {
    /// Start a process, and answer with [`Input::Started`] or [`Input::CannotStart`].
    Start,
    /// Send a signal to the process and those that it has started, and again to those that missed it.
    Signal(Signal),
    /// Tell the user this.
    Report(String),
    /// Tell the user how the process ended, and after how long.
    ReportEnd(Ending, Duration),
}
