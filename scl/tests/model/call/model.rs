//! What may become of a call.

use super::layout::{IMPATIENT, REQUESTERS};
use crate::model::runner::Outcome;
use bytes::Bytes;
use scl::CallError;
use std::collections::HashMap;
use std::fmt;

/// A question: its requester, and its number among all questions.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Question {
    pub(super) requester: usize,
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
        write!(f, "{}/{}", self.requester, self.number)
    }
}

pub(super) struct Model {
    /// Whether it is known at once that an end has vanished, and nothing is lost with it that it has sent.
    exact: bool,
    questions: HashMap<Question, Progress>,
    /// Whether each requester may still have to learn that a replier vanished, which costs it one call.
    to_learn: [bool; REQUESTERS],
    /// How often each requester has vanished, and, as the last element, the replier.
    vanished: [u32; REQUESTERS + 1],
    /// Number of calls of each requester that were answered.
    answered: [u32; REQUESTERS],
}

/// What has become of a question.
#[derive(Default)]
struct Progress {
    /// How often its requester had vanished before it asked.
    requester: u32,
    arrived: bool,
    answered: bool,
    /// Whether the replier vanished after it arrived.
    orphaned: bool,
}

/// The requester and the replier of a request, by how often each had vanished before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Ends(u32, u32);

impl Model {
    pub(super) fn new(exact: bool) -> Self {
        let (to_learn, vanished, answered) = ([false; REQUESTERS], [0; REQUESTERS + 1], [0; REQUESTERS]);
        Self { exact, questions: HashMap::new(), to_learn, vanished, answered }
    }

    pub(super) fn answered(&self) -> [u32; REQUESTERS] {
        self.answered
    }

    pub(super) fn begins(&mut self, requester: usize) -> Question {
        let question = Question { requester, number: self.questions.len() as u32 };
        let progress = Progress { requester: self.vanished[requester], ..Progress::default() };
        self.questions.insert(question, progress);
        if self.exact {
            // The requester looks at its connection first.
            self.to_learn[requester] = false;
        }
        question
    }

    /// A request arrived: it was sent, and did not arrive before.
    pub(super) fn arrives(&mut self, body: &Bytes) -> Result<(Question, Ends), String> {
        let known = self.questions.iter_mut().find(|(question, _)| question.body() == body);
        let (question, progress) = known.ok_or_else(|| format!("{body:?} was never sent"))?;
        if progress.arrived {
            return Err(format!("{question:?} arrived a second time"));
        }
        progress.arrived = true;
        Ok((*question, Ends(progress.requester, self.vanished[REQUESTERS])))
    }

    /// A request was answered, which fails only if its requester or replier has vanished.
    pub(super) fn is_answered(&mut self, question: Question, ends: Ends, accepted: bool) -> Outcome {
        let same_ends = ends == Ends(self.vanished[question.requester], self.vanished[REQUESTERS]);
        if accepted && !same_ends && self.exact {
            return Err(format!("the answer to {question:?} was accepted, although one of its ends has vanished"));
        }
        if !accepted && same_ends {
            return Err(format!("the answer to {question:?} was refused"));
        }
        if let Some(progress) = self.questions.get_mut(&question) {
            progress.answered |= accepted;
        }
        Ok(())
    }

    /// A call has ended.
    pub(super) fn ends_with(&mut self, question: Question, answer: Result<Bytes, CallError>) -> Outcome {
        let answered = self.questions.get(&question).is_some_and(|progress| progress.answered);
        match answer {
            Ok(body) if body != question.answer() => Err(format!("{question:?} was answered {body:?}")),
            Ok(_) if !answered => Err(format!("{question:?} was never answered")),
            Ok(_) => {
                self.answered[question.requester] += 1;
                Ok(())
            }
            Err(CallError::Timeout { .. }) if question.requester == IMPATIENT => Ok(()),
            Err(CallError::PeerLost { .. }) if std::mem::take(&mut self.to_learn[question.requester]) => {
                if answered && self.exact { Err(format!("the answer to {question:?} is lost")) } else { Ok(()) }
            }
            Err(error) => Err(format!("{question:?}: {error}")),
        }
    }

    /// Returns true if a call must end as soon as its requester looks: it was answered, or never will be.
    pub(super) fn is_over(&self, question: Question) -> bool {
        self.questions.get(&question).is_some_and(|progress| progress.answered || progress.orphaned)
    }

    pub(super) fn has_arrived(&self, question: Question) -> bool {
        self.questions.get(&question).is_some_and(|progress| progress.arrived)
    }

    pub(super) fn requester_vanishes(&mut self, requester: usize) {
        self.vanished[requester] += 1;
        self.to_learn[requester] = false;
    }

    pub(super) fn replier_vanishes(&mut self) {
        self.vanished[REQUESTERS] += 1;
        self.to_learn = [true; REQUESTERS];
        self.questions.values_mut().filter(|one| one.arrived).for_each(|one| one.orphaned = true);
    }
}
