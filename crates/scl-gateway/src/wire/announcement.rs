//! Announcements of running components, with their plans and schemas.
//!
//! A token shows that an announcement exists. Its content is queried in parts, so that no message is larger than what
//! the network library sends without dropping it.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use bytes::{Bytes, BytesMut};
use zenoh::sample::Sample;

use super::command::{Command, Commands, Declared, Part};
use super::keys::Token;
use super::mailbox::Mailbox;
use super::neighbour::Neighbour;

pub(super) const PART: usize = 30 * 1024;
/// Largest announcement that is fetched.
const LARGEST: u64 = 64 << 20;
/// Delay before a part that did not arrive is queried again.
const RETRY: Duration = Duration::from_millis(200);

/// A component is announced while this exists.
#[derive(Debug)]
#[must_use = "the component is announced only until this is dropped"]
pub struct Announced {
    pub(super) _declared: Declared,
}

/// The announcements of the neighbours.
#[derive(Debug)]
pub(super) struct Announcements {
    neighbours: Arc<Mailbox<Neighbour>>,
    /// By token.
    known: HashMap<String, Loading>,
}

#[derive(Debug, Default)]
struct Loading {
    content: BytesMut,
    retry_at: Option<Instant>,
    is_complete: bool,
}

impl Announcements {
    pub(super) fn new(neighbours: &Arc<Mailbox<Neighbour>>) -> Self {
        Announcements { neighbours: Arc::clone(neighbours), known: HashMap::new() }
    }

    /// Starts loading an announcement. The caller must query the part at offset 0.
    pub(super) fn appeared(&mut self, key: &str) {
        self.known.insert(key.to_owned(), Loading::default());
    }

    pub(super) fn disappeared(&mut self, key: &str) {
        if self.known.remove(key).is_some_and(|it| it.is_complete)
            && let Some((component, host)) = names(key)
        {
            self.neighbours.push(0, Neighbour::Stopped { component, host });
        }
    }

    /// Handles a part, or `None` for a part that did not arrive. Returns the offset of the next part to query, if any.
    pub(super) fn part(&mut self, key: &str, part: Option<Part>) -> Option<usize> {
        let loading = self.known.get_mut(key).filter(|it| !it.is_complete)?;
        let Loading { content, retry_at, .. } = loading;
        let fits = |part: &Part| {
            part.offset == content.len() as u64
                && part.total <= LARGEST
                && part.offset + part.bytes.len() as u64 <= part.total
                && (!part.bytes.is_empty() || part.total == 0)
        };
        let Some(part) = part.filter(fits) else {
            *retry_at = Some(Instant::now() + RETRY);
            return None;
        };
        content.extend_from_slice(&part.bytes);
        if (content.len() as u64) < part.total {
            return Some(content.len());
        }
        let content = std::mem::take(content).freeze();
        *loading = Loading { is_complete: true, ..Loading::default() };
        if let Some((component, host)) = names(key) {
            self.neighbours.push(0, Neighbour::Started { component, host, content });
        }
        None
    }

    /// Returns the parts that are due to be queried again.
    pub(super) fn due(&mut self, now: Instant) -> Vec<(String, usize)> {
        let due = |(key, it): (&String, &mut Loading)| {
            it.retry_at.take_if(|at| *at <= now)?;
            Some((key.clone(), it.content.len()))
        };
        self.known.iter_mut().filter_map(due).collect()
    }

    pub(super) fn deadline(&self) -> Option<Instant> {
        self.known.values().filter_map(|it| it.retry_at).min()
    }
}

/// The answer to a query for a part of an announcement. Reports the part to the thread, or that none arrived if it is
/// dropped without a reply.
pub(super) struct Answer {
    commands: Commands,
    key: String,
    has_come: bool,
}

impl Answer {
    pub(super) fn new(commands: &Commands, key: &str) -> Self {
        Answer { commands: commands.clone(), key: key.to_owned(), has_come: false }
    }

    pub(super) fn part(&mut self, sample: &Sample) {
        let Some(place) = sample.attachment().map(|place| place.to_bytes()) else { return };
        let Some((offset, total)) = place.split_first_chunk() else { return };
        let Ok(total) = total.try_into() else { return };
        let bytes = Bytes::from(sample.payload().to_bytes().into_owned());
        let part = Part { offset: u64::from_be_bytes(*offset), total: u64::from_be_bytes(total), bytes };
        self.has_come = true;
        self.commands.send(Command::Part { key: self.key.clone(), part: Some(part) });
    }
}

impl Drop for Answer {
    fn drop(&mut self) {
        if !self.has_come {
            self.commands.send(Command::Part { key: self.key.clone(), part: None });
        }
    }
}

fn names(key: &str) -> Option<(String, String)> {
    match Token::parse(key)? {
        Token::Component { component, host, .. } => Some((component.to_owned(), host.to_owned())),
        _ => None,
    }
}
