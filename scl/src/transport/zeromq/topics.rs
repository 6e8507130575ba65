//! The topics that a subscriber has subscribed to.

use super::zmtp::{ProtocolError, Subscription};
use bytes::Bytes;

/// Limits per subscriber. SCL's own subscribers subscribe to everything, once.
const MOST_TOPICS: usize = 1024;
const MOST_BYTES: usize = 64 << 10;

#[derive(Default)]
pub(super) struct Topics {
    topics: Vec<Bytes>,
    bytes: usize,
    /// Number of `topics` that match everything.
    everything: usize,
}

impl Topics {
    pub(super) fn handle(&mut self, subscription: Subscription) -> Result<(), ProtocolError> {
        match subscription {
            Subscription::Add(topic) => {
                if self.topics.len() >= MOST_TOPICS || self.bytes + topic.len() > MOST_BYTES {
                    return Err(ProtocolError::TooManyTopics);
                }
                self.bytes += topic.len();
                self.everything += usize::from(topic.is_empty());
                // Copied, so that a short topic does not keep the whole receive buffer alive.
                self.topics.push(Bytes::copy_from_slice(&topic));
            }
            Subscription::Cancel(topic) => {
                if let Some(index) = self.topics.iter().position(|known| *known == topic) {
                    self.topics.swap_remove(index);
                    self.bytes -= topic.len();
                    self.everything -= usize::from(topic.is_empty());
                }
            }
        }
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.topics.is_empty()
    }

    pub(super) fn match_everything(&self) -> bool {
        self.everything > 0
    }

    pub(super) fn matches(&self, message: &[u8]) -> bool {
        self.match_everything() || self.topics.iter().any(|topic| message.starts_with(topic))
    }
}
