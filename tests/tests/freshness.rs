//! The promise of `queue: 1`: however long a subscriber pauses, what it receives next is the newest message.

use crate::programs::FRESH;
use scl::TransportKind;
use scl_tests::{Process, System, wait_until};

/// Calls that wait, with and without async.
const WAITING: [(&str, &str); 3] = [("recv", "async"), ("recv", "blocking"), ("recv_timeout", "blocking")];

/// Calls that do not wait. They give the publisher a moment to answer, but no more.
const NOT_WAITING: [(&str, &str); 4] =
    [("latest", "async"), ("try_recv", "async"), ("latest", "blocking"), ("try_recv", "blocking")];

/// In milliseconds; the publisher sends a message each millisecond. The pauses are the subject of these tests.
const PAUSES: [u64; 4] = [300, 2000, 30, 1000];

#[test]
fn a_call_that_waits_returns_the_newest_message_over_unix_sockets() {
    calls_that_wait_return_the_newest(TransportKind::Ipc);
}

#[test]
fn a_call_that_waits_returns_the_newest_message_over_tcp() {
    calls_that_wait_return_the_newest(TransportKind::Tcp);
}

#[test]
fn a_call_that_does_not_wait_returns_the_newest_message_over_unix_sockets() {
    calls_that_do_not_wait_return_the_newest(TransportKind::Ipc);
}

#[test]
fn a_call_that_does_not_wait_returns_the_newest_message_over_tcp() {
    calls_that_do_not_wait_return_the_newest(TransportKind::Tcp);
}

fn calls_that_wait_return_the_newest(kind: TransportKind) {
    let start = |call: &(&str, &str)| ["async", "blocking"].map(|clock| Pair::start(kind, clock, *call));
    let mut pairs: Vec<Pair> = WAITING.iter().flat_map(start).collect();
    for pause in PAUSES {
        // All of them pause at the same time.
        pairs.iter_mut().for_each(|pair| pair.viewer.tell(&pause.to_string()));
        for pair in &mut pairs {
            let age = pair.read_age();
            assert!(age <= 1, "{}: {age} newer messages had been sent after a pause of {pause} ms", pair.name);
        }
    }
}

/// On a machine with other work the publisher may need longer than the call gives it, so this demands most of the
/// values to be fresh. Without asking the publisher, none of them would be.
fn calls_that_do_not_wait_return_the_newest(kind: TransportKind) {
    for call in NOT_WAITING {
        for clock in ["async", "blocking"] {
            let mut pair = Pair::start(kind, clock, call);
            let ages = [150; 5].map(|pause| {
                pair.viewer.tell(&pause.to_string());
                pair.read_age()
            });
            let fresh = ages.iter().filter(|age| **age <= 1).count();
            assert!(fresh >= 3, "{}: newer messages that had been sent: {ages:?}", pair.name);
        }
    }
}

struct Pair {
    name: String,
    viewer: Process,
    _clock: Process,
    _system: System,
}

impl Pair {
    fn start(kind: TransportKind, clock: &str, (call, mode): (&str, &str)) -> Self {
        let system = System::over(kind);
        let newest = system.runtime_dir().join("newest");
        let environment = [("NEWEST", newest.to_str().expect("a path in UTF-8"))];
        let clock_process = system.start_with(FRESH, &["clock", clock], &environment);
        wait_until("the clock ticks", || newest.metadata().is_ok_and(|file| file.len() > 0));
        let mut viewer = system.start_with(FRESH, &["viewer", call, mode], &environment);
        viewer.expect("receiving");
        Self { name: format!("{clock} clock, {mode} {call}"), viewer, _clock: clock_process, _system: system }
    }

    /// How many newer messages had been sent before the call was made. A value younger than two periods has one at
    /// most.
    fn read_age(&mut self) -> u64 {
        let line = self.viewer.next_line();
        let (sent, received) = line.split_once(' ').unwrap_or_else(|| panic!("{}: {line}", self.name));
        let number = |text: &str| text.parse::<u64>().expect("a number");
        number(sent).saturating_sub(number(received))
    }
}
