//! How a program ended, and whether that was in order.

use nix::sys::signal::Signal;
use nix::sys::wait::WaitStatus;
use std::fmt;

/// How a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// It returned this code.
    Exited(i32),
    /// This signal ended it.
    Killed(Signal),
    /// A signal without a name (a real-time signal) ended it.
    KilledByUnnamedSignal,
}

impl Ending {
    /// From the status of the operating system; `None` if the program is still running.
    pub(crate) fn from_wait(status: WaitStatus) -> Option<Self> {
        match status {
            WaitStatus::Exited(_, code) => Some(Ending::Exited(code)),
            WaitStatus::Signaled(_, signal, _) => Some(Ending::Killed(signal)),
            _ => None,
        }
    }

    /// Returns true for a successful end. `asked_by` is the signal that asked the program to stop, if any.
    ///
    /// Besides code 0, ending by that signal counts as success, and so does code 128 + number, as shells report it.
    pub(crate) fn is_in_order(self, asked_by: Option<Signal>) -> bool {
        match self {
            Ending::Exited(0) => true,
            Ending::Exited(code) => asked_by.is_some_and(|signal| code == 128 + signal as i32),
            Ending::Killed(signal) => asked_by == Some(signal),
            Ending::KilledByUnnamedSignal => false,
        }
    }

    /// Returns true for the exit codes by which a shell or another launcher says that a signal ended its program: 128 + number.
    pub(crate) fn is_signal_of_child(self) -> bool {
        matches!(self, Ending::Exited(code) if Signal::try_from(code - 128).is_ok())
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Ending::Exited(code) => write!(f, "ended with exit code {code}"),
            Ending::Killed(signal) => write!(f, "killed by signal {} ({})", *signal as i32, signal.as_str()),
            Ending::KilledByUnnamedSignal => write!(f, "killed by a real-time signal"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_is_in_order_if_it_is_zero_or_what_was_asked_for() {
        let term = Some(Signal::SIGTERM);
        let cases = [
            (Ending::Exited(0), None, true),
            (Ending::Exited(0), term, true),
            (Ending::Exited(1), None, false),
            (Ending::Exited(1), term, false),
            (Ending::Exited(143), None, false),
            (Ending::Exited(143), term, true),
            (Ending::Killed(Signal::SIGTERM), None, false),
            (Ending::Killed(Signal::SIGTERM), term, true),
            (Ending::Killed(Signal::SIGSEGV), term, false),
            (Ending::Killed(Signal::SIGKILL), term, false),
        ];
        for (ending, asked_by, expected) in cases {
            assert_eq!(ending.is_in_order(asked_by), expected, "{ending:?}, asked by {asked_by:?}");
        }
    }

    #[test]
    fn endings_name_the_code_or_the_signal() {
        assert_eq!(Ending::Exited(1).to_string(), "ended with exit code 1");
        assert_eq!(Ending::Killed(Signal::SIGSEGV).to_string(), "killed by signal 11 (SIGSEGV)");
    }
}
