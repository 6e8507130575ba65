//! What a sending end tells a peer to which only the newest message matters: whether newer ones wait.

use super::session::Session;
use super::zmtp::{BEHIND, caught_up};
use std::io;

#[derive(Default)]
pub(super) struct WaitingReport {
    /// Whether the peer wants to be told when messages wait for its acknowledgement, and whether it has been told.
    is_wanted: bool,
    is_told: bool,
    /// Number of the peer's last question whether newer messages wait, and of the last that was answered.
    question: u64,
    answered: u64,
}

impl WaitingReport {
    pub(super) fn new(is_wanted: bool) -> Self {
        Self { is_wanted, ..Self::default() }
    }

    pub(super) fn is_wanted(&self) -> bool {
        self.is_wanted
    }

    pub(super) fn ask(&mut self, question: u64) {
        self.question = question;
    }

    /// Tells the peer that messages wait, or that none does, unless it has been told. The latter also answers its last
    /// question.
    pub(super) fn write(&mut self, session: &mut Session, waiting: bool) -> io::Result<()> {
        if self.is_wanted && waiting && !self.is_told {
            self.is_told = true;
            session.write(BEHIND)?;
        }
        if !waiting && (self.is_told || self.answered != self.question) {
            self.is_told = false;
            self.answered = self.question;
            session.write(&caught_up(self.answered))?;
        }
        Ok(())
    }
}
