//! The cable's own test: bytes of a TCP connection.

use super::Shape;
use crate::network::{Network, address};
use scl_tests::Process;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

/// Set in the two processes of the test: `listen` or `connect`.
const SIDE: &str = "SCL_TEST_STREAM";
const TEST: &str = "cable::stream::bytes_cross_a_bad_cable";
const PORT: u16 = 4000;
/// Some hundred frames.
const LENGTH: usize = 300_000;

#[test]
fn bytes_cross_a_bad_cable() {
    match std::env::var(SIDE).as_deref() {
        Ok("listen") => listen(),
        Ok(_) => connect(),
        Err(_) => check(),
    }
}

pub(super) fn check() {
    let mut network = Network::new(&["board", "ground"]);
    let start = |host: usize, side: &str| {
        let mut command = network.hosts[host].command(std::env::current_exe().unwrap());
        command.args(["--exact", TEST, "--nocapture", "--test-threads=1"]).env(SIDE, side);
        Process::spawn(command)
    };
    let mut listening = start(1, "listen");
    listening.expect_containing("= listening");
    let mut connecting = start(0, "connect");
    connecting.expect_containing("= connected");
    for shape in [
        Shape::PERFECT,
        Shape { loss: 0.01, delay: 5.0, jitter: 5.0, rate: 0.0 },
        Shape { rate: 10e6, ..Shape::PERFECT },
    ] {
        network.cable.shape(0, shape);
        // Of some hundred frames, each of which is lost by chance, none may be lost.
        let mut lost = false;
        while !lost {
            connecting.tell("send");
            assert_eq!(listening.expect_containing("= "), format!("= {LENGTH} unchanged"));
            lost = shape.loss == 0.0 || network.cable.counts(0).1 > 0;
        }
    }
    let (passed, lost) = network.cable.counts(0);
    assert!(passed > 600 && lost > 0, "{passed} frames passed, {lost} lost");

    network.cable.shape(0, Shape::PERFECT);
    network.cable.cut(0);
    let (before, lost_before) = network.cable.counts(0);
    connecting.tell("send");
    scl_tests::wait_until("frames are lost", || network.cable.counts(0).1 > lost_before);
    assert_eq!(network.cable.counts(0).0, before, "no frame passed");
    assert_eq!(listening.try_next_line(), None);
    network.cable.repair(0);
    assert_eq!(listening.expect_containing("= "), format!("= {LENGTH} unchanged"));
}

fn listen() {
    let listener = TcpListener::bind((address(1), PORT)).unwrap();
    println!("= listening");
    let (mut stream, _) = listener.accept().unwrap();
    let mut bytes = vec![0; LENGTH];
    while stream.read_exact(&mut bytes).is_ok() {
        let word = if bytes == content() { "unchanged" } else { "changed" };
        println!("= {LENGTH} {word}");
    }
}

fn connect() {
    let mut stream = TcpStream::connect((address(1), PORT)).unwrap();
    println!("= connected");
    for _line in std::io::stdin().lines() {
        stream.write_all(&content()).unwrap();
    }
}

fn content() -> Vec<u8> {
    (0..LENGTH).map(|index| (index * index / 7) as u8).collect()
}
