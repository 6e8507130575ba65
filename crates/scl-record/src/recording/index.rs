//! Reading a recording from any time on.
//!
//! All of it is read once. At each chunk, what a later reader needs is noted: where the chunk is, that nothing before
//! it is later, how far the clock was set back by then, and which channels have messages in it.

use super::messages::Known;
use super::{Clock, Messages, RecordedChannel, RecordedMessage, Recording};
use scl_terminal::Problem;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Shortest distance of two marks in bytes, for files whose messages are in no chunks.
const SPACING: u64 = 64 << 10;

/// Knows where in a recording each time is.
#[derive(Debug)]
pub struct Index {
    files: Vec<File>,
    channels: Vec<RecordedChannel>,
    marks: Vec<Mark>,
    /// For each channel the marks behind which it has messages before the next one.
    marks_of_channel: Vec<Vec<usize>>,
    first: u64,
    last: u64,
}

#[derive(Debug)]
struct File {
    path: PathBuf,
    known: Known,
}

/// A place at which reading can begin.
#[derive(Debug, Clone, Copy)]
struct Mark {
    file: usize,
    offset: u64,
    /// The latest time of all messages before it.
    before: u64,
    /// By how much the clock was set back until its first message.
    set_back: u64,
}

/// The messages of a recording from a time on.
#[derive(Debug)]
pub struct MessagesFrom {
    index: Arc<Index>,
    file: usize,
    messages: Messages,
    clock: Clock,
}

/// A message and its time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimedMessage {
    /// When the recorder received it, counted from the beginning of the recording, as if the clock had not been set.
    pub at: Duration,
    /// The message.
    pub message: RecordedMessage,
}

impl Index {
    /// Reads a recording once.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn build(recording: &Recording) -> Result<Self, Problem> {
        let (files, channels, marks) = (Vec::new(), Vec::new(), Vec::new());
        let mut index = Self { files, channels, marks, marks_of_channel: Vec::new(), first: u64::MAX, last: 0 };
        let mut clock = Clock::default();
        for path in recording.paths() {
            index.add_file(path.to_owned(), &mut clock)?;
        }
        Ok(index)
    }

    fn add_file(&mut self, path: PathBuf, clock: &mut Clock) -> Result<(), Problem> {
        let mut messages = Messages::resume(&path, None, Known::default(), std::mem::take(&mut self.channels))?;
        let file = self.files.len();
        while let Some(message) = messages.read()? {
            let (time, offset) = (clock.times(&message).received, messages.offset());
            if self.marks.last().is_none_or(|mark| mark.file != file || offset >= mark.offset + SPACING) {
                self.marks.push(Mark { file, offset, before: self.last, set_back: clock.set_back() });
            }
            let mark = self.marks.len() - 1;
            self.marks_of_channel.resize_with(self.marks_of_channel.len().max(message.channel + 1), Vec::new);
            let marks = &mut self.marks_of_channel[message.channel];
            if marks.last() != Some(&mark) {
                marks.push(mark);
            }
            (self.first, self.last) = (self.first.min(time), self.last.max(time));
        }
        let (known, channels) = messages.into_known();
        self.channels = channels;
        self.files.push(File { path, known });
        Ok(())
    }

    /// The channels, by the numbers that messages have.
    pub fn channels(&self) -> &[RecordedChannel] {
        &self.channels
    }

    /// The time from the first to the last message.
    pub fn length(&self) -> Duration {
        Duration::from_nanos(self.last.saturating_sub(self.first))
    }

    /// When the first message was received, in nanoseconds since 1970; `None` without messages.
    pub fn first_ns(&self) -> Option<u64> {
        (!self.marks.is_empty()).then_some(self.first)
    }

    /// The messages from a time on, counted from the beginning of the recording, and possibly a few before.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn messages_from(self: &Arc<Self>, at: Duration) -> Result<MessagesFrom, Problem> {
        MessagesFrom::open(self, self.mark_at(at))
    }

    /// The last message of a channel until a time; `None` if there is none.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn latest(self: &Arc<Self>, channel: usize, at: Duration) -> Result<Option<TimedMessage>, Problem> {
        let limit = self.mark_at(at);
        let marks = self.marks_of_channel.get(channel).into_iter().flatten().rev();
        for &mark in marks.filter(|mark| **mark <= limit) {
            let mut messages = MessagesFrom::open(self, mark)?;
            let mut latest = None;
            while messages.is_before(mark + 1)
                && let Some(message) = messages.read()?
            {
                if message.message.channel == channel && message.at <= at {
                    latest = Some(message);
                }
            }
            if latest.is_some() {
                return Ok(latest);
            }
        }
        Ok(None)
    }

    /// The last mark before which all messages are earlier than a time.
    fn mark_at(&self, at: Duration) -> usize {
        let time = self.first.saturating_add(u64::try_from(at.as_nanos()).unwrap_or(u64::MAX));
        self.marks.partition_point(|mark| mark.before < time).saturating_sub(1)
    }
}

impl MessagesFrom {
    fn open(index: &Arc<Index>, mark: usize) -> Result<Self, Problem> {
        let mark = index.marks.get(mark);
        let (file, offset) = (mark.map_or(0, |mark| mark.file), mark.map(|mark| mark.offset));
        let clock = Clock::set_back_by(mark.map_or(0, |mark| mark.set_back));
        Ok(Self { index: index.clone(), file, messages: index.open(file, offset)?, clock })
    }

    /// The next message; `None` at the end.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn read(&mut self) -> Result<Option<TimedMessage>, Problem> {
        loop {
            if let Some(message) = self.messages.read()? {
                let time = self.clock.times(&message).received;
                return Ok(Some(TimedMessage {
                    at: Duration::from_nanos(time.saturating_sub(self.index.first)),
                    message,
                }));
            }
            if self.file + 1 >= self.index.files.len() {
                return Ok(None);
            }
            self.file += 1;
            self.messages = self.index.open(self.file, None)?;
        }
    }

    /// Whether the next message may be before a mark.
    fn is_before(&self, mark: usize) -> bool {
        let place = (self.file, self.messages.next_offset());
        self.index.marks.get(mark).is_none_or(|mark| place < (mark.file, mark.offset))
    }
}

impl Index {
    fn open(&self, file: usize, offset: Option<u64>) -> Result<Messages, Problem> {
        match self.files.get(file) {
            Some(File { path, known }) => Messages::resume(path, offset, known.clone(), self.channels.clone()),
            None => Ok(Messages::default()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Recorder, Sample, write_file};

    /// Three chunks of two topics; the second has a message of `b` only.
    fn index(folder: &std::path::Path) -> Arc<Index> {
        let chunk = |recorder: Recorder, samples: &[Sample<'_>]| recorder.messages(samples).end_chunk();
        let new = || Recorder::with_compression(None);
        let recorder = chunk(new(), &[("/x/a", 0, "a0"), ("/x/b", 100, "b100"), ("/x/a", 200, "a200")]);
        let recorder = chunk(recorder, &[("/x/b", 300, &"b300".repeat(40_000))]);
        let first = chunk(recorder, &[("/x/a", 400, "a400")]).finish();
        let second = chunk(new(), &[("/x/b", 500, "b500"), ("/x/a", 600, "a600")]).finish();
        let files = [write_file(folder, "1.mcap", &first), write_file(folder, "2.mcap", &second)];
        Arc::new(Index::build(&Recording::open(&files).unwrap()).unwrap())
    }

    fn name(message: &TimedMessage) -> String {
        String::from_utf8_lossy(&message.message.payload).chars().take(4).collect()
    }

    fn from(index: &Arc<Index>, at: u64) -> Vec<u128> {
        let mut messages = index.messages_from(Duration::from_millis(at)).unwrap();
        std::iter::from_fn(|| messages.read().unwrap()).map(|it| it.at.as_millis()).collect()
    }

    #[test]
    fn reading_begins_at_any_time() {
        let folder = tempfile::tempdir().unwrap();
        let index = index(folder.path());
        assert_eq!(index.length(), Duration::from_millis(600));
        assert_eq!(from(&index, 0), [0, 100, 200, 300, 400, 500, 600]);
        for at in (0..=700).step_by(50) {
            let read = from(&index, at);
            let expected: Vec<u128> = (0..7).map(|it| it * 100).filter(|time| *time >= u128::from(at)).collect();
            assert!(read.ends_with(&expected), "{at}: {read:?}");
        }
        assert!(from(&index, 550).len() < 3);
    }

    #[test]
    fn the_latest_message_of_a_channel_is_found_however_long_ago_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let index = index(folder.path());
        let latest = |topic: &str, at: u64| {
            let channel = index.channels().iter().position(|it| it.topic.gate == topic).unwrap();
            index.latest(channel, Duration::from_millis(at)).unwrap().map(|message| name(&message))
        };
        assert_eq!(latest("a", 0).as_deref(), Some("a0"));
        assert_eq!(latest("a", 399).as_deref(), Some("a200"));
        assert_eq!(latest("b", 50), None);
        assert_eq!(latest("b", 499).as_deref(), Some("b300"));
        assert_eq!(latest("b", 9_999).as_deref(), Some("b500"));
        assert_eq!(latest("a", 9_999).as_deref(), Some("a600"));
    }
}
