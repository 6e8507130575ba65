//! Control loops keep their period, whatever the network does.

use crate::fleet::Fleet;
use crate::long::is_long;
use crate::player::pace::Pace;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A loop of the same period that has no gates at all, in the test itself: what this machine is capable of just now.
pub(crate) struct Reference {
    ends: Arc<AtomicBool>,
    thread: JoinHandle<Pace>,
}

impl Reference {
    /// Starts the comparison: forgets how the control loop of `source` did so far.
    pub(crate) fn start(fleet: &mut Fleet) -> Self {
        let ends = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&ends);
        let thread = thread::spawn(move || {
            let mut pace = Pace::new(Duration::from_millis(2));
            while !ended.load(Ordering::Relaxed) {
                pace.wait();
            }
            pace
        });
        fleet.player("source").counts("control", "pace");
        Self { ends, thread }
    }

    /// Compares the loops. The control loop of `source` publishes for the other host 500 times in a second; one that
    /// ever waited for the network would have far fewer rounds. Returns the time of its longest call.
    #[track_caller]
    pub(crate) fn compare(self, fleet: &mut Fleet, during: &str) -> Duration {
        let answer = fleet.player("source").counts("control", "pace");
        self.ends.store(true, Ordering::Relaxed);
        let reference = self.thread.join().unwrap().take();
        println!("{during}: control loop {answer}; without gates {reference}");
        let (rounds, expected) = (answer.get("rounds"), reference.rounds as u64);
        if is_long() {
            assert!(rounds >= expected * 3 / 4, "{rounds} rounds, {expected} in a loop without gates");
        }
        Duration::from_micros(answer.get("longest_call_us"))
    }
}
