//! Asking the senders of a gate with `queue: 1` what they hold back.
//!
//! The senders may be slow to answer, each at another time, and the program may give up each of its calls after a
//! while. It must still get their newest message, and one that is not older than its call.

use super::links::Links;
use std::task::Poll;
use std::time::{Duration, Instant};

/// How old a question may be for the call of a stream, whose beginning is not known.
const FRESH: Duration = Duration::from_millis(1);
/// How old a second question may be when a call begins: longer than a slow sender needs, so that there is no third.
const FRESH_ENOUGH: Duration = Duration::from_secs(1);

/// The kind of call that polls for a message.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Caller {
    /// The first poll of a call.
    NewCall,
    /// A later poll of the same call.
    SameCall,
    /// A stream, whose call may be dropped and followed by another one without notice.
    Stream,
}

#[derive(Default)]
pub(super) struct CatchUp {
    /// The question that some senders have not answered. It stays open if the call that asked is dropped.
    open: Option<Question>,
}

struct Question {
    asked_at: Instant,
    /// Whether this is the second question, because the first was older than the call.
    again: bool,
    /// Whether it is too old for the call that waits.
    is_old: bool,
}

impl CatchUp {
    pub(super) fn is_waiting(&self) -> bool {
        self.open.is_some()
    }

    /// Ready when each sender has answered, since the call began, that it holds back nothing newer. The links may have
    /// read further messages to learn that.
    pub(super) fn poll(&mut self, links: &mut Links, caller: Caller) -> Poll<()> {
        match &mut self.open {
            Some(question) => question.is_old |= !question.counts_for(caller),
            None => links.forget_answers(),
        }
        if links.are_behind() {
            self.open.get_or_insert_with(|| Question::now(false));
            return Poll::Pending;
        }
        if self.open.take().is_some_and(|question| question.is_old) {
            links.forget_answers();
            if links.are_behind() {
                self.open = Some(Question::now(true));
                return Poll::Pending;
            }
        }
        Poll::Ready(())
    }
}

impl Question {
    fn now(again: bool) -> Self {
        Self { asked_at: Instant::now(), again, is_old: false }
    }

    fn counts_for(&self, caller: Caller) -> bool {
        match caller {
            Caller::SameCall => true,
            Caller::NewCall | Caller::Stream if self.again => self.asked_at.elapsed() <= FRESH_ENOUGH,
            Caller::NewCall => false,
            Caller::Stream => self.asked_at.elapsed() <= FRESH,
        }
    }
}
