//! The accounts of each connection, across orderly ends and kills of its peers.

use crate::programs::{PEER, open};
use crate::stats::dir;
use scl::runtime_dir::{ComponentStats, ConnectionFigures};
use scl_tests::{Process, System, on_each_transport, wait_until};

/// The promise: what a program has received stays taken when it ends, and only what it has not received is lost. That
/// holds for what waited in its gate, too. Shared memory: `shm/exit.rs`.
#[test]
fn what_a_program_received_stays_taken_when_it_ends() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let (mut published, mut taken) = (0, 0);
        // Never more than may be on its way, and it arrives before the sink ends, so that nothing waits for the next
        // one.
        for (count, length) in [(300, 0), (40, 20_000), (900, 100)] {
            let mut sink = open(&system, "sink");
            source.get_ready();
            let (sent, received) = (published + count, published + count * 5 / 6);
            source.ask(&format!("publish {published} {sent} {length}"), "published");
            sink.ask(&format!("receive_up_to {}", received - 1), &format!("{published}..{received}"));
            source.ask(&format!("push {published} {sent} {length}"), "pushed");
            sink.ask(&format!("pull_up_to {}", received - 1), &format!("{published}..{received}"));
            source.ask(&format!("lossless {published} {} {length}", published + 5), "published");
            sink.ask("receive_lossless 5", &format!("{published}..{}", published + 5));
            sink.ask(&format!("waiting {}", sent - received), "waiting");
            assert_eq!(sink.wait_for_exit().code(), 0);
            source.ask("alone", "alone");
            (published, taken) = (sent, taken + count * 5 / 6);
            for gate in ["readings", "jobs"] {
                let found = Account::of(&mut source, gate);
                let expected =
                    Account { published, taken, replaced: 0, dropped: 0, lost: published - taken, waiting: 0 };
                assert_eq!(found, expected, "{gate}");
            }
            let found = Account::of(&mut source, "lossless");
            assert_eq!((found.taken, found.lost), (found.published, 0), "{found:?}");
        }
    });
}

/// The promise: in the figures that tools read, `taken` and `lost` never fall, whether peers end in order or are
/// killed, and they add up to what was published.
#[test]
fn figures_of_what_was_taken_never_fall() {
    on_each_transport(|system| {
        let mut source = system.start_with(PEER, &["source"], &[("SCL_STATS", "10ms")]);
        source.expect("open");
        let (mut published, mut received) = (0, 0);
        let mut last = ConnectionFigures::default();
        for round in 0..ends() {
            let mut sink = open(&system, "sink");
            source.get_ready();
            source.ask(&format!("publish {published} {}", published + 945), "published");
            let count = last.waiting + 945;
            sink.ask(&format!("receive {count}"), &format!("{}..{}", published - last.waiting, published + 945));
            (published, received) = (published + 945, received + count);
            wait_until("the peer has said what it has received", || {
                let Some(now) = figures(&system) else { return false };
                assert!(now.taken >= last.taken && now.lost >= last.lost, "{now:?} after {last:?}");
                last = now;
                now.taken == received
            });
            source.ask(&format!("publish {published} {}", published + 100), "published");
            published += 100;
            if round % 2 == 0 {
                drop(sink.wait_for_exit())
            } else {
                sink.kill()
            }
            source.ask("alone", "alone");
            wait_until("the figures are written again", || {
                let Some(now) = figures(&system) else { return false };
                assert!(now.taken >= last.taken && now.lost >= last.lost, "{now:?} after {last:?}");
                last = now;
                // What was not handed over yet waits for the next sink.
                let rest = now.lost + now.waiting;
                !now.connected && (now.taken, rest, now.published()) == (received, published - received, published)
            });
        }
    });
}

/// The promise: values that a newer one replaces in a `queue: 1` are no drops, neither for the component nor for a
/// plain ZeroMQ program.
#[test]
fn replaced_values_are_not_dropped() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        source.ask("publish 0 50", "published");
        let mut sink = open(&system, "sink");
        source.get_ready();
        sink.ask("newest", "49");
        sink.pause();
        source.ask("publish 50 1050 1000", "published");
        let found = Account::of(&mut source, "newest");
        assert!(found.dropped == 0 && found.replaced > 49, "{found:?}");
        let sum = found.taken + found.replaced + found.lost + found.waiting;
        assert_eq!(sum, 1050, "{found:?}");
        sink.resume();
        sink.ask("newest", "1049");
        assert_eq!(sink.wait_for_exit().code(), 0);
        source.ask("alone", "alone");
        let found = Account::of(&mut source, "newest");
        assert_eq!((found.lost, found.dropped, found.taken + found.replaced), (0, 0, 1050), "{found:?}");
    });
}

/// How many ends of a program a test sees: 6, or `SCL_TEST_KILLS`.
fn ends() -> u64 {
    std::env::var("SCL_TEST_KILLS").map_or(6, |number| number.parse().expect("a number"))
}

/// The connection from `source.readings` to `sink.readings`, as tools see it; `None` if the figures are just being
/// written.
fn figures(system: &System) -> Option<ConnectionFigures> {
    ComponentStats::read(&dir(system), "source").map(|found| found.gates[0].connections[0])
}

/// The promise: published = taken + replaced + dropped + lost + waiting, for each connection, at any time: before the
/// peer has started, while it reads, while it is paused, after it was killed, and for its successor.
#[test]
fn the_accounts_of_a_connection_are_exact_at_any_time() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let mut published = 0;
        let mut publish = |source: &mut Process, count: u64| {
            source.ask(&format!("publish {published} {} 4000", published + count), "published");
            published += count;
            published
        };
        // Nobody is there: the queue of 1000 fills up.
        for count in [300, 700, 500] {
            let total = publish(&mut source, count);
            assert_balanced(&mut source, total);
        }
        let account = Account::of(&mut source, "readings");
        assert_eq!((account.taken, account.dropped, account.lost, account.waiting), (0, 500, 0, 1000), "{account:?}");
        for _ in 0..3 {
            let mut sink = open(&system, "sink");
            source.get_ready();
            let total = publish(&mut source, 1);
            sink.tell(&format!("receive_up_to {}", total - 1));
            sink.next_line();
            wait_until("the sink has said what it has received", || Account::of(&mut source, "readings").taken > 0);
            assert_balanced(&mut source, total);
            sink.pause();
            for count in [100, 1000, 2000] {
                let total = publish(&mut source, count);
                assert_balanced(&mut source, total);
            }
            sink.kill();
            source.ask("alone", "alone");
            let total = publish(&mut source, 10);
            assert_balanced(&mut source, total);
        }
        let account = Account::of(&mut source, "readings");
        assert!(account.lost > 0 && account.dropped > 500 && account.taken > 0, "{account:?}");
    });
}

/// The promise: what counts as taken has been taken by the other program, not merely by a socket.
#[test]
fn a_message_is_taken_when_the_other_program_has_it() {
    let system = System::new();
    let (mut source, sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    sink.pause();
    source.ask("publish 0 10", "published");
    let account = Account::of(&mut source, "readings");
    assert_eq!((account.taken, account.waiting), (0, 10), "{account:?}");
    wait_until("the figures tell what is on its way", || {
        figures(&system).is_some_and(|found| (found.in_flight, found.published()) == (10, 10))
    });
    sink.kill();
    source.ask("alone", "alone");
    let account = Account::of(&mut source, "readings");
    assert_eq!((account.taken, account.lost, account.waiting), (0, 10, 0), "{account:?}");
}

/// The account of a connection from the source, without the difference between its two kinds of drops.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Account {
    pub(crate) published: u64,
    pub(crate) taken: u64,
    pub(crate) replaced: u64,
    pub(crate) dropped: u64,
    pub(crate) lost: u64,
    pub(crate) waiting: u64,
}

impl Account {
    /// Asks the source for the account of the connection to a gate of the sink.
    #[track_caller]
    pub(crate) fn of(source: &mut Process, gate: &str) -> Self {
        source.tell(&format!("account {gate}"));
        let line = source.next_line();
        let words: Vec<&str> = line.split(' ').collect();
        assert_eq!(words[0], format!("sink.{gate}"), "{line}");
        let [published, taken, dropped_oldest, dropped_newest, lost, waiting, replaced] =
            [1, 2, 3, 4, 5, 6, 7].map(|index| words[index].parse::<u64>().expect("a number"));
        Self { published, taken, replaced, dropped: dropped_oldest + dropped_newest, lost, waiting }
    }

    /// Every published message is in one place.
    #[track_caller]
    pub(crate) fn assert_balanced(&self) {
        let sum = self.taken + self.replaced + self.dropped + self.lost + self.waiting;
        assert_eq!(sum, self.published, "{self:?}");
    }
}

#[track_caller]
fn assert_balanced(source: &mut Process, published: u64) {
    let account = Account::of(source, "readings");
    assert_eq!(account.published, published, "{account:?}");
    account.assert_balanced();
}
