use super::GateMemory;
use crate::{GateKind, GateOptions, WhenFull};

const KIB: u64 = 1 << 10;
const MIB: u64 = 1 << 20;
const DEFAULT: GateOptions = GateOptions::DEFAULT;

fn receiver(queue: u32, max_size: u64, when_full: WhenFull) -> GateOptions {
    GateOptions { queue, max_size, when_full, ..DEFAULT }
}

fn of(kind: GateKind, own: &GateOptions, peers: &[GateOptions]) -> GateMemory {
    GateMemory::of(kind, own, peers)
}

#[test]
fn queues_of_a_publisher_share_their_messages() {
    use WhenFull::{DropNewest, DropOldest, Wait};
    for (queues, messages) in [
        (&[(100, DropOldest)][..], 100),
        (&[(100, DropOldest), (10, Wait), (1, DropOldest)], 100),
        (&[(100, DropOldest), (10, DropNewest), (7, DropNewest)], 117),
        (&[(10, DropNewest)], 10),
        (&[], 0),
    ] {
        let peers: Vec<_> = queues.iter().map(|&(queue, when_full)| receiver(queue, MIB, when_full)).collect();
        assert_eq!(of(GateKind::Pub, &DEFAULT, &peers).messages, messages, "{queues:?}");
    }
    // Each message of a pusher goes to one puller.
    let pullers = [receiver(100, MIB, DropOldest), receiver(10, MIB, Wait)];
    assert_eq!(of(GateKind::Push, &DEFAULT, &pullers).messages, 110);
}

#[test]
fn a_sender_holds_messages_that_all_peers_accept() {
    let peers = [receiver(10, MIB, WhenFull::DropOldest), receiver(10, 3 * MIB, WhenFull::DropOldest)];
    let memory = of(GateKind::Pub, &GateOptions { latched: true, ..DEFAULT }, &peers);
    let expected = GateMemory { messages: 10, longest: MIB, in_flight: 3 * MIB, latched: MIB };
    assert_eq!((memory, memory.waiting(), memory.total()), (expected, 10 * MIB, 14 * MIB));
}

#[test]
fn short_messages_are_written_together() {
    for (queue, max_size, written) in [(100, 100, 10_000), (1000, KIB, 64 * KIB), (1, KIB, KIB), (2, MIB, MIB)] {
        let memory = of(GateKind::Push, &DEFAULT, &[receiver(queue, max_size, WhenFull::DropOldest)]);
        assert_eq!(memory.in_flight, max_size + written, "{queue} x {max_size}");
    }
}

#[test]
fn a_receiver_holds_its_queue_and_a_window_of_each_peer() {
    use WhenFull::{DropOldest, Wait};
    for (own, window) in [
        (receiver(100, MIB, DropOldest), 2 * MIB),
        (receiver(100, 16, DropOldest), 4096 * 16),
        (receiver(1, MIB, DropOldest), MIB + 32 * KIB),
        (receiver(1, 16, DropOldest), 64 * 16),
        (receiver(1, MIB, Wait), 2 * MIB),
    ] {
        for kind in [GateKind::Sub, GateKind::Pull] {
            let memory = of(kind, &own, &[DEFAULT, DEFAULT]);
            let expected =
                GateMemory { messages: own.queue.into(), longest: own.max_size, in_flight: 2 * window, latched: 0 };
            assert_eq!(memory, expected, "{own:?}");
        }
    }
}

#[test]
fn requests_and_replies_are_in_flight() {
    let of_size = |max_size, in_flight| GateOptions { max_size, in_flight, ..DEFAULT };
    for (requester, replier, requests, replies) in [
        // One request of an earlier call, almost complete, and the next; a reply, another one, and a read.
        (of_size(2 * MIB, 1), of_size(4 * MIB, 1), 5 * MIB, 4 * MIB + 256 * KIB),
        (of_size(2 * MIB, 3), of_size(4 * MIB, 1), 16 * MIB, 8 * MIB + 256 * KIB),
        (of_size(KIB, 1), of_size(KIB, 1), 22 * KIB, 258 * KIB),
    ] {
        let memory = of(GateKind::Req, &requester, std::slice::from_ref(&replier));
        assert_eq!(memory, GateMemory { in_flight: requests + replies, ..GateMemory::default() });
    }
    let requesters = [of_size(2 * MIB, 1), of_size(3 * MIB, 4)];
    let replies = 3 * MIB + 10 * MIB;
    let requests = MIB + 2 * (2 * MIB + 256 * KIB);
    assert_eq!(of(GateKind::Rep, &of_size(MIB, 1), &requesters).total(), replies + requests);
}

#[test]
fn a_gate_without_peers_holds_what_others_may_send() {
    for kind in [GateKind::Pub, GateKind::Push, GateKind::Sub, GateKind::Req] {
        assert_eq!(of(kind, &GateOptions { latched: true, ..DEFAULT }, &[]).total(), 0, "{kind:?}");
    }
    // A plain ZeroMQ program may connect to a gate that listens.
    assert_eq!(of(GateKind::Pull, &DEFAULT, &[]).total(), 6400 * MIB);
    assert_eq!(of(GateKind::Rep, &DEFAULT, &[]).total(), 64 * MIB);
}

#[test]
fn sums_saturate() {
    let peers = [receiver(u32::MAX, u64::MAX, WhenFull::Wait), receiver(u32::MAX, u64::MAX, WhenFull::DropNewest)];
    for kind in GateKind::ALL {
        assert_eq!(of(kind, &peers[0], &peers).total(), u64::MAX, "{kind:?}");
    }
}
