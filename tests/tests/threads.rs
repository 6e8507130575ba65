//! Gates work on every runtime, in any task or thread, with and without async.

use crate::programs::TWIN;
use scl_tests::{Process, System, on_each_transport};

const RUNTIMES: [&str; 7] = [
    "current_thread",
    "local_set",
    "multi_thread_1",
    "multi_thread_2",
    "multi_thread_8",
    "blocking",
    "threads_beside_async",
];

/// The promise: every kind of gate works on every runtime, each gate in a task or thread of its own.
#[test]
fn every_kind_of_gate_works_on_every_runtime() {
    on_each_transport(|system| {
        for runtime in RUNTIMES {
            // Alternates, so that each runtime meets the usual one and itself.
            for other in ["current_thread", runtime] {
                let mut left = system.start(TWIN, &["left", runtime, "wait"]);
                let mut right = system.start(TWIN, &["right", other, "wait"]);
                for twin in [&mut left, &mut right] {
                    twin.expect("open");
                    twin.expect("ready");
                }
                exchange(&mut left, &mut right);
                exchange(&mut right, &mut left);
            }
        }
    });
}

/// The promise: a thread or task that waits at one gate keeps no other gate from working. All receiving gates of a twin
/// wait all the time.
#[test]
fn a_gate_that_waits_keeps_no_other_from_working() {
    for runtime in RUNTIMES {
        let system = System::new();
        let mut left = system.start(TWIN, &["left", runtime]);
        left.expect("open");
        // The call waits for a replier that is not there yet; so does the push, once the queue is full.
        left.tell("call 1");
        left.tell("push 0 1500");
        left.ask("publish 0 10", "published");
        let mut right = system.start(TWIN, &["right", runtime]);
        right.expect("open");
        right.ask("values 9", "0..10");
        let mut answers = [left.next_line(), left.next_line()];
        answers.sort();
        assert_eq!(answers, ["2", "pushed"], "on {runtime}");
        right.ask("jobs 1499", "0..1500");
    }
}

fn exchange(from: &mut Process, to: &mut Process) {
    from.ask("publish 0 100", "published");
    to.ask("values 99", "0..100");
    from.ask("push 0 2000", "pushed");
    to.ask("jobs 1999", "0..2000");
    from.ask("call 21", "42");
}
