//! Several taps as one stream of events.

use crate::folder_changes::FolderChanges;
use crate::gate::ObservedGate;
use crate::system::System;
use crate::woken::Woken;
use scl::runtime_dir::ArrivalWatch;
use scl::tap::{Observer, TapEvent};
use std::collections::VecDeque;
use std::fmt;
use std::future::poll_fn;
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::time::{Interval, MissedTickBehavior, interval};

/// How often the folder is checked for components that started, if nothing tells of their arrival. A check is one
/// `stat`; the announcements are read only after a change.
const LOOK: Duration = Duration::from_millis(100);

/// The taps of some gates, or of all gates, as one stream.
///
/// After a component has stopped and started again, its taps are connected again; messages in between are not seen.
/// Gates are numbered in the order of [`gates`](Self::gates), which only grows.
pub struct Taps {
    gates: Vec<ObservedGate>,
    observers: Vec<Watched>,
    woken: Woken,
    started: VecDeque<ObservedGate>,
    following: Option<Following>,
}

/// What happened at one of the taps.
#[derive(Debug)]
pub enum TapsEvent {
    /// A gate was added, with the next number. Only from [`Taps::follow_all`], and before the first event of the gate.
    ///
    /// A gate that starts again with another type, codec or schema is added again, and its old number has no more
    /// events.
    Started(ObservedGate),
    /// An event at a tap of the gate with this number.
    Event { gate: usize, event: TapEvent },
}

/// One observer, and the number of its gate.
struct Watched {
    gate: usize,
    /// `None` if the gate was replaced by another.
    observer: Option<Observer>,
    waker: Waker,
}

/// What is needed to notice components that start later.
struct Following {
    system: System,
    filter: Box<dyn Fn(&ObservedGate) -> bool + Send>,
    changes: FolderChanges,
    /// `None` without the folder, or if the user's limit for inotify is reached.
    arrivals: Option<ArrivalWatch>,
    due: Interval,
}

impl Taps {
    /// Observes these gates at all their taps. Must be called inside a tokio runtime, as must [`next`](Self::next).
    pub fn open(system: &System, gates: Vec<ObservedGate>) -> Self {
        let mut taps = Self::empty(None);
        gates.into_iter().for_each(|gate| taps.add(system, gate));
        taps
    }

    /// Observes every gate with a tap for which `filter` returns true, also of components that start later. Each is
    /// reported as [`TapsEvent::Started`] first.
    ///
    /// A component is noticed at once when it starts, and within a tenth of a second if it starts after the runtime
    /// folder was removed and created again. Must be called inside a tokio runtime, as must [`next`](Self::next).
    pub fn follow_all(system: &System, filter: impl Fn(&ObservedGate) -> bool + Send + 'static) -> Self {
        let mut due = interval(LOOK);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let changes = FolderChanges::new(system.dir().folder().to_owned());
        let (system, filter) = (system.clone(), Box::new(filter));
        let mut taps = Self::empty(Some(Following { system, filter, changes, arrivals: None, due }));
        taps.look();
        taps
    }

    /// The gates, by number.
    pub fn gates(&self) -> &[ObservedGate] {
        &self.gates
    }

    /// Waits for the next event. Without any gate, it waits until one is added; after [`open`](Self::open), forever.
    ///
    /// # Cancel safety
    /// Cancel safe.
    pub async fn next(&mut self) -> TapsEvent {
        poll_fn(|cx| self.poll_next(cx)).await
    }

    /// [`next`](Self::next) as a poll function.
    pub fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<TapsEvent> {
        while self.following.as_mut().is_some_and(|following| following.poll(cx).is_ready()) {
            self.look();
        }
        if let Some(gate) = self.started.pop_front() {
            return Poll::Ready(TapsEvent::Started(gate));
        }
        // Poll each woken observer only once: when tokio's budget is used up, its futures wake themselves at once, but
        // make progress only when the whole task is polled again.
        for _ in 0..self.woken.len() {
            let Some(index) = self.woken.take() else { break };
            let watched = &mut self.observers[index];
            let Some(observer) = &mut watched.observer else { continue };
            if let Poll::Ready(event) = observer.poll_next(&mut Context::from_waker(&watched.waker)) {
                // This observer may have more events, but poll the others first.
                self.woken.put_back(index);
                return Poll::Ready(TapsEvent::Event { gate: watched.gate, event });
            }
        }
        self.woken.wake_when_any(cx.waker());
        Poll::Pending
    }

    fn empty(following: Option<Following>) -> Self {
        Self { gates: Vec::new(), observers: Vec::new(), woken: Woken::default(), started: VecDeque::new(), following }
    }

    fn add(&mut self, system: &System, gate: ObservedGate) {
        for tap in &gate.taps {
            let waker = self.woken.add(self.observers.len());
            let observer = Some(Observer::open(system.dir(), &tap.socket));
            self.observers.push(Watched { gate: self.gates.len(), observer, waker });
        }
        self.gates.push(gate);
    }

    /// Adds the gates that are new since the last look, if anything changed.
    fn look(&mut self) {
        let Some(following) = &mut self.following else { return };
        if !following.changes.look() {
            return;
        }
        let system = following.system.clone();
        let wanted: Vec<ObservedGate> = system.gates().into_iter().filter(|gate| (following.filter)(gate)).collect();
        for gate in wanted {
            let known =
                self.gates.iter().rposition(|known| (&known.component, &known.gate) == (&gate.component, &gate.gate));
            match known {
                Some(number) if self.gates[number].carries_the_same(&gate) => continue,
                Some(number) => self.close(number),
                None => {}
            }
            self.started.push_back(gate.clone());
            self.add(&system, gate);
        }
    }

    /// Ends the observers of a gate that was replaced: their sockets may have the same names as the new ones.
    fn close(&mut self, gate: usize) {
        self.observers.iter_mut().filter(|watched| watched.gate == gate).for_each(|watched| watched.observer = None);
    }
}

impl Following {
    /// Returns when it is time to look.
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.due.poll_tick(cx).is_ready() {
            if self.arrivals.as_ref().is_none_or(ArrivalWatch::is_over) {
                self.arrivals = ArrivalWatch::start(self.system.dir()).ok();
            }
            return Poll::Ready(());
        }
        self.arrivals.as_mut().map_or(Poll::Pending, |arrivals| arrivals.poll_arrived(cx))
    }
}

impl fmt::Debug for Taps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Taps").field("gates", &self.gates).field("follows", &self.following.is_some()).finish()
    }
}
