//! The output of all components on one screen: whole lines, each with the name of its component before it, and the
//! reports of `scl run` itself.
//!
//! Separate threads write, because neither a component nor the supervisor may wait for a reader: a paused `less`,
//! Ctrl-S, a pipe that nobody reads. Lines are dropped and counted while several MiB wait for such a reader.

mod backlog;

use super::event::Event;
use super::lock::lock;
use super::log_file::{LogFile, LogStream};
use anstream::ColorChoice;
use backlog::Backlog;
use owo_colors::{AnsiColors, OwoColorize};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::os::fd::AsFd;
use std::os::unix::fs::MetadataExt;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// Maximum length of a line in bytes. Longer ones are split, so that output without line breaks cannot exhaust memory.
const LONGEST_LINE: u64 = 64 * 1024 * 1024;

const COLOURS: [AnsiColors; 10] = [
    AnsiColors::Cyan,
    AnsiColors::Green,
    AnsiColors::Yellow,
    AnsiColors::Blue,
    AnsiColors::Magenta,
    AnsiColors::BrightCyan,
    AnsiColors::BrightGreen,
    AnsiColors::BrightYellow,
    AnsiColors::BrightBlue,
    AnsiColors::BrightMagenta,
];

/// Writes the lines of all programs; shared by the threads that read them.
#[derive(Debug)]
pub(crate) struct Output {
    names: Vec<String>,
    width: usize,
    /// Whether standard output and standard error show colours.
    colours: [bool; 2],
    /// The backlogs of standard output and standard error. Both are the same one if the streams go to the same file,
    /// where their order is visible.
    backlogs: [Arc<Backlog>; 2],
    /// Where the loss of the reader is reported, once.
    events: Mutex<Option<Sender<Event>>>,
    /// In the order of the names; `None` for those without a log.
    logs: Vec<Option<LogFile>>,
}

impl Output {
    /// Creates the output for programs with these names, in colour if the stream is a terminal that supports it, and
    /// starts the threads that write. `logs` belong to the last programs; the others have none.
    pub(crate) fn start(names: Vec<String>, logs: Vec<Option<LogFile>>, events: Sender<Event>) -> Arc<Self> {
        let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        let choices = [anstream::AutoStream::choice(&io::stdout()), anstream::AutoStream::choice(&io::stderr())];
        let colours = choices.map(|choice| !matches!(choice, ColorChoice::Never));
        let unlogged = names.len().saturating_sub(logs.len());
        let logs = (0..unlogged).map(|_| None).chain(logs).collect();
        let out = Arc::<Backlog>::default();
        let err = if is_one_file() { Arc::clone(&out) } else { Arc::default() };
        let (backlogs, events) = ([out, err], Mutex::new(Some(events)));
        let output = Arc::new(Self { names, width, colours, backlogs, events, logs });
        let [out, err] = &output.backlogs;
        let distinct = if Arc::ptr_eq(out, err) { &output.backlogs[..1] } else { &output.backlogs };
        for backlog in distinct {
            let (output, backlog) = (Arc::clone(&output), Arc::clone(backlog));
            thread::spawn(move || output.write(&backlog));
        }
        output
    }

    /// Copies every line of a program's stream, with its name before it, until the stream ends.
    ///
    /// Bytes are copied as they are, whether or not they are UTF-8; a missing line break at the end is added.
    ///
    /// A stream that cannot be read counts as ended.
    pub(crate) fn copy_lines(&self, program: usize, stream: LogStream, from: impl Read) {
        let mut reader = BufReader::with_capacity(64 * 1024, from);
        let prefix = format!("{} | ", self.painted_name(program, stream)).into_bytes();
        let mut line = prefix.clone();
        let log = self.logs[program].as_ref().map(|log| (log, log.begin(stream)));
        while matches!(reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line), Ok(1..)) {
            if !line.ends_with(b"\n") {
                line.push(b'\n');
            }
            // `write` returns only the first failure of each log; the program continues.
            if let Some((log, run)) = log
                && let Err(report) = log.write(stream, run, &line[prefix.len()..line.len() - 1])
            {
                self.announce(&report);
            }
            self.backlog(stream).add_line(program, stream, &line);
            line.truncate(prefix.len());
            line.shrink_to(64 * 1024);
        }
    }

    /// Shows the whole lines at the front of `text`, and removes them.
    pub(crate) fn show_lines(&self, program: usize, stream: LogStream, text: &mut Vec<u8>) {
        let Some(end) = text.iter().rposition(|byte| *byte == b'\n') else { return };
        let prefix = format!("{} | ", self.painted_name(program, stream)).into_bytes();
        for line in text[..=end].split_inclusive(|byte| *byte == b'\n') {
            self.backlog(stream).add_line(program, stream, &[&prefix, line].concat());
        }
        text.drain(..=end);
    }

    /// Reports on a program.
    pub(crate) fn report(&self, program: usize, text: &str) {
        let name = self.painted_name(program, LogStream::Stderr);
        self.backlog(LogStream::Stderr).add_report(&format!("{name}  {text}\n"));
    }

    /// Reports on the whole run.
    pub(crate) fn announce(&self, text: &str) {
        self.backlog(LogStream::Stderr).add_report(&format!("scl: {text}\n"));
    }

    /// Waits until everything is written, or until no reader has read anything for `patience`.
    pub(crate) fn finish(&self, patience: Duration) {
        // Standard error comes last: lines dropped from standard output are reported there.
        self.backlogs.iter().for_each(|backlog| backlog.finish(patience));
    }

    fn backlog(&self, stream: LogStream) -> &Backlog {
        &self.backlogs[stream as usize]
    }

    /// Writes what a backlog receives, for as long as the process runs.
    fn write(&self, backlog: &Backlog) {
        loop {
            let written = backlog.write();
            for (program, lines) in written.dropped {
                let name = &self.names[program];
                let noun = if lines == 1 { "line" } else { "lines" };
                let logged =
                    if self.logs[program].is_some() { format!("; `scl log {name}` has them") } else { String::new() };
                self.announce(&format!(
                    "{lines} {noun} of `{name}` were dropped, because nobody read the output{logged}"
                ));
            }
            if written.is_lost {
                let events = lock(&self.events).take();
                // After the supervisor has finished, nothing receives or needs the event.
                let _ = events.map(|events| events.send(Event::OutputLost));
            }
        }
    }

    fn painted_name(&self, program: usize, stream: LogStream) -> String {
        let name = format!("{:width$}", self.names[program], width = self.width);
        // The build of a component has the component's name, and therefore its colour.
        let first = self.names.iter().position(|name| *name == self.names[program]).unwrap_or(program);
        if self.colours[stream as usize] { name.color(COLOURS[first % COLOURS.len()]).to_string() } else { name }
    }
}

/// Whether standard output and standard error are the same terminal, pipe or file.
fn is_one_file() -> bool {
    let identity = |stream: &dyn AsFd| {
        let metadata = File::from(stream.as_fd().try_clone_to_owned()?).metadata()?;
        Ok::<_, io::Error>((metadata.dev(), metadata.ino()))
    };
    matches!((identity(&io::stdout()), identity(&io::stderr())), (Ok(out), Ok(err)) if out == err)
}
