//! What a recording contains, learned by reading all of its messages once.

use super::{OtherTopic, RecordedChannel, Recording};
use crate::format::Topic;
use scl_terminal::{Problem, escape};
use std::collections::BTreeMap;

/// How many topics of other programs a note names.
const NAMED: usize = 5;

/// What a recording contains.
#[derive(Debug, Clone, Default)]
pub struct Survey {
    /// The topics that SCL recorded.
    pub topics: BTreeMap<Topic, SurveyedTopic>,
    /// The topics that other programs recorded.
    pub others: Vec<OtherTopic>,
    /// When the first message was sent, in nanoseconds since 1970; `None` without messages.
    pub first_ns: Option<u64>,
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
        while let Some(message) = messages.read()? {
            counts.resize(counts.len().max(message.channel + 1), (0, 0));
            let (messages, bytes) = &mut counts[message.channel];
            *messages += 1;
            *bytes += message.payload.len() as u64;
            survey.first_ns.get_or_insert(message.sent_ns);
        }
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

    /// What a reader of the messages should know: topics that are left out.
    pub fn notes(&self) -> Vec<String> {
        let named = self.others.iter().take(NAMED).map(|other| {
            let (topic, messages) = (escape(&other.topic), other.messages);
            format!("`{topic}` was not recorded by SCL: {}; messages left out: {messages}", other.reason)
        });
        let more = self.others.len().saturating_sub(NAMED);
        let more = (more > 0).then(|| format!("{more} more topics were not recorded by SCL; leaving them out"));
        named.chain(more).collect()
    }
}
