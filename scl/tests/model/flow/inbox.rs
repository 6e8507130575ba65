//! The model of the gate that receives: its own queue, which is applied to what has arrived.

use super::layout::Declared;
use super::message::Message;
use crate::trial::Outcome;
use scl::private::WhenFull;
use std::collections::VecDeque;

pub(super) struct Inbox {
    declared: Declared,
    pub(super) waiting: VecDeque<Message>,
    /// Whether the call in progress asks for the newest message, whatever it passes over.
    passing_over: bool,
    pub(super) received: u64,
    pub(super) dropped_oldest: u64,
    pub(super) dropped_newest: u64,
}

impl Inbox {
    pub(super) fn new(declared: Declared) -> Self {
        let waiting = VecDeque::new();
        Self { declared, waiting, passing_over: false, received: 0, dropped_oldest: 0, dropped_newest: 0 }
    }

    pub(super) fn arrives(&mut self, message: Message) -> Outcome {
        self.received += 1;
        let full = self.waiting.len() >= self.declared.queue as usize;
        match self.declared.when_full {
            WhenFull::DropNewest if full => {
                self.dropped_newest += 1;
                return Ok(());
            }
            WhenFull::DropOldest if full => {
                self.waiting.pop_front();
                self.dropped_oldest += 1;
            }
            WhenFull::Wait if full && !self.passing_over => {
                return Err(format!("{message:?} was fetched into a full queue"));
            }
            _ => {}
        }
        self.waiting.push_back(message);
        Ok(())
    }

    /// A call for the next message is done.
    pub(super) fn gives(&mut self, given: Option<Message>) -> Outcome {
        check(self.waiting.pop_front(), given)
    }

    pub(super) fn passes_over(&mut self) {
        self.passing_over = true;
    }

    /// A call for the newest message is done.
    pub(super) fn gives_newest(&mut self, given: Option<Message>) -> Outcome {
        self.passing_over = false;
        let newest = self.waiting.pop_back();
        self.waiting.clear();
        check(newest, given)
    }

    /// Whether it makes its sender wait, and so takes in no more than it is asked for.
    pub(super) fn waits(&self) -> bool {
        self.declared.when_full == WhenFull::Wait
    }

    pub(super) fn holds_one(&self) -> bool {
        self.declared.queue == 1
    }
}

fn check(expected: Option<Message>, given: Option<Message>) -> Outcome {
    if given == expected { Ok(()) } else { Err(format!("the reader was given {given:?} instead of {expected:?}")) }
}
