//! What a receiving end knows about messages that are newer than those it has read, when only the newest matters.

use super::timer::Timer;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How long a receiver waits for the messages that the sender has announced: a stopped sender must not stop a control
/// loop.
pub(super) const LIMIT: Duration = Duration::from_millis(100);
/// Number of steps that the limit is divided into. Time in which this program itself is stopped counts as one step at
/// most.
const STEPS: u32 = 10;
/// How long an answer stays valid for a caller that does not wait, but calls repeatedly.
const FRESH: Duration = Duration::from_millis(1);

#[derive(Default)]
pub(super) struct CatchUp {
    /// Whether the sender holds messages until earlier ones are acknowledged.
    behind: bool,
    /// Whether the sender was silent for the whole limit.
    gave_up: bool,
    /// Number of steps of the limit in which the sender has been silent.
    silent_steps: u32,
    /// Number of the last question whether newer messages wait, and of the last that the sender has answered.
    question: u64,
    answered: u64,
    answered_at: Option<Instant>,
    answer: Answer,
    timer: Timer,
}

/// What a sender has said about messages that are newer than those read.
#[derive(PartialEq, Default)]
enum Answer {
    /// Nothing that counts for the present call.
    #[default]
    Forgotten,
    /// Nothing yet since the call began.
    Awaited,
    /// That none waited, at some time since the call began. A sender that never pauses reports right afterwards that
    /// others wait.
    CaughtUp,
}

impl CatchUp {
    /// Notes that the sender holds newer messages.
    pub(super) fn note_behind(&mut self) {
        (self.behind, self.gave_up) = (true, false);
    }

    /// Notes that the sender has answered a question: no newer message waits.
    pub(super) fn note_caught_up(&mut self, question: u64) {
        (self.behind, self.gave_up) = (false, false);
        if question == self.question {
            (self.answered, self.answered_at) = (question, Some(Instant::now()));
            if self.answer == Answer::Awaited {
                self.answer = Answer::CaughtUp;
            }
        }
    }

    /// Marks the start of a call, which does not rely on earlier answers.
    pub(super) fn forget_answer(&mut self) {
        self.answer = Answer::Forgotten;
    }

    pub(super) fn is_forgotten(&self) -> bool {
        self.answer == Answer::Forgotten
    }

    pub(super) fn await_answer(&mut self) {
        self.answer = Answer::Awaited;
    }

    /// Returns true if the last question was answered just now.
    pub(super) fn is_fresh(&self) -> bool {
        self.question == self.answered && self.answered_at.is_some_and(|at| at.elapsed() < FRESH)
    }

    pub(super) fn next_question(&mut self) -> u64 {
        self.question += 1;
        self.question
    }

    /// Returns true if the sender may hold newer messages. `is_unread`: some received bytes, which may contain the
    /// answer, have not been decoded.
    pub(super) fn may_be_behind(&self, is_unread: bool) -> bool {
        self.answer != Answer::CaughtUp && (self.behind || self.question != self.answered || is_unread)
    }

    pub(super) fn gave_up(&self) -> bool {
        self.gave_up
    }

    /// Notes that the sender was silent for `limit`, which may be too short to give up.
    pub(super) fn note_silence(&mut self, limit: Duration) {
        self.gave_up = limit >= LIMIT;
    }

    /// Ready when another step of the limit has passed in silence.
    pub(super) fn poll_silence(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if !self.timer.is_set() {
            self.timer.set(LIMIT / STEPS);
        }
        if self.timer.poll(cx).is_pending() {
            return Poll::Pending;
        }
        self.silent_steps += 1;
        self.gave_up = self.silent_steps >= STEPS;
        Poll::Ready(())
    }

    /// Ends a wait: the next one measures silence anew.
    pub(super) fn end_wait(&mut self) {
        self.timer.unset();
        self.silent_steps = 0;
    }
}
