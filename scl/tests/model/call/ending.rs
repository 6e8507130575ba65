//! The end of each case, when every call has to end and the next ones have to be answered.

use super::layout::REQUESTERS;
use super::stage::Stage;
use crate::trial::Outcome;
use std::time::{Duration, Instant};

/// In memory, how often the tasks may run until everything has ended.
const ROUNDS: u32 = 1000;
/// Over sockets, how long that may take at most.
const PATIENCE: Duration = Duration::from_secs(60);

impl Stage {
    pub(super) async fn end(&mut self) -> Outcome {
        self.replier_appears().await?;
        for place in 0..REQUESTERS {
            self.requester_appears(place).await?;
        }
        self.neglected_calls_are_given_up();
        self.serve().await?;
        // A call may still be lost to a replier that vanished, and one in a hurry may be late: they ask again.
        let (asked, started, mut rounds) = (self.model.answered(), Instant::now(), 0);
        while (0..REQUESTERS).any(|place| self.model.answered()[place] == asked[place]) {
            for place in 0..REQUESTERS {
                self.ask(place)?;
            }
            self.serve().await?;
            rounds += 1;
            if self.is_overdue(started, rounds) {
                return Err("a replier is there, and calls are not answered".to_owned());
            }
        }
        Ok(())
    }

    /// Nobody else will end them within the hour.
    fn neglected_calls_are_given_up(&mut self) {
        for caller in self.callers.iter_mut().flatten() {
            let neglected = caller.asks().is_some_and(|question| {
                self.model.has_arrived(question) && !self.taken.iter().any(|taken| taken.question == question)
            });
            if neglected && !caller.asks().is_some_and(|question| self.model.is_over(question)) {
                caller.give_up();
            }
        }
    }

    /// Answers, the oldest last, until all calls have ended.
    async fn serve(&mut self) -> Outcome {
        let (started, mut rounds) = (Instant::now(), 0);
        while self.callers.iter().flatten().any(|caller| caller.asks().is_some()) {
            self.take(usize::MAX)?;
            while let Some(newest) = self.taken.len().checked_sub(1) {
                self.answer(newest)?;
            }
            self.tasks_run().await?;
            rounds += 1;
            if self.is_overdue(started, rounds) {
                let left: Vec<_> = self.callers.iter().flatten().filter_map(|caller| caller.asks()).collect();
                return Err(format!("a replier answers everything, and calls do not end: {left:?}"));
            }
        }
        Ok(())
    }

    fn is_overdue(&self, started: Instant, rounds: u32) -> bool {
        if self.exact { rounds > ROUNDS } else { started.elapsed() > PATIENCE }
    }
}
