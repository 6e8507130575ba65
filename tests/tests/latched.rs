//! `latched: true` between processes: subscribers with every kind of queue that start late or again, over each
//! transport, and plain ZeroMQ programs among them.

use crate::programs::{LATCHED, open_with};
use scl::TransportKind;
use scl_tests::{Process, RawPeer, System, wait_until, zmtp};
use zeromq::{Socket, SocketRecv, SubSocket};

/// Long enough for shared memory.
const LONG: usize = 1 << 20;
const MODE: &str = "setter.mode--getter.mode.";

/// The promise: whatever the queue, the last message is there at once, after those that wait, and is marked.
#[test]
fn a_late_or_restarted_subscriber_gets_the_last_message() {
    on_every_transport(|system, length| {
        let mut setter = open_with(&system, LATCHED, "setter");
        setter.ask(&format!("send mode 0 5 {length}"), "sent");
        let mut getter = open_with(&system, LATCHED, "getter");
        assert_eq!([(); 3].map(|()| answer(&mut getter, "take mode")), ["2", "3", "4 latched"]);
        assert_eq!(answer(&mut getter, "take newest"), "4 latched");
        // How many of the others arrive depends on how soon they are taken.
        assert_eq!(take_until_latched(&mut getter, "oldest"), "4 latched");
        for round in 1..3 {
            getter.kill();
            setter.ask("connected mode 0", "connected");
            getter = open_with(&system, LATCHED, "getter");
            for gate in ["mode", "newest", "oldest"] {
                assert_eq!(answer(&mut getter, &format!("take {gate}")), "4 latched", "{gate} in round {round}");
            }
        }
        setter.ask(&format!("send mode 5 6 {length}"), "sent");
        for gate in ["mode", "newest", "oldest"] {
            assert_eq!(answer(&mut getter, &format!("take {gate}")), "5", "{gate}: it was there when this was sent");
        }
        assert_adds_up(&mut setter, "mode", 2);
    });
}

/// The promise: a message that the publisher has written into shared memory is kept like any other.
#[test]
fn a_lent_message_is_kept() {
    let system = System::over(TransportKind::Shm);
    let mut setter = open_with(&system, LATCHED, "setter");
    for round in 0..3 {
        let mut getter = open_with(&system, LATCHED, "getter");
        if round > 0 {
            assert_eq!(answer(&mut getter, "take mode"), "7 latched");
        }
        setter.ask("connected mode 3", "connected");
        // Memory is agreed on a moment after the connection.
        wait_until("memory is shared", || answer_as_it_is(&mut setter, &format!("lend mode 6 {LONG}")) == "shared");
        setter.ask(&format!("lend mode 7 {LONG}"), "shared");
        wait_until("it has arrived", || answer_as_it_is(&mut getter, "take mode") == "7 shared");
        // What waits for a subscriber that is killed is not sent once more, but for the first time.
        take_until(&mut getter, "newest", "7");
        getter.kill();
        setter.ask("connected mode 0", "connected");
    }
    assert_adds_up(&mut setter, "mode", 2);
}

/// The promise: a sender that waits loses nothing, and a subscriber that restarts gets the last message all the same.
#[test]
fn a_sender_that_waits_keeps_its_last_message() {
    on_every_transport(|system, length| {
        let mut setter = open_with(&system, LATCHED, "setter");
        // Nobody waits for an optional component that does not run.
        setter.ask(&format!("send plan 0 5 {length}"), "sent");
        let mut getter = open_with(&system, LATCHED, "getter");
        assert_eq!([(); 2].map(|()| answer(&mut getter, "take plan")), ["3", "4 latched"]);
        assert_eq!(answer(&mut getter, "take step"), "4 latched");
        setter.tell(&format!("send plan 10 20 {length}"));
        for number in 10..20 {
            for gate in ["plan", "step"] {
                assert_eq!(answer(&mut getter, &format!("take {gate}")), number.to_string(), "{gate}");
            }
        }
        setter.expect("sent");
        getter.kill();
        setter.ask("connected plan 0", "connected");
        let mut getter = open_with(&system, LATCHED, "getter");
        for gate in ["plan", "step"] {
            assert_eq!(answer(&mut getter, &format!("take {gate}")), "19 latched", "{gate}");
        }
        assert_adds_up(&mut setter, "plan", 1);
    });
}

/// The promise: that holds for one that is killed while the sender waits for it.
#[test]
fn a_sender_that_waits_for_a_subscriber_that_is_killed_keeps_its_last_message() {
    on_every_transport(|system, _| {
        let mut setter = open_with(&system, LATCHED, "setter");
        let getter = open_with(&system, LATCHED, "getter");
        setter.ask("connected plan 2", "connected");
        // More than fits into queues and sockets.
        setter.tell(&format!("send plan 0 40 {LONG}"));
        getter.kill();
        setter.expect("sent");
        let mut getter = open_with(&system, LATCHED, "getter");
        for gate in ["plan", "step"] {
            assert_eq!(take_until_latched(&mut getter, gate), "39 latched", "{gate}");
        }
        assert_adds_up(&mut setter, "plan", 0);
    });
}

/// The promise: where only the newest message counts, it is the latched one, once, until there is a newer one.
#[test]
fn the_latest_message_is_the_latched_one_until_there_is_a_newer_one() {
    on_every_transport(|system, length| {
        let mut setter = open_with(&system, LATCHED, "setter");
        setter.ask(&format!("send mode 0 5 {length}"), "sent");
        let mut getter = open_with(&system, LATCHED, "getter");
        let mut latest = String::new();
        wait_until("the last message arrives", || {
            latest = answer(&mut getter, "latest newest");
            latest != "nothing"
        });
        assert_eq!(latest, "4 latched");
        assert_eq!(answer(&mut getter, "latest newest"), "nothing", "it comes once");
        setter.ask(&format!("send mode 5 8 {length}"), "sent");
        wait_until("the newest message arrives", || {
            latest = answer(&mut getter, "latest newest");
            latest == "7"
        });
    });
}

/// The promise: plain ZeroMQ programs get the last message each time that they connect, before or beside the component.
#[test]
fn plain_subscribers_get_the_last_message() {
    on_every_transport(|system, length| {
        let mut setter = open_with(&system, LATCHED, "setter");
        setter.ask(&format!("send mode 0 2 {length}"), "sent");
        let address = system.address("latched", MODE);
        for _ in 0..2 {
            let mut early = RawPeer::join(&address, "SUB");
            early.send(&zmtp::subscribe(b"")).expect("subscribed");
            assert_eq!([first_byte(&mut early), first_byte(&mut early)], [0, 1], "what waits for the component");
        }
        let mut getter = open_with(&system, LATCHED, "getter");
        assert_eq!([(); 2].map(|()| answer(&mut getter, "take mode")), ["0", "1 latched"]);
        for _ in 0..2 {
            let mut raw = RawPeer::join(&address, "SUB");
            raw.send(&zmtp::subscribe(b"")).expect("subscribed");
            assert_eq!(first_byte(&mut raw), 1);
            assert_eq!(with_zeromq(&address.url()), 1);
        }
        setter.ask(&format!("send mode 2 3 {length}"), "sent");
        assert_eq!(answer(&mut getter, "take mode"), "2");
        assert_adds_up(&mut setter, "mode", 0);
    });
}

/// The promise: one that subscribes to a topic later gets the last message then, if it is of this topic.
#[test]
fn a_plain_subscriber_that_subscribes_later_gets_the_last_message_of_its_topic() {
    on_every_transport(|system, length| {
        let mut setter = open_with(&system, LATCHED, "setter");
        let mut getter = open_with(&system, LATCHED, "getter");
        setter.ask("connected mode 3", "connected");
        setter.ask(&format!("send mode 1 4 {length}"), "sent");
        let mut raw = RawPeer::join(&system.address("latched", MODE), "SUB");
        raw.send(&zmtp::subscribe(b"\x07")).expect("subscribed");
        setter.ask("connected mode 3", "connected");
        pong(&mut raw);
        raw.send(&zmtp::subscribe(b"\x03")).expect("subscribed");
        assert_eq!(first_byte(&mut raw), 3);
        setter.ask(&format!("send mode 7 9 {length}"), "sent");
        assert_eq!(first_byte(&mut raw), 7);
        pong(&mut raw);
        raw.send(&zmtp::subscribe(b"")).expect("subscribed");
        assert_eq!(first_byte(&mut raw), 8);
        // It has had that one.
        raw.send(&zmtp::subscribe(b"\x08")).expect("subscribed");
        pong(&mut raw);
        setter.ask(&format!("send mode 9 10 {length}"), "sent");
        assert_eq!(first_byte(&mut raw), 9);
        assert_eq!(take_until(&mut getter, "mode", "9"), "9", "the component gets everything");
    });
}

/// With the length of messages that suits the transport.
fn on_every_transport(test: impl Fn(System, usize)) {
    for (kind, length) in [(TransportKind::Ipc, 1), (TransportKind::Tcp, 1), (TransportKind::Shm, LONG)] {
        test(System::over(kind), length);
    }
}

#[track_caller]
fn answer_as_it_is(process: &mut Process, command: &str) -> String {
    process.tell(command);
    process.next_line()
}

/// An answer without where the message is: the first ones of a connection are not in shared memory.
#[track_caller]
fn answer(process: &mut Process, command: &str) -> String {
    answer_as_it_is(process, command).replace(" shared", "")
}

#[track_caller]
fn take_until_latched(getter: &mut Process, gate: &str) -> String {
    take_until(getter, gate, "latched")
}

#[track_caller]
fn take_until(getter: &mut Process, gate: &str, end: &str) -> String {
    loop {
        let taken = answer(getter, &format!("take {gate}"));
        if taken.ends_with(end) {
            return taken;
        }
    }
}

/// Asserts that the account of each connection of a gate adds up, and how often it has sent its last message once more.
#[track_caller]
fn assert_adds_up(setter: &mut Process, gate: &str, again: u64) {
    let accounts = answer_as_it_is(setter, &format!("accounts {gate}"));
    assert!(!accounts.contains("WRONG"), "{accounts}");
    for account in accounts.split("; ").filter(|account| !account.contains("getter.oldest")) {
        assert!(account.contains(&format!(" {again} again")), "{account}");
    }
}

#[track_caller]
fn first_byte(peer: &mut RawPeer) -> u8 {
    peer.message().expect("a message")[0][0]
}

/// Returns when the publisher has read everything that this peer has sent.
#[track_caller]
fn pong(peer: &mut RawPeer) {
    peer.send(&zmtp::command("PING", b"\0\0read")).expect("sent");
    let answer = peer.frame().expect("an answer");
    assert_eq!(answer.body, b"\x04PONGread", "a message that it did not subscribe to");
}

/// What a new subscriber of the library `zeromq` receives first.
fn with_zeromq(url: &str) -> u8 {
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    runtime.block_on(async {
        let mut subscriber = SubSocket::new();
        subscriber.connect(url).await.expect("connected");
        subscriber.subscribe("").await.expect("subscribed");
        let message = subscriber.recv().await.expect("a message");
        message.get(0).expect("a frame")[0]
    })
}
