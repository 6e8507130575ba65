//! What the threads of a run tell its supervisor.

use super::control::ReceivedRequest;
use super::ending::Ending;
use super::lifecycle::Notice;
use super::terminal::Key;
use rustix::process::{Pid, Signal};

/// What the other threads tell the supervisor.
#[derive(Debug)]
pub(crate) enum Event {
    /// The first process of a program ended, and others that it has started have not.
    LeaderEnded { process: usize, ending: Ending },
    /// A program ended, with all its processes; of a build, the first one. `ending` is that of the first one.
    Ended { process: usize, ending: Ending },
    /// One of the two streams of a program ended.
    StreamClosed { process: usize },
    /// A process of this group said something about itself.
    Notified { group: Pid, notice: Notice },
    /// A key of the terminal has sent a signal to the program to which it is lent.
    Key { process: usize, key: Key },
    /// The first process of a program was stopped because the terminal is not lent to it.
    StoppedByTerminal { process: usize, signal: Signal },
    /// The reader of our output has gone.
    OutputLost,
    /// A signal asks us to stop.
    Signalled(Signal),
    /// Another `scl` asks for something.
    Requested(ReceivedRequest),
}
