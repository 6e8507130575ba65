//! What may become of a call.

use super::layout::{HASTY, REQUESTERS};
use crate::trial::Outcome;
use bytes::Bytes;
use scl::CallError;
use std::collections::HashMap;
use std::fmt;

/// A question: who asks, and its number among all.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Question {
    pub(super) place: usize,
    number: u32,
}

impl Question {
    pub(super) fn body(self) -> Bytes {
        format!("{self:?}").into()
    }

    /// The only right answer.
    pub(super) fn answer(self) -> Bytes {
        format!("to {self:?}").into()
    }
}

impl fmt::Debug for Question {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.place, self.number)
    }
}

pub(super) struct Model {
    /// Whether an end that vanishes is known to be gone at once, and takes nothing with it that was given to the other.
    exact: bool,
    asked: HashMap<Question, Asked>,
    /// Of each requester, whether it may still have to learn that a replier vanished; that costs it one call.
    to_learn: [bool; REQUESTERS],
    /// How often each requester has vanished, and in the end the replier.
    vanished: [u32; REQUESTERS + 1],
    /// How many calls of each requester were answered.
    answered: [u32; REQUESTERS],
}

/// What has become of a question.
#[derive(Default)]
struct Asked {
    /// How often its requester had vanished when it was asked.
    asker: u32,
    arrived: bool,
    answered: bool,
    /// Whether a replier vanished since it arrived.
    bereft: bool,
}

/// The requester and the replier of a request, as how many of each had vanished before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Ends(u32, u32);

impl Model {
    pub(super) fn new(exact: bool) -> Self {
        let (to_learn, vanished, answered) = ([false; REQUESTERS], [0; REQUESTERS + 1], [0; REQUESTERS]);
        Self { exact, asked: HashMap::new(), to_learn, vanished, answered }
    }

    pub(super) fn answered(&self) -> [u32; REQUESTERS] {
        self.answered
    }

    pub(super) fn asks(&mut self, place: usize) -> Question {
        let question = Question { place, number: self.asked.len() as u32 };
        self.asked.insert(question, Asked { asker: self.vanished[place], ..Asked::default() });
        if self.exact {
            // The requester looks before it asks.
            self.to_learn[place] = false;
        }
        question
    }

    /// A request has come: one that was asked, for the first time.
    pub(super) fn arrives(&mut self, body: &Bytes) -> Result<(Question, Ends), String> {
        let asked = self.asked.iter_mut().find(|(question, _)| question.body() == body);
        let (question, asked) = asked.ok_or_else(|| format!("{body:?} was never asked"))?;
        if asked.arrived {
            return Err(format!("{question:?} came a second time"));
        }
        asked.arrived = true;
        Ok((*question, Ends(asked.asker, self.vanished[REQUESTERS])))
    }

    /// A request was answered, which fails only when one of the ends it went between is gone.
    pub(super) fn is_answered(&mut self, question: Question, came_by: Ends, taken: bool) -> Outcome {
        let same_ends = came_by == Ends(self.vanished[question.place], self.vanished[REQUESTERS]);
        if taken && !same_ends && self.exact {
            return Err(format!("the answer to {question:?} was taken, although one of its ends is gone"));
        }
        if !taken && same_ends {
            return Err(format!("the answer to {question:?} was refused"));
        }
        if let Some(asked) = self.asked.get_mut(&question) {
            asked.answered |= taken;
        }
        Ok(())
    }

    /// A call has ended.
    pub(super) fn ends_with(&mut self, question: Question, answer: Result<Bytes, CallError>) -> Outcome {
        let answered = self.asked.get(&question).is_some_and(|asked| asked.answered);
        match answer {
            Ok(body) if body != question.answer() => Err(format!("{question:?} was answered {body:?}")),
            Ok(_) if !answered => Err(format!("{question:?} was answered by nobody")),
            Ok(_) => {
                self.answered[question.place] += 1;
                Ok(())
            }
            Err(CallError::Timeout { .. }) if question.place == HASTY => Ok(()),
            Err(CallError::PeerLost { .. }) if std::mem::take(&mut self.to_learn[question.place]) => {
                if answered && self.exact { Err(format!("the answer to {question:?} is lost")) } else { Ok(()) }
            }
            Err(error) => Err(format!("{question:?}: {error}")),
        }
    }

    /// Whether a call must have ended by now, if its requester has had time to see it: it was answered, or never will be.
    pub(super) fn is_over(&self, question: Question) -> bool {
        self.asked.get(&question).is_some_and(|asked| asked.answered || asked.bereft)
    }

    pub(super) fn has_arrived(&self, question: Question) -> bool {
        self.asked.get(&question).is_some_and(|asked| asked.arrived)
    }

    pub(super) fn requester_goes(&mut self, place: usize) {
        self.vanished[place] += 1;
        self.to_learn[place] = false;
    }

    pub(super) fn replier_goes(&mut self) {
        self.vanished[REQUESTERS] += 1;
        self.to_learn = [true; REQUESTERS];
        self.asked.values_mut().filter(|asked| asked.arrived).for_each(|asked| asked.bereft = true);
    }
}
