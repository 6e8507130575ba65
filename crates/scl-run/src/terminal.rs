//! The terminal of `scl run`, lent to the one component whose entry has `input: terminal`.
//!
//! A program reads from a terminal, and changes its modes, only in the terminal's foreground; elsewhere the kernel
//! stops it. So the component's process group becomes the foreground one. The signals of keys such as Ctrl-C also go
//! there and not to `scl run`, so a process of ours in that group, [`keys`], reports them.

mod keys;

pub use keys::{KEYS_WORD, tell_keys};

use super::orphan_guard::this_program;
use super::orphans;
pub(crate) use keys::Key;
use nix::sys::signal::{self, SigSet, SigmaskHow};
use rustix::process::{Pid, Signal, getpgrp, kill_process_group};
use rustix::termios::{OptionalActions, Termios, tcgetattr, tcgetpgrp, tcsetattr, tcsetpgrp};
use scl_text::words;
use signal_hook::consts::SIGTSTP;
use std::io::{self, BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::process::{Child, Stdio};
use std::thread::{self, JoinHandle};

words! {
    /// Where a program's standard input comes from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub(crate) enum StandardInput {
        /// It is empty.
        #[default]
        Empty = "empty",
        /// The terminal of `scl run`.
        Terminal = "terminal",
    }
}

/// The terminal that is our standard input, while we are in its foreground.
#[derive(Debug, Clone)]
pub(crate) struct Terminal {
    /// The modes to restore.
    modes: Termios,
}

impl Terminal {
    /// Returns the terminal, with its current modes.
    ///
    /// # Errors
    ///
    /// Why it cannot be used, in a few words.
    pub(crate) fn open() -> Result<Self, &'static str> {
        let none = "the standard input of `scl run` is not its terminal";
        let foreground = tcgetpgrp(io::stdin()).map_err(|_| none)?;
        if foreground != getpgrp() {
            return Err("`scl run` is in the background");
        }
        Ok(Self { modes: tcgetattr(io::stdin()).map_err(|_| none)? })
    }

    /// Lends the terminal to a process group; `pressed` is called for each key that sends a signal.
    ///
    /// # Errors
    ///
    /// If no process can be started in that group, or the terminal refuses the group.
    pub(crate) fn lend(self, group: Pid, pressed: impl Fn(Key) + Send + 'static) -> io::Result<Loan> {
        let mut keys = with_signals_blocked(SigSet::all(), || {
            let mut command = this_program();
            command.arg(KEYS_WORD).process_group(group.as_raw_pid());
            orphans::spawn(command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()))
        })?;
        let told = keys.stdout.take();
        let reader = thread::spawn(move || {
            let lines = told.map(BufReader::new).into_iter().flat_map(BufRead::lines).map_while(Result::ok);
            lines.filter_map(|line| Key::of(&line)).for_each(pressed);
        });
        let loan = Loan { terminal: self, group, keys, reader };
        match hand_over(group) {
            Ok(()) => Ok(loan),
            Err(error) => {
                loan.end();
                Err(error)
            }
        }
    }

    /// Suspends `scl run` after Ctrl-Z, as a shell expects it of a program. When `scl run` is continued, continues the
    /// group, in the foreground if `scl run` is there.
    pub(crate) fn suspend(&self, group: Pid) {
        let of_group = tcgetattr(io::stdin());
        self.take_back(group);
        let _ = signal_hook::low_level::raise(SIGTSTP);
        if tcgetpgrp(io::stdin()).is_ok_and(|foreground| foreground == getpgrp()) {
            if let Ok(modes) = of_group {
                set_modes(&modes);
            }
            let _ = hand_over(group);
        }
        let _ = kill_process_group(group, Signal::CONT);
    }

    /// Puts this process into the foreground again and restores the modes, if `group` is in the foreground.
    fn take_back(&self, group: Pid) {
        let has_it = tcgetpgrp(io::stdin()).is_ok_and(|foreground| foreground == group);
        if has_it {
            let _ = set_foreground(getpgrp());
            set_modes(&self.modes);
        }
    }
}

/// A terminal that is lent.
#[derive(Debug)]
pub(crate) struct Loan {
    terminal: Terminal,
    group: Pid,
    keys: Child,
    reader: JoinHandle<()>,
}

impl Loan {
    /// Takes the terminal back, after the events of all keys so far have been sent.
    pub(crate) fn end(mut self) {
        // Close its input, which ends `scl __keys`.
        drop(self.keys.stdin.take());
        orphans::wait(&mut self.keys);
        let _ = self.reader.join();
        self.terminal.take_back(self.group);
    }
}

/// Puts a group into the foreground, and continues it: it may have been stopped because it was not there.
fn hand_over(group: Pid) -> io::Result<()> {
    set_foreground(group)?;
    // Ignore errors: the group may have ended.
    let _ = kill_process_group(group, Signal::CONT);
    Ok(())
}

fn set_foreground(group: Pid) -> io::Result<()> {
    Ok(from_background(|| tcsetpgrp(io::stdin(), group))?)
}

fn set_modes(modes: &Termios) {
    // Ignore errors: a terminal that is gone needs no modes.
    let _ = from_background(|| tcsetattr(io::stdin(), OptionalActions::Drain, modes));
}

/// Changes the terminal with SIGTTOU blocked: if we are in the background, the kernel would stop us otherwise.
fn from_background<T>(change: impl FnOnce() -> T) -> T {
    with_signals_blocked(SigSet::from(signal::Signal::SIGTTOU), change)
}

/// Runs `work` with these signals blocked. Processes that it starts inherit the mask.
fn with_signals_blocked<T>(signals: SigSet, work: impl FnOnce() -> T) -> T {
    let before = signals.thread_swap_mask(SigmaskHow::SIG_BLOCK);
    let done = work();
    let _ = before.map(|before| before.thread_set_mask());
    done
}
