//! One of the two recordings: what it contains, and its messages by gate.

use crate::format::Topic;
use crate::recording::{Messages, RecordedMessage, Recording, Survey};
use bytes::Bytes;
use scl_terminal::Problem;
use scl_value::{MessageType, Value};
use std::cell::OnceCell;
use std::collections::VecDeque;
use std::time::Duration;

/// Checks that both recordings have messages of the same types.
pub(super) fn check_types(names: [&str; 2], surveys: &[Survey; 2], topics: &[Topic]) -> Result<(), Problem> {
    for topic in topics {
        let [Some(first), Some(second)] = surveys.each_ref().map(|survey| survey.topics.get(topic)) else { continue };
        let [first, second] = [first, second].map(|topic| topic.channel.type_and_codec());
        if first != second {
            let [first_name, second_name] = names;
            return Err(Problem::new(format!(
                "`{}` cannot be compared: it is {first} in `{first_name}`, but {second} in `{second_name}`",
                topic.gate_name(),
            ))
            .help("compare other gates with `--gate`"));
        }
    }
    Ok(())
}

/// A message that waits for its counterpart.
#[derive(Debug, Clone)]
pub(super) struct Waiting {
    pub(super) payload: Bytes,
    /// Index in [`Side::types`].
    pub(super) channel: usize,
    /// Index of the message in its topic, from 0.
    pub(super) index: u64,
    pub(super) sent_ns: u64,
    /// See [`crate::format::sequence`].
    pub(super) sequence: u32,
    /// The decoded message, cached at the first comparison: the search for gaps compares each message with many others.
    value: OnceCell<Option<Value>>,
}

impl Waiting {
    /// The decoded message, by the type of its channel; `None` if it cannot be decoded.
    pub(super) fn value(&self, side: &Side) -> Option<&Value> {
        let decode = || side.types[self.channel].decode(&self.payload).ok();
        let value = self.value.get_or_init(decode).as_ref();
        value.filter(|value| !matches!(value, Value::Opaque(_)))
    }
}

/// The messages of one recording, by compared topic.
pub(super) struct Side {
    messages: Messages,
    pub(super) topics: Vec<TopicQueue>,
    /// By channel, the index of its topic, `None` if that is not compared, and the type of its messages.
    by_channel: Vec<Option<usize>>,
    pub(super) types: Vec<MessageType>,
    pub(super) is_at_end: bool,
    start_ns: u64,
    pub(super) position: Duration,
}

/// The messages of a topic that wait for their counterparts.
pub(super) struct TopicQueue {
    topic: Topic,
    pub(super) waiting: VecDeque<Waiting>,
    /// Total payload size of the waiting messages.
    pub(super) bytes: usize,
    /// Numbers of messages read so far and still to be read.
    read: u64,
    pub(super) left: u64,
}

impl Side {
    pub(super) fn new(recording: &Recording, survey: &Survey, topics: &[Topic]) -> Self {
        let queue = |topic: &Topic| {
            let left = survey.topics.get(topic).map_or(0, |topic| topic.messages);
            TopicQueue { topic: topic.clone(), waiting: VecDeque::new(), bytes: 0, read: 0, left }
        };
        let topics: Vec<_> = topics.iter().map(queue).collect();
        Self {
            messages: recording.messages(),
            is_at_end: topics.iter().all(|topic| topic.left == 0),
            topics,
            by_channel: Vec::new(),
            types: Vec::new(),
            start_ns: survey.first_ns.unwrap_or_default(),
            position: Duration::ZERO,
        }
    }

    /// Reads one message; returns the index of its topic, if that is compared.
    pub(super) fn read(&mut self) -> Result<Option<usize>, Problem> {
        let Some(message) = self.messages.read()? else {
            self.is_at_end = true;
            return Ok(None);
        };
        self.position = self.since_start(message.sent_ns);
        for channel in &self.messages.channels()[self.types.len()..] {
            self.by_channel.push(self.topics.iter().position(|queue| queue.topic == channel.topic));
            self.types.push(channel.message_type());
        }
        let RecordedMessage { channel, sent_ns, sequence, payload, .. } = message;
        let Some(index) = self.by_channel[channel] else { return Ok(None) };
        let queue = &mut self.topics[index];
        queue.bytes += payload.len();
        let value = OnceCell::new();
        queue.waiting.push_back(Waiting { payload, channel, index: queue.read, sent_ns, sequence, value });
        queue.read += 1;
        queue.left -= 1;
        self.is_at_end = self.topics.iter().all(|topic| topic.left == 0);
        Ok(Some(index))
    }

    pub(super) fn pop(&mut self, topic: usize) -> Option<Waiting> {
        let queue = &mut self.topics[topic];
        let message = queue.waiting.pop_front()?;
        queue.bytes -= message.payload.len();
        Some(message)
    }

    pub(super) fn since_start(&self, sent_ns: u64) -> Duration {
        Duration::from_nanos(sent_ns.saturating_sub(self.start_ns))
    }
}
