//! A program of another user on the same machine, with plain sockets: `stranger connect PORT SOCKET_TYPE`,
//! `stranger listen PORT SOCKET_TYPE` or `stranger flood PORT CONNECTIONS`.

use scl_tests::zmtp::{greeting, message, ready, subscribe};
use scl_tests::{Address, RawListener, RawPeer, say};
use std::net::{Ipv4Addr, TcpListener};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [what, port, socket_type] = &arguments[..] else {
        return say("usage: stranger connect|listen|flood PORT WORD");
    };
    let address = (Ipv4Addr::LOCALHOST, port.parse().expect("a port"));
    if what == "connect" {
        connect(&Address::Tcp(address.into()), socket_type);
    } else if what == "flood" {
        flood(&Address::Tcp(address.into()), socket_type.parse().expect("a number"));
    } else {
        listen(&TcpListener::bind(address).expect("the port is free"), socket_type);
    }
}

/// Says everything that a peer would say, without waiting for an answer, and reports what it hears.
fn connect(address: &Address, socket_type: &str) {
    let mut peer = RawPeer::connect(address);
    let said = match socket_type {
        "SUB" => subscribe(b""),
        "PUSH" => message(&[b"\x08\x05"]),
        _ => message(&[b"", b"\x08\x05"]),
    };
    for bytes in [greeting(), ready(socket_type), said] {
        // It may be disconnected in the midst of it.
        let _closed = peer.send(&bytes);
    }
    say(format!("heard {} bytes", peer.wait_until_closed().len()));
}

/// Connects again and again, each time until it is disconnected.
fn flood(address: &Address, connections: usize) {
    for _ in 0..connections {
        RawPeer::connect(address).wait_until_closed();
    }
    say("refused");
}

/// Greets every peer that connects, and reports what it sends.
fn listen(listener: &TcpListener, socket_type: &str) {
    listener.set_nonblocking(true).expect("no waiting");
    say("listening");
    let listener = RawListener::Tcp(listener.try_clone().expect("a duplicate"));
    loop {
        let mut peer = listener.accept();
        let _closed = peer.send(&[greeting(), ready(socket_type)].concat());
        say(format!("heard {} bytes", peer.wait_until_closed().len()));
    }
}
