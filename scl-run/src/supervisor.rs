//! Supervises the programs from the first start to the last end, event by event.

use super::children::{Event, Running};
use super::ending::Ending;
use super::reports::Reports;
use nix::sys::signal::Signal;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How long to wait for output after a program has ended: processes it started may still write.
const LATE_OUTPUT: Duration = Duration::from_millis(500);

/// How long a run may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// When to stop without being asked, if ever.
    pub(crate) run_for: Option<Duration>,
    /// How long the programs have to stop before they are killed.
    pub(crate) grace: Duration,
}

/// The phase of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Running { until: Option<Instant> },
    Stopping { asked_by: Signal, kill_at: Option<Instant> },
    Killing { asked_by: Signal },
}

/// One component's program, and how it ended.
#[derive(Debug)]
struct Component {
    program: Running,
    open_streams: u8,
    ended: Option<(Ending, Instant)>,
    reported: bool,
}

/// Watches the programs until all have ended.
#[derive(Debug)]
pub(crate) struct Supervisor<'a> {
    components: Vec<Component>,
    events: Receiver<Event>,
    reports: &'a Reports,
    grace: Duration,
    phase: Phase,
    failed: bool,
}

impl<'a> Supervisor<'a> {
    /// Starts without programs. The time of the run counts from here.
    pub(crate) fn new(events: Receiver<Event>, reports: &'a Reports, limits: Limits) -> Self {
        // A time too far in the future to be represented means never.
        let until = limits.run_for.and_then(|time| Instant::now().checked_add(time));
        let phase = Phase::Running { until };
        Self { components: Vec::new(), events, reports, grace: limits.grace, phase, failed: false }
    }

    /// Adds a program that has just been started, in the order of the component numbers in events.
    pub(crate) fn add(&mut self, program: Running) {
        self.components.push(Component { program, open_streams: 2, ended: None, reported: false });
    }

    /// Waits until every program has ended. Returns true if all ended successfully.
    pub(crate) fn wait_for_all(&mut self) -> bool {
        while self.components.iter().any(|component| !component.reported) {
            match self.next_event() {
                Some(event) => self.take(event),
                None => self.keep_time(),
            }
            self.report_ended();
        }
        !self.failed
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
        let unreported = self.components.iter().filter(|component| !component.reported);
        let reports_due = unreported.filter_map(|component| component.ended.map(|(_, at)| at + LATE_OUTPUT));
        reports_due.chain(phase_due).min()
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::StreamClosed { component } => self.components[component].open_streams -= 1,
            Event::Ended { component, ending } => self.take_ending(component, ending),
            Event::Asked(signal) => self.take_request(signal),
            Event::OutputLost => self.stop(Signal::SIGTERM),
        }
    }

    fn take_ending(&mut self, component: usize, ending: Ending) {
        self.components[component].ended = Some((ending, Instant::now()));
        // Processes that the program left behind in its group are no longer needed.
        self.components[component].program.signal(Signal::SIGTERM);
        if !ending.is_in_order(self.asked_by()) {
            self.failed = true;
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
        for component in &self.components {
            component.program.signal(signal);
        }
    }

    fn asked_by(&self) -> Option<Signal> {
        match self.phase {
            Phase::Running { .. } => None,
            Phase::Stopping { asked_by, .. } | Phase::Killing { asked_by } => Some(asked_by),
        }
    }

    fn names_of_living(&self) -> String {
        let living = self.components.iter().enumerate().filter(|(_, component)| component.ended.is_none());
        living.map(|(index, _)| format!("`{}`", self.reports.name(index))).collect::<Vec<_>>().join(", ")
    }

    /// Reports each end once, after the last output of its component.
    fn report_ended(&mut self) {
        for (index, component) in self.components.iter_mut().enumerate().filter(|(_, it)| !it.reported) {
            let Some((ending, at)) = component.ended else { continue };
            if component.open_streams == 0 || at.elapsed() >= LATE_OUTPUT {
                component.reported = true;
                let after = at.saturating_duration_since(component.program.started).as_secs_f64();
                self.reports.report(index, &format!("{ending} after {after:.1} s"));
            }
        }
    }
}
