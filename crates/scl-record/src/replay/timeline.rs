//! The messages of a recording in the order in which they were sent, read ahead by a thread.

use crate::recording::{Clock, Messages, RecordedChannel, RecordedMessage, Recording};
use scl_terminal::Problem;
use std::collections::BTreeMap;
use std::ops::Range;
use tokio::sync::mpsc;

/// Messages arrive at the recorder in almost the order in which they were sent. A message that is late by no more than
/// this, in nanoseconds, is still put in order. On a busy machine, a recorder that could not run for a second reads the
/// backlog of one gate after that of another.
const WINDOW: u64 = 2_000_000_000;
/// Maximum number of messages and bytes held to be put in order.
const MOST_MESSAGES: usize = 65_536;
const MOST_BYTES: usize = 16 << 20;
/// Size of a batch in messages and bytes.
const BATCH_MESSAGES: usize = 256;
const BATCH_BYTES: usize = 256 << 10;
/// Number of batches read ahead.
const AHEAD: usize = 4;

/// A part of the timeline.
#[derive(Debug, Default)]
pub(super) struct Batch {
    /// Channels that were not in a batch before.
    pub(super) channels: Vec<RecordedChannel>,
    pub(super) messages: Vec<Timed>,
}

/// A message and its time.
#[derive(Debug)]
pub(super) struct Timed {
    /// Nanoseconds since 1970, as if the clock had not been set back. Never less than the time of the previous message
    /// of the same channel.
    pub(super) time: u64,
    pub(super) message: RecordedMessage,
}

/// The parts of a timeline; the last one is empty.
pub(super) type Batches = mpsc::Receiver<Result<Batch, Problem>>;

/// Reads the messages that were sent in a span of time. Ends early when the receiver is dropped.
pub(super) fn read(recording: &Recording, span: Range<u64>) -> Batches {
    let (sender, receiver) = mpsc::channel(AHEAD);
    let mut timeline = Timeline::new(recording, span);
    std::thread::spawn(move || {
        loop {
            let batch = timeline.next_batch();
            let is_last = batch.as_ref().map_or(true, |batch| batch.messages.is_empty());
            if sender.blocking_send(batch).is_err() || is_last {
                return;
            }
        }
    });
    receiver
}

#[derive(Default)]
struct Timeline {
    messages: Messages,
    clock: Clock,
    span: Range<u64>,
    /// The messages held to be put in order, by time, then by place in the recording.
    held: BTreeMap<(u64, u64), RecordedMessage>,
    held_bytes: usize,
    /// Number of messages read, and the latest time at which the recorder received one.
    read: u64,
    received: u64,
    /// For each channel, the time of its latest message.
    latest: Vec<u64>,
    channels_given: usize,
    is_at_end: bool,
}

impl Timeline {
    fn new(recording: &Recording, span: Range<u64>) -> Self {
        Self { messages: recording.messages(), span, ..Self::default() }
    }

    /// Returns the next batch, which is empty at the end.
    fn next_batch(&mut self) -> Result<Batch, Problem> {
        let mut batch = Batch::default();
        let mut bytes = 0;
        while batch.messages.len() < BATCH_MESSAGES && bytes < BATCH_BYTES {
            let Some(timed) = self.next()? else { break };
            if timed.time >= self.span.end {
                self.is_at_end = true;
                self.held.clear();
                break;
            }
            if timed.time >= self.span.start {
                bytes += timed.message.payload.len();
                batch.messages.push(timed);
            }
        }
        let channels = self.messages.channels();
        batch.channels = channels[self.channels_given..].to_vec();
        self.channels_given = channels.len();
        Ok(batch)
    }

    fn next(&mut self) -> Result<Option<Timed>, Problem> {
        while !self.is_at_end && !self.is_first_in_place() {
            match self.messages.read()? {
                Some(message) => self.hold(message),
                None => self.is_at_end = true,
            }
        }
        let first = self.held.pop_first().map(|((time, _), message)| Timed { time, message });
        self.held_bytes -= first.as_ref().map_or(0, |first| first.message.payload.len());
        Ok(first)
    }

    fn hold(&mut self, message: RecordedMessage) {
        if self.latest.len() <= message.channel {
            self.latest.resize(message.channel + 1, 0);
        }
        let times = self.clock.times(&message);
        // A gate's messages stay in order whatever its own host's clock does.
        let latest = &mut self.latest[message.channel];
        let time = times.sent.max(*latest);
        *latest = time;
        self.received = self.received.max(times.received);
        self.held_bytes += message.payload.len();
        self.read += 1;
        self.held.insert((time, self.read), message);
    }

    /// Returns true if no message with an earlier time than the first held one is expected, or no more can be held.
    fn is_first_in_place(&self) -> bool {
        let is_full = self.held.len() >= MOST_MESSAGES || self.held_bytes >= MOST_BYTES;
        let is_old = |time: &u64| time.saturating_add(WINDOW) < self.received;
        self.held.first_key_value().is_some_and(|((time, _), _)| is_full || is_old(time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{BEGINNING, Recorder, Sample};

    const SENSOR: &str = "/sensor/measurements";
    const GPS: &str = "/gps/fix";

    /// After a second in which the recorder could not run, it reads one gate's backlog after that of the other.
    #[tokio::test]
    async fn backlogs_are_put_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let sent_by = |topic| (0..150).map(|step| (topic, step * 10, "1")).collect::<Vec<Sample<'_>>>();
        let recorder = Recorder::new().messages_received(1500, &sent_by(GPS)).messages_received(1510, &sent_by(SENSOR));
        let last = [(SENSOR, 9000, "1"), (GPS, 9010, "1")];
        let file = recorder.messages(&last).write_to(folder.path(), "busy.mcap");
        let recording = Recording::open(&[file]).unwrap();
        let mut batches = read(&recording, 0..u64::MAX);
        let mut times = Vec::new();
        while let Some(batch) = batches.recv().await {
            times.extend(batch.unwrap().messages.iter().map(|timed| timed.time / 1_000_000 - BEGINNING));
        }
        assert_eq!(times.len(), 302);
        assert!(times.is_sorted(), "{times:?}");
    }

    /// A clock that was set back by an hour moves no message: before, all of the hour after it were due at once.
    #[tokio::test]
    async fn messages_after_a_step_back_keep_their_distances() {
        let folder = tempfile::tempdir().unwrap();
        const HOUR: u64 = 3_600_000;
        let before = (0..50).map(|step| (SENSOR, HOUR + step * 100, "1"));
        let after = (50..100).map(|step| (SENSOR, step * 100, "1"));
        let mut recorder = Recorder::new();
        for sample in before.chain(after) {
            recorder = recorder.messages(&[sample]);
        }
        let file = recorder.write_to(folder.path(), "stepped.mcap");
        let recording = Recording::open(&[file]).unwrap();
        let mut batches = read(&recording, 0..u64::MAX);
        let mut times = Vec::new();
        while let Some(batch) = batches.recv().await {
            times.extend(batch.unwrap().messages.iter().map(|timed| timed.time / 1_000_000 - BEGINNING - HOUR));
        }
        // The step itself takes no time.
        let expected: Vec<u64> = (0..50).chain(49..99).map(|step| step * 100).collect();
        assert_eq!(times, expected);
        let survey = recording.survey().unwrap();
        assert_eq!((survey.length.as_millis(), survey.steps.len()), (9800, 1));
        let note = "the clock was set back by 3599.9 s at 4.9 s of the recording";
        assert_eq!(survey.notes(), [note]);
    }
}
