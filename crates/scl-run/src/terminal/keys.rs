//! `scl __keys`: reports the keys that have sent a signal to its process group. It blocks all signals, so none ends it.

use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use rustix::event::{PollFd, PollFlags, poll};
use std::io::{self, Write};
use std::process::ExitCode;

/// The hidden command.
pub const KEYS_WORD: &str = "__keys";

/// `si_code` of signals that the kernel has sent, as for a key. Signals from processes have other codes.
const SI_KERNEL: i32 = 0x80;

/// A key that sends a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Key {
    /// Ctrl-C.
    Interrupt,
    /// Ctrl-Z.
    Suspend,
}

impl Key {
    const ALL: [(Self, Signal, &'static str); 2] =
        [(Key::Interrupt, Signal::SIGINT, "interrupt"), (Key::Suspend, Signal::SIGTSTP, "suspend")];

    /// The key that a line of `scl __keys` names.
    pub(super) fn of(line: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(.., word)| *word == line).map(|(key, ..)| key)
    }
}

/// The body of `scl __keys`: writes a line for each key, until standard input ends.
pub fn tell_keys() -> ExitCode {
    match tell() {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn tell() -> io::Result<()> {
    let signals: SigSet = Key::ALL.into_iter().map(|(_, signal, _)| signal).collect();
    SigSet::all().thread_block()?;
    let source = SignalFd::with_flags(&signals, SfdFlags::SFD_NONBLOCK)?;
    loop {
        let input = io::stdin();
        let mut ready = [PollFd::new(&source, PollFlags::IN), PollFd::new(&input, PollFlags::IN)];
        poll(&mut ready, None)?;
        let is_last = !ready[1].revents().is_empty();
        // Read these signals even if the input has ended: the kernel signals all processes of the group before one of
        // them can end because of the key.
        while let Some(signal) = source.read_signal()? {
            let sent = Key::ALL.iter().find(|(_, key, _)| *key as i32 == signal.ssi_signo.cast_signed());
            if let Some((.., word)) = sent.filter(|_| signal.ssi_code == SI_KERNEL) {
                println!("{word}");
                io::stdout().flush()?;
            }
        }
        if is_last {
            return Ok(());
        }
    }
}
