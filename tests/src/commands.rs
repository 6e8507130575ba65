//! The counterpart of [`Process`](crate::Process) inside a test program: reads commands line by line and answers each
//! with a line.

use std::io::Write;
use std::ops::Range;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// The commands that a test gives to this program.
pub struct Commands {
    lines: UnboundedReceiver<String>,
    /// The next one, if it has been looked for.
    peeked: Option<String>,
    /// Whether none follows.
    ended: bool,
}

impl Commands {
    /// Starts reading this program's standard input.
    pub fn listen() -> Self {
        let (sender, receiver) = unbounded_channel();
        std::thread::spawn(move || {
            for line in std::io::stdin().lines().map_while(Result::ok) {
                let _program_ends = sender.send(line);
            }
        });
        Self { lines: receiver, peeked: None, ended: false }
    }

    /// Whether a command has arrived, or none will.
    pub fn is_waiting(&self) -> bool {
        self.peeked.is_some() || !self.lines.is_empty() || self.lines.is_closed()
    }

    /// Waits until [`next`](Self::next) returns at once, without a turn for other tasks.
    pub async fn arrived(&mut self) {
        // Not asked again at the end: whatever is ready, the runtime may give others their turn first.
        if self.peeked.is_none() && !self.ended {
            self.peeked = self.lines.recv().await;
            self.ended = self.peeked.is_none();
        }
    }

    /// The next command, split into words; `None` when the test has closed the input.
    pub async fn next(&mut self) -> Option<Vec<String>> {
        self.arrived().await;
        self.peeked.take().map(|line| words(&line))
    }

    /// [`next`](Self::next) for a program without async.
    pub fn next_blocking(&mut self) -> Option<Vec<String>> {
        self.peeked.take().or_else(|| self.lines.blocking_recv()).map(|line| words(&line))
    }
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// Answers the test with a line.
pub fn say(line: impl std::fmt::Display) {
    let mut output = std::io::stdout().lock();
    // The test may have ended.
    let _written = writeln!(output, "{line}").and_then(|()| output.flush());
}

/// Answers the test with an error and its causes, on one line.
pub fn say_error(error: impl Into<scl::Error>) {
    let error = error.into();
    say(format!("error: {error:?}").replace("\n  caused by", ""));
}

/// Answers the test with a value as a text, or with an error.
pub fn say_result<T, E: Into<scl::Error>>(result: Result<T, E>, text: impl Fn(T) -> String) {
    match result {
        Ok(value) => say(text(value)),
        Err(error) => say_error(error),
    }
}

/// Stops this program (SIGSTOP) until the test resumes it.
pub fn stop_self() {
    if rustix::process::kill_process(rustix::process::getpid(), rustix::process::Signal::STOP).is_err() {
        say("cannot stop");
    }
}

/// Values in order of arrival, with consecutive ones merged: `0..10 12..13`.
pub fn ranges(values: &[u64]) -> String {
    let mut ranges: Vec<Range<u64>> = Vec::new();
    for &value in values {
        match ranges.last_mut() {
            Some(last) if last.end == value => last.end += 1,
            _ => ranges.push(value..value + 1),
        }
    }
    ranges.iter().map(|range| format!("{}..{}", range.start, range.end)).collect::<Vec<_>>().join(" ")
}
