//! What a recording contains, learned by reading all of its messages once.

use super::{Clock, OtherTopic, RecordedChannel, Recording};
use crate::format::Topic;
use scl_terminal::{Problem, escape};
use std::collections::BTreeMap;
use std::time::Duration;

/// Maximum number of notes of each kind.
const NAMED: usize = 5;

/// Shortest gap between messages that is noted, in nanoseconds.
const LONG: u64 = 60_000_000_000;

/// What a recording contains.
#[derive(Debug, Clone, Default)]
pub struct Survey {
    /// The topics that SCL recorded.
    pub topics: BTreeMap<Topic, SurveyedTopic>,
    /// The topics that other programs recorded.
    pub others: Vec<OtherTopic>,
    /// When the first message was sent, in nanoseconds since 1970; `None` without messages.
    pub first_ns: Option<u64>,
    /// The time from the first to the last message, as if the clock had not been set back.
    pub length: Duration,
    /// Where the clock was set back, and by how much.
    pub steps: Vec<Interval>,
    /// Where nothing was recorded for at least a minute, or the clock was set forward.
    pub gaps: Vec<Interval>,
}

/// A span of time in a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interval {
    /// When it begins, counted from the beginning of the recording.
    pub from: Duration,
    pub length: Duration,
}

/// A topic that SCL recorded.
#[derive(Debug, Clone)]
pub struct SurveyedTopic {
    /// The first of its channels.
    pub channel: RecordedChannel,
    pub messages: u64,
    /// Bytes of all payloads.
    pub bytes: u64,
}

impl Survey {
    pub(super) fn take(recording: &Recording) -> Result<Self, Problem> {
        let mut messages = recording.messages();
        let mut counts = Vec::<(u64, u64)>::new();
        let mut survey = Self::default();
        let mut clock = Clock::default();
        let mut received: Option<(u64, u64)> = None;
        while let Some(message) = messages.read()? {
            counts.resize(counts.len().max(message.channel + 1), (0, 0));
            let (messages, bytes) = &mut counts[message.channel];
            *messages += 1;
            *bytes += message.payload.len() as u64;
            survey.first_ns.get_or_insert(message.sent_ns);
            let times = clock.times(&message);
            let (first, last) = received.unwrap_or((times.received, times.received));
            let interval = |length| {
                let from = Duration::from_nanos(last.saturating_sub(first));
                Interval { from, length: Duration::from_nanos(length) }
            };
            survey.steps.extend(times.step.map(interval));
            survey.gaps.extend(Some(times.gap).filter(|gap| *gap >= LONG).map(interval));
            received = Some((first.min(times.received), last.max(times.received)));
        }
        survey.length = received.map_or(Duration::ZERO, |(first, last)| Duration::from_nanos(last - first));
        counts.resize(messages.channels().len(), (0, 0));
        for (channel, (messages, bytes)) in messages.channels().iter().zip(counts) {
            let new = || SurveyedTopic { channel: channel.clone(), messages: 0, bytes: 0 };
            let topic = survey.topics.entry(channel.topic.clone()).or_insert_with(new);
            topic.messages += messages;
            topic.bytes += bytes;
        }
        survey.others = messages.others().to_vec();
        Ok(survey)
    }

    /// What a reader of the messages should know: topics that are left out, and a clock that was set.
    pub fn notes(&self) -> Vec<String> {
        let named = self.others.iter().map(|other| {
            let (topic, messages) = (escape(&other.topic), other.messages);
            format!("`{topic}` was not recorded by SCL: {}; messages left out: {messages}", other.reason)
        });
        let steps = self.steps.iter().map(|step| {
            let (from, length) = (step.from.as_secs_f64(), step.length.as_secs_f64());
            format!("the clock was set back by {length:.1} s at {from:.1} s of the recording")
        });
        let gaps = self.gaps.iter().map(|gap| {
            let (from, length) = (gap.from.as_secs_f64(), gap.length.as_secs_f64());
            format!("nothing was recorded for {length:.1} s from {from:.1} s on, or the clock was set forward")
        });
        first_few(named).chain(first_few(steps)).chain(first_few(gaps)).collect()
    }
}

/// Returns the first notes of a kind, and a note with the number of the others.
fn first_few(mut notes: impl ExactSizeIterator<Item = String>) -> impl Iterator<Item = String> {
    let more = notes.len().saturating_sub(NAMED);
    let first: Vec<_> = notes.by_ref().take(NAMED).collect();
    let last = first.last().filter(|_| more > 0).map(|_| format!("and {more} more notes like the last one"));
    first.into_iter().chain(last)
}
