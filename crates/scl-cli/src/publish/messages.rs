//! The messages of `scl pub`: one from the command line, or those of standard input.

use scl::bytes::Bytes;
use scl_terminal::Problem;
use scl_value::{Documents, MessageType, ReadError, Value, read_yaml};
use std::io::{self, BufRead};
use std::thread;
use tokio::sync::mpsc::{Receiver, channel};

/// The word for standard input.
const INPUT: &str = "-";

/// How many messages of standard input are read ahead.
const AHEAD: usize = 16;

/// The messages to send, encoded.
pub(super) enum Messages {
    /// The same message, once or again and again.
    Fixed { message: Bytes, repeat: bool, taken: bool },
    /// The messages of standard input, and how many were read.
    Input { read: Receiver<io::Result<Result<Value, ReadError>>>, messages: MessageType, count: u64 },
}

impl Messages {
    /// Creates the messages of an argument, which is a message or `-` for standard input.
    pub(super) fn new(argument: &str, messages: MessageType, repeat: bool) -> Result<Self, Problem> {
        if argument == INPUT {
            return Ok(Self::Input { read: read_input(), messages, count: 0 });
        }
        let message = messages.encode(&read_yaml(argument)?)?;
        Ok(Self::Fixed { message, repeat, taken: false })
    }

    /// Whether the messages come from standard input, and so end by themselves.
    pub(super) fn are_from_input(&self) -> bool {
        matches!(self, Self::Input { .. })
    }

    /// The next message; `None` after the last.
    ///
    /// # Cancel safety
    /// Cancel safe.
    pub(super) async fn next(&mut self) -> Result<Option<Bytes>, Problem> {
        match self {
            Messages::Fixed { taken: true, repeat: false, .. } => Ok(None),
            Messages::Fixed { message, taken, .. } => {
                *taken = true;
                Ok(Some(message.clone()))
            }
            Messages::Input { read, messages, count } => {
                let Some(value) = read.recv().await else { return Ok(None) };
                *count += 1;
                let unreadable = |error| Problem::new(format!("standard input cannot be read: {error}"));
                let place = format!("message {count} of standard input");
                let value = value.map_err(unreadable)?.map_err(|error| Problem::from(error).at(place.clone()))?;
                messages.encode(&value).map(Some).map_err(|error| Problem::from(error).at(place))
            }
        }
    }
}

/// Reads standard input on a thread, because reading from a pipe may block for any length of time.
fn read_input() -> Receiver<io::Result<Result<Value, ReadError>>> {
    let (sender, receiver) = channel(AHEAD);
    thread::spawn(move || {
        let mut documents = Documents::default();
        for line in text_lines(io::stdin().lock()) {
            let message = match line {
                Ok(line) => documents.line(&line).map(Ok),
                Err(error) => Some(Err(error)),
            };
            // The send fails once the command has ended.
            let is_last = message.as_ref().is_some_and(Result::is_err);
            if message.is_some_and(|message| sender.blocking_send(message).is_err()) || is_last {
                return;
            }
        }
        let _ = documents.end().map(|message| sender.blocking_send(Ok(message)));
    });
    receiver
}

/// The lines of a text in UTF-8.
fn text_lines(mut input: impl BufRead) -> impl Iterator<Item = io::Result<String>> {
    // These bytes never occur in UTF-8, but begin a byte order mark of UTF-16 or UTF-32.
    let wrong = match input.fill_buf().map(<[u8]>::first) {
        Ok(Some(0xfe | 0xff)) => Some(io::Error::other("it is text in UTF-16, but must be UTF-8")),
        Ok(_) => None,
        Err(error) => Some(error),
    };
    // The caller stops at the first error.
    wrong.map(Err).into_iter().chain(input.lines())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_in_utf_16_is_named() {
        for input in [&b"\xff\xfe{\0}\0\n\0"[..], b"\xfe\xff\0{\0}\0\n", b"\xff\xfe\0\0"] {
            let error = text_lines(input).next().unwrap().unwrap_err();
            assert_eq!(error.to_string(), "it is text in UTF-16, but must be UTF-8");
        }
    }

    #[test]
    fn other_lines_are_read_as_they_are() {
        let lines: Vec<_> = text_lines("\u{feff}{a: 1}\r\n\nä".as_bytes()).map(Result::unwrap).collect();
        assert_eq!(lines, ["\u{feff}{a: 1}", "", "ä"]);
        assert!(text_lines(&b""[..]).next().is_none());
        assert!(text_lines(&b"a\xff"[..]).next().unwrap().is_err());
    }
}
