//! What `scl run` itself has to say. A thread of its own says it, so that the supervisor never waits for a screen that
//! takes nothing (a paused `less`, Ctrl-S), and can still stop its programs.

use super::output::Output;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

/// Takes reports at once and writes them, in order, as soon as they can be written.
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

    /// Says something about a component.
    pub(crate) fn report(&self, component: usize, text: &str) {
        self.send(format!("{}  {text}\n", self.output.report_name(component)));
    }

    /// Says something about the whole run.
    pub(crate) fn announce(&self, text: &str) {
        self.send(format!("scl: {text}\n"));
    }

    /// The name of a component.
    pub(crate) fn name(&self, component: usize) -> &str {
        self.output.name(component)
    }

    /// Waits until everything has been written, but no longer than this.
    pub(crate) fn finish(self, patience: Duration) {
        drop(self.lines);
        let _ = self.written.recv_timeout(patience);
    }

    fn send(&self, line: String) {
        // The thread takes lines as long as this value lives.
        let _ = self.lines.send(line);
    }
}
