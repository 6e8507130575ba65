//! Reports of `scl run` itself, written by a separate thread: the supervisor must not wait for a blocked terminal (a
//! paused `less`, Ctrl-S) while it has programs to stop.

use super::output::Output;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

/// Accepts reports without waiting and writes them in order.
#[derive(Debug)]
pub(crate) struct Reports {
    output: Arc<Output>,
    lines: Sender<String>,
    /// Closed when everything has been written.
    written: Receiver<()>,
}

impl Reports {
    /// Starts the thread that writes.
    pub(crate) fn new(output: Arc<Output>) -> Self {
        let (lines, to_write) = channel::<String>();
        let (writing, written) = channel();
        let screen = Arc::clone(&output);
        thread::spawn(move || {
            to_write.iter().for_each(|line| screen.write_report(&line));
            drop(writing);
        });
        Self { output, lines, written }
    }

    /// Reports on a program.
    pub(crate) fn report(&self, program: usize, text: &str) {
        self.send(format!("{}  {text}\n", self.output.report_name(program)));
    }

    /// Reports on the whole run.
    pub(crate) fn announce(&self, text: &str) {
        self.send(format!("scl: {text}\n"));
    }

    /// Waits until everything has been written, but no longer than this.
    pub(crate) fn finish(self, patience: Duration) {
        drop(self.lines);
        let _ = self.written.recv_timeout(patience);
    }

    fn send(&self, line: String) {
        // The thread runs until this sender is dropped.
        let _ = self.lines.send(line);
    }
}
