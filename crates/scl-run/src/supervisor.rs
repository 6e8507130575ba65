//! Carries out the actions of a run's state machine: starts processes, signals them, reports. Passes it what happens,
//! event by event.
//!
//! The process of a component, of which there is one at a time:
//!
//! ```text
//!   none ──────▶ running ──────────────▶ ended ──────────────────────────▶ drained ──────────────▶ silent
//!     ▲  start              all of its           both streams are closed,          its reports are
//!     │                     processes ended      or 500 ms are over                written
//!     └──────────────────────────── the next start, or the end of the run ───────────────────────────┘
//! ```
//!
//! Only an ended process is replaced, after its reports. The run is over when no component gets another process and all
//! are silent. What the components do is in [`lifecycle`](super::lifecycle), what the run does in
//! [`run_state`](super::run_state).

mod process;
mod simulated;
mod texts;

use super::children::{Running, Start};
use super::command_line::shell_text;
use super::conductor::Conductor;
use super::control::{BuildCommand, Command, ReceivedRequest, Response};
use super::ending::{Ending, name_of};
use super::event::Event;
use super::lifecycle::{Action, Input, Notice, State};
use super::member::{Member, Role};
use super::notify::NotifySocket;
use super::orphan_guard::OrphanGuard;
use super::output::Output;
use super::program::Build;
use super::requests::Requests;
use super::restarts::Time;
use super::run_clock::{LONGEST_WAIT, RunClock};
use super::run_state::{RunEvent, RunState};
use super::summary;
use super::terminal::{Key, StandardInput, Terminal};
use process::Process;
use rustix::process::Signal;
use scl_terminal::Problem;
use simulated::Simulated;
use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};
use std::time::{Duration, Instant};
use texts::{end_text, stopped_by_terminal, unusable, wrong_program};

/// How the programs ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All ended without being asked, and no essential one has failed.
    InOrder,
    /// An essential one has failed. Its last process ended like this, if it had one.
    Failed(Option<Ending>),
    /// They were stopped with this signal.
    Stopped(Signal),
}

/// Where output and reports go, and where events come from.
pub(crate) struct Surroundings<'a> {
    pub(crate) output: &'a Arc<Output>,
    pub(crate) events: Receiver<Event>,
    pub(crate) sender: Sender<Event>,
}

/// Runs programs, each with at most one process at any time.
pub(crate) struct Supervisor<'a, 'c> {
    surroundings: Surroundings<'a>,
    notify: Option<&'a NotifySocket>,
    // Dropped before the processes: the guard must not kill a group whose number may be reused.
    guard: OrphanGuard,
    processes: Vec<Option<Process>>,
    next_process: usize,
    /// The programs that have ended by themselves, with their exit codes.
    pub(crate) exits: BTreeMap<usize, i32>,
    simulated: Option<Simulated<'c>>,
}

/// A run in progress.
struct Run<'r> {
    members: &'r [Member<'r>],
    /// The builds that make their programs, for restarts.
    builds: &'r [Build],
    state: RunState,
    clock: RunClock,
    requests: Requests,
    said_ready: bool,
}

impl<'a, 'c> Supervisor<'a, 'c> {
    pub(crate) fn new(surroundings: Surroundings<'a>, guard: OrphanGuard, notify: Option<&'a NotifySocket>) -> Self {
        let (processes, exits) = (Vec::new(), BTreeMap::new());
        Self { surroundings, notify, guard, processes, next_process: 0, exits, simulated: None }
    }

    /// From now on, a run is one in the time of this conductor, if there is one.
    ///
    /// # Errors
    ///
    /// If the operating system refuses what that takes.
    pub(crate) fn follow_conductor(&mut self, conductor: Option<&'c mut dyn Conductor>) -> io::Result<()> {
        self.simulated = conductor.map(Simulated::new).transpose()?;
        Ok(())
    }

    /// Why the simulation could not go on, if it could not.
    pub(crate) fn broken(&mut self) -> Option<Problem> {
        self.simulated.as_mut()?.broken.take()
    }

    /// Starts the programs and waits until all have ended. They are stopped after `run_for`, if given. `builds` are
    /// reported to `scl restart`, which runs them.
    pub(crate) fn run(&mut self, members: &[Member<'_>], builds: &[Build], run_for: Option<Duration>) -> Outcome {
        let last = members.iter().position(|member| matches!(member.role, Role::Gateway | Role::Recorder));
        let state = RunState::new(members.iter().map(|member| member.policy.clone()), last, run_for);
        let clock = RunClock::start(Instant::now());
        let mut run = Run { members, builds, state, clock, requests: Requests::default(), said_ready: false };
        self.processes = members.iter().map(|_| None).collect();
        self.exits.clear();
        self.apply(&mut run, RunEvent::Time);
        while !(self.is_broken() || run.state.is_over() && self.processes.iter().flatten().all(Process::is_silent)) {
            match self.next_event(&mut run) {
                Some(event) => self.take(&mut run, event),
                None => self.apply(&mut run, RunEvent::Time),
            }
            self.write_late_reports(&run);
            self.follow(&mut run);
        }
        for index in 0..self.processes.len() {
            self.discard(index);
        }
        if members.iter().any(|member| member.role != Role::Build) {
            summary::lines(members, &run.state).iter().for_each(|line| self.surroundings.output.announce(line));
        }
        match (run.state.failed(), run.state.stopping) {
            // An interrupted build tool exits with a code of its own, which is not a failure here.
            (Some(index), Some(signal)) if members[index].role == Role::Build && run.state.asked => {
                Outcome::Stopped(signal)
            }
            (Some(index), _) => Outcome::Failed(run.state.components()[index].last_ending),
            (None, Some(signal)) => Outcome::Stopped(signal),
            (None, None) => Outcome::InOrder,
        }
    }

    /// The time of the run.
    fn now(&self, run: &Run<'_>) -> Time {
        self.simulated.as_ref().map_or_else(|| run.clock.at(Instant::now()), Simulated::now)
    }

    fn is_broken(&self) -> bool {
        self.simulated.as_ref().is_some_and(|simulated| simulated.broken.is_some())
    }

    /// Waits for the next event. Returns `None` if something may be due before.
    fn next_event(&mut self, run: &mut Run<'_>) -> Option<Event> {
        if let Some(simulated) = &mut self.simulated {
            let Surroundings { output, events, .. } = &self.surroundings;
            if !run.state.is_over() {
                return simulated.next_event(events, output, self.notify, run.state.due());
            }
            if let Some(ended) = simulated.next_end_of_stream(output) {
                return Some(ended);
            }
        }
        let events = &self.surroundings.events;
        let now = Instant::now();
        run.look(now, Duration::ZERO);
        let drained = self.processes.iter().flatten().filter(|process| !process.is_silent());
        let drained = drained.filter_map(Process::drained_at).map(|at| at.saturating_duration_since(now));
        let due = run.state.due().map(|due| due.saturating_sub(run.clock.at(now)).min(LONGEST_WAIT));
        let wait = drained.chain(due).min();
        let event = wait.map_or_else(|| events.recv().ok(), |wait| events.recv_timeout(wait).ok());
        run.look(Instant::now(), wait.unwrap_or(Duration::MAX));
        event
    }

    fn take(&mut self, run: &mut Run<'_>, event: Event) {
        match event {
            Event::StreamClosed { process } => {
                if let Some((_, process)) = self.find(|it| it.number == process) {
                    process.open_streams -= 1;
                }
            }
            Event::LeaderEnded { process, ending } => {
                let Some((index, _)) = self.find(|it| it.number == process) else { return };
                // After `./one & ./two &`, the shell exits, and the processes that it started are the program.
                let is_shell_text = shell_text(&run.members[index].program.command).is_some();
                let goes_on = is_shell_text && ending.is_in_order(None);
                if !(goes_on && matches!(run.state.components()[index].state, State::Running | State::Ready)) {
                    self.apply(run, RunEvent::One(index, Input::LeaderEnded));
                }
            }
            Event::Ended { process, ending } => {
                let Some((index, process)) = self.find(|it| it.number == process) else { return };
                debug_assert!(process.ended.is_none(), "a process ends once");
                process.ended = Some(Instant::now());
                // Processes that a build left behind in its group are no longer needed.
                process.running.signal(Signal::TERM);
                match ending {
                    Ending::Exited(code) if run.state.stopping.is_none() => _ = self.exits.insert(index, code),
                    _ => _ = self.exits.remove(&index),
                }
                self.apply(run, RunEvent::One(index, Input::Exited(ending)));
            }
            Event::Notified { group, notice } => {
                let Some((index, _)) = self.find(|it| it.running.group == group && it.ended.is_none()) else {
                    return;
                };
                let input = match notice {
                    Notice::Opens(opened) => Input::Refused(wrong_program(&run.members[index], &opened)),
                    notice => Input::Notified(notice),
                };
                self.apply(run, RunEvent::One(index, input));
            }
            Event::Key { process, key } => {
                let Some((_, process)) = self.find(|it| it.number == process) else { return };
                match key {
                    Key::Interrupt => {
                        process.running.is_interrupted = true;
                        self.take(run, Event::Signalled(Signal::INT));
                    }
                    Key::Suspend => process.running.suspend(),
                }
            }
            Event::StoppedByTerminal { process, signal } => {
                let Some((index, process)) = self.find(|it| it.number == process) else { return };
                // A program that is lent the terminal may have been stopped before it got it; `hand_over` continues it.
                if process.running.terminal.is_none() {
                    let text = stopped_by_terminal(&run.members[index], signal);
                    self.report(index, &run.members[index], text);
                }
            }
            Event::Signalled(signal) => {
                if !run.state.is_requested() {
                    let name = name_of(signal);
                    let text = match run.state.stopping {
                        None => format!("received {name}, stopping; a second signal kills at once"),
                        Some(_) => format!("received {name}, already stopping; a second signal kills at once"),
                    };
                    self.surroundings.output.announce(&text);
                }
                self.apply(run, RunEvent::Stop(signal));
            }
            Event::OutputLost => self.apply(run, RunEvent::OutputLost),
            Event::Requested(request) => self.take_request(run, request),
        }
    }

    fn take_request(&mut self, run: &mut Run<'_>, received: ReceivedRequest) {
        let names: Vec<&str> = run.members.iter().map(|member| member.name).collect();
        let chosen = received.request.components.iter().filter(|name| names.contains(&name.as_str()));
        let chosen: String = chosen.map(|name| format!(" {name}")).collect();
        match received.request.command {
            Command::List => {}
            Command::Builds => {
                let builds = run.builds.iter().filter_map(|build| build.only_for(&received.request.components));
                let builds = builds.map(|build| BuildCommand::of(&build)).collect();
                return received.answer(&Response { builds, ..Response::of(Vec::new()) });
            }
            Command::Stop => self.surroundings.output.announce(&format!("requested: `scl stop{chosen}`")),
            Command::Restart => {
                if let Some(problem) = unusable(run.members, &received.request.components) {
                    return received.answer(&Response::error(problem));
                }
                self.surroundings.output.announce(&format!("requested: `scl restart{chosen}`"));
            }
        }
        for event in run.requests.take(received, &names, &run.state) {
            self.apply(run, event);
        }
    }

    /// Feeds an event to the state and carries out the resulting actions, until none is left.
    fn apply(&mut self, run: &mut Run<'_>, event: RunEvent) {
        let mut actions: VecDeque<_> = run.state.step(self.now(run), event).into();
        while let Some((index, action)) = actions.pop_front() {
            match action {
                Action::Start if run.state.components()[index].state == State::Starting => {
                    let is_first = run.state.components()[index].starts == 0;
                    let input = match self.start(index, &run.members[index], is_first) {
                        Ok(()) => Input::Started,
                        Err(error) => Input::CannotStart(error.to_string()),
                    };
                    actions.extend(run.state.step(self.now(run), RunEvent::One(index, input)));
                }
                // The component was stopped before it could be started.
                Action::Start => {}
                Action::Signal(signal) => {
                    let Some(process) = &self.processes[index] else { continue };
                    let stopped = match signal {
                        Signal::KILL => {
                            process.running.kill();
                            Vec::new()
                        }
                        signal => process.running.ask_to_end(signal),
                    };
                    if let Some(simulated) = &mut self.simulated {
                        simulated.signalled(process.number, signal);
                    }
                    for process in stopped {
                        let text =
                            format!("process {process} was stopped, as by SIGSTOP; sent SIGCONT so that it can end");
                        self.report(index, &run.members[index], text);
                    }
                }
                Action::Report(text) => self.report(index, &run.members[index], text),
                Action::ReportEnd(ending, after) => {
                    let text = end_text(run.members[index].role, ending, after);
                    self.report(index, &run.members[index], text);
                }
            }
        }
    }

    fn start(&mut self, index: usize, member: &Member<'_>, is_first: bool) -> std::io::Result<()> {
        if let Some(process) = &mut self.processes[index] {
            assert!(process.ended.is_some(), "`{}` is started while it runs", member.name);
            let late = std::mem::take(&mut process.reports);
            late.iter().for_each(|text| self.surroundings.output.report(member.label, text));
            self.discard(index);
        }
        let notify = self.notify.filter(|_| member.role != Role::Build);
        let terminal = match member.program.input {
            StandardInput::Empty => None,
            StandardInput::Terminal => Terminal::open()
                .inspect_err(|why| self.report(index, member, format!("its standard input is empty: {why}")))
                .ok(),
        };
        let number = self.next_process;
        let component = Some(member.name).filter(|_| member.role != Role::Recorder);
        let seat = self.simulated.as_mut().map(|simulated| simulated.seat(number, component)).transpose()?;
        let kept = if is_first {
            member.kept.forget();
            None
        } else {
            member.kept.variable(&member.program.environment)
        };
        let start = Start { process: number, notify, terminal, kept, seat };
        let Surroundings { output, sender, .. } = &self.surroundings;
        let streams = self.simulated.as_mut().map(|simulated| &mut simulated.streams);
        let running = Running::start(member, start, &mut self.guard, output, sender, streams)?;
        self.next_process += 1;
        self.processes[index] = Some(Process::new(number, running));
        Ok(())
    }

    /// Kills what is left of a program, and frees the number of its process group.
    fn discard(&mut self, index: usize) {
        if let Some(process) = self.processes[index].take() {
            self.guard.forget(process.running.group);
        }
    }

    /// Reports now, or after the last output of a process that has ended.
    fn report(&mut self, index: usize, member: &Member<'_>, text: String) {
        match &mut self.processes[index] {
            Some(process) if process.ended.is_some() && !process.is_drained() => process.reports.push(text),
            _ => self.surroundings.output.report(member.label, &text),
        }
    }

    fn write_late_reports(&mut self, run: &Run<'_>) {
        for (process, member) in self.processes.iter_mut().zip(run.members) {
            let Some(process) = process.as_mut().filter(|process| process.is_drained()) else { continue };
            let late = std::mem::take(&mut process.reports);
            late.iter().for_each(|text| self.surroundings.output.report(member.label, text));
        }
    }

    /// Reports once that all components are ready, and answers the requests that are done.
    fn follow(&mut self, run: &mut Run<'_>) {
        if !run.said_ready && run.state.is_ready() {
            run.said_ready = true;
            let after = self.now(run).as_secs_f64();
            self.surroundings.output.announce(&format!("all components are ready after {after:.1} s"));
        }
        let pid = |index: usize| {
            let living = self.processes[index].as_ref().filter(|process| process.ended.is_none());
            living.map(|process| process.running.group.as_raw_pid())
        };
        run.requests.answer(&run.state, &pid);
    }

    fn find(&mut self, is_meant: impl Fn(&Process) -> bool) -> Option<(usize, &mut Process)> {
        let processes = self.processes.iter_mut().enumerate();
        processes.filter_map(|(index, process)| Some((index, process.as_mut()?))).find(|(_, it)| is_meant(it))
    }
}

impl Run<'_> {
    /// Notes that this process is running, after a wait that was meant to take `waited`.
    fn look(&mut self, now: Instant, waited: Duration) {
        let lost = self.clock.look(now, waited);
        self.state.take_pause(lost);
    }
}
