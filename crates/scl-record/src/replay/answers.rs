//! What a played replier answers: the replies that were recorded.

use crate::format::Part;
use crate::recording::Recording;
use bytes::Bytes;
use scl_terminal::Problem;
use scl_value::{MessageType, to_json};
use std::collections::HashMap;

/// A component and one of its gates.
pub(super) type GateId = (String, String);

/// Maximum memory for the requests and replies of a replay, in bytes.
const LIMIT: usize = 256 << 20;

/// The recorded replies of one gate.
///
/// A request is answered with the reply to an equal request: with the oldest that was not given yet, or else with the
/// last one again. A request that was never recorded gets the oldest reply that was not given yet: requests may contain
/// a time or a number that differs in each run.
#[derive(Debug)]
pub(super) struct Answers {
    /// Requests are compared by what they mean: another program may write maps in another order.
    requests: MessageType,
    /// The replies, and whether each was given.
    replies: Vec<(Bytes, bool)>,
    /// Indices of the replies, by the canonical form of their request.
    by_request: HashMap<Bytes, Vec<usize>>,
    /// All replies before this one were given.
    first: usize,
}

/// The reply to a request.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// The recorded reply to an equal request.
    Recorded(Bytes),
    /// The oldest reply not given yet, because no equal request was recorded.
    NextInOrder(Bytes),
    /// The recording has no reply for this request.
    Missing,
}

impl Answers {
    fn new(requests: MessageType) -> Self {
        Self { requests, replies: Vec::new(), by_request: HashMap::new(), first: 0 }
    }

    fn add(&mut self, request: Bytes, reply: Bytes) {
        self.by_request.entry(request).or_default().push(self.replies.len());
        self.replies.push((reply, false));
    }

    /// Returns the reply to a request, and marks it as given.
    pub(super) fn answer(&mut self, request: &[u8]) -> Answer {
        if let Some(own) = self.by_request.get(&self.requests.canonical(request)) {
            let chosen = own.iter().find(|&&index| !self.replies[index].1).or(own.last()).copied();
            return chosen.and_then(|index| self.give(index)).map_or(Answer::Missing, Answer::Recorded);
        }
        while self.replies.get(self.first).is_some_and(|(_, given)| *given) {
            self.first += 1;
        }
        self.give(self.first).map_or(Answer::Missing, Answer::NextInOrder)
    }

    /// A request as JSON, for messages.
    pub(super) fn shown(&self, request: &[u8]) -> String {
        to_json(&self.requests.show(request))
    }

    fn give(&mut self, index: usize) -> Option<Bytes> {
        let (reply, given) = self.replies.get_mut(index)?;
        *given = true;
        Some(reply.clone())
    }
}

/// Reads the recorded replies of the `wanted` gates. Without wanted gates, nothing is read.
///
/// # Errors
/// The recording cannot be read, or its requests and replies need more memory than [`LIMIT`].
pub(super) fn read_answers(recording: &Recording, wanted: &[GateId]) -> Result<HashMap<GateId, Answers>, Problem> {
    let mut answers = HashMap::new();
    if wanted.is_empty() {
        return Ok(answers);
    }
    let mut open = HashMap::new();
    let mut messages = recording.messages();
    let mut bytes = 0;
    while let Some(message) = messages.read()? {
        let channel = &messages.channels()[message.channel];
        let gate = (channel.topic.component.clone(), channel.topic.gate.clone());
        if !wanted.contains(&gate) {
            continue;
        }
        match channel.topic.part {
            Part::Message => continue,
            Part::Request => {
                let answers = answers.entry(gate.clone()).or_insert_with(|| Answers::new(channel.message_type()));
                let request = answers.requests.canonical(&message.payload);
                bytes += request.len();
                // A component that was started again numbers from the beginning: the last request counts.
                open.insert((gate, message.sequence), request);
            }
            Part::Reply => {
                // Its request may have been lost.
                let asked = open.remove(&(gate.clone(), message.sequence));
                if let (Some(request), Some(answers)) = (asked, answers.get_mut(&gate)) {
                    bytes += message.payload.len();
                    answers.add(request, message.payload);
                }
            }
        }
        if bytes > LIMIT {
            let message = format!("the recorded requests and replies need more than {} MiB of memory", LIMIT >> 20);
            return Err(Problem::new(message).help("leave out the replier: name the components to play with `--as`"));
        }
    }
    Ok(answers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Recorder;

    fn answers(pairs: &[(&str, &str)]) -> Answers {
        let mut answers = Answers::new(MessageType::new(None, "json", None).unwrap());
        for &(request, reply) in pairs {
            answers.add(answers.requests.canonical(request.as_bytes()), reply.to_owned().into());
        }
        answers
    }

    fn recorded(reply: &str) -> Answer {
        Answer::Recorded(reply.to_owned().into())
    }

    #[test]
    fn equal_requests_are_answered_in_order_and_unknown_ones_with_what_is_left() {
        let mut answers = answers(&[("a", "1"), ("b", "2"), ("a", "3"), ("c", "4")]);
        let given = ["b", "a", "a", "a", "x", "c", "y"].map(|request| answers.answer(request.as_bytes()));
        let known = ["2", "1", "3", "3"].map(recorded);
        assert_eq!(given[..4], known);
        assert_eq!(given[4..], [Answer::NextInOrder("4".into()), recorded("4"), Answer::Missing]);
    }

    /// Programs of other languages, or the same one in its next run, write the same map in another order.
    #[test]
    fn requests_are_equal_whatever_the_order_of_their_maps() {
        let request = |index: usize, order: [usize; 3]| {
            let entries = order.map(|key| format!("\"{key}\":{}", index * key));
            format!("{{\"layers\":{{{}}},\"tile\":{index}}}", entries.join(","))
        };
        let pairs: Vec<_> = (0..60).map(|index| (request(index, [1, 2, 3]), index.to_string())).collect();
        let pairs: Vec<_> = pairs.iter().map(|(request, reply)| (request.as_str(), reply.as_str())).collect();
        let mut answers = answers(&pairs);
        for index in (0..60).rev() {
            let reordered = request(index, [3, 1, 2]);
            assert_eq!(answers.answer(reordered.as_bytes()), recorded(&index.to_string()), "{reordered}");
        }
        assert_eq!(answers.answer(b"{\"tile\":60}"), Answer::Missing);
    }

    #[test]
    fn replies_belong_to_the_requests_with_their_number() {
        let folder = tempfile::tempdir().unwrap();
        let (request, reply) = ("/map/tiles/request", "/map/tiles/reply");
        // The recorder numbers one after the other, so both directions are written twice, from 0.
        let path = Recorder::new()
            .messages(&[(request, 0, "a"), (request, 1, "b")])
            .restart_numbers()
            .messages(&[(reply, 2, "A"), (reply, 3, "B"), (reply, 4, "nobody asked")])
            .write_to(folder.path(), "map.mcap");
        let gate = ("map".to_owned(), "tiles".to_owned());
        let recording = Recording::open(&[path]).unwrap();
        let mut answers = read_answers(&recording, std::slice::from_ref(&gate)).unwrap().remove(&gate).unwrap();
        assert_eq!(["b", "a"].map(|request| answers.answer(request.as_bytes())), ["B", "A"].map(recorded));
        assert_eq!(answers.replies.len(), 2);
    }

    /// The first `a` got no reply before the replier was killed; the next one numbers its requests from 0 again.
    #[test]
    fn a_reply_belongs_to_the_last_request_with_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let (request, reply) = ("/map/tiles/request", "/map/tiles/reply");
        let recorder = Recorder::new().messages(&[(request, 0, "a")]).restart_numbers();
        let path = recorder
            .messages(&[(request, 1, "b")])
            .restart_numbers()
            .messages(&[(reply, 2, "B")])
            .write_to(folder.path(), "map.mcap");
        let gate = ("map".to_owned(), "tiles".to_owned());
        let recording = Recording::open(&[path]).unwrap();
        let mut answers = read_answers(&recording, std::slice::from_ref(&gate)).unwrap().remove(&gate).unwrap();
        assert_eq!(answers.answer(b"b"), recorded("B"));
        assert_eq!(answers.replies.len(), 1);
    }
}
