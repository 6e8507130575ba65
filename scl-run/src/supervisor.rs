//! Supervises the programs from the first start to the last end, event by event.

use super::children::{Event, Role, Running};
use super::ending::Ending;
use super::reports::Reports;
use nix::sys::signal::Signal;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How long to wait for output after a program has ended: processes it started may still write.
const LATE_OUTPUT: Duration = Duration::from_millis(500);

/// How the programs ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All in order, without being asked.
    InOrder,
    /// The first that did not end in order.
    Failed(Ending),
    /// In order, after this signal was sent to them.
    Stopped(Signal),
}

/// The phase of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Running { until: Option<Instant> },
    Stopping { asked_by: Signal, kill_at: Option<Instant> },
    Killing { asked_by: Signal },
}

/// A program, and how it ended.
#[derive(Debug)]
struct Supervised {
    running: Running,
    role: Role,
    open_streams: u8,
    ended: Option<(Ending, Instant)>,
    reported: bool,
}

/// Watches the programs until all have ended.
#[derive(Debug)]
pub(crate) struct Supervisor<'a> {
    programs: Vec<Supervised>,
    events: Receiver<Event>,
    reports: &'a Reports,
    grace: Duration,
    phase: Phase,
    failure: Option<Ending>,
}

impl<'a> Supervisor<'a> {
    /// Starts without programs; `grace` is how long they have to stop before they are killed.
    pub(crate) fn new(events: Receiver<Event>, reports: &'a Reports, grace: Duration) -> Self {
        let phase = Phase::Running { until: None };
        Self { programs: Vec::new(), events, reports, grace, phase, failure: None }
    }

    /// Stops the programs after this time, if any, without being asked.
    pub(crate) fn start_time(&mut self, run_for: Option<Duration>) {
        if let Phase::Running { until } = &mut self.phase {
            // A time too far in the future to be represented means never.
            *until = run_for.and_then(|time| Instant::now().checked_add(time));
        }
    }

    /// The number of the next program in events.
    pub(crate) fn next_index(&self) -> usize {
        self.programs.len()
    }

    /// Adds a program that has just been started with the number [`next_index`](Self::next_index).
    pub(crate) fn add(&mut self, running: Running, role: Role) {
        self.programs.push(Supervised { running, role, open_streams: 2, ended: None, reported: false });
    }

    /// Waits until every program has ended.
    pub(crate) fn wait_for_all(&mut self) -> Outcome {
        while self.programs.iter().any(|program| !program.reported) {
            match self.next_event() {
                Some(event) => self.take(event),
                None => self.keep_time(),
            }
            self.report_ended();
        }
        match (self.failure, self.asked_by()) {
            (Some(ending), _) => Outcome::Failed(ending),
            (None, Some(signal)) => Outcome::Stopped(signal),
            (None, None) => Outcome::InOrder,
        }
    }

    /// The next event, or `None` if a deadline comes first.
    fn next_event(&self) -> Option<Event> {
        let Some(due) = self.next_due() else { return self.events.recv().ok() };
        self.events.recv_timeout(due.saturating_duration_since(Instant::now())).ok()
    }

    fn next_due(&self) -> Option<Instant> {
        let phase_due = match self.phase {
            Phase::Running { until } => until,
            Phase::Stopping { kill_at, .. } => kill_at,
            Phase::Killing { .. } => None,
        };
        let unreported = self.programs.iter().filter(|program| !program.reported);
        let reports_due = unreported.filter_map(|program| program.ended.map(|(_, at)| at + LATE_OUTPUT));
        reports_due.chain(phase_due).min()
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::StreamClosed { program } => self.programs[program].open_streams -= 1,
            Event::Ended { program, ending } => self.take_ending(program, ending),
            Event::Asked(signal) => self.take_request(signal),
            Event::OutputLost => self.stop(Signal::SIGTERM),
        }
    }

    fn take_ending(&mut self, program: usize, ending: Ending) {
        let asked_by = self.asked_by();
        let ended = &mut self.programs[program];
        ended.ended = Some((ending, Instant::now()));
        // Processes that the program left behind in its group are no longer needed.
        ended.running.signal(Signal::SIGTERM);
        // Build tools have codes of their own for being interrupted.
        let interrupted_build = ended.role == Role::Build && asked_by.is_some();
        if !interrupted_build && !ending.is_in_order(asked_by) {
            self.failure.get_or_insert(ending);
            self.stop(Signal::SIGTERM);
        }
    }

    fn take_request(&mut self, signal: Signal) {
        match self.phase {
            Phase::Running { .. } => {
                self.reports.announce(&format!("stopping on {}; once more kills at once", signal.as_str()));
                self.stop(signal);
            }
            Phase::Stopping { .. } => self.kill(),
            Phase::Killing { .. } => {}
        }
    }

    fn keep_time(&mut self) {
        let now = Instant::now();
        match self.phase {
            Phase::Running { until: Some(until) } if until <= now => self.stop(Signal::SIGTERM),
            Phase::Stopping { kill_at: Some(kill_at), .. } if kill_at <= now => {
                self.reports.announce(&format!("not stopped within {:?}: {}", self.grace, self.names_of_living()));
                self.kill();
            }
            _ => {}
        }
    }

    /// Asks every program to stop. Further calls have no effect.
    fn stop(&mut self, signal: Signal) {
        if let Phase::Running { .. } = self.phase {
            self.phase = Phase::Stopping { asked_by: signal, kill_at: Instant::now().checked_add(self.grace) };
            self.signal_all(signal);
        }
    }

    fn kill(&mut self) {
        if let Some(asked_by) = self.asked_by() {
            self.phase = Phase::Killing { asked_by };
            self.signal_all(Signal::SIGKILL);
        }
    }

    fn signal_all(&self, signal: Signal) {
        for program in &self.programs {
            program.running.signal(signal);
        }
    }

    fn asked_by(&self) -> Option<Signal> {
        match self.phase {
            Phase::Running { .. } => None,
            Phase::Stopping { asked_by, .. } | Phase::Killing { asked_by } => Some(asked_by),
        }
    }

    fn names_of_living(&self) -> String {
        let living = self.programs.iter().enumerate().filter(|(_, program)| program.ended.is_none());
        living.map(|(index, _)| format!("`{}`", self.reports.name(index))).collect::<Vec<_>>().join(", ")
    }

    /// Reports each end once, after the last output of its program.
    fn report_ended(&mut self) {
        for (index, program) in self.programs.iter_mut().enumerate().filter(|(_, it)| !it.reported) {
            let Some((ending, at)) = program.ended else { continue };
            if program.open_streams == 0 || at.elapsed() >= LATE_OUTPUT {
                program.reported = true;
                let after = at.saturating_duration_since(program.running.started).as_secs_f64();
                let text = match (program.role, ending) {
                    (Role::Component, _) => format!("{ending} after {after:.1} s"),
                    (Role::Build, Ending::Exited(0)) => format!("built after {after:.1} s"),
                    (Role::Build, _) => format!("build {ending} after {after:.1} s"),
                };
                self.reports.report(index, &text);
            }
        }
    }
}
