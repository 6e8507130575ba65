//! The output of all components on one screen: whole lines, each with the name of its component before it.

use super::log_file::{LogFile, LogStream};
use anstream::ColorChoice;
use owo_colors::{AnsiColors, OwoColorize};
use scl_terminal::{output_is_closed, print_out_bytes};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

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

/// One of the two output streams of a program, and of this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Standard output.
    Out,
    /// Standard error.
    Err,
}

/// Writes the lines of all programs; shared by the threads that read them.
#[derive(Debug)]
pub(crate) struct Output {
    names: Vec<String>,
    width: usize,
    colour_out: bool,
    colour_err: bool,
    /// One lock for both streams: on a terminal they share the screen.
    writing: Mutex<()>,
    /// In the order of the names; `None` for those without a log.
    logs: Vec<Option<Log>>,
}

/// A component's log, and how often each of its streams was begun, which numbers its processes.
#[derive(Debug)]
struct Log {
    file: LogFile,
    runs: [AtomicU64; 2],
}

impl Output {
    /// Output for programs of these names, in colour if the stream is a terminal that supports it. `logs` are the logs of
    /// the last of them; the others have none.
    pub(crate) fn new(names: Vec<String>, logs: Vec<Option<LogFile>>) -> Self {
        let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        let wants_colour = |choice| !matches!(choice, ColorChoice::Never);
        let colour_out = wants_colour(anstream::AutoStream::choice(&io::stdout()));
        let colour_err = wants_colour(anstream::AutoStream::choice(&io::stderr()));
        let unlogged = names.len().saturating_sub(logs.len());
        let log = |file: Option<LogFile>| file.map(|file| Log { file, runs: Default::default() });
        let logs = (0..unlogged).map(|_| None).chain(logs.into_iter().map(log)).collect();
        Self { names, width, colour_out, colour_err, writing: Mutex::new(()), logs }
    }

    /// Copies every line of a program's stream, with its name before it, until the stream ends.
    ///
    /// Bytes are copied as they are, whether or not they are UTF-8; a missing line break at the end is added.
    ///
    /// # Errors
    ///
    /// If our own stream can no longer be written. A program's stream that cannot be read counts as ended.
    pub(crate) fn copy_lines(&self, program: usize, stream: Stream, from: impl Read) -> io::Result<()> {
        let mut reader = BufReader::with_capacity(64 * 1024, from);
        let prefix = format!("{} | ", self.painted_name(program, stream)).into_bytes();
        let mut line = prefix.clone();
        let log = self.logs[program].as_ref().map(|log| (log, log.begin(stream)));
        while matches!(reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line), Ok(1..)) {
            if !line.ends_with(b"\n") {
                line.push(b'\n');
            }
            // First, because a terminal may block.
            if let Some((log, run)) = log {
                self.log(&log.file, stream, run, &line[prefix.len()..line.len() - 1]);
            }
            self.write(stream, &line)?;
            line.truncate(prefix.len());
            line.shrink_to(64 * 1024);
        }
        Ok(())
    }

    /// The name of a program as it stands before a report on it.
    pub(crate) fn report_name(&self, program: usize) -> String {
        self.painted_name(program, Stream::Err)
    }

    /// Writes one of our own reports to standard error.
    pub(crate) fn write_report(&self, line: &str) {
        // If standard error is closed, there is no place to report that.
        let _ = self.write(Stream::Err, line.as_bytes());
    }

    /// The first failure of each log is reported; the programs go on.
    fn log(&self, file: &LogFile, stream: Stream, run: u64, text: &[u8]) {
        let stream = match stream {
            Stream::Out => LogStream::Stdout,
            Stream::Err => LogStream::Stderr,
        };
        if let Err(report) = file.write(stream, run, text) {
            self.write_report(&format!("scl: {report}\n"));
        }
    }

    fn painted_name(&self, program: usize, stream: Stream) -> String {
        let name = format!("{:width$}", self.names[program], width = self.width);
        let coloured = match stream {
            Stream::Out => self.colour_out,
            Stream::Err => self.colour_err,
        };
        // A component's build has its name, and so its colour.
        let first = self.names.iter().position(|name| *name == self.names[program]).unwrap_or(program);
        if coloured { name.color(COLOURS[first % COLOURS.len()]).to_string() } else { name }
    }

    fn write(&self, stream: Stream, line: &[u8]) -> io::Result<()> {
        let _writing = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        match stream {
            Stream::Out => {
                print_out_bytes(line);
                if output_is_closed() { Err(io::ErrorKind::WriteZero.into()) } else { Ok(()) }
            }
            Stream::Err => {
                let mut err = io::stderr().lock();
                err.write_all(line).and_then(|()| err.flush())
            }
        }
    }
}

impl Log {
    /// The number of the process whose stream begins.
    fn begin(&self, stream: Stream) -> u64 {
        self.runs[stream as usize].fetch_add(1, Ordering::Relaxed) + 1
    }
}
