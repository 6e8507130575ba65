//! The state machine of one component, from its first start to its last end. It takes inputs with their times and
//! returns actions; it touches neither processes nor a clock.
//!
//! ```text
//!            time              started            READY=1
//!   Waiting ──────▶ Starting ──────────▶ Running ─────────▶ Ready
//!     ▲  ▲             │ cannot start       │                 │
//!     │  └─────────────┤                    │                 │ asked to stop, or stops itself; not ready
//!     │ another start  │                    ├─────────────────┤ or alive in time; the wrong program;
//!     │ is allowed     ▼                    ▼                 ▼ its first process has ended
//!     │             Ended ◀─────────────── Stopping (killed when its time is over)
//!     │               ▲        exited       │
//!     └───────────────┴─────────────────────┘
//! ```
//!
//! A process that exits without being asked takes the same transitions from Running and Ready as from Stopping. A
//! restart request starts an ended component at once, and a running one as soon as its process has been stopped and has
//! exited. A component that is stopped before it has a process ends at once.
//!
//! A component has at most one process: only `Starting` asks for one, and nothing leads there before the last has
//! exited. Each restart of the policy is counted once, when it is planned.

mod input;
mod state;

pub(crate) use input::{Action, Input, Notice};
pub(crate) use state::{State, StopReason, Verdict};

use super::ending::Ending;
use super::policy::{Policy, Restart, RestartLimit};
use super::restarts::{Restarts, Time};
use rustix::process::Signal;

/// A component, and all that is known about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lifecycle {
    pub(crate) policy: Policy,
    pub(crate) state: State,
    /// The restarts that the policy has asked for.
    pub(crate) restarts: Restarts,
    /// Number of processes so far.
    pub(crate) starts: usize,
    /// When the process was started.
    started: Time,
    /// When the next sign of life is due.
    alive_until: Option<Time>,
    /// The last status that the process has reported.
    status: String,
    /// Why it failed last.
    pub(crate) failure: Option<String>,
    /// How its last process ended.
    pub(crate) last_ending: Option<Ending>,
}

impl Lifecycle {
    /// A component to be started at once.
    pub(crate) fn new(policy: Policy) -> Self {
        let state = State::Waiting { until: Time::ZERO };
        Self {
            policy,
            state,
            restarts: Restarts::default(),
            starts: 0,
            started: Time::ZERO,
            alive_until: None,
            status: String::new(),
            failure: None,
            last_ending: None,
        }
    }

    /// When [`Input::Time`] is due, if nothing else happens before.
    pub(crate) fn due(&self) -> Option<Time> {
        match self.state {
            State::Waiting { until } => Some(until),
            State::Running => self.ready_until().into_iter().chain(self.alive_until).min(),
            State::Ready => self.alive_until,
            State::Stopping { kill_at, .. } => kill_at,
            State::Starting | State::Ended(_) => None,
        }
    }

    /// Processes an input, and returns the actions to take.
    pub(crate) fn step(&mut self, now: Time, input: Input) -> Vec<Action> {
        match (input, self.state) {
            (Input::Started, State::Starting) => self.take_start(now),
            (Input::CannotStart(error), State::Starting) => {
                self.take_failure(now, format!("cannot be started: {error}"))
            }
            (Input::LeaderEnded, State::Running | State::Ready) => {
                self.state = State::Stopping { reason: StopReason::LeaderEnded, kill_at: self.kill_time(now) };
                vec![Action::Signal(Signal::TERM)]
            }
            (Input::LeaderEnded, State::Stopping { reason, kill_at }) => self.stop_rest(reason, kill_at),
            (Input::Exited(ending), State::Running | State::Ready | State::Stopping { .. }) => {
                self.take_end(now, ending)
            }
            (Input::Refused(text), State::Running | State::Ready) => {
                self.state = State::Stopping { reason: StopReason::Refused, kill_at: self.kill_time(now) };
                self.failure = Some(text.clone());
                vec![Action::Report(text)]
            }
            (Input::Notified(notice), State::Running | State::Ready | State::Stopping { .. }) => {
                self.take_notice(now, notice)
            }
            (Input::StopAll(signal), _) => self.stop(now, StopReason::Everything(signal)),
            (Input::Stop, _) => self.stop(now, StopReason::Request { start_again: false }),
            (Input::Restart, _) => self.restart(now),
            (Input::Kill, State::Running | State::Ready) => {
                self.kill(StopReason::Everything(Signal::TERM), "killed on request".to_owned())
            }
            (Input::Kill, State::Stopping { reason, .. }) => self.kill(reason, "killed on request".to_owned()),
            (Input::Kill, State::Waiting { .. } | State::Starting) => {
                self.state = State::Ended(Verdict::InOrder);
                Vec::new()
            }
            (Input::Time, _) => self.take_time(now),
            // A late event of a process that has been replaced.
            _ => Vec::new(),
        }
    }

    fn ready_until(&self) -> Option<Time> {
        self.policy.ready_within.map(|limit| self.started.saturating_add(limit))
    }

    fn take_start(&mut self, now: Time) -> Vec<Action> {
        debug_assert!(self.starts == 0 || self.last_ending.is_some(), "a component has one process at a time");
        self.state = State::Running;
        self.starts += 1;
        self.started = now;
        self.alive_until = None;
        self.status.clear();
        Vec::new()
    }

    fn take_notice(&mut self, now: Time, notice: Notice) -> Vec<Action> {
        match (notice, self.state) {
            (Notice::Status(text), _) => self.status = text,
            (Notice::Ready, State::Running) => {
                self.state = State::Ready;
                self.take_sign_of_life(now);
            }
            (Notice::Alive, State::Running | State::Ready) => self.take_sign_of_life(now),
            (Notice::Stopping, State::Running | State::Ready) => {
                self.state = State::Stopping { reason: StopReason::Own, kill_at: self.kill_time(now) };
            }
            _ => {}
        }
        Vec::new()
    }

    fn take_sign_of_life(&mut self, now: Time) {
        self.alive_until = self.policy.alive_within.map(|limit| now.saturating_add(limit));
    }

    fn kill_time(&self, now: Time) -> Option<Time> {
        Some(now.saturating_add(self.policy.stop_within))
    }

    fn stop(&mut self, now: Time, reason: StopReason) -> Vec<Action> {
        let verdict = match reason {
            StopReason::Everything(_) => Verdict::InOrder,
            _ => Verdict::Stopped,
        };
        match self.state {
            State::Running | State::Ready => {
                self.state = State::Stopping { reason, kill_at: self.kill_time(now) };
                vec![Action::Signal(reason.signal())]
            }
            State::Stopping { reason: earlier, kill_at } => {
                // Send no second signal to a process that was asked to end. One that hangs may have ignored its first
                // signal, so it gets another.
                let reason = if matches!(earlier, StopReason::Everything(_)) { earlier } else { reason };
                self.state = State::Stopping { reason, kill_at };
                if earlier.is_asked() { Vec::new() } else { vec![Action::Signal(reason.signal())] }
            }
            State::Waiting { .. } | State::Starting => {
                self.state = State::Ended(verdict);
                Vec::new()
            }
            State::Ended(_) => Vec::new(),
        }
    }

    /// Called when the first process of a stopping program has ended: asks the remaining processes to end. Does nothing
    /// if they were asked before, because a second signal would end an SCL program at once.
    fn stop_rest(&mut self, reason: StopReason, kill_at: Option<Time>) -> Vec<Action> {
        let reason = match reason {
            StopReason::Own => StopReason::LeaderEnded,
            StopReason::Refused => reason,
            _ => return Vec::new(),
        };
        self.state = State::Stopping { reason, kill_at };
        vec![Action::Signal(Signal::TERM)]
    }

    fn restart(&mut self, now: Time) -> Vec<Action> {
        match self.state {
            State::Waiting { .. } | State::Ended(_) => self.start(),
            State::Starting | State::Stopping { reason: StopReason::Everything(_), .. } => Vec::new(),
            _ => self.stop(now, StopReason::Request { start_again: true }),
        }
    }

    fn start(&mut self) -> Vec<Action> {
        self.state = State::Starting;
        vec![Action::Start]
    }

    fn take_time(&mut self, now: Time) -> Vec<Action> {
        if self.due().is_none_or(|due| now < due) {
            return Vec::new();
        }
        match self.state {
            State::Waiting { .. } => self.start(),
            State::Running if self.ready_until().is_some_and(|until| until <= now) => {
                let limit = self.policy.ready_within.unwrap_or_default();
                let text = format!("not ready within {limit:?}{}", self.shown_status());
                self.fail_running(now, text, Signal::TERM)
            }
            State::Running | State::Ready => {
                let limit = self.policy.alive_within.unwrap_or_default();
                // SIGABRT, as systemd does: a core dump shows where the program hangs.
                self.fail_running(now, format!("no sign of life for {limit:?}"), Signal::ABORT)
            }
            State::Stopping { reason, .. } => {
                let text = format!("not stopped within {:?}", self.policy.stop_within);
                let report = Action::Report(format!("{text}, killed"));
                [vec![report], self.kill(reason, text)].concat()
            }
            State::Starting | State::Ended(_) => Vec::new(),
        }
    }

    /// Kills a process. `why` becomes the reason of its failure, unless it had failed before.
    fn kill(&mut self, reason: StopReason, why: String) -> Vec<Action> {
        self.state = State::Stopping { reason, kill_at: None };
        if !matches!(reason, StopReason::Failed | StopReason::Refused) {
            self.failure = Some(why);
        }
        vec![Action::Signal(Signal::KILL)]
    }

    fn shown_status(&self) -> String {
        if self.status.is_empty() { ", and has sent no `STATUS=`".to_owned() } else { format!(": {}", self.status) }
    }

    /// Asks a process that has missed a time limit to end, and notes the failure.
    fn fail_running(&mut self, now: Time, text: String, signal: Signal) -> Vec<Action> {
        self.state = State::Stopping { reason: StopReason::Failed, kill_at: self.kill_time(now) };
        self.failure = Some(text.clone());
        vec![Action::Report(text), Action::Signal(signal)]
    }

    fn take_end(&mut self, now: Time, ending: Ending) -> Vec<Action> {
        self.last_ending = Some(ending);
        let report = Action::ReportEnd(ending, now.saturating_sub(self.started));
        let (reason, was_killed) = match self.state {
            State::Stopping { reason, kill_at } => (Some(reason), kill_at.is_none()),
            _ => (None, false),
        };
        let failed = !matches!(reason, Some(StopReason::Failed | StopReason::Refused | StopReason::Request { .. }));
        let asked_by = reason.and_then(StopReason::asked_by);
        if failed && !was_killed && !ending.is_in_order(asked_by) {
            self.failure = Some(ending.to_string());
        }
        let next = match reason {
            Some(StopReason::Request { start_again: true }) => self.start(),
            Some(StopReason::Request { start_again: false }) => self.end(Verdict::Stopped),
            Some(StopReason::Everything(_)) if !was_killed && ending.is_in_order(asked_by) => {
                self.end(Verdict::InOrder)
            }
            Some(StopReason::Everything(_) | StopReason::Refused) => self.end(Verdict::Failed),
            Some(StopReason::Failed) => self.start_again(now),
            Some(StopReason::Own | StopReason::LeaderEnded) | None => self.take_own_end(now, ending),
        };
        [vec![report], next].concat()
    }

    fn take_own_end(&mut self, now: Time, ending: Ending) -> Vec<Action> {
        match ending.is_in_order(None) {
            true if self.policy.restart == Restart::Always => self.start_again(now),
            true => self.end(Verdict::InOrder),
            false if self.is_final(ending) => self.end(Verdict::Failed),
            false => self.start_again(now),
        }
    }

    /// Returns true if the program itself reported a failure by its exit code, and the policy does not restart it for
    /// that.
    fn is_final(&self, ending: Ending) -> bool {
        let is_code = matches!(ending, Ending::Exited(_)) && !ending.is_signal_of_child();
        is_code && self.policy.restart == Restart::OnAbnormal
    }

    fn take_failure(&mut self, now: Time, text: String) -> Vec<Action> {
        self.failure = Some(text.clone());
        [vec![Action::Report(text)], self.start_again(now)].concat()
    }

    fn end(&mut self, verdict: Verdict) -> Vec<Action> {
        self.state = State::Ended(verdict);
        Vec::new()
    }

    /// Plans the next start, if the policy has one.
    fn start_again(&mut self, now: Time) -> Vec<Action> {
        if self.policy.restart == Restart::Never {
            return self.end(Verdict::Failed);
        }
        let Some(delay) = self.restarts.next(now, self.policy.delay, self.policy.limit) else {
            let RestartLimit { count, within } = self.policy.limit;
            let limit = format!("the restart limit ({count} in {within:?})");
            let failure = self.failure.take().unwrap_or_else(|| "ended too often".to_owned());
            self.failure = Some(format!("{failure}, and {limit} is reached"));
            self.state = State::Ended(Verdict::Failed);
            return vec![Action::Report(format!("not restarted: {limit} is reached"))];
        };
        self.state = State::Waiting { until: now.saturating_add(delay) };
        vec![Action::Report(format!("restarting in {delay:?}"))]
    }
}

#[cfg(test)]
mod tests;
