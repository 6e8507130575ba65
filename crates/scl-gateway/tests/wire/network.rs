//! Hosts, routes and what both ends of a route do in most tests.

use std::collections::BTreeMap;
use std::future::poll_fn;

use bytes::Bytes;
use scl_gateway::route::{Pattern, Route, RouteEnd};
use scl_gateway::wire::{
    Neighbour, Peer, ReceiverEvent, ReplierEvent, RequesterEvent, SenderEvent, Wire, WireOptions, WireReceiver,
    WireReplier, WireRequester, WireSender,
};

/// A message route of 100 messages between components that are named like their hosts.
pub(super) fn route(from: &str, to: &str, gate: &str) -> Route {
    let end = |host: &str| RouteEnd {
        host: host.to_owned(),
        component: Some(format!("{host}_program")),
        gate: Some(gate.to_owned()),
    };
    Route {
        pattern: Pattern::Messages { listens_at_sender: true },
        from: end(from),
        to: end(to),
        endpoint: String::new(),
        queue: 100,
        lossless: true,
        latched: false,
        max_size: 4 << 20,
        key: format!("scl/system/{from}_program/{gate}/{to}_program/{gate}/c0"),
    }
}

pub(super) fn requests(from: &str, to: &str, gate: &str) -> Route {
    let route = route(from, to, gate);
    let key = route.key.replace(&format!("{from}_program/{gate}"), &format!("host:{from}/req"));
    Route {
        pattern: Pattern::Requests,
        from: RouteEnd { component: None, gate: None, ..route.from.clone() },
        key,
        ..route
    }
}

pub(super) fn free_address() -> String {
    scl_tests::free_address().to_string()
}

/// Options of a host without TLS. Names of components end the way [`route`] makes them.
pub(super) fn options(host: &str, listen: Option<&str>, peers: &[(&str, Option<&str>)]) -> WireOptions {
    let peers =
        peers.iter().map(|(host, address)| Peer { host: (*host).to_owned(), address: address.map(str::to_owned) });
    let hosts = ["board", "ground", "tower"];
    WireOptions {
        system: "system".to_owned(),
        host: host.to_owned(),
        listen: listen.map(str::to_owned),
        peers: peers.collect(),
        tls: None,
        insecure: false,
        routes: Vec::new(),
        components: BTreeMap::from(hosts.map(|host| (format!("{host}_program"), host.to_owned()))),
    }
}

/// `board` connects to `ground`, directly or through `via`.
pub(super) async fn two_hosts_via(address: &str, via: &str) -> (Wire, Wire) {
    let ground = Wire::open(options("ground", Some(address), &[("board", None)])).await;
    let board = Wire::open(options("board", None, &[("ground", Some(via))])).await;
    (board.expect("board"), ground.expect("ground"))
}

pub(super) async fn two_hosts() -> (Wire, Wire) {
    let address = free_address();
    two_hosts_via(&address, &address).await
}

/// Both ends of a route, open and matched.
pub(super) async fn connected(route: &Route, from: &Wire, to: &Wire) -> (WireSender, WireReceiver) {
    let (mut sender, mut receiver) = (from.sender(route), to.receiver(route));
    sender.set_open(true);
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Matched);
    receiver.set_open(true);
    assert_eq!(sent(&mut sender).await, SenderEvent::Matched);
    (sender, receiver)
}

pub(super) async fn sent(sender: &mut WireSender) -> SenderEvent {
    poll_fn(|cx| sender.poll_event(cx)).await
}

pub(super) async fn received(receiver: &mut WireReceiver) -> ReceiverEvent {
    poll_fn(|cx| receiver.poll_event(cx)).await
}

pub(super) async fn requested(requester: &mut WireRequester) -> RequesterEvent {
    poll_fn(|cx| requester.poll_event(cx)).await
}

pub(super) async fn replied(replier: &mut WireReplier) -> ReplierEvent {
    poll_fn(|cx| replier.poll_event(cx)).await
}

pub(super) async fn neighbour(wire: &Wire) -> Neighbour {
    poll_fn(|cx| wire.poll_neighbour(cx)).await
}

/// Waits for a neighbour's event that fulfils the condition.
pub(super) async fn neighbour_that(wire: &Wire, condition: impl Fn(&Neighbour) -> bool) -> Neighbour {
    loop {
        let event = neighbour(wire).await;
        if condition(&event) {
            return event;
        }
    }
}

/// Sends within the credit, and waits until everything is acknowledged. Returns how many were given up.
pub(super) async fn send_all(sender: &mut WireSender, messages: impl IntoIterator<Item = Bytes>) -> u64 {
    let mut given_up = 0;
    let mut note = |event| given_up += if let SenderEvent::GivenUp(count) = event { count } else { 0 };
    for message in messages {
        while !sender.may_send(message.len()) {
            note(sent(sender).await);
        }
        sender.send(message);
    }
    while sender.unacknowledged() > 0 {
        note(sent(sender).await);
    }
    given_up
}

/// Receives and acknowledges as many messages.
pub(super) async fn receive(receiver: &mut WireReceiver, count: usize) -> Vec<Bytes> {
    let mut messages = Vec::new();
    while messages.len() < count {
        if let ReceiverEvent::Message(message) = received(receiver).await {
            messages.push(message);
            receiver.acknowledge(messages.len() as u64);
        }
    }
    messages
}

/// Messages that say which they are, of many lengths: also empty payloads behind the number, and several pieces.
pub(super) fn numbered(count: usize) -> Vec<Bytes> {
    let lengths = [0, 1, 100, 3_000, 40_000, 7, 90_000];
    let message = |number: usize| {
        let mut bytes = (number as u64).to_be_bytes().to_vec();
        bytes.extend((0..lengths[number % lengths.len()]).map(|index| (index * 7 + number) as u8));
        bytes.into()
    };
    (0..count).map(message).collect()
}
