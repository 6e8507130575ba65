//! What a played replier answers: the replies that were recorded.

use crate::format::Part;
use crate::recording::Recording;
use bytes::Bytes;
use scl_terminal::Problem;
use std::collections::{HashMap, VecDeque};

/// The most memory for the requests and replies of a replay, in bytes.
const LIMIT: usize = 256 << 20;

/// The recorded replies of one gate.
///
/// A request is answered with the reply to the same request: with the oldest that was not given yet, or else with the last
/// one again. A request that was never recorded gets the oldest reply that was not given yet: requests may contain a time
/// or a number that differs in each run.
#[derive(Debug, Default)]
pub(super) struct Answers {
    replies: Vec<Bytes>,
    given: Vec<bool>,
    /// By request, indices of its replies.
    by_request: HashMap<Bytes, Vec<usize>>,
    /// All replies before this one were given.
    first: usize,
}

impl Answers {
    fn add(&mut self, request: Bytes, reply: Bytes) {
        self.by_request.entry(request).or_default().push(self.replies.len());
        self.replies.push(reply);
        self.given.push(false);
    }

    /// The reply to a request; `None` if the recording has none that could be meant.
    pub(super) fn answer(&mut self, request: &[u8]) -> Option<Bytes> {
        let own = self.by_request.get(request);
        let index = match own {
            Some(own) => *own.iter().find(|&&index| !self.given[index]).or(own.last())?,
            None => {
                while self.given.get(self.first) == Some(&true) {
                    self.first += 1;
                }
                self.first
            }
        };
        *self.given.get_mut(index)? = true;
        self.replies.get(index).cloned()
    }
}

/// Reads the replies of all gates for which `wanted` returns true. Without wanted gates nothing is read.
///
/// # Errors
/// The recording cannot be read, or has more of them than fit into memory.
pub(super) fn read_answers(
    recording: &Recording,
    wanted: &[(String, String)],
) -> Result<HashMap<(String, String), Answers>, Problem> {
    let mut answers: HashMap<_, _> = wanted.iter().map(|gate| (gate.clone(), Answers::default())).collect();
    if wanted.is_empty() {
        return Ok(answers);
    }
    let mut open = HashMap::<_, VecDeque<Bytes>>::new();
    let mut messages = recording.messages();
    let mut bytes = 0;
    while let Some(message) = messages.read()? {
        let topic = &messages.channels()[message.channel].topic;
        let gate = (topic.component.clone(), topic.gate.clone());
        let Some(answers) = answers.get_mut(&gate) else { continue };
        match topic.part {
            Part::Message => continue,
            Part::Request => open.entry((gate, message.sequence)).or_default().push_back(message.payload.clone()),
            Part::Reply => {
                // Its request may have been lost.
                let asked = open.get_mut(&(gate, message.sequence)).and_then(VecDeque::pop_front);
                if let Some(request) = asked {
                    answers.add(request, message.payload.clone());
                }
            }
        }
        bytes += message.payload.len();
        if bytes > LIMIT {
            let message = format!("the recorded requests and replies need more than {} MiB of memory", LIMIT >> 20);
            return Err(Problem::new(message).help("do not play the replier: name the components with `--as`"));
        }
    }
    Ok(answers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Recorder;

    fn answers(pairs: &[(&str, &str)]) -> Answers {
        let mut answers = Answers::default();
        pairs.iter().for_each(|&(request, reply)| answers.add(request.to_owned().into(), reply.to_owned().into()));
        answers
    }

    #[test]
    fn equal_requests_are_answered_in_order_and_unknown_ones_with_what_is_left() {
        let mut answers = answers(&[("a", "1"), ("b", "2"), ("a", "3"), ("c", "4")]);
        let given = ["b", "a", "a", "a", "x", "c", "y"].map(|request| answers.answer(request.as_bytes()));
        let given = given.map(|reply| reply.map(|reply| String::from_utf8(reply.to_vec()).unwrap()));
        let expected = ["2", "1", "3", "3", "4", "4"].map(|reply| Some(reply.to_owned()));
        assert_eq!((&given[..6], &given[6]), (&expected[..], &None));
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
        assert_eq!(["b", "a"].map(|request| answers.answer(request.as_bytes()).unwrap()), ["B", "A"]);
        assert_eq!(answers.replies.len(), 2);
    }
}
