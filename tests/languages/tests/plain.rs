//! Programs with nothing but libzmq, through pyzmq, on the connections of SCL programs. Those that no library can play
//! are in the tests without other languages.

use crate::programs::{IMAGES, LATCHED, LISTING1, TWIN, open, open_with};
use scl::TransportKind;
use scl_tests::{Process, System, start_python, wait_until};
use std::thread::park_timeout;
use std::time::Duration;

#[test]
fn a_plain_zeromq_program_plays_the_user_interface() {
    let system = System::new();
    let _controller = system.start(LISTING1, &["controller"]);
    let folder = system.runtime_dir().join("listing1");
    let mut plain = start_python("user_interface.py", &[folder.to_str().expect("a path in UTF-8")]);
    plain.expect("b'done'");
    plain.expect("b'faster'");
    assert!(plain.wait_for_exit().status.success());
}

#[test]
fn a_request_that_does_not_decode_names_gate_peer_and_codec_and_the_next_is_served() {
    let system = System::new();
    let mut sink = open(&system, "sink");
    sink.tell("serve 2");
    let folder = system.runtime_dir().join("six");
    let mut plain = start_python("garbage.py", &[folder.to_str().expect("a path in UTF-8")]);
    let error = sink.next_line();
    for word in ["error: ", "`sink.answer`", "`source.question`", "protobuf"] {
        assert!(error.contains(word), "{error}");
    }
    sink.expect("served");
    plain.expect(r"b'\x08\n'");
    assert!(plain.wait_for_exit().status.success());
}

#[test]
fn a_message_of_several_frames_is_skipped_and_counted() {
    let system = System::new();
    let mut sink = open(&system, "sink");
    let mut plain = start_plain(&system, "multipart");
    plain.expect("sent");
    // The good message was sent after the other, so that one has been skipped by now.
    sink.ask("pull 1", "5..6");
    sink.ask("rejected", "1");
    sink.tell("serve 1");
    let mut plain = start_plain(&system, "two_bodies");
    sink.expect("served");
    plain.expect(r"b'\x08\n'");
}

#[test]
fn a_subscriber_with_heartbeats_stays_connected() {
    let system = System::new();
    let mut source = open(&system, "source");
    let mut plain = start_plain(&system, "heartbeats");
    source.ask("peers 1", "peers");
    // It sends one each millisecond.
    for value in 0..200 {
        source.ask(&format!("publish {value} {}", value + 1), "published");
        plain.expect(&value.to_string());
    }
    plain.ask("still connected?", "yes");
}

#[test]
fn a_subscriber_gets_what_others_get_in_shared_memory() {
    let system = System::over(TransportKind::Shm);
    let mut camera = open_with(&system, IMAGES, "camera");
    let mut plain = start_python("images.py", &[&system.address("images", "camera.frames--viewer.frames.").url()]);
    plain.expect("open");
    wait_until("it has subscribed", || {
        camera.tell("reach 1000");
        camera.next_line() == "1"
    });
    for number in 0..4 {
        let length = if number % 2 == 0 { 4 << 20 } else { 100 };
        camera.tell(&format!("lend {number} {} {length}", number + 1));
        camera.next_line();
        plain.expect_containing(&format!("{number} {length}"));
    }
}

/// The promise: the last message comes once for each connection.
#[test]
fn a_late_subscriber_gets_the_last_message() {
    for (kind, length) in [(TransportKind::Ipc, 1), (TransportKind::Tcp, 1), (TransportKind::Shm, 100_000)] {
        let system = System::over(kind);
        let mut setter = open_with(&system, LATCHED, "setter");
        setter.ask(&format!("send mode 0 1 {length}"), "sent");
        let mut plain = start_python("latched.py", &[&system.address("latched", "setter.mode--getter.mode.").url()]);
        plain.expect("0");
        setter.ask(&format!("send mode 1 2 {length}"), "sent");
        plain.expect("1");
    }
}

/// The promise: every observer gets everything, and the second frame is part of the message for any ZeroMQ program.
#[test]
fn observers_with_plain_zeromq_get_two_frames() {
    let system = System::new();
    let mut left = system.start(TWIN, &["left", "current_thread"]);
    left.expect("open");
    let address = system.address("twins", "left.values.tap").url();
    let mut observers = [start_python("tap.py", &[&address]), start_python("tap.py", &[&address])];
    for observer in &mut observers {
        // A subscriber of plain ZeroMQ does not know when it is connected.
        let line = loop {
            match observer.try_next_line() {
                Some(line) => break line,
                None => left.ask("publish 7 8", "published"),
            }
            park_timeout(Duration::from_millis(1));
        };
        assert_eq!(line, "0807 32 bytes");
    }
}

fn start_plain(system: &System, script: &str) -> Process {
    let folder = system.runtime_dir().join("six");
    start_python("strange_sender.py", &[folder.to_str().expect("a path in UTF-8"), script])
}
