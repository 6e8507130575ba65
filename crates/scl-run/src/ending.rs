//! How a program ended, and whether that counts as success.

use rustix::process::Signal;
use signal_hook::low_level;
use std::fmt;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;

/// How a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// It exited with this code.
    Exited(i32),
    /// The signal with this number ended it.
    Killed(i32),
}

impl Ending {
    /// Returns true for a successful end. `asked_by` is the signal that asked the program to stop, if any.
    ///
    /// Besides code 0, ending by that signal counts as success, and so does code 128 + number, as shells report it.
    pub(crate) fn is_in_order(self, asked_by: Option<Signal>) -> bool {
        match self {
            Ending::Exited(0) => true,
            Ending::Exited(code) => asked_by.is_some_and(|signal| code == 128 + signal.as_raw()),
            Ending::Killed(number) => asked_by.is_some_and(|signal| number == signal.as_raw()),
        }
    }

    /// Returns true for the exit codes by which a shell or another launcher says that a signal ended its program: 128 +
    /// number.
    pub(crate) fn is_signal_of_child(self) -> bool {
        matches!(self, Ending::Exited(code) if Signal::from_named_raw(code - 128).is_some())
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Ending::Exited(code) => write!(f, "ended with exit code {code}"),
            Ending::Killed(number) => match (Signal::from_named_raw(*number), low_level::signal_name(*number)) {
                (None, _) => write!(f, "killed by a real-time signal"),
                (Some(_), None) => write!(f, "killed by signal {number}"),
                (Some(_), Some(name)) => write!(f, "killed by signal {number} ({name})"),
            },
        }
    }
}

impl From<ExitStatus> for Ending {
    fn from(status: ExitStatus) -> Self {
        // A program that has ended has either an exit code or the signal that killed it.
        status.code().map_or(Ending::Killed(status.signal().unwrap_or_default()), Ending::Exited)
    }
}

/// Returns the name of a signal, such as `SIGTERM`.
pub(crate) fn name_of(signal: Signal) -> &'static str {
    low_level::signal_name(signal.as_raw()).unwrap_or("a signal")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_is_in_order_if_it_is_zero_or_what_was_asked_for() {
        let term = Some(Signal::TERM);
        let cases = [
            (Ending::Exited(0), None, true),
            (Ending::Exited(0), term, true),
            (Ending::Exited(1), None, false),
            (Ending::Exited(1), term, false),
            (Ending::Exited(143), None, false),
            (Ending::Exited(143), term, true),
            (Ending::Killed(15), None, false),
            (Ending::Killed(15), term, true),
            (Ending::Killed(11), term, false),
            (Ending::Killed(9), term, false),
        ];
        for (ending, asked_by, expected) in cases {
            assert_eq!(ending.is_in_order(asked_by), expected, "{ending:?}, asked by {asked_by:?}");
        }
    }

    #[test]
    fn endings_name_the_code_or_the_signal() {
        assert_eq!(Ending::Exited(1).to_string(), "ended with exit code 1");
        assert_eq!(Ending::Killed(11).to_string(), "killed by signal 11 (SIGSEGV)");
        assert_eq!(Ending::Killed(34).to_string(), "killed by a real-time signal");
    }
}
