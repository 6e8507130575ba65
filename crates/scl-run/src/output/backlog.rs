//! Lines on their way to the streams of this process.

use super::super::lock::lock;
use super::LogStream;
use scl_terminal::{output_is_closed, print_out_bytes};
use std::collections::{BTreeMap, VecDeque};
use std::io::{self, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Lines of programs are dropped while more bytes than this wait.
const LONGEST: usize = 16 << 20;
/// At most one longer line is queued at a time; the next one waits for it while the reader makes progress.
const HUGE: usize = 1 << 20;
/// A reader that reads nothing for this long has stopped reading.
const STALLED: Duration = Duration::from_secs(1);
/// Maximum number of bytes written at once; small, so that the progress of a slow reader is visible.
const CHUNK: usize = 64 << 10;

/// Bytes that wait to be written, in order.
#[derive(Debug, Default)]
pub(super) struct Backlog {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    parts: VecDeque<Part>,
    /// Total length of all lines; of each line, at most [`HUGE`] bytes count.
    bytes: usize,
    has_huge: bool,
    is_writing: bool,
    /// Number of bytes that were written.
    written: u64,
    /// Number of lines dropped for lack of room, by program.
    dropped: BTreeMap<usize, u64>,
}

/// Whole lines for one stream.
#[derive(Debug)]
struct Part {
    stream: LogStream,
    is_report: bool,
    bytes: Vec<u8>,
}

/// The result of writing.
#[derive(Debug)]
pub(super) struct Written {
    /// Number of lines dropped after what was written, by program.
    pub(super) dropped: BTreeMap<usize, u64>,
    /// Whether the programs' lines could not be written, because their reader has closed the stream.
    pub(super) is_lost: bool,
}

impl Backlog {
    /// Adds a line of a program, or drops and counts it.
    pub(super) fn add_line(&self, program: usize, stream: LogStream, line: &[u8]) {
        let mut state = lock(&self.state);
        let is_huge = line.len() > HUGE;
        if is_huge {
            state = self.wait(state, STALLED, |state| state.has_huge);
        }
        if state.bytes < LONGEST && !(is_huge && state.has_huge) {
            state.add(stream, false, line);
            self.changed.notify_all();
        } else {
            *state.dropped.entry(program).or_default() += 1;
        }
    }

    /// Adds a report, which is never dropped.
    pub(super) fn add_report(&self, line: &str) {
        lock(&self.state).add(LogStream::Stderr, true, line.as_bytes());
        self.changed.notify_all();
    }

    /// Waits until everything is written, or until nothing was written for `patience`.
    pub(super) fn finish(&self, patience: Duration) {
        drop(self.wait(lock(&self.state), patience, |state| state.is_writing || !state.parts.is_empty()));
    }

    /// Waits while a condition holds. Gives up if nothing is written for `patience`.
    fn wait<'a>(
        &self,
        mut state: MutexGuard<'a, State>,
        patience: Duration,
        condition: impl Fn(&State) -> bool,
    ) -> MutexGuard<'a, State> {
        while condition(&state) {
            let written = state.written;
            let waited = self.changed.wait_timeout(state, patience).unwrap_or_else(PoisonError::into_inner);
            state = waited.0;
            if waited.1.timed_out() && state.written == written {
                break;
            }
        }
        state
    }

    /// Waits for something to write, and writes it.
    pub(super) fn write(&self) -> Written {
        let (parts, dropped) = self.take();
        let mut is_lost = false;
        for part in parts {
            let written = part.bytes.chunks(CHUNK).try_for_each(|chunk| {
                write(part.stream, chunk)?;
                lock(&self.state).written += chunk.len() as u64;
                self.changed.notify_all();
                Ok::<_, io::Error>(())
            });
            // A failed report is ignored: if standard error is closed, there is no place to report that.
            is_lost |= written.is_err() && !part.is_report;
        }
        Written { dropped, is_lost }
    }

    /// Waits for something to write. Returns it, with the numbers of lines that were dropped after it.
    fn take(&self) -> (VecDeque<Part>, BTreeMap<usize, u64>) {
        let mut state = lock(&self.state);
        state.is_writing = false;
        self.changed.notify_all();
        let is_idle = |state: &mut State| state.parts.is_empty();
        let mut state = self.changed.wait_while(state, is_idle).unwrap_or_else(PoisonError::into_inner);
        state.is_writing = true;
        (state.bytes, state.has_huge) = (0, false);
        (std::mem::take(&mut state.parts), std::mem::take(&mut state.dropped))
    }
}

impl State {
    fn add(&mut self, stream: LogStream, is_report: bool, line: &[u8]) {
        self.bytes += line.len().min(HUGE);
        self.has_huge |= line.len() > HUGE;
        match self.parts.back_mut().filter(|part| part.stream == stream && part.is_report == is_report) {
            Some(part) => part.bytes.extend_from_slice(line),
            None => self.parts.push_back(Part { stream, is_report, bytes: line.to_owned() }),
        }
    }
}

fn write(stream: LogStream, bytes: &[u8]) -> io::Result<()> {
    match stream {
        LogStream::Stdout => {
            print_out_bytes(bytes);
            if output_is_closed() { Err(io::ErrorKind::WriteZero.into()) } else { Ok(()) }
        }
        LogStream::Stderr => {
            let mut err = io::stderr().lock();
            err.write_all(bytes).and_then(|()| err.flush())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_nobody_takes_are_counted_and_reports_kept() {
        let backlog = Backlog::default();
        let line = vec![b'x'; HUGE];
        (0..LONGEST / HUGE).for_each(|_| backlog.add_line(0, LogStream::Stdout, &line));
        [1, 0, 1].into_iter().for_each(|program| backlog.add_line(program, LogStream::Stdout, b"one more"));
        backlog.add_report("report\n");
        let (parts, dropped) = backlog.take();
        let lengths: Vec<_> = parts.iter().map(|part| (part.stream, part.bytes.len())).collect();
        assert_eq!(lengths, [(LogStream::Stdout, LONGEST), (LogStream::Stderr, 7)]);
        assert_eq!(dropped, BTreeMap::from([(0, 1), (1, 2)]));
        // There is room again.
        backlog.add_line(0, LogStream::Stdout, &line);
        assert!(backlog.take().1.is_empty());
    }

    #[test]
    fn a_huge_line_leaves_room_for_others() {
        let backlog = Backlog::default();
        backlog.add_line(0, LogStream::Stdout, &vec![b'x'; 2 * LONGEST]);
        backlog.add_line(0, LogStream::Stdout, b"end");
        assert!(backlog.take().1.is_empty());
    }

    #[test]
    fn streams_of_one_screen_keep_their_order() {
        let backlog = Backlog::default();
        for (stream, line) in
            [(LogStream::Stdout, "1"), (LogStream::Stdout, "2"), (LogStream::Stderr, "3"), (LogStream::Stdout, "4")]
        {
            backlog.add_line(0, stream, line.as_bytes());
        }
        backlog.add_report("5");
        let (parts, _) = backlog.take();
        let texts: Vec<_> = parts.iter().map(|part| String::from_utf8_lossy(&part.bytes).into_owned()).collect();
        assert_eq!(texts, ["12", "3", "4", "5"]);
    }
}
