//! A topic of a gate, and the topics that are made of it.

use crate::channels::{Channel, Messages, Sent};
use crate::companions::{Companion, Descriptions};
use foxglove::Context;
use scl_record::format::Topic;
use scl_terminal::{Problem, print_err};
use std::sync::Arc;

/// A topic whose messages come from a gate or a recording.
pub(crate) struct Source {
    pub(crate) topic: Topic,
    channel: Channel,
    companions: Vec<Companion>,
}

impl Source {
    /// Makes the channels. What cannot be made of the messages is told, and left out.
    ///
    /// # Errors
    /// The topic cannot be shown.
    pub(crate) fn new(
        context: &Arc<Context>,
        topic: Topic,
        messages: &Messages<'_>,
        descriptions: &Descriptions,
    ) -> Result<Self, Problem> {
        let channel = Channel::new(context, &topic.to_string(), messages)
            .map_err(|error| Problem::new(format!("{topic} cannot be shown: {error}")))?;
        let made = descriptions.companions(context, &topic, messages);
        let companions = made.filter_map(|made| made.map_err(|problem| print_err(&problem.to_string())).ok()).collect();
        Ok(Self { topic, channel, companions })
    }

    /// Whether a panel shows it, or what is made of it.
    pub(crate) fn is_shown(&self) -> bool {
        self.channel.is_shown() || self.companions.iter().any(Companion::is_shown)
    }

    pub(crate) fn send(&self, sent: &Sent) {
        self.channel.send(sent);
        self.companions.iter().filter(|companion| companion.is_shown()).for_each(|companion| companion.send(sent));
    }

    pub(crate) fn close(&self) {
        self.channel.close();
        self.companions.iter().for_each(Companion::close);
    }
}
