//! A queue for each subscriber of a connection: plain ZeroMQ subscribers, stalled or not, cost the component nothing. And
//! the accounts of each connection.

use crate::programs::open;
use scl_tests::zmtp::{command, subscribe};
use scl_tests::{Process, RawPeer, System, on_each_medium};

const READINGS: &str = "source.readings--sink.readings.";
const LOSSLESS: &str = "source.lossless--sink.lossless.";

/// The promise: a plain subscriber that comes first does not take the messages that wait for the component.
#[test]
fn a_plain_subscriber_that_comes_first_takes_nothing_away() {
    on_each_medium(|system| {
        let mut source = open(&system, "source");
        source.ask("publish 0 50", "published");
        let mut plain = subscribe_to(&system, READINGS);
        source.ask("publish 50 100", "published");
        // The plain one gets at least what was published since it subscribed.
        while last_value(&plain.message().expect("a message")[0]) != 99 {}
        let mut sink = open(&system, "sink");
        sink.ask("receive 100", "0..100");
        source.ask("publish 100 150", "published");
        sink.ask("receive 50", "100..150");
        while last_value(&plain.message().expect("a message")[0]) != 149 {}
    });
}

/// The promise: plain subscribers that never read cost the component beside them nothing, and bounded memory.
#[test]
fn plain_subscribers_that_never_read_starve_nobody() {
    on_each_medium(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.ask("ready 30000", "ready");
        let before = source.memory();
        let stalled: Vec<RawPeer> = (0..5).map(|_| subscribe_to(&system, READINGS)).collect();
        let mut reading = subscribe_to(&system, READINGS);
        for round in 0..20 {
            let (from, to) = (round * 100, (round + 1) * 100);
            source.ask(&format!("publish {from} {to} 10000"), "published");
            sink.ask("receive 100", &format!("{from}..{to}"));
            while last_value(&reading.message().expect("a message")[0]) != to - 1 {}
        }
        // Each of them has a queue of 1000 messages of 10 kB.
        let growth = source.memory().saturating_sub(before);
        assert!(growth < 70 << 10, "{growth} KiB for 5 subscribers that do not read");
        drop(stalled);
    });
}

/// The promise: nor does a sender with backpressure wait for them; it waits for the component alone.
#[test]
fn plain_subscribers_that_never_read_hold_up_no_sender() {
    on_each_medium(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.ask("ready 30000", "ready");
        let stalled = subscribe_to(&system, LOSSLESS);
        source.tell("lossless 0 4000 10000");
        sink.ask("receive_lossless 4000", "0..4000");
        source.expect("published");
        drop(stalled);
    });
}

/// The promise: published = taken + dropped + lost + waiting, for each connection, at any time: before the peer has
/// started, while it reads, while it is paused, after it was killed, and for its successor.
#[test]
fn the_accounts_of_a_connection_are_exact_at_any_time() {
    on_each_medium(|system| {
        let mut source = open(&system, "source");
        let mut published = 0;
        // So long that the sink acknowledges some of what it takes in each round.
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
        let account = account_of_readings(&mut source);
        assert_eq!((account.taken, account.dropped, account.lost, account.waiting), (0, 500, 0, 1000), "{account:?}");
        for _ in 0..3 {
            let mut sink = open(&system, "sink");
            source.ask("ready 30000", "ready");
            let total = publish(&mut source, 1);
            sink.tell(&format!("receive_up_to {}", total - 1));
            sink.next_line();
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
        let account = account_of_readings(&mut source);
        assert!(account.lost > 0 && account.dropped > 500 && account.taken > 0, "{account:?}");
    });
}

/// The promise: what counts as taken has been taken by the other program, not merely by a socket.
#[test]
fn a_message_is_taken_when_the_other_program_has_it() {
    let system = System::new();
    let (mut source, sink) = (open(&system, "source"), open(&system, "sink"));
    source.ask("ready 30000", "ready");
    sink.pause();
    source.ask("publish 0 10", "published");
    let account = account_of_readings(&mut source);
    assert_eq!((account.taken, account.waiting), (0, 10), "{account:?}");
    sink.kill();
    source.ask("alone", "alone");
    let account = account_of_readings(&mut source);
    assert_eq!((account.taken, account.lost, account.waiting), (0, 10, 0), "{account:?}");
}

#[derive(Debug)]
struct Account {
    published: u64,
    taken: u64,
    dropped: u64,
    lost: u64,
    waiting: u64,
}

fn account_of_readings(source: &mut Process) -> Account {
    source.tell("account");
    let line = source.next_line();
    let words: Vec<&str> = line.split(' ').collect();
    assert_eq!(words[0], "sink.readings", "{line}");
    let [published, taken, dropped_oldest, dropped_newest, lost, waiting] =
        [1, 2, 3, 4, 5, 6].map(|index| words[index].parse::<u64>().expect("a number"));
    Account { published, taken, dropped: dropped_oldest + dropped_newest, lost, waiting }
}

#[track_caller]
fn assert_balanced(source: &mut Process, published: u64) {
    let account = account_of_readings(source);
    assert_eq!(account.published, published, "{account:?}");
    let sum = account.taken + account.dropped + account.lost + account.waiting;
    assert_eq!(sum, published, "{account:?}");
}

/// Returns once the subscription has taken effect.
fn subscribe_to(system: &System, endpoint: &str) -> RawPeer {
    let mut peer = RawPeer::join(&system.address("six", endpoint), "SUB");
    peer.send(&[subscribe(b""), command("PING", b"\0\0subscribed")].concat()).expect("sent");
    loop {
        let frame = peer.frame().expect("an answer");
        if frame.body == b"\x04PONGsubscribed" {
            return peer;
        }
    }
}

/// The value of a `test.Number`.
fn last_value(message: &[u8]) -> u64 {
    let Some((8, pieces)) = message.split_first() else { return 0 };
    let mut value = 0;
    for (index, piece) in pieces.iter().enumerate() {
        value |= u64::from(piece & 127) << (7 * index);
        if piece & 128 == 0 {
            break;
        }
    }
    value
}
