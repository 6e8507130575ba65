//! Text for the user: all output of the command line is written here, so that failed writes are detected in one place.
//!
//! A command prints without checking for errors, and its `main` ends with [`finish_output`], which reports the first
//! one. A command that prints a stream checks [`output_is_closed`] after each message, to end when no more can be
//! printed. Lints forbid other ways of writing to standard output.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::OnceLock;

/// Exit code: the result could not be written.
const COULD_NOT_WRITE: u8 = 2;

/// The first failed write to standard output.
static FAILURE: OnceLock<io::Error> = OnceLock::new();

/// Writes to standard output without adding a line break. After a failed write, nothing more is written.
pub fn print_out(text: &str) {
    print_out_bytes(text.as_bytes());
}

/// [`print_out`] for bytes that need not be UTF-8.
pub fn print_out_bytes(bytes: &[u8]) {
    if output_is_closed() {
        return;
    }
    let mut out = io::stdout().lock();
    // Flush, because writes that are left in the buffer until the process exits fail silently.
    note_failure(out.write_all(bytes).and_then(|()| out.flush()));
}

/// Whether a write to standard output has failed: its reader has gone, or the disk is full.
pub fn output_is_closed() -> bool {
    FAILURE.get().is_some()
}

/// Whether the reader of standard output has gone, for commands that may have nothing to print for long.
pub fn reader_has_gone() -> bool {
    let output = io::stdout();
    let mut polled = [PollFd::new(&output, PollFlags::empty())];
    let is_polled = poll(&mut polled, Some(&Timespec::default())).is_ok();
    is_polled && polled[0].revents().intersects(PollFlags::ERR | PollFlags::HUP)
}

/// Whether standard output is a terminal.
pub fn output_is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Remembers a failed write of a library that writes to standard output by itself.
pub fn note_failure(written: io::Result<()>) {
    if let Err(error) = written {
        // Only the first one matters.
        let _known = FAILURE.set(error);
    }
}

/// The exit code of a program that has done its work: `code`, unless its output could not be written, which is
/// reported. If a reader has closed the output (`scl check | head`), that is no error.
pub fn finish_output(code: ExitCode) -> ExitCode {
    match FAILURE.get() {
        None => code,
        Some(error) if error.kind() == ErrorKind::BrokenPipe => code,
        Some(error) => {
            print_err(&format!("error: cannot write to standard output: {error}\n"));
            ExitCode::from(COULD_NOT_WRITE)
        }
    }
}

/// Writes to standard error without adding a line break.
pub fn print_err(text: &str) {
    // There is nowhere left to report a failure.
    let _failed = io::stderr().lock().write_all(text.as_bytes());
}
