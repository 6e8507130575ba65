//! Requests of other `scl` commands: what each means for the components, and when it is done.

use super::control::{Asked, Command, ComponentReport, Response};
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
    asked: Asked,
    targets: Vec<Target>,
}

#[derive(Debug)]
struct Target {
    index: usize,
    name: String,
    /// Number of processes that it had had when the request came.
    starts: usize,
}

impl Requests {
    /// Accepts a request, or answers it with an error. Returns what it means for the components.
    pub(crate) fn take(&mut self, asked: Asked, names: &[&str], state: &RunState) -> Vec<RunEvent> {
        let chosen = asked.request.components.clone();
        let unknown: Vec<&str> = chosen.iter().map(String::as_str).filter(|name| !names.contains(name)).collect();
        if !unknown.is_empty() {
            asked.answer(&Response::error(format!("unknown: {}", quoted_list(unknown))));
            return Vec::new();
        }
        let command = asked.request.command;
        if command == Command::Restart && state.stopping().is_some() {
            asked.answer(&Response::error("all components are being stopped"));
            return Vec::new();
        }
        let is_chosen = |name: &str| chosen.is_empty() || chosen.iter().any(|it| it == name);
        let all = names.iter().zip(state.components()).enumerate();
        let targets: Vec<Target> = all
            .filter(|(_, (name, _))| is_chosen(name))
            .map(|(index, (name, component))| Target { index, name: (*name).to_owned(), starts: component.starts() })
            .collect();
        let each = |input: Input| targets.iter().map(|target| RunEvent::One(target.index, input.clone())).collect();
        let events = match command {
            Command::List | Command::Builds => Vec::new(),
            // Twice would be a kill.
            Command::Stop if chosen.is_empty() && state.stopping().is_some() => Vec::new(),
            Command::Stop if chosen.is_empty() => vec![RunEvent::Stop(Signal::TERM)],
            Command::Stop => each(Input::Stop),
            Command::Restart => each(Input::Restart),
        };
        self.pending.push(Pending { asked, targets });
        events
    }

    /// Answers the requests that are done. `pid` returns the process of a component, if it has one.
    pub(crate) fn answer(&mut self, state: &RunState, pid: &dyn Fn(usize) -> Option<i32>) {
        let components = state.components();
        for pending in std::mem::take(&mut self.pending) {
            let command = pending.asked.request.command;
            let outcomes = pending.targets.iter().map(|it| (it, outcome(command, &components[it.index], it.starts)));
            let outcomes: Vec<_> = outcomes.collect();
            if outcomes.iter().any(|(_, outcome)| outcome.is_none()) {
                self.pending.push(pending);
                continue;
            }
            let report = |(target, done): &(&Target, Option<bool>)| ComponentReport {
                component: target.name.clone(),
                done: done.unwrap_or_default(),
                pid: pid(target.index),
                ..report_on(&components[target.index])
            };
            let reports = outcomes.iter().map(report).collect();
            pending.asked.answer(&Response::of(reports));
        }
    }
}

/// Whether the request is fulfilled for a component; `None` while that is open.
fn outcome(command: Command, component: &Lifecycle, starts_before: usize) -> Option<bool> {
    let is_new = component.starts() > starts_before;
    match (command, component.state()) {
        (Command::List | Command::Builds, _) | (Command::Stop, State::Ended(_)) => Some(true),
        (Command::Restart, State::Ready) if is_new => Some(true),
        (Command::Restart, State::Running) if is_new && component.policy().ready_within.is_none() => Some(true),
        // It has failed again, or everything was stopped meanwhile.
        (Command::Restart, State::Waiting { .. }) if is_new => Some(false),
        (Command::Restart, State::Ended(_)) => Some(false),
        _ => None,
    }
}

fn report_on(component: &Lifecycle) -> ComponentReport {
    let state = match component.state() {
        State::Waiting { .. } => "waiting",
        State::Starting => "starting",
        State::Running => "running",
        State::Ready => "ready",
        State::Stopping { .. } => "stopping",
        State::Ended(Verdict::Stopped) => "stopped",
        State::Ended(Verdict::InOrder) => "ended",
        State::Ended(Verdict::Failed) => "failed",
    };
    let failed = matches!(component.state(), State::Ended(Verdict::Failed) | State::Waiting { .. });
    let ending = component.last_ending().map(|ending| ending.to_string());
    ComponentReport {
        component: String::new(),
        state: state.to_owned(),
        done: false,
        pid: None,
        restarts: component.restarts(),
        detail: if failed { component.failure().map(str::to_owned).or(ending) } else { ending },
    }
}
