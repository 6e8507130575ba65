//! The state machine of a run: when the end of one component stops all, and what a request means for each. It takes
//! events with their times and returns actions; it touches neither processes nor a clock.

use super::lifecycle::{Action, Input, Lifecycle, State, Verdict};
use super::policy::Policy;
use super::restarts::Time;
use rustix::process::Signal;
use scl::host::ONE_REQUEST;
use std::time::Duration;

/// What happens to a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum RunEvent {
    /// Something happens to one component.
    One(usize, Input),
    /// All components are to be stopped with this signal. A second request kills them.
    Stop(Signal),
    /// The reader of the output has closed it.
    OutputLost,
    /// Time has passed.
    Time,
}

/// The components, and whether they are being stopped.
#[derive(Debug, Clone, Default)]
pub(crate) struct RunState {
    components: Vec<Lifecycle>,
    /// The component that is stopped after all others have ended: what they send while they stop passes through it.
    last: Option<usize>,
    /// When all components are stopped without a request.
    until: Option<Time>,
    /// The signal by which they are being stopped.
    pub(crate) stopping: Option<Signal>,
    /// Whether the stop was asked for, and not the consequence of a failure.
    pub(crate) asked: bool,
    /// Time of the first stop request.
    requested: Option<Time>,
    /// Total length of the pauses since the first stop request, which the times of events leave out.
    paused: Duration,
    killing: bool,
}

impl RunState {
    /// Creates a run whose components are to be started at once, and stopped at `until`, if given. `last` is stopped
    /// after all others.
    pub(crate) fn new(policies: impl IntoIterator<Item = Policy>, last: Option<usize>, until: Option<Time>) -> Self {
        let components = policies.into_iter().map(Lifecycle::new).collect();
        Self { components, last, until, ..Self::default() }
    }

    pub(crate) fn components(&self) -> &[Lifecycle] {
        &self.components
    }

    /// Whether a stop was requested, so that the next request kills.
    pub(crate) fn is_requested(&self) -> bool {
        self.requested.is_some()
    }

    /// Whether every component has ended.
    pub(crate) fn is_over(&self) -> bool {
        self.components.iter().all(|component| matches!(component.state, State::Ended(_)))
    }

    /// Whether every component has said that it is ready.
    pub(crate) fn is_ready(&self) -> bool {
        self.components.iter().all(|component| component.state == State::Ready)
    }

    /// The first component whose failure makes the run fail.
    pub(crate) fn failed(&self) -> Option<usize> {
        self.components.iter().position(has_failed_the_run)
    }

    /// When [`RunEvent::Time`] is due, if nothing else happens before.
    pub(crate) fn due(&self) -> Option<Time> {
        let until = self.until.filter(|_| self.stopping.is_none());
        self.components.iter().filter_map(Lifecycle::due).chain(until).min()
    }

    /// Processes an event, and returns the actions to take, each with the index of its component.
    pub(crate) fn step(&mut self, now: Time, event: RunEvent) -> Vec<(usize, Action)> {
        let mut actions = match event {
            // Nothing is restarted while the run is stopping.
            RunEvent::One(_, Input::Restart) if self.stopping.is_some() => Vec::new(),
            RunEvent::One(index, input) => self.take_input(now, index, &input),
            RunEvent::Stop(signal) => self.take_request(now, signal),
            RunEvent::OutputLost => self.stop(now, Signal::TERM),
            RunEvent::Time => self.take_time(now),
        };
        if self.failed().is_some() || self.only_last_is_left() {
            actions.extend(self.stop(now, Signal::TERM));
        }
        actions.extend(self.stop_last(now));
        debug_assert!(
            self.stopping.is_some() || (self.requested, self.killing) == (None, false),
            "a request stops the run"
        );
        actions
    }

    /// Notes a pause that the times of events leave out. It counts as time between two stop requests, because the user
    /// has waited.
    pub(crate) fn take_pause(&mut self, lost: Duration) {
        self.paused += if self.is_requested() { lost } else { Duration::ZERO };
    }

    fn take_request(&mut self, now: Time, signal: Signal) -> Vec<(usize, Action)> {
        match self.requested {
            None => {
                self.requested = Some(now);
                self.asked = self.stopping.is_none();
                self.stop(now, signal)
            }
            Some(requested) if now + self.paused < requested + ONE_REQUEST => Vec::new(),
            Some(_) => self.kill(now),
        }
    }

    fn take_input(&mut self, now: Time, index: usize, input: &Input) -> Vec<(usize, Action)> {
        // The last component is told to stop only after all others. If it exits before that, tell it now, so that it is
        // not restarted.
        let ends_early = Some(index) == self.last && matches!(input, Input::Exited(_));
        let told = self.stopping.filter(|_| ends_early);
        let mut actions = told.map_or_else(Vec::new, |signal| self.step_one(now, index, &Input::StopAll(signal)));
        actions.extend(self.step_one(now, index, input));
        actions
    }

    fn is_working(&self, index: usize) -> bool {
        self.components.get(index).is_some_and(|it| matches!(it.state, State::Running | State::Ready))
    }

    /// Whether all components but the last one have ended. False if there are no others: alone, it runs until it is
    /// asked to stop.
    fn only_last_is_left(&self) -> bool {
        let Some(last) = self.last else { return false };
        let mut others = self.components.iter().enumerate().filter(|(index, _)| *index != last).peekable();
        others.peek().is_some() && others.all(|(_, other)| matches!(other.state, State::Ended(_)))
    }

    /// Stops the last component if the run is stopping and all others have ended.
    fn stop_last(&mut self, now: Time) -> Vec<(usize, Action)> {
        let (Some(signal), Some(last)) = (self.stopping, self.last) else { return Vec::new() };
        let is_due = self.components.len() == 1 || self.only_last_is_left();
        if is_due && self.is_working(last) {
            return self.step_one(now, last, &Input::StopAll(signal));
        }
        Vec::new()
    }

    fn take_time(&mut self, now: Time) -> Vec<(usize, Action)> {
        let mut actions = self.step_all(now, &Input::Time);
        if self.until.is_some_and(|until| until <= now) {
            actions.extend(self.stop(now, Signal::TERM));
        }
        actions
    }

    /// Stops all components, except for the last one if it is running. Further calls have no effect.
    fn stop(&mut self, now: Time, signal: Signal) -> Vec<(usize, Action)> {
        if self.stopping.is_some() {
            return Vec::new();
        }
        self.stopping = Some(signal);
        let input = Input::StopAll(signal);
        let is_later = |index: usize| Some(index) == self.last && self.is_working(index);
        let now_due: Vec<usize> = (0..self.components.len()).filter(|index| !is_later(*index)).collect();
        now_due.into_iter().flat_map(|index| self.step_one(now, index, &input)).collect()
    }

    fn kill(&mut self, now: Time) -> Vec<(usize, Action)> {
        debug_assert!(self.requested.is_some(), "only a second request kills");
        if std::mem::replace(&mut self.killing, true) {
            return Vec::new();
        }
        self.step_all(now, &Input::Kill)
    }

    fn step_all(&mut self, now: Time, input: &Input) -> Vec<(usize, Action)> {
        (0..self.components.len()).flat_map(|index| self.step_one(now, index, input)).collect()
    }

    fn step_one(&mut self, now: Time, index: usize, input: &Input) -> Vec<(usize, Action)> {
        let Some(component) = self.components.get_mut(index) else { return Vec::new() };
        component.step(now, input.clone()).into_iter().map(|action| (index, action)).collect()
    }
}

fn has_failed_the_run(component: &Lifecycle) -> bool {
    component.policy.essential && component.state == State::Ended(Verdict::Failed)
}

#[cfg(test)]
mod tests;
