//! A queue for each subscriber of a connection: plain ZeroMQ subscribers, stalled or not, cost the component nothing.

use crate::programs::open;
use crate::stats::dir;
use scl::runtime_dir::ComponentStats;
use scl_tests::zmtp::{command, subscribe};
use scl_tests::{RawPeer, System, on_each_transport, wait_until};

const READINGS: &str = "source.readings--sink.readings.";
const LOSSLESS: &str = "source.lossless--sink.lossless.";

/// The promise: a plain subscriber that comes first does not take the messages that wait for the component.
#[test]
fn a_plain_subscriber_that_comes_first_takes_nothing_away() {
    on_each_transport(|system| {
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

/// The promise: a message to a plain subscriber in the place of the component counts once, with its bytes, though the
/// gate also keeps it for the component, where it takes the place of an older one.
#[test]
fn a_plain_subscriber_in_the_place_of_a_component_counts_once() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let waiting = 1000;
        source.ask(&format!("publish 0 {}", 2 * waiting), "published");
        let mut plain = subscribe_to(&system, READINGS);
        source.ask("publish 5000 5010", "published");
        while last_value(&plain.message().expect("a message")[0]) != 5009 {}
        source.tell("stats");
        let stats = source.next_line();
        assert!(stats.starts_with(&format!("sent {} ", waiting + 10)), "{stats}");
        let figures = || ComponentStats::read(&dir(&system), "source").expect("stats").gates;
        wait_until("the figures have them", || figures().iter().any(|gate| gate.sent == waiting + 10));
        let [gate] = &figures().into_iter().filter(|gate| gate.sent > 0).collect::<Vec<_>>()[..] else {
            panic!("only one gate has sent")
        };
        // The numbers of two bytes, with their tag.
        assert_eq!(gate.bytes, (waiting + 10) * 3);
        assert!(gate.last_activity.is_some());
    });
}

/// The promise: plain subscribers that never read cost the component beside them nothing, and bounded memory.
#[test]
fn plain_subscribers_that_never_read_starve_nobody() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
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
        let dropped = || {
            let found = ComponentStats::read(&dir(&system), "source").map(|found| found.gates);
            found.map_or((0, 0), |gates| (gates[0].dropped_for_observers, gates[0].tap_dropped))
        };
        wait_until("the figures tell what was dropped", || dropped().0 > 0);
        assert_eq!(dropped().1, 0, "none of them is at the tap");
        drop(stalled);
    });
}

/// The promise: nor does a sender with backpressure wait for them; it waits for the component alone.
#[test]
fn plain_subscribers_that_never_read_hold_up_no_sender() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        let stalled = subscribe_to(&system, LOSSLESS);
        source.tell("lossless 0 4000 10000");
        sink.ask("receive_lossless 4000", "0..4000");
        source.expect("published");
        drop(stalled);
    });
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
