//! The events of a run in simulated time.

use super::super::conductor::{Conductor, Pause, Seat};
use super::super::event::Event;
use super::super::notify::NotifySocket;
use super::super::output::Output;
use super::super::restarts::Time;
use super::super::streams::Streams;
use rustix::process::Signal;
use scl_terminal::Problem;
use std::collections::{HashSet, VecDeque};
use std::io;
use std::sync::mpsc::Receiver;

/// A conductor, and what happens between the turns that it gives.
#[derive(Debug)]
pub(super) struct Simulated<'a> {
    conductor: &'a mut dyn Conductor,
    /// The processes that have a seat.
    seated: HashSet<usize>,
    /// Their ends, which threads have seen before the conductor has.
    ends: Vec<Event>,
    /// What the programs print.
    pub(super) streams: Streams,
    /// Other events that have arrived and were not handled yet.
    pending: VecDeque<Event>,
    /// Why the simulation could not go on.
    pub(super) broken: Option<Problem>,
}

impl<'a> Simulated<'a> {
    pub(super) fn new(conductor: &'a mut dyn Conductor) -> io::Result<Self> {
        let (seated, ends, pending) = (HashSet::new(), Vec::new(), VecDeque::new());
        Ok(Self { conductor, seated, ends, streams: Streams::new()?, pending, broken: None })
    }

    pub(super) fn now(&self) -> Time {
        self.conductor.now()
    }

    pub(super) fn seat(&mut self, process: usize, component: Option<&str>) -> io::Result<Seat> {
        self.seated.insert(process);
        self.conductor.seat(process, component)
    }

    pub(super) fn signalled(&mut self, process: usize, signal: Signal) {
        match signal {
            Signal::KILL => self.conductor.killed(process),
            _ => self.conductor.signalled(process),
        }
    }

    /// Lets the programs run until something happens. Returns `None` at `due`, or if the simulation cannot go on.
    pub(super) fn next_event(
        &mut self,
        events: &Receiver<Event>,
        output: &Output,
        notify: Option<&NotifySocket>,
        due: Option<Time>,
    ) -> Option<Event> {
        loop {
            if let Some(event) = self.pending.pop_front() {
                return Some(event);
            }
            let Self { conductor, seated, ends, streams, pending, .. } = self;
            let mut has_arrived = || {
                // What a program has said in its turn counts at the end of the turn, not when a thread has read it.
                let _ = notify.map(|notify| notify.datagrams.take());
                streams.read(output, |ended| pending.push_back(ended));
                events.try_iter().for_each(|event| keep(event, seated, ends, pending));
                !pending.is_empty()
            };
            match conductor.run(due, &mut has_arrived) {
                Ok(Pause::Time) => return None,
                Ok(Pause::Arrived) => {}
                Ok(Pause::Ended(process)) => self.wait_for_end(process, events),
                Err(problem) => {
                    self.broken = Some(problem);
                    return None;
                }
            }
        }
    }

    /// What programs that have ended have printed is shown. Returns a stream that has ended, if one has.
    pub(super) fn next_end_of_stream(&mut self, output: &Output) -> Option<Event> {
        let Self { streams, pending, .. } = self;
        streams.read(output, |ended| pending.push_back(ended));
        pending.pop_front()
    }

    /// Waits until the thread that watches a process has seen its end, too: it counts from now on, in each run.
    fn wait_for_end(&mut self, process: usize, events: &Receiver<Event>) {
        let Self { seated, ends, pending, .. } = self;
        while !ends.iter().any(|end| ended(end) == Some(process)) {
            let Ok(event) = events.recv() else { break };
            keep(event, seated, ends, pending);
        }
        seated.remove(&process);
        pending.extend(ends.extract_if(.., |end| ended(end) == Some(process)));
    }
}

fn keep(event: Event, seated: &HashSet<usize>, ends: &mut Vec<Event>, pending: &mut VecDeque<Event>) {
    if ended(&event).is_some_and(|process| seated.contains(&process)) {
        ends.push(event);
    } else {
        pending.push_back(event);
    }
}

/// The process whose end this is.
fn ended(event: &Event) -> Option<usize> {
    match event {
        Event::LeaderEnded { process, .. } | Event::Ended { process, .. } => Some(*process),
        _ => None,
    }
}
