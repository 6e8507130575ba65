//! Messages that follow each other faster than the sending gate's task runs.

use super::stage::{ENDPOINT, Stage, next, number, numbered, once};
use crate::error::GateName;
use crate::gate::Connection;
use crate::spec::{ConnectionSpec, GateKind, GateOptions, GateSpec, WhenFull};
use crate::state::{Changes, SendingEnd};
use crate::transport::Transport;
use crate::transport::zeromq::TransportKind;
use std::future::poll_fn;
use std::task::Poll;

const LINK: ConnectionSpec = ConnectionSpec {
    peer_component: "controller",
    peer_gate: "in",
    endpoint: ENDPOINT,
    contract: "1a2b3c4d",
    required: true,
    queue: 1000,
    when_full: WhenFull::DropOldest,
    max_size: 1 << 20,
    max_age: None,
};

static GATE: GateSpec = GateSpec {
    name: "out",
    kind: GateKind::Pub,
    payload: "bytes",
    codec: "bytes",
    declared_at: "topology.yaml:6:9",
    endpoint: "",
    tap: "",
    contract: "1a2b3c4d",
    options: GateOptions::DEFAULT,
    connections: &[LINK],
};

#[tokio::test]
async fn what_is_held_back_is_written_before_a_call_waits() {
    let stage = Stage::new(TransportKind::Ipc);
    let sender = stage.transport.publish(&super::stage::endpoint()).unwrap();
    let gate = GateName::new("sensor", "out");
    let mut connection = Connection::new(sender, gate, &GATE, &GATE.connections[0], Changes::default(), None);
    let mut receiver = stage.subscriber();
    poll_fn(|cx| {
        connection.drive(cx);
        assert!(receiver.poll_recv(cx).is_pending());
        if connection.is_connected() { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
    for first in (0..10_000).step_by(500) {
        let mut messages = numbered(first..first + 500);
        let mut sent = 0;
        // The first messages of a burst are written one by one; a clock tick between them may start that again.
        while sent < 500 && connection.leftover(false).is_none() {
            connection.send(messages.next().unwrap().into());
            sent += 1;
        }
        assert!(sent > 1, "a message that is sent by itself is written by its call");
        assert!(connection.write_out());
        assert!(connection.leftover(false).is_none());
        for expected in first..first + sent {
            assert_eq!(number(&next(&mut *receiver).await), expected);
        }
        once(|cx| connection.drive(cx)).await;
        if sent < 500 {
            return;
        }
    }
    panic!("no burst was held back");
}
