//! Requests of other `scl` commands: what each means for the components, and when it is done.

use super::control::{Command, ComponentReport, ReceivedRequest, Response};
use super::lifecycle::{Input, Lifecycle, State, Verdict};
use super::run_state::{RunEvent, RunState};
use rustix::process::Signal;
use scl_terminal::quoted_list;

/// The requests that are not done yet.
#[derive(Debug, Default)]
pub(crate) struct Requests {
    pending: Vec<Pending>,
}

#[derive(Debug)]
struct Pending {
    received: ReceivedRequest,
    targets: Vec<Target>,
}

#[derive(Debug)]
struct Target {
    index: usize,
    name: String,
    /// Number of processes that had been started for it when the request came.
    starts: usize,
}

impl Requests {
    /// Accepts a request, or answers it with an error. Returns the resulting events for the components.
    pub(crate) fn take(&mut self, received: ReceivedRequest, names: &[&str], state: &RunState) -> Vec<RunEvent> {
        let chosen = received.request.components.clone();
        let unknown: Vec<&str> = chosen.iter().map(String::as_str).filter(|name| !names.contains(name)).collect();
        if !unknown.is_empty() {
            received.answer(&Response::error(format!("unknown: {}", quoted_list(unknown))));
            return Vec::new();
        }
        let command = received.request.command;
        if command == Command::Restart && state.stopping.is_some() {
            received.answer(&Response::error("all components are being stopped"));
            return Vec::new();
        }
        let is_chosen = |name: &str| chosen.is_empty() || chosen.iter().any(|it| it == name);
        let all = names.iter().zip(state.components()).enumerate();
        let targets: Vec<Target> = all
            .filter(|(_, (name, _))| is_chosen(name))
            .map(|(index, (name, component))| Target { index, name: (*name).to_owned(), starts: component.starts })
            .collect();
        let each = |input: Input| targets.iter().map(|target| RunEvent::One(target.index, input.clone())).collect();
        let events = match command {
            Command::List | Command::Builds => Vec::new(),
            // A repeated stop event would kill the components.
            Command::Stop if chosen.is_empty() && state.stopping.is_some() => Vec::new(),
            Command::Stop if chosen.is_empty() => vec![RunEvent::Stop(Signal::TERM)],
            Command::Stop => each(Input::Stop),
            Command::Restart => each(Input::Restart),
        };
        self.pending.push(Pending { received, targets });
        events
    }

    /// Answers the requests that are done. `pid` returns the process of a component, if it has one.
    pub(crate) fn answer(&mut self, state: &RunState, pid: &dyn Fn(usize) -> Option<i32>) {
        let components = state.components();
        for pending in std::mem::take(&mut self.pending) {
            let command = pending.received.request.command;
            let outcomes = pending.targets.iter().map(|it| (it, outcome(command, &components[it.index], it.starts)));
            let outcomes: Vec<_> = outcomes.collect();
            if outcomes.iter().any(|(_, outcome)| outcome.is_none()) {
                self.pending.push(pending);
                continue;
            }
            let reports = outcomes.into_iter().map(|(target, done)| {
                report_on(target, &components[target.index], done.unwrap_or_default(), pid(target.index))
            });
            pending.received.answer(&Response::of(reports.collect()));
        }
    }
}

/// Whether the request is fulfilled for a component; `None` while that is undecided.
fn outcome(command: Command, component: &Lifecycle, starts_before: usize) -> Option<bool> {
    let is_new = component.starts > starts_before;
    match (command, component.state) {
        (Command::List | Command::Builds, _) | (Command::Stop, State::Ended(_)) => Some(true),
        (Command::Restart, State::Ready) if is_new => Some(true),
        (Command::Restart, State::Running) if is_new && component.policy.ready_within.is_none() => Some(true),
        // The component has failed again, or everything was stopped meanwhile.
        (Command::Restart, State::Waiting { .. }) if is_new => Some(false),
        (Command::Restart, State::Ended(_)) => Some(false),
        _ => None,
    }
}

fn report_on(target: &Target, component: &Lifecycle, done: bool, pid: Option<i32>) -> ComponentReport {
    let state = match component.state {
        State::Waiting { .. } => "waiting",
        State::Starting => "starting",
        State::Running => "running",
        State::Ready => "ready",
        State::Stopping { .. } => "stopping",
        State::Ended(Verdict::Stopped) => "stopped",
        State::Ended(Verdict::InOrder) => "ended",
        State::Ended(Verdict::Failed) => "failed",
    };
    let failed = matches!(component.state, State::Ended(Verdict::Failed) | State::Waiting { .. });
    let ending = component.last_ending.map(|ending| ending.to_string());
    ComponentReport {
        component: target.name.clone(),
        state: state.to_owned(),
        done,
        pid,
        restarts: component.restarts.total,
        detail: if failed { component.failure.clone().or(ending) } else { ending },
    }
}
