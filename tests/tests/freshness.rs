//! The promise of `queue: 1`: however long a subscriber pauses, what it receives next is the newest message.

use crate::programs::FRESH;
use scl::TransportKind;
use scl_tests::{HANG_LIMIT, Process, System, wait_until};
use std::path::PathBuf;
use std::time::Instant;

/// Calls that wait, with and without async.
const WAITING: [(&str, &str); 3] = [("recv", "async"), ("recv", "blocking"), ("recv_timeout", "blocking")];

/// Calls that do not wait. They give the publisher a moment to answer, but no more.
const NOT_WAITING: [(&str, &str); 4] =
    [("latest", "async"), ("try_recv", "async"), ("latest", "blocking"), ("try_recv", "blocking")];

/// In milliseconds; the publisher sends a message each millisecond. The pauses are the subject of these tests.
const PAUSES: [u64; 4] = [300, 2000, 30, 1000];

/// How many calls that do not wait must get a fresh value.
const FRESH_CALLS: usize = 3;

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

/// A call waits a tenth of a second for a publisher that is silent. On a machine with other work a publisher may be
/// silent for longer, so a call that found such a one is repeated.
fn calls_that_wait_return_the_newest(kind: TransportKind) {
    let start = |call: &(&str, &str)| ["async", "blocking"].map(|clock| Pair::start(kind, clock, *call));
    let mut pairs: Vec<Pair> = WAITING.iter().flat_map(start).collect();
    for pause in PAUSES {
        let started = Instant::now();
        let mut left: Vec<&mut Pair> = pairs.iter_mut().collect();
        while !left.is_empty() {
            assert!(started.elapsed() < HANG_LIMIT, "the publishers are silent all the time");
            // All of them pause at the same time.
            let gaps: Vec<u64> = left.iter().map(|pair| pair.published().long_gaps).collect();
            left.iter_mut().for_each(|pair| pair.viewer.tell(&pause.to_string()));
            let mut gaps = gaps.into_iter();
            left.retain_mut(|pair| {
                let (age, gaps) = (pair.read_age(), gaps.next());
                let stale = format!("{}: {age} newer messages had been sent after a pause of {pause} ms", pair.name);
                assert!(age <= 1 || Some(pair.published_now().long_gaps) > gaps, "{stale}");
                age > 1
            });
        }
    }
}

/// On a machine with other work the publisher may need longer than a call gives it, so the calls are repeated until
/// [`FRESH_CALLS`] of them got a fresh value. Without asking the publisher, none of them would.
fn calls_that_do_not_wait_return_the_newest(kind: TransportKind) {
    for call in NOT_WAITING {
        for clock in ["async", "blocking"] {
            let mut pair = Pair::start(kind, clock, call);
            let started = Instant::now();
            let (mut fresh, mut stale) = (0, Vec::new());
            while fresh < FRESH_CALLS {
                pair.viewer.tell("150");
                match pair.read_age() {
                    0 | 1 => fresh += 1,
                    age => stale.push(age),
                }
                assert!(
                    started.elapsed() < HANG_LIMIT,
                    "{}: {fresh} fresh values; of others, newer messages that had been sent: {:?} ...",
                    pair.name,
                    &stale[..stale.len().min(10)]
                );
            }
        }
    }
}

struct Pair {
    name: String,
    viewer: Process,
    newest: PathBuf,
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
        Self { name: format!("{clock} clock, {mode} {call}"), viewer, newest, _clock: clock_process, _system: system }
    }

    fn published(&self) -> Published {
        let bytes = std::fs::read(&self.newest).expect("what the clock has written");
        let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"));
        Published { newest: number(0), long_gaps: number(8) }
    }

    /// The same, with the gap that there is now.
    fn published_now(&self) -> Published {
        let before = self.published().newest;
        wait_until("the clock goes on", || self.published().newest > before);
        self.published()
    }

    /// How many messages newer than the last one received had been sent before the call was made. A value younger than
    /// two periods has one at most.
    fn read_age(&mut self) -> u64 {
        let line = self.viewer.next_line();
        let (sent, received) = line.split_once(' ').unwrap_or_else(|| panic!("{}: {line}", self.name));
        let number = |text: &str| text.parse::<u64>().expect("a number");
        number(sent).saturating_sub(number(received))
    }
}

/// What the clock has written.
struct Published {
    newest: u64,
    /// How often it did not run for half as long as a call waits for it.
    long_gaps: u64,
}
