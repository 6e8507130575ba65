//! The last messages, kept in memory and written to a file on request.

use super::contents::{Contents, now_ns};
use super::file::{RecordingFile, WrittenFile};
use super::file_names::FileNames;
use super::gate::Message;
use super::write_error::WriteError;
use bytes::Bytes;
use scl_terminal::Problem;
use std::collections::VecDeque;
use std::time::Duration;

/// How the error begins when the ring cannot be written.
const INCOMPLETE: &str = "the ring was not written completely";

/// The messages of the last seconds.
pub(crate) struct Ring {
    window_ns: u64,
    limit: usize,
    save_at_end: bool,
    names: FileNames,
    messages: VecDeque<Message>,
    bytes: usize,
    written: Vec<WrittenFile>,
}

impl Ring {
    /// A ring for the messages of `window`, but for no more than `limit` bytes.
    pub(crate) fn new(names: FileNames, window: Duration, limit: usize, save_at_end: bool) -> Self {
        let window_ns = scl_text::duration::nanoseconds(window);
        Self { window_ns, limit, save_at_end, names, messages: VecDeque::new(), bytes: 0, written: Vec::new() }
    }

    /// Memory of the messages.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes
    }

    pub(crate) fn push(&mut self, mut message: Message) {
        // The bytes may be a part of a larger buffer of the connection, which would stay in memory with them.
        message.payload = Bytes::copy_from_slice(&message.payload);
        self.forget_before(message.received_ns.saturating_sub(self.window_ns));
        self.bytes += message.memory();
        self.messages.push_back(message);
        while self.bytes > self.limit {
            self.forget_oldest();
        }
    }

    /// Writes the messages to a new file. They stay in the ring, and recording continues.
    pub(crate) fn save(&mut self, contents: &Contents) -> Result<WrittenFile, Problem> {
        self.forget_before(now_ns().saturating_sub(self.window_ns));
        let (path, file) = self.names.create_next()?;
        let mut recording =
            contents.start_file(path.clone(), file).map_err(|error| error.problem(INCOMPLETE, &path))?;
        let copied = self.copy_to(&mut recording);
        let finished = match copied {
            Err(WriteError::Failed(_)) => None,
            _ => Some(recording.flush().and_then(|()| recording.finish())),
        };
        let (written, error) = match finished {
            Some(Ok(written)) => (written, copied.and_then(|()| recording.check_name()).err()),
            Some(Err(error)) => (recording.abandon(), Some(error)),
            None => (recording.abandon(), copied.err()),
        };
        self.written.push(written.clone());
        error.map_or(Ok(written), |error| Err(error.problem(INCOMPLETE, &path)))
    }

    /// Writes a last file if `save_at_end` is set. Returns the written files, the number of deleted ones, which is 0,
    /// and what went wrong.
    pub(crate) fn finish(mut self, contents: &Contents) -> (Vec<WrittenFile>, usize, Option<Problem>) {
        let problem = if self.save_at_end { self.save(contents).err() } else { None };
        (self.written, 0, problem)
    }

    fn copy_to(&self, recording: &mut RecordingFile) -> Result<(), WriteError> {
        self.messages.iter().enumerate().try_for_each(|(index, message)| {
            // Losses before the first message are older than this recording.
            if index > 0 {
                recording.count_lost(message.gate, message.lost_before);
            }
            recording.write(message)
        })
    }

    fn forget_before(&mut self, oldest_ns: u64) {
        while self.messages.front().is_some_and(|message| message.received_ns < oldest_ns) {
            self.forget_oldest();
        }
    }

    fn forget_oldest(&mut self) {
        if let Some(message) = self.messages.pop_front() {
            self.bytes -= message.memory();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Part;
    use crate::record::file_names::Numbering;
    use std::path::Path;

    fn message(second: u64, size: usize) -> Message {
        let time = second * 1_000_000_000;
        let payload = Bytes::from(vec![0; size]);
        Message {
            gate: 0,
            part: Part::Message,
            sequence: 0,
            sent_ns: time,
            received_ns: time,
            lost_before: 0,
            latched: false,
            payload,
        }
    }

    fn ring(limit: usize) -> Ring {
        let names = FileNames::new(Some(Path::new("/nowhere/f.mcap")), "rover", Numbering::FromSecond, false).unwrap();
        Ring::new(names, Duration::from_secs(10), limit, false)
    }

    #[test]
    fn messages_older_than_the_window_are_forgotten() {
        let mut ring = ring(usize::MAX);
        (0..100).for_each(|second| ring.push(message(second, 10)));
        assert_eq!(ring.messages.front().unwrap().received_ns, 89_000_000_000);
        assert_eq!(ring.bytes(), 11 * message(0, 10).memory());
    }

    #[test]
    fn memory_is_bounded() {
        let mut ring = ring(3 * message(0, 1000).memory());
        (0..100).for_each(|_| ring.push(message(5, 1000)));
        assert_eq!(ring.messages.len(), 3);
    }
}
