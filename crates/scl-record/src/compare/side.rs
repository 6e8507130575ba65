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
    /// Number of the message among those of its topic.
    pub(super) index: u64,
    pub(super) sent_ns: u64,
    /// See [`crate::format::sequence`].
    pub(super) sequence: u32,
    /// Decoded when it is first compared: to find messages that only one recording has, each is compared with many.
    value: OnceCell<Option<Value>>,
}

impl Waiting {
    /// The decoded message, by the type of its channel; `None` if it cannot be decoded.
    pub(super) fn value(&self, side: &Side) -> Option<&Value> {
        let decode = || side.message_type(self.channel).decode(&self.payload).ok();
        let value = self.value.get_or_init(decode).as_ref();
        value.filter(|value| !matches!(value, Value::Opaque(_)))
    }
}

/// The messages of one recording, by compared topic.
pub(super) struct Side {
    messages: Messages,
    topics: Vec<Topic>,
    queues: Vec<VecDeque<Waiting>>,
    /// Of each topic, bytes in its queue.
    bytes: Vec<usize>,
    /// Of each topic, messages not read yet, and read.
    left: Vec<u64>,
    read: Vec<u64>,
    /// By channel, the index of its topic if that is compared, and how its messages are read.
    by_channel: Vec<Option<usize>>,
    types: Vec<MessageType>,
    is_at_end: bool,
    start_ns: u64,
    position: Duration,
}

impl Side {
    pub(super) fn new(recording: &Recording, survey: &Survey, topics: &[Topic]) -> Self {
        let left = topics.iter().map(|topic| survey.topics.get(topic).map_or(0, |topic| topic.messages));
        let left: Vec<u64> = left.collect();
        Self {
            messages: recording.messages(),
            topics: topics.to_vec(),
            queues: topics.iter().map(|_| VecDeque::new()).collect(),
            bytes: vec![0; topics.len()],
            is_at_end: left.iter().all(|left| *left == 0),
            read: vec![0; left.len()],
            left,
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
            self.by_channel.push(self.topics.iter().position(|topic| *topic == channel.topic));
            self.types.push(channel.message_type());
        }
        let RecordedMessage { channel, sent_ns, sequence, payload, .. } = message;
        let Some(topic) = self.by_channel[channel] else { return Ok(None) };
        let index = self.read[topic];
        self.read[topic] += 1;
        self.left[topic] -= 1;
        self.is_at_end = self.left.iter().all(|left| *left == 0);
        self.bytes[topic] += payload.len();
        let value = OnceCell::new();
        self.queues[topic].push_back(Waiting { payload, channel, index, sent_ns, sequence, value });
        Ok(Some(topic))
    }

    /// The messages of a topic that wait for their counterparts.
    pub(super) fn queue(&self, topic: usize) -> &VecDeque<Waiting> {
        &self.queues[topic]
    }

    pub(super) fn pop(&mut self, topic: usize) -> Option<Waiting> {
        let message = self.queues[topic].pop_front()?;
        self.bytes[topic] -= message.payload.len();
        Some(message)
    }

    /// Whether no more messages of a topic will be read.
    pub(super) fn is_complete(&self, topic: usize) -> bool {
        self.left[topic] == 0
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.is_at_end
    }

    /// Bytes of the messages of a topic that wait for their counterparts.
    pub(super) fn bytes(&self, topic: usize) -> usize {
        self.bytes[topic]
    }

    pub(super) fn queued_bytes(&self) -> usize {
        self.bytes.iter().sum()
    }

    /// How the messages of a channel are read.
    pub(super) fn message_type(&self, channel: usize) -> &MessageType {
        &self.types[channel]
    }

    pub(super) fn since_start(&self, sent_ns: u64) -> Duration {
        Duration::from_nanos(sent_ns.saturating_sub(self.start_ns))
    }

    pub(super) fn position(&self) -> Duration {
        self.position
    }
}
