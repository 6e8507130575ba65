//! One line of a log, written and read.

use super::LONGEST_TEXT;
use scl_terminal::timestamp;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::time::SystemTime;

/// One of the two output streams of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogStream {
    /// Standard output.
    Stdout,
    /// Standard error.
    Stderr,
}

impl LogStream {
    /// `stdout` or `stderr`.
    pub fn word(self) -> &'static str {
        match self {
            LogStream::Stdout => "stdout",
            LogStream::Stderr => "stderr",
        }
    }
}

/// A line that a component has printed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogEntry {
    /// When it was read, in RFC 3339 and UTC.
    pub time: String,
    /// The component.
    pub component: String,
    /// Where it was printed.
    pub stream: LogStream,
    /// The number of the component's process since the log began.
    pub run: u64,
    /// The line without its end. If it is [`escaped`](Self::escaped), each byte that is not UTF-8 is `\xff` and each
    /// backslash is `\\`.
    pub text: String,
    /// Whether the line had bytes that are not UTF-8.
    #[serde(default, skip_serializing_if = "is_false")]
    pub escaped: bool,
    /// Number of bytes of the line that are missing after `text`, because it was too long.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub cut_bytes: u64,
}

impl LogEntry {
    /// Creates the entry of a line that was printed now; it keeps at most [`LONGEST_TEXT`] bytes.
    pub(super) fn new(component: &str, stream: LogStream, run: u64, line: &[u8]) -> Self {
        let kept = &line[..cut(line, LONGEST_TEXT)];
        let (text, escaped) = match std::str::from_utf8(kept) {
            Ok(text) => (text.to_owned(), false),
            Err(_) => (escape_reversibly(kept), true),
        };
        let (time, component) = (timestamp(SystemTime::now()), component.to_owned());
        Self { time, component, stream, run, text, escaped, cut_bytes: (line.len() - kept.len()) as u64 }
    }
}

/// Returns where to cut the text, so that no character is cut in two.
fn cut(text: &[u8], longest: usize) -> usize {
    if text.len() <= longest {
        return text.len();
    }
    let is_inside = |&at: &usize| text[at] & 0b1100_0000 == 0b1000_0000;
    // A UTF-8 character has at most four bytes. If no boundary is found, the text is not UTF-8.
    (longest.saturating_sub(3)..=longest).rev().find(|at| !is_inside(at)).unwrap_or(longest)
}

fn escape_reversibly(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() + 16);
    for chunk in bytes.utf8_chunks() {
        text.push_str(&chunk.valid().replace('\\', "\\\\"));
        for byte in chunk.invalid() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\\x{byte:02x}");
        }
    }
    text
}

fn is_false(value: &bool) -> bool {
    !value
}

fn is_zero(value: &u64) -> bool {
    *value == 0
}
