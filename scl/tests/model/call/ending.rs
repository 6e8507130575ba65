//! The end of each case: every call must end, and the next ones must be answered.

use super::layout::REQUESTERS;
use super::stage::Stage;
use crate::model::runner::Outcome;
use std::time::{Duration, Instant};

/// In memory, how often the tasks may run until all calls have ended.
const ROUNDS: u32 = 1000;
/// Over sockets, how long that may take at most.
const PATIENCE: Duration = Duration::from_secs(300);

impl Stage {
    pub(super) async fn end(&mut self) -> Outcome {
        self.replier_appears().await?;
        for requester in 0..REQUESTERS {
            self.requester_appears(requester).await?;
        }
        self.give_up_neglected_calls();
        self.serve().await?;
        // A call may still be lost with a replier that vanished, or time out: those requesters ask again.
        let (before, started, mut rounds) = (self.model.answered(), Instant::now(), 0);
        while (0..REQUESTERS).any(|requester| self.model.answered()[requester] == before[requester]) {
            for requester in 0..REQUESTERS {
                self.ask(requester)?;
            }
            self.serve().await?;
            rounds += 1;
            if self.is_overdue(started, rounds) {
                return Err("a replier is there, and new calls are not answered".to_owned());
            }
        }
        Ok(())
    }

    /// Otherwise they would end by their timeout of an hour.
    fn give_up_neglected_calls(&mut self) {
        for caller in self.callers.iter_mut().flatten() {
            let neglected = caller.question().is_some_and(|question| {
                self.model.has_arrived(question) && !self.taken.iter().any(|taken| taken.question == question)
            });
            if neglected && !caller.question().is_some_and(|question| self.model.is_over(question)) {
                caller.give_up();
            }
        }
    }

    /// Answers the newest first, until all calls have ended.
    async fn serve(&mut self) -> Outcome {
        let (started, mut rounds) = (Instant::now(), 0);
        while self.callers.iter().flatten().any(|caller| caller.question().is_some()) {
            self.take(usize::MAX)?;
            while let Some(newest) = self.taken.len().checked_sub(1) {
                self.answer(newest)?;
            }
            self.tasks_run().await?;
            rounds += 1;
            if self.is_overdue(started, rounds) {
                let left: Vec<_> = self.callers.iter().flatten().filter_map(|caller| caller.question()).collect();
                return Err(format!("a replier answers everything, and calls do not end: {left:?}"));
            }
        }
        Ok(())
    }

    fn is_overdue(&self, started: Instant, rounds: u32) -> bool {
        if self.exact { rounds > ROUNDS } else { started.elapsed() > PATIENCE }
    }
}
