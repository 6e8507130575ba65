//! What a component prints: the last lines, and those that follow, as `scl log` shows them.

use scl_observe::Commands;
use serde_json::{Value as Json, json};
use std::mem::take;
use std::process::Stdio;
use std::time::Duration;
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader, Lines};
use tokio::process::{Child, ChildStdout};
use tokio::time::{Instant, sleep_until, timeout_at};

/// Number of earlier lines that are shown.
const EARLIER: &str = "200";
/// Maximum number of lines in one event.
const MOST_LINES: usize = 200;
/// How long an event waits for further lines.
const GATHERING: Duration = Duration::from_millis(100);
/// The time between two attempts to read a log that is not there.
const RETRY: Duration = Duration::from_secs(2);

/// The log of one component.
pub(crate) struct Log {
    commands: Commands,
    component: String,
    reading: Option<Reading>,
    retry: Instant,
    /// What has been read and not been shown yet.
    lines: Vec<String>,
    /// Why there is no log, as it was shown last.
    error: String,
}

struct Reading {
    process: Child,
    lines: Lines<BufReader<ChildStdout>>,
}

impl Log {
    pub(crate) fn new(commands: Commands, component: String) -> Self {
        let (lines, error) = (Vec::new(), String::new());
        Self { commands, component, reading: None, retry: Instant::now(), lines, error }
    }

    /// Waits until there is something new to show, and returns that.
    ///
    /// # Cancel safety
    /// Cancel safe: what has been read is shown by the next call.
    pub(crate) async fn next(&mut self) -> Json {
        loop {
            if self.gather().await {
                return json!({"component": self.component, "lines": take(&mut self.lines)});
            }
            if let Some(error) = self.end().await {
                return json!({"component": self.component, "error": error});
            }
            sleep_until(self.retry).await;
            self.retry = Instant::now() + RETRY;
            self.reading = self.start();
        }
    }

    /// Reads lines for a moment. False if there are none, because nothing is read, or the end was reached.
    async fn gather(&mut self) -> bool {
        let Some(reading) = &mut self.reading else { return !self.lines.is_empty() };
        if self.lines.is_empty() {
            let Ok(Some(line)) = reading.lines.next_line().await else { return false };
            self.lines.push(line);
        }
        let end = Instant::now() + GATHERING;
        while self.lines.len() < MOST_LINES {
            match timeout_at(end, reading.lines.next_line()).await {
                Ok(Ok(Some(line))) => self.lines.push(line),
                _ => break,
            }
        }
        true
    }

    /// Forgets a process that has ended. Returns why, if that is another reason than before.
    async fn end(&mut self) -> Option<String> {
        let reading = self.reading.as_mut()?;
        let mut text = String::new();
        if let Some(errors) = &mut reading.process.stderr {
            _ = errors.read_to_string(&mut text).await;
        }
        self.reading = None;
        (text != self.error).then(|| self.error.clone_from(&text)).map(|()| text)
    }

    fn start(&self) -> Option<Reading> {
        let mut command = self.commands.command("log", &["--follow", "--lines", EARLIER], &[&self.component]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().ok()?;
        let lines = BufReader::new(process.stdout.take()?).lines();
        Some(Reading { process, lines })
    }
}
