//! The events that the threads of a run send to its supervisor.

use super::control::ReceivedRequest;
use super::ending::Ending;
use super::lifecycle::Notice;
use super::terminal::Key;
use rustix::process::{Pid, Signal};

/// An event that another thread sends to the supervisor.
#[derive(Debug)]
pub(crate) enum Event {
    /// The first process of a program ended, but others that it has started are still running.
    LeaderEnded { process: usize, ending: Ending },
    /// All processes of a program ended, or the first process of a build. `ending` is that of the first process.
    Ended { process: usize, ending: Ending },
    /// One of the two streams of a program ended.
    StreamClosed { process: usize },
    /// A process of this group sent a notice.
    Notified { group: Pid, notice: Notice },
    /// A key has sent a signal to the program to which the terminal is lent.
    Key { process: usize, key: Key },
    /// The first process of a program was stopped because the terminal is not lent to it.
    StoppedByTerminal { process: usize, signal: Signal },
    /// The reader of our output has closed it.
    OutputLost,
    /// A signal asks us to stop.
    Signalled(Signal),
    /// Another `scl` sent a request.
    Requested(ReceivedRequest),
}
