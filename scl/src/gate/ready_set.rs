//! For event loops: a file descriptor that is readable while at least one of several gates has a message or request.
//!
//! All reasons to be readable are kept under one lock, together with the state of the descriptor, so the two always
//! agree: no change can slip in between checking the reasons and clearing the descriptor.

use crate::state::WakeCall;
use crate::sync::lock;
use rustix::event::{EventfdFlags, eventfd};
use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::{Arc, Mutex, Weak};
use std::task::Wake;

pub(crate) struct ReadySet {
    descriptor: OwnedFd,
    reasons: Mutex<Reasons>,
}

/// Why the descriptor is readable.
#[derive(Default)]
struct Reasons {
    /// Number of gates that have a message or request.
    gates: usize,
    /// Whether a waker was woken and the wake-up has not been acknowledged yet.
    woken: bool,
    stop_requested: bool,
    stop_acknowledged: bool,
    /// Whether the descriptor is readable.
    raised: bool,
}

impl ReadySet {
    pub(crate) fn new() -> io::Result<Arc<Self>> {
        let descriptor = eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK)?;
        Ok(Arc::new(Self { descriptor, reasons: Mutex::default() }))
    }

    pub(crate) fn descriptor(&self) -> BorrowedFd<'_> {
        self.descriptor.as_fd()
    }

    pub(crate) fn set_woken(&self, woken: bool) {
        self.change(|reasons| reasons.woken = woken);
    }

    pub(crate) fn request_stop(&self) {
        self.change(|reasons| reasons.stop_requested = true);
    }

    /// Acknowledges the stop request, so that it is no longer a reason. May be called before
    /// [`request_stop`](Self::request_stop).
    pub(crate) fn acknowledge_stop(&self) {
        self.change(|reasons| reasons.stop_acknowledged = true);
    }

    fn change(&self, change: impl FnOnce(&mut Reasons)) {
        let mut reasons = lock(&self.reasons);
        change(&mut reasons);
        let raise = reasons.gates > 0 || reasons.woken || (reasons.stop_requested && !reasons.stop_acknowledged);
        if std::mem::replace(&mut reasons.raised, raise) == raise {
            return;
        }
        // Neither can fail: the counter is 0 before the write, and 1 before the read.
        let _done = match raise {
            true => rustix::io::write(&self.descriptor, &1_u64.to_ne_bytes()),
            false => rustix::io::read(&self.descriptor, &mut [0; 8]),
        };
    }
}

impl Wake for ReadySet {
    fn wake(self: Arc<Self>) {
        self.set_woken(true);
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.set_woken(true);
    }
}

/// Makes the descriptor readable when calls are ended, so that the event loop polls them.
impl WakeCall for ReadySet {
    fn wake_call(&self) {
        self.set_woken(true);
    }

    /// An event loop counts as waiting while the descriptor is not readable.
    fn waits(&self, _futures: bool) -> bool {
        !lock(&self.reasons).raised
    }
}

/// Reports whether a gate has a message or request to the sets that the gate belongs to.
#[derive(Default)]
pub(crate) struct ReadySignals {
    sets: Vec<Weak<ReadySet>>,
    /// What was reported last.
    ready: bool,
}

impl ReadySignals {
    /// Returns true if the gate belongs to no set.
    pub(crate) fn is_empty(&self) -> bool {
        self.sets.is_empty()
    }

    pub(crate) fn add(&mut self, set: Weak<ReadySet>) {
        if self.ready {
            set.upgrade().into_iter().for_each(|set| set.change(|reasons| reasons.gates += 1));
        }
        self.sets.push(set);
    }

    pub(crate) fn report(&mut self, ready: bool) {
        if self.sets.is_empty() || std::mem::replace(&mut self.ready, ready) == ready {
            return;
        }
        self.sets.retain(|set| {
            let Some(set) = set.upgrade() else { return false };
            set.change(|reasons| if ready { reasons.gates += 1 } else { reasons.gates -= 1 });
            true
        });
    }
}

/// Reports that a dropped gate has no message or request any more.
impl Drop for ReadySignals {
    fn drop(&mut self) {
        self.report(false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use std::sync::Barrier;
    use std::task::Waker;

    const GATES: usize = 2;

    #[derive(Debug, Clone, Copy)]
    enum Step {
        Gate(usize, bool),
        Wake,
        Acknowledge,
        RequestStop,
        AcknowledgeStop,
    }

    const STEPS: [Step; 8] = [
        Step::Gate(0, true),
        Step::Gate(0, false),
        Step::Gate(1, true),
        Step::Gate(1, false),
        Step::Wake,
        Step::Acknowledge,
        Step::RequestStop,
        Step::AcknowledgeStop,
    ];

    /// What the descriptor should do.
    #[derive(Default)]
    struct Model {
        gates: [bool; GATES],
        woken: bool,
        stop: (bool, bool),
    }

    impl Model {
        fn step(&mut self, step: Step) {
            match step {
                Step::Gate(gate, ready) => self.gates[gate] = ready,
                Step::Wake => self.woken = true,
                Step::Acknowledge => self.woken = false,
                Step::RequestStop => self.stop.0 = true,
                Step::AcknowledgeStop => self.stop.1 = true,
            }
        }

        fn is_readable(&self) -> bool {
            self.gates.contains(&true) || self.woken || self.stop == (true, false)
        }
    }

    fn is_readable(set: &ReadySet) -> bool {
        let now = Timespec { tv_sec: 0, tv_nsec: 0 };
        poll(&mut [PollFd::new(&set.descriptor(), PollFlags::IN)], Some(&now)).unwrap() == 1
    }

    #[test]
    fn the_descriptor_agrees_with_its_reasons_after_every_step() {
        let sequences = STEPS.len().pow(4);
        for sequence in 0..sequences {
            let set = ReadySet::new().unwrap();
            let mut signals: [ReadySignals; GATES] = Default::default();
            signals.iter_mut().for_each(|signals| signals.add(Arc::downgrade(&set)));
            let (mut model, mut rest) = (Model::default(), sequence);
            for _ in 0..4 {
                let step = STEPS[rest % STEPS.len()];
                rest /= STEPS.len();
                match step {
                    Step::Gate(gate, ready) => signals[gate].report(ready),
                    Step::Wake => Waker::from(Arc::clone(&set)).wake(),
                    Step::Acknowledge => set.set_woken(false),
                    Step::RequestStop => set.request_stop(),
                    Step::AcknowledgeStop => set.acknowledge_stop(),
                }
                model.step(step);
                assert_eq!(is_readable(&set), model.is_readable(), "{step:?} of sequence {sequence}");
            }
            // Gates that are gone have nothing.
            drop(signals);
            model.gates = [false; GATES];
            assert_eq!(is_readable(&set), model.is_readable(), "sequence {sequence}");
        }
    }

    #[test]
    fn a_set_that_is_added_late_is_told_what_there_is() {
        let (early, late) = (ReadySet::new().unwrap(), ReadySet::new().unwrap());
        let mut signals = ReadySignals::default();
        signals.add(Arc::downgrade(&early));
        signals.report(true);
        signals.add(Arc::downgrade(&late));
        assert!(is_readable(&early) && is_readable(&late));
        drop(early);
        signals.report(false);
        assert!(!is_readable(&late));
    }

    /// A change may come from any thread while another clears the descriptor.
    #[test]
    fn changes_from_several_threads_leave_the_descriptor_right() {
        for _ in 0..2000 {
            let set = ReadySet::new().unwrap();
            let start = Barrier::new(3);
            let mut signals = ReadySignals::default();
            signals.add(Arc::downgrade(&set));
            std::thread::scope(|threads| {
                threads.spawn(|| {
                    start.wait();
                    set.set_woken(true);
                    set.set_woken(false);
                });
                threads.spawn(|| {
                    start.wait();
                    [true, false, true].into_iter().for_each(|ready| signals.report(ready));
                });
                start.wait();
            });
            assert!(is_readable(&set), "a gate has something");
            signals.report(false);
            assert!(!is_readable(&set));
        }
    }
}
