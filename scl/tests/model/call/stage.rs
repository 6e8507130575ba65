//! The real gates, and what a step does to them.

use super::caller::Caller;
use super::layout::{IMPATIENT, REQUESTERS, open_replier, open_requester};
use super::model::{Ends, Model, Question};
use super::step::{Case, Step};
use crate::model::runner::Outcome;
use crate::model::wake_flag::WakeFlag;
use bytes::Bytes;
use futures_core::Stream;
use scl::{OpenOptions, Rep, Request};
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How often tasks and woken calls may run in one step: often enough for all that they can do without new events.
const TURNS: usize = 10;
/// Over sockets, how long tasks may run until the ends have found each other. Those that have not continue later.
const CONNECTING: Duration = Duration::from_millis(50);

pub(super) struct Stage {
    pub(super) exact: bool,
    pub(super) model: Model,
    options: OpenOptions,
    replier: Option<Rep<Bytes, Bytes>>,
    /// Set when the replier, which waits, is woken.
    news: Option<WakeFlag>,
    pub(super) callers: [Option<Caller>; REQUESTERS],
    pub(super) taken: Vec<Taken>,
}

/// A request that was taken and not answered.
pub(super) struct Taken {
    pub(super) question: Question,
    ends: Ends,
    request: Request<Bytes, Bytes>,
}

impl Stage {
    pub(super) fn new(options: OpenOptions, exact: bool) -> Self {
        Self {
            exact,
            model: Model::new(exact),
            options,
            replier: None,
            news: None,
            callers: [const { None }; REQUESTERS],
            taken: Vec::new(),
        }
    }

    pub(super) async fn play(mut self, case: &Case) -> Outcome {
        for (step, number) in case.steps.iter().zip(1..) {
            self.step(*step).await.map_err(|reason| format!("step {number}, {step:?}: {reason}"))?;
        }
        self.end().await.map_err(|reason| format!("after the last step: {reason}"))
    }

    async fn step(&mut self, step: Step) -> Outcome {
        match step {
            Step::ReplierAppears => self.replier_appears().await,
            Step::ReplierVanishes => self.replier_vanishes(),
            Step::Take(count) => self.take(count),
            Step::Answer(which) => self.answer(which),
            Step::Neglect(which) => self.neglect(which),
            Step::RequesterAppears(requester) => self.requester_appears(requester).await,
            Step::RequesterVanishes(requester) => self.requester_vanishes(requester),
            Step::Ask(requester) => self.ask(requester),
            Step::GiveUp(requester) => self.give_up(requester),
            Step::AskAndGiveUp(requester, times) => {
                (0..times).try_for_each(|_| self.ask(requester).and_then(|()| self.give_up(requester)))
            }
            Step::TimeRunsOut => self.time_runs_out().await,
            Step::TasksRun => self.tasks_run().await,
        }
    }

    pub(super) async fn replier_appears(&mut self) -> Outcome {
        if self.replier.is_none() {
            self.replier = Some(open_replier(self.options.clone()).await.map_err(|error| error.to_string())?);
        }
        Ok(())
    }

    fn replier_vanishes(&mut self) -> Outcome {
        if let Some(replier) = self.replier.take() {
            drop(replier);
            self.news = None;
            self.model.replier_vanishes();
        }
        Ok(())
    }

    pub(super) fn take(&mut self, count: usize) -> Outcome {
        for _ in 0..count {
            let Some(replier) = &mut self.replier else { return Ok(()) };
            let flag = WakeFlag::default();
            match Pin::new(replier).poll_next(&mut Context::from_waker(&flag.waker())) {
                Poll::Ready(Some(request)) => {
                    let request = request.map_err(|error| error.to_string())?;
                    let (question, ends) = self.model.arrives(request.message())?;
                    self.taken.push(Taken { question, ends, request });
                    self.news = None;
                }
                Poll::Ready(None) => return Err("the stream of requests has ended".to_owned()),
                Poll::Pending => {
                    self.news = Some(flag);
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    fn one_of_taken(&mut self, which: usize) -> Option<Taken> {
        let count = self.taken.len();
        (count > 0).then(|| self.taken.remove(which % count))
    }

    pub(super) fn answer(&mut self, which: usize) -> Outcome {
        let Some(Taken { question, ends, request }) = self.one_of_taken(which) else { return Ok(()) };
        let accepted = request.reply(&question.answer()).is_ok();
        self.model.is_answered(question, ends, accepted)
    }

    fn neglect(&mut self, which: usize) -> Outcome {
        drop(self.one_of_taken(which));
        Ok(())
    }

    pub(super) async fn requester_appears(&mut self, requester: usize) -> Outcome {
        if self.callers[requester].is_none() {
            let gate = open_requester(requester, self.options.clone()).await.map_err(|error| error.to_string())?;
            self.callers[requester] = Some(Caller::new(gate));
        }
        Ok(())
    }

    fn requester_vanishes(&mut self, requester: usize) -> Outcome {
        if let Some(caller) = self.callers[requester].take() {
            drop(caller);
            self.model.requester_vanishes(requester);
        }
        Ok(())
    }

    /// Asks, unless a call is in progress.
    pub(super) fn ask(&mut self, requester: usize) -> Outcome {
        match &mut self.callers[requester] {
            Some(caller) if caller.question().is_none() => {
                caller.ask(self.model.begins(requester));
                self.poll_caller(requester).map(drop)
            }
            _ => Ok(()),
        }
    }

    fn give_up(&mut self, requester: usize) -> Outcome {
        self.callers[requester].iter_mut().for_each(Caller::give_up);
        Ok(())
    }

    async fn time_runs_out(&mut self) -> Outcome {
        let Some(caller) = &mut self.callers[IMPATIENT] else { return Ok(()) };
        match caller.end().await {
            Some((question, answer)) => self.model.ends_with(question, answer),
            None => Ok(()),
        }
    }

    /// Continues a requester's call if it was woken. Returns true if it was.
    fn poll_caller(&mut self, requester: usize) -> Result<bool, String> {
        let Some(caller) = &mut self.callers[requester] else { return Ok(false) };
        let woken = caller.is_woken();
        if let Some((question, answer)) = caller.poll_if_woken() {
            self.model.ends_with(question, answer)?;
        }
        Ok(woken)
    }

    pub(super) async fn tasks_run(&mut self) -> Outcome {
        let (started, mut turn) = (Instant::now(), 0);
        while turn < TURNS || (!self.exact && !self.is_known() && started.elapsed() < CONNECTING) {
            tokio::task::yield_now().await;
            for requester in 0..REQUESTERS {
                self.poll_caller(requester)?;
            }
            turn += 1;
        }
        if self.exact { self.check_progress() } else { Ok(()) }
    }

    /// Returns true if the requesters without a call know whether the replier is there.
    fn is_known(&self) -> bool {
        let there = Some(self.replier.is_some());
        self.callers.iter().flatten().all(|caller| [None, there].contains(&caller.is_connected()))
    }

    /// After the tasks have run, in memory: calls that could end have ended, and waiting calls were woken.
    fn check_progress(&self) -> Outcome {
        for caller in self.callers.iter().flatten() {
            if caller.is_connected().is_some_and(|connected| connected != self.replier.is_some()) {
                return Err(format!("connected: {:?}, replier: {:?}", caller.is_connected(), self.replier));
            }
            let Some(question) = caller.question() else { continue };
            if self.model.is_over(question) {
                return Err(format!("the call of {question:?} should have ended"));
            }
            if !self.model.has_arrived(question) && self.news.as_ref().is_some_and(|news| !news.is_set()) {
                return Err(format!("{question:?} was sent, and the replier was not woken"));
            }
        }
        Ok(())
    }
}
